//! `decisions`: tests: what explains a decision is what it was decided on. In whole matches the reports that
//! hosts receive by radio are those that the robots themselves keep; in matches and trials the explanation of
//! each problem names the robot's own decision, with every margin of its winner, its correspondence and "no
//! case fits", and those of the cycle's own beacons. Cases that lose are held to the oracle, which knows
//! docs/case-format.md alone: the same candidates, with the same margins. What a recorded trace gives again
//! are the same reports.

use std::collections::BTreeMap;
use std::io::BufReader;
use std::path::Path;

use arena::game::{Game, GameConfig, Watcher, header, play};
use arena::{CycleEvent, CycleLog, Moment, TrialConfig, TrialReport};
use brain::Approach;
use casebase::{CaseBase, CaseVerdict, GoalEnd, Match, Problem, RetrievalSettings, rank_order};
use hil_sim::{Configuration, NativeBackend, Scenario};
use host::Input;
use host::radio::To;
use host::record::Recorder;
use host::record::header::RecordingHeader;
use host::record::recheck::Recheck;
use host::record::trace::Reader;
use host::strategy::Tactics;
use match_tests::oracle::library::{Goal, Library, Point};
use match_tests::oracle::{self, NEAR, Rules};
use protocol::decision::{DecisionReport, Grounds};
use protocol::frame::TeamKey;
use protocol::{CycleId, Instant, RobotId};
use rules::{Colour, League};

/// A robots' case base, and the same case files as the oracle reads them.
struct Cases {
    base: CaseBase<'static>,
    oracle: Library,
}

impl Cases {
    fn of(league: &str, base: CaseBase<'static>) -> Self {
        let directory = Path::new(env!("CARGO_MANIFEST_DIR")).join("../casebase/library/cases").join(league);
        let oracle = Library::read(&directory).expect("readable by the oracle");
        assert_eq!(base.len(), oracle.cases.len());
        Self { base, oracle }
    }

    /// The candidates that the explanation of a problem names, in the order of the rank.
    fn candidates(&self, problem: &Problem) -> Vec<Match> {
        let settings = RetrievalSettings::default();
        let mut found: Vec<Match> = Vec::new();
        casebase::explain(&self.base, problem, &settings, |_, verdict| {
            if let CaseVerdict::Candidate(candidate) = verdict {
                found.push(candidate);
            }
        });
        found.sort_by(|a, b| rank_order(a, b, &settings));
        found
    }

    /// Holds winner and losers to the oracle; false: it saw a near tie, and another answer may be right.
    fn agrees(&self, problem: &Problem, ours: &[Match]) -> bool {
        let point = |at: casebase::PointMm| Point { x: i64::from(at.x), y: i64::from(at.y) };
        let asked = oracle::problem::Problem {
            ball: point(problem.ball),
            defending: match problem.defending {
                GoalEnd::Negative => Goal::Yellow,
                GoalEnd::Positive => Goal::Cyan,
            },
            teammates: problem.teammates.iter().map(|(id, at)| (id.number(), point(*at))).collect(),
            opponents: problem.opponents.iter().map(|at| point(*at)).collect(),
        };
        let (theirs, near_tie) = oracle::ranked(&self.oracle, &asked, &Rules::default());
        let near = |a: f64, b: f32| (a - f64::from(b)).abs() <= NEAR * a.max(1.0);
        let same = theirs.len() == ours.len()
            && theirs.iter().zip(ours).all(|(a, b)| {
                let robots = b.correspondence.iter().map(|id| id.number());
                a.id == usize::from(b.case.0)
                    && near(a.similarity, b.similarity)
                    && near(a.cost, b.cost)
                    && a.conditions == usize::from(b.conditions)
                    && robots.eq(a.correspondence.iter().copied())
            });
        assert!(same || near_tie.is_some(), "{}: {theirs:?} expected, got {ours:?}", asked.to_line());
        same
    }
}

/// Compares a decision with the explanation of its problem, and returns what the explanation names.
fn explain(cases: &Cases, report: &DecisionReport, compared: &mut Compared) -> Option<Match> {
    let base = &cases.base;
    let Some(problem) = Problem::of(report) else {
        assert_eq!(report.case, None);
        return None;
    };
    let candidates = cases.candidates(&problem);
    compared.problems += 1;
    compared.losers += candidates.len().saturating_sub(1);
    compared.near_ties += usize::from(!cases.agrees(&problem, &candidates));
    let best = candidates.first().cloned();
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

/// What was held to the oracle.
#[derive(Debug, Default)]
struct Compared {
    problems: usize,
    /// Candidates that another case beat.
    losers: usize,
    /// Problems with a near tie that the oracle answers otherwise.
    near_ties: usize,
}

impl Compared {
    fn check_and_print(&self, least: usize) {
        eprintln!("{self:?}");
        assert!(self.problems >= least && self.losers > 0, "{self:?}");
        assert!(self.near_ties * 100 < self.problems.max(100), "{self:?}");
    }
}

/// The cycles of a team as beacons report them, and its robots' reports.
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
    fn judge(&self, cases: &Cases, end: f32, compared: &mut Compared) -> Unreported {
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
            let best = explain(cases, report, compared);
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

/// A decision is reported in two or three parts, each twice, in steps of 10 ms that send nothing else: one
/// that is replaced sooner may never be, s.
const REPORTED_WITHIN: f32 = 0.1;

struct Teams {
    ledgers: [Ledger; 2],
    recorder: Recorder,
}

impl Watcher for Teams {
    fn input(&mut self, now: Instant, host: Colour, input: Input<'_>) {
        self.recorder.input(now, host, input);
    }

    fn sent(&mut self, now: Instant, host: Colour, to: To, packet: &[u8]) {
        self.recorder.sent(now, host, to, packet);
    }

    fn tick(&mut self, game: &Game<'_>) {
        for colour in [Colour::Blue, Colour::Yellow] {
            let (host, ledger) = (game.host(colour), &mut self.ledgers[colour as usize]);
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

/// The reports that hosts give again when a trace is replayed, by team.
fn replayed(trace: &Path) -> [BTreeMap<CycleId, DecisionReport>; 2] {
    let file = BufReader::new(foreign::open(trace).expect("a trace"));
    let reader = Reader::new(flate2::bufread::MultiGzDecoder::new(file)).expect("its header");
    let header = RecordingHeader::from_json(reader.header()).expect("a header");
    let mut again = Recheck::new(&header, TeamKey::ZERO).expect("hosts");
    let mut reports = [BTreeMap::new(), BTreeMap::new()];
    for record in reader {
        assert!(again.feed(&record));
        let Some(host) = again.host(usize::from(record.host)) else { continue };
        let team: &mut BTreeMap<_, _> = &mut reports[host.settings().us as usize];
        for report in RobotId::all().filter_map(|robot| host.decision(robot)) {
            team.entry(report.cycle).or_insert_with(|| report.clone());
        }
    }
    for (counts, difference) in again.results() {
        assert!(difference.is_none() && counts.same > 1000, "{difference:?}");
    }
    reports
}

/// Three matches, `seconds` each.
fn matches(seconds: f64) {
    let cases = Cases::of("division-b", case_library::division_b());
    let mut compared = Compared::default();
    for seed in [5, 11, 2] {
        let mut config = GameConfig::new(League::DivisionB, seed, seconds);
        // Who plays by the rated list decides on cases more rarely.
        config.teams.iter_mut().for_each(|team| team.tactics = Tactics::ROUND_1);
        let stem = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("decisions-{seconds}-{seed}"));
        let recorder = Recorder::begin(&stem, &header("test", "test", &config)).expect("a recording");
        let mut teams = Teams { ledgers: Default::default(), recorder };
        play(&config, &mut NativeBackend::new(cases.base), &mut teams).unwrap();
        teams.recorder.finish().expect("written");
        let [log, trace] = Recorder::files(&stem);
        let again = replayed(&trace);
        for (ledger, again) in teams.ledgers.iter().zip(&again) {
            let unreported = ledger.judge(&cases, seconds as f32, &mut compared);
            for decision in ledger.own.values() {
                explain(&cases, decision, &mut compared);
            }
            assert!(ledger.own.len() > 20, "{}", ledger.own.len());
            assert!(ledger.decided > 20, "{}", ledger.decided);
            assert_eq!(&ledger.reports, again, "live, and from the trace");
            // Orders that change every few steps would replace many.
            assert!(
                unreported.lasting == 0 && unreported.replaced * 50 <= ledger.decided.max(50),
                "{unreported:?} of {}",
                ledger.decided
            );
            eprintln!(
                "seed {seed}: {} decided, {} of robots, {unreported:?}",
                ledger.decided,
                ledger.own.len()
            );
        }
        for file in [log, trace] {
            std::fs::remove_file(file).expect("it was there");
        }
    }
    compared.check_and_print(200);
}

/// Whole matches take minutes: `DECISIONS_SECONDS=600 cargo test --release -p match-tests --test decisions`.
#[test]
fn in_three_matches_every_decision_is_explained_by_its_own_problem() {
    let seconds = std::env::var("DECISIONS_SECONDS").map(|text| text.parse().expect("seconds of a match"));
    matches(seconds.unwrap_or(180.0));
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
    let cases = Cases::of("four-legged", case_library::four_legged());
    let (mut decided, mut compared) = (0, Compared::default());
    for seed in 0..40 {
        let scenario = Scenario::ALL[seed as usize % Scenario::ALL.len()];
        let opponents = Configuration::TwoDefenders;
        let config = TrialConfig::new(scenario, opponents, Approach::Cases, seed);
        let mut trial = Trial::default();
        arena::run(&config, Box::new(NativeBackend::new(config.base)), &mut [&mut trial]).unwrap();
        assert_eq!(config.base.hash(), cases.base.hash());
        let unreported = trial.0.judge(&cases, f32::INFINITY, &mut compared);
        assert_eq!(unreported, Unreported::default(), "seed {seed}");
        decided += trial.0.reports.len();
    }
    assert!(decided > 200, "{decided}");
    compared.check_and_print(200);
}
