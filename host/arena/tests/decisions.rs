//! `decisions`: tests: what explains a decision is what it was decided on. In whole matches the reports that
//! hosts receive by radio are those that the robots themselves keep; in matches and trials the explanation of
//! each problem names the robot's own decision, with every margin of its winner, its correspondence and "no
//! case fits", and those of the cycle's own beacons.

use std::collections::BTreeMap;

use arena::game::{Game, GameConfig, Watcher, play};
use arena::{CycleEvent, CycleLog, Moment, TrialConfig, TrialReport};
use brain::Approach;
use casebase::{CaseBase, CaseVerdict, Match, Problem, RetrievalSettings, rank_order};
use hil_sim::{Configuration, NativeBackend, Scenario};
use host::strategy::Tactics;
use protocol::decision::{DecisionReport, Grounds};
use protocol::{CycleId, RobotId};
use rules::{Colour, League};

/// What the explanation of a problem names as the winner.
fn winner(base: &CaseBase<'_>, problem: &Problem) -> Option<Match> {
    let settings = RetrievalSettings::default();
    let mut found: Vec<Match> = Vec::new();
    casebase::explain(base, problem, &settings, |_, verdict| {
        if let CaseVerdict::Candidate(candidate) = verdict {
            found.push(candidate);
        }
    });
    found.into_iter().min_by(|a, b| rank_order(a, b, &settings))
}

/// Compares a decision with the explanation of its problem, and returns what the explanation names.
fn explain(base: &CaseBase<'_>, report: &DecisionReport) -> Option<Match> {
    let Some(problem) = Problem::of(report) else {
        assert_eq!(report.case, None);
        return None;
    };
    let best = winner(base, &problem);
    // The robots' own retrieval is another program than the explanation: it looks up an index and stops
    // early. Every margin of the winner is equal to the bit.
    assert_eq!(casebase::retrieve_best(base, &problem, &RetrievalSettings::default()), best);
    match report.grounds {
        Grounds::Retrieved => {
            assert_eq!(best.as_ref().map(|best| best.case), report.case, "{report:?}");
        }
        Grounds::Holds(holder) => {
            let best = best.as_ref().expect("a best case gives the ball to another");
            let getter = base.case(best.case).map(|case| best.correspondence[case.getter().index()]);
            assert_ne!(getter, Some(holder));
            assert_eq!(report.case, None);
        }
        Grounds::ShootsSooner => assert!(best.is_some() && report.case.is_none()),
        Grounds::BallRolls | Grounds::NoBall => assert_eq!(report.case, None),
        Grounds::Proposed => assert!(report.case.is_some()),
    }
    best
}

/// The cycles of a team as told by beacons, and its robots' reports.
#[derive(Default)]
struct Ledger {
    cycles: CycleLog,
    reports: BTreeMap<CycleId, DecisionReport>,
    /// Every decision of every robot as it keeps it itself, those that no other robot ever heard of among
    /// them.
    own: BTreeMap<(CycleId, RobotId), DecisionReport>,
    decided: usize,
}

impl Ledger {
    fn report(&mut self, report: &DecisionReport) {
        self.reports.entry(report.cycle).or_insert_with(|| report.clone());
    }

    /// Compares every decision with the explanation of its report.
    fn judge(&self, base: &CaseBase<'_>, end: f32) -> Unreported {
        let mut unreported = Unreported::default();
        for cycle in self.cycles.cycles() {
            if cycle.play.is_none() && !cycle.no_case {
                continue;
            }
            let Some(report) = self.reports.get(&cycle.id) else {
                let replaced = cycle.end.as_ref().map(|(at, _)| *at);
                if replaced.unwrap_or(end) - cycle.start > REPORTED_WITHIN {
                    unreported.lasting += 1;
                } else if replaced.is_some() {
                    unreported.replaced += 1;
                }
                continue;
            };
            assert_eq!(report.case, cycle.play.as_ref().map(|play| play.case), "{report:?}");
            let best = explain(base, report);
            if report.grounds == Grounds::Retrieved {
                let robots = best.map(|best| best.correspondence.iter().copied().collect::<Vec<_>>());
                assert_eq!(robots, cycle.play.as_ref().map(|play| play.robots.to_vec()));
            }
        }
        unreported
    }
}

/// Numbers of decisions without a report; one at the very end of a match may still be on its way.
#[derive(Debug, Default, PartialEq)]
struct Unreported {
    /// Those that stood for longer than a report takes.
    lasting: usize,
    /// Those that were replaced before.
    replaced: usize,
}

/// Length of a match, s.
const SECONDS: f64 = 60.0;
/// A decision is reported in two or three parts, each twice, in steps of 10 ms that send nothing else: one
/// that is replaced sooner may never be, s.
const REPORTED_WITHIN: f32 = 0.1;

#[derive(Default)]
struct Teams([Ledger; 2]);

impl Watcher for Teams {
    fn tick(&mut self, game: &Game<'_>) {
        for colour in [Colour::Blue, Colour::Yellow] {
            let (host, ledger) = (game.host(colour), &mut self.0[colour as usize]);
            for robot in RobotId::all() {
                if let Some(state) = host.beacon(robot).and_then(|beacon| beacon.cycle.as_ref()) {
                    let event = ledger.cycles.receive(game.time() as f32, state);
                    ledger.decided += usize::from(matches!(event, CycleEvent::Decided(_)));
                }
            }
            for (robot, decision) in game.decisions(colour) {
                ledger.own.entry((decision.cycle, robot)).or_insert(decision);
            }
            for robot in RobotId::all() {
                if let Some(report) = host.decision(robot) {
                    assert_eq!(Some(report), ledger.own.get(&(report.cycle, robot)), "by radio, and its own");
                    ledger.report(report);
                }
            }
        }
    }
}

#[test]
fn in_three_matches_every_decision_is_explained_by_its_own_problem() {
    let base = case_library::division_b();
    for seed in [5, 11, 23] {
        let mut config = GameConfig::new(League::DivisionB, seed, SECONDS);
        // Who plays by the rated list decides on cases more rarely.
        config.teams.iter_mut().for_each(|team| team.tactics = Tactics::ROUND_1);
        let mut teams = Teams::default();
        play(&config, &mut NativeBackend::new(base), &mut teams).unwrap();
        for ledger in &teams.0 {
            let unreported = ledger.judge(&base, SECONDS as f32);
            ledger.own.values().for_each(|decision| drop(explain(&base, decision)));
            assert!(ledger.own.len() > 20, "{}", ledger.own.len());
            assert!(ledger.decided > 20, "{}", ledger.decided);
            // Orders that change every few steps would replace many.
            assert!(
                unreported.lasting == 0 && unreported.replaced <= 1,
                "{unreported:?} of {}",
                ledger.decided
            );
        }
    }
}

#[derive(Default)]
struct Trial(Ledger);

impl arena::Watcher for Trial {
    fn watch(&mut self, moment: &Moment<'_>) {
        for (_, report) in moment.decisions {
            self.0.report(report);
        }
    }

    fn end(&mut self, moment: &Moment<'_>, _report: &TrialReport) {
        self.0.cycles = moment.cycles.clone();
    }
}

#[test]
fn in_forty_trials_every_decision_is_explained_by_its_own_problem() {
    let mut decided = 0;
    for seed in 0..40 {
        let scenario = Scenario::ALL[seed as usize % Scenario::ALL.len()];
        let opponents = Configuration::TwoDefenders;
        let config = TrialConfig::new(scenario, opponents, Approach::Cases, seed);
        let mut trial = Trial::default();
        arena::run(&config, Box::new(NativeBackend::new(config.base)), &mut [&mut trial]).unwrap();
        assert_eq!(trial.0.judge(&config.base, f32::INFINITY), Unreported::default(), "seed {seed}");
        decided += trial.0.reports.len();
    }
    assert!(decided > 200, "{decided}");
}
