//! Tests: trials are repeatable, reported as docs/case-format.md §5.2 specifies, and sensitive to a single
//! bit. With full brains, in process.

use hil_sim::{Fault, NativeBackend};

use crate::profile::Profile;

use super::*;
use crate::story::TextLog;

fn play(config: &TrialConfig<'static>) -> TrialReport {
    run(config, Box::new(NativeBackend::new(config.base)), &mut []).unwrap()
}

fn config(seed: u64) -> TrialConfig<'static> {
    TrialConfig::new(Scenario::DefenderAhead, Configuration::TwoDefenders, Approach::Cases, seed)
}

#[test]
fn the_same_seed_plays_the_same_trial_and_another_another() {
    let (one, again, other) = (play(&config(1)), play(&config(1)), play(&config(2)));
    assert_eq!(one, again);
    assert_ne!(one.trace_hash, other.trace_hash);
}

#[test]
fn one_flipped_bit_of_one_order_changes_the_hash() {
    let mut flipped = config(1);
    let fault = Fault::FlipOrderBit { robot: RobotId::new(1).unwrap(), bit: 0 };
    flipped.faults.push(ScheduledFault { tick: 20, fault });
    assert_ne!(play(&flipped).trace_hash, play(&config(1)).trace_hash);
}

#[test]
fn watching_changes_nothing() {
    let config = config(3);
    let (mut story, mut recording) = (TextLog::default(), crate::Recording::default());
    let backend = Box::new(NativeBackend::new(config.base));
    let watched = run(&config, backend, &mut [&mut story, &mut recording]).unwrap();
    assert_eq!(watched, play(&config));
    assert!(story.take_lines().len() > 3);
    // Ticks of 40 ms; the verdict falls into the last.
    let ticks = (watched.time_s / 0.04).ceil() as usize;
    assert!(recording.samples.len().abs_diff(ticks) <= 1);
}

#[test]
fn the_story_of_a_trial_is_in_the_order_of_time() {
    for seed in 1..=20 {
        let config = config(seed);
        let mut story = TextLog::default();
        run(&config, Box::new(NativeBackend::new(config.base)), &mut [&mut story]).unwrap();
        let times: Vec<f32> = (story.take_lines().iter())
            .map(|line| line.split_whitespace().next().unwrap().parse().unwrap())
            .collect();
        assert!(times.is_sorted(), "seed {seed}: {times:?}");
    }
}

#[test]
fn every_scenario_against_both_configurations_ends_in_both_approaches() {
    for scenario in Scenario::PAPER.into_iter().chain([Scenario::Random]) {
        for opponents in [Configuration::DefenderGoalie, Configuration::TwoDefenders] {
            for approach in [Approach::Cases, Approach::Reactive] {
                let report = play(&TrialConfig::new(scenario, opponents, approach, 5));
                assert!(report.time_s > 0.0 && report.time_s <= 600.0, "{report:?}");
                if approach == Approach::Reactive {
                    assert_eq!(report.cases, CaseCounts::default());
                }
            }
        }
    }
}

#[test]
fn a_report_has_the_fields_of_the_agreement_in_their_order() {
    let text = serde_json::to_string(&play(&config(1))).unwrap();
    let order = [
        "{\"scenario\":3,",
        "\"opponents\":\"2d\",",
        "\"approach\":\"cbr\",",
        "\"backend\":\"native\",",
        "\"seed\":1,",
        "\"outcome\":\"",
        "\"time_s\":",
        "\"possession\":{\"defender\":",
        "\"midfield\":",
        "\"backups\":{\"A\":",
        "\"B\":",
        "\"out_by\":",
        "\"cases\":{\"individual\":",
        "\"cooperative\":",
        "\"none\":",
        "\"cycles\":[{\"cycle\":\"",
        "\"coordinator\":",
        "\"case\":",
        "\"symmetry\":",
        "\"match\":",
        "\"start_s\":",
        "\"end_s\":",
        "\"end\":\"",
        "\"trace_hash\":\"",
    ];
    let places: Vec<_> =
        order.iter().map(|key| text.find(key).unwrap_or_else(|| panic!("{key} in {text}"))).collect();
    assert!(places.is_sorted(), "{text}");
}

#[test]
fn the_retrievers_are_those_with_the_highest_ids() {
    let mut config = config(1);
    (config.robots, config.retrievers) = (4, 1);
    let retrievers: Vec<_> = config.simulation().brains.iter().map(|brain| brain.retriever).collect();
    assert_eq!(retrievers, [false, false, false, true]);
}

#[test]
fn without_cases_the_team_plays_reactively_and_its_report_shows_it() {
    let empty = config(1).with_library(CaseBase::default(), CaseNames::default());
    let report = run(&empty, Box::new(NativeBackend::new(empty.base)), &mut []).unwrap();
    assert_eq!((report.cases.individual, report.cases.cooperative), (0, 0));
    assert!(report.cases.none > 0 && report.cycles.iter().all(|cycle| cycle.case.is_none()));
}

/// Longest walk of an opponent and of an attacker in the pauses after gameplays, m, and number of pauses.
#[derive(Default)]
struct Pauses {
    until: f32,
    from: Option<(f32, Vec<geometry::Point<geometry::Field>>)>,
    count: u32,
    moved: [f32; 2],
}

impl Watcher for Pauses {
    fn watch(&mut self, moment: &Moment<'_>) {
        let places = || moment.world.walkers.iter().map(|walker| walker.pose.position).collect::<Vec<_>>();
        let ended = moment.events.iter().any(|events| match *events {
            CycleEvent::Ended(place) => {
                let end = moment.cycles.cycles()[place].end;
                matches!(end, Some((_, CycleEnd::Closed(closure))) if closure != Closure::NoCase)
            }
            _ => false,
        });
        if ended {
            self.count += 1;
            // Legs need half a second to stop; robots are within two ticks of each other.
            (self.until, self.from) = (moment.tick.time + 4.8, None);
        }
        if moment.tick.time >= self.until {
            return;
        }
        let since = moment.tick.time - (self.until - 4.8);
        match &self.from {
            None if since > 0.7 => self.from = Some((since, places())),
            Some((_, from)) => {
                let attackers = moment.cast.attackers.len();
                for (i, (a, b)) in from.iter().zip(places()).enumerate() {
                    let side = usize::from(i < attackers);
                    self.moved[side] = self.moved[side].max(a.distance(b));
                }
            }
            None => {}
        }
    }
}

#[test]
fn all_robots_stop_for_five_seconds_after_a_gameplay_of_robots() {
    let watch = |opponents_pause| {
        let mut pauses = Pauses::default();
        for seed in 0..6 {
            let config = TrialConfig::new(
                Scenario::DefenderAhead,
                Configuration::DefenderGoalie,
                Approach::Cases,
                seed,
            );
            let config = TrialConfig { opponents_pause, ..Profile::Robots.apply(config) };
            pauses.until = 0.0;
            run(&config, Box::new(NativeBackend::new(config.base)), &mut [&mut pauses]).unwrap();
        }
        assert!(pauses.count > 10, "{}", pauses.count);
        pauses.moved
    };
    let [opponents, attackers] = watch(true);
    assert!(opponents < 0.02 && attackers < 0.02, "opponents {opponents} m, attackers {attackers} m");
    // The other reading: only the attackers stop; opponents walk to the ball, and push them.
    let [opponents, _] = watch(false);
    assert!(opponents > 0.5, "{opponents} m");
}
