//! `ledger`: tests: in a whole match the ledger counts the cycles that beacons tell of and no others, and
//! what followed is what the referee's and the physics' own events allow.

use std::collections::BTreeMap;

use arena::game::{Game, GameConfig, GameReport, Watcher, play};
use arena::ledger::{CaseTable, FOLLOWED, FOLLOWS_WITHIN, Followed, SituationTally};
use arena::{CaseNames, CycleEnd, CycleLog, CycleSeen};
use hil_sim::NativeBackend;
use hil_sim::small_size::PhysicsEvent;
use host::strategy::Tactics;
use protocol::team::{AbortReason, Closure};
use protocol::{RobotId, Who};
use rules::{Colour, League, Phase};

/// Length of the match, s.
const SECONDS: f64 = 150.0;

/// The same match by other means: logs of beacons, goals of the referee's accounts, kicks of the physics.
#[derive(Default)]
struct Witness {
    logs: [CycleLog; 2],
    score: [u32; 2],
    goals: Vec<(f64, Colour)>,
    kicks: Vec<(f64, Who)>,
    /// Last moment at which the ball was not in play.
    stands: Vec<(f64, f64)>,
}

impl Watcher for Witness {
    fn tick(&mut self, game: &Game<'_>) {
        let now = game.time();
        for colour in Colour::ALL {
            let log = &mut self.logs[colour as usize];
            for robot in RobotId::all() {
                if let Some(state) = game.host(colour).beacon(robot).and_then(|beacon| beacon.cycle.as_ref())
                {
                    log.receive(now as f32, state);
                }
            }
            let score = game.referee().accounts().of(colour).score;
            if score > std::mem::replace(&mut self.score[colour as usize], score) {
                self.goals.push((now, colour));
            }
        }
        for event in game.events() {
            if let PhysicsEvent::Kicked { robot, .. } = event {
                self.kicks.push((now, *robot));
            }
        }
        let runs = matches!(game.referee().phase(), Phase::Run | Phase::FreeKick(_) | Phase::Kickoff(_));
        match self.stands.last_mut() {
            _ if runs => {}
            Some((_, until)) if now - *until < 0.015 => *until = now,
            _ => self.stands.push((now, now)),
        }
    }
}

fn witnessed(seed: u64) -> (GameReport, Witness) {
    let mut config = GameConfig::new(League::DivisionB, seed, SECONDS);
    // Robots that are left to themselves play most cases.
    for team in &mut config.teams {
        team.tactics = Tactics::NONE;
    }
    let mut witness = Witness::default();
    let mut backend = NativeBackend::new(case_library::division_b());
    let report = play(&config, &mut backend, &mut witness).unwrap();
    (report, witness)
}

fn plays(log: &CycleLog) -> impl Iterator<Item = &CycleSeen> {
    log.cycles().iter().filter(|cycle| cycle.play.is_some())
}

fn by_label<'a>(labels: impl Iterator<Item = &'a str>) -> BTreeMap<String, u32> {
    let mut counts = BTreeMap::new();
    for label in labels {
        *counts.entry(label.to_owned()).or_default() += 1;
    }
    counts
}

#[test]
fn the_ledger_agrees_with_beacons_referee_and_physics() {
    let names = CaseNames::new(case_library::league("division-b").unwrap().names.iter().copied());
    for seed in [5, 11] {
        let (report, witness) = witnessed(seed);
        for (colour, metrics) in Colour::ALL.into_iter().zip([&report.metrics.yellow, &report.metrics.blue]) {
            let (log, table) = (&witness.logs[colour as usize], &metrics.cases);
            same_cycles(log, table, &names);
            sums_agree(table);
            witness.allows(colour, table);
        }
    }
}

fn same_cycles(log: &CycleLog, table: &CaseTable, names: &CaseNames) {
    let of = |cycle: &CycleSeen| cycle.play.as_ref().map_or_else(String::new, |play| names.of(play.case));
    let retrieved: BTreeMap<String, u32> =
        table.cases.iter().map(|line| (line.case.clone(), line.all.retrieved)).collect();
    let seen: Vec<String> = plays(log).map(of).collect();
    assert!(seen.len() > 10, "{}", seen.len());
    assert_eq!(retrieved, by_label(seen.iter().map(String::as_str)));
    for line in &table.cases {
        let ends = plays(log).filter(|cycle| of(cycle) == line.case);
        let ends = ends.map(|cycle| cycle.end.map_or("trial-over", |(_, end)| end.label()));
        assert_eq!(line.all.ends, by_label(ends), "{}", line.case);
    }
    let none = log.cycles().iter().filter(|cycle| cycle.no_case && cycle.play.is_none()).count();
    assert_eq!(table.no_case as usize, none);
}

fn sums_agree(table: &CaseTable) {
    for line in &table.cases {
        let all = &line.all;
        let sum = |of: fn(&arena::ledger::CaseTally) -> u32| line.by_opponents.values().map(of).sum::<u32>();
        assert_eq!(all.retrieved, sum(|tally| tally.retrieved));
        assert_eq!((all.passes, all.passes_arrived), (sum(|t| t.passes), sum(|t| t.passes_arrived)));
        assert_eq!(FOLLOWED.map(|what| all.followed(what)).iter().sum::<u32>(), all.retrieved);
        assert_eq!(all.ends.values().sum::<u32>(), all.retrieved);
        assert_eq!(all.finished, all.ends.get("finished").copied().unwrap_or(0));
        assert!(all.passes_arrived <= all.passes);
        assert!(line.by_opponents.keys().all(|n| (1..=6).contains(n)), "{:?}", line.by_opponents.keys());
    }
    assert_eq!(table.no_case, table.no_case_by_opponents.values().sum::<u32>());
    assert_eq!(table.no_case, table.no_case_because.values().sum::<u32>());
    for tally in table.by_situation.values() {
        assert_eq!(tally.followed_by.values().sum::<u32>(), tally.possessions);
        assert_eq!(tally.ends.values().sum::<u32>(), tally.plays);
        assert!(tally.with_case <= tally.plays.min(tally.possessions), "{tally:?}");
    }
    let sum = |of: fn(&SituationTally) -> u32| table.by_situation.values().map(of).sum::<u32>();
    assert!(sum(|tally| tally.possessions) > 8, "{:?}", table.by_situation);
    // Cases are decided on for balls that no robot has, too, and end before one has it.
    let plays = sum(|tally| tally.plays);
    assert!((1..=table.retrieved).contains(&plays), "{plays} of {}", table.retrieved);
    assert_eq!(CaseTable::read(&table.column()), *table);
}

impl Witness {
    fn allows(&self, colour: Colour, table: &CaseTable) {
        let log = &self.logs[colour as usize];
        let (mut kicks, mut goals) = (0, 0);
        for cycle in plays(log) {
            let (start, end) = (f64::from(cycle.start), cycle.end.map_or(SECONDS, |(at, _)| f64::from(at)));
            let within = |at: f64| at >= start && at <= end;
            let has_part = |who: &Who| {
                who.colour == colour && cycle.play.as_ref().is_some_and(|play| play.robots.contains(&who.id))
            };
            kicks += self.kicks.iter().filter(|(at, by)| within(*at) && has_part(by)).count();
            let scored =
                |(at, by): &(f64, Colour)| *by == colour && *at > start && *at < end + FOLLOWS_WITHIN;
            goals += u32::from(self.goals.iter().any(scored));
            // The referee's own word for what robots say of it.
            let stopped = Closure::Aborted { by: RobotId::ZERO, reason: AbortReason::GameStopped };
            if cycle.end.is_some_and(|(_, why)| why.label() == CycleEnd::Closed(stopped).label()) {
                let stands = self.stands.iter().any(|(from, until)| (*from..*until + 0.5).contains(&end));
                assert!(stands, "{cycle:?}, {:?}", self.stands);
            }
        }
        let sum = |of: &dyn Fn(&arena::ledger::CaseTally) -> u32| {
            table.cases.iter().map(|line| of(&line.all)).sum::<u32>()
        };
        let passes = sum(&|tally| tally.passes);
        assert!(passes > 0 && passes as usize <= kicks, "{passes} passes of {kicks} kicks");
        let followed = sum(&|tally| tally.followed(Followed::Goal));
        assert!(followed <= goals, "{followed} plays with goals, {goals} with goals near them");
    }
}
