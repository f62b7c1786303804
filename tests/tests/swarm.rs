//! `swarm`: samples of the runs that `cargo xtask swarm` plays by the thousand. A hundred runs of a team
//! under faults drawn at random, and two matches under the referee's plan.

use arena::game::NoWatcher;
use match_tests::swarm::matches::{self, LENGTH, Plan};
use match_tests::swarm::{Runs, report, run, watch};

const SEEDS: u64 = 100;

#[test]
fn a_hundred_random_fault_runs_violate_no_property() {
    let (counters, broken) = watch(Runs { first: 0, seeds: SEEDS, jobs: 2 }, |_| {});
    let reported: Vec<String> = broken.iter().map(|(seed, found)| report(*seed, found)).collect();
    assert!(reported.is_empty(), "\n{}", reported.join("\n"));
    assert_eq!(u64::from(counters.runs), SEEDS);
    // The runs are not trivial: teams play, forged packets are sent, robots brake.
    assert!(u64::from(counters.gameplays) > SEEDS && counters.unbelievable > 10_000, "{counters:?}");
    assert!(counters.brakings > 10_000 && counters.slowest_ms > 0, "{counters:?}");
}

/// Seed 17190: its coordinator boots, and loss hides the running cycle from it for as long as it listens.
#[test]
fn a_coordinator_that_boots_does_not_decide_a_cycle_again() {
    let (_, broken) = watch(Runs { first: 17_190, seeds: 1, jobs: 1 }, |_| {});
    assert!(broken.is_empty(), "{:?}", broken.first());
}

#[test]
fn a_seed_gives_the_same_run_on_any_number_of_threads() {
    let play = |jobs| watch(Runs { first: 40, seeds: 6, jobs }, |_| {}).0;
    assert_eq!(play(1), play(3));
    assert_eq!(run(41), run(41));
}

#[test]
fn matches_with_cards_restarts_and_halts_violate_no_property() {
    // One of each division.
    for seed in [4, 7] {
        let plan = Plan::drawn(seed, LENGTH);
        let outcome = matches::play(&plan, &mut NoWatcher);
        assert!(outcome.found.is_empty(), "\n{}", matches::report(&plan, &outcome));
        // The match is not trivial.
        assert!(outcome.acts > 1 && outcome.begun[1] > 0, "{outcome:?}");
    }
}
