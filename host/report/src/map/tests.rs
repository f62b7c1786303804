//! Tests: a map agrees with what happened. Hand-made flights, and a trial played twice.

use arena::{Setup, TEAM};
use brain::Approach;
use hil_sim::Configuration;
use study::evaluation::EvaluationPlan;

use super::*;

fn cell() -> EvaluationCell {
    EvaluationCell {
        profile: Profile::Simulated,
        configuration: Configuration::DefenderGoalie,
        scenario: Scenario::DefenderAhead,
        approach: Approach::Cases,
        trials: 2,
    }
}

fn config(seed: u64) -> TrialConfig<'static> {
    TrialConfig::new(Scenario::DefenderAhead, Configuration::DefenderGoalie, Approach::Cases, seed)
}

#[test]
fn a_pass_is_what_its_receiver_makes_of_it() {
    let flight = |by, pass| Flight { by, from: Point::new(0.0, 0.0), pass };
    let to = Point::new(1.0, 0.5);
    // Robots 0 and 1 attack, 2 is an opponent.
    for (by, pass, got_by, kind) in [
        (0, true, 1, Some(PassKind::Completed)),
        (0, true, 0, Some(PassKind::Lost)),
        (0, true, 2, Some(PassKind::Lost)),
        (1, false, 0, Some(PassKind::Chance)),
        (1, false, 1, None),
        (1, false, 2, None),
    ] {
        let mut mapper = Mapper { flying: Some(flight(by, pass)), ..Mapper::default() };
        mapper.got(got_by, 2, to);
        assert_eq!(mapper.passes().first().map(|pass| pass.kind), kind, "{by} {pass} {got_by}");
        assert_eq!(mapper.flying, None);
    }
}

#[test]
fn the_ball_is_counted_in_the_square_it_lies_in() {
    let mut map = Map::empty(cell(), config(1).base.field());
    // 5.4 × 3.6 m.
    assert_eq!((map.columns(), map.rows()), (54, 36));
    let balls = vec![Point::new(-2.65, -1.75), Point::new(2.69, 1.79), Point::new(2.71, 0.0)];
    map.add(Mapper { balls, ..Mapper::default() });
    assert_eq!((map.seconds[0], map.seconds[54 * 36 - 1]), (0.04, 0.04));
    assert_eq!(map.seconds.iter().filter(|seconds| **seconds > 0.0).count(), 2);
}

#[test]
fn a_map_holds_all_the_time_of_its_trials_and_their_ends() {
    let configs = [config(3), config(4)];
    let map = Map::play(cell(), configs[0].base.field(), &configs).unwrap();
    assert_eq!(map, Map::play(cell(), configs[0].base.field(), &configs).unwrap());
    let mut time = 0.0;
    let mut outcomes = Vec::new();
    for config in &configs {
        let report = run(config, Box::new(NativeBackend::new(config.base)), &mut []).unwrap();
        time += report.time_s;
        outcomes.push(report.outcome);
    }
    let seconds: f64 = map.seconds.iter().sum();
    // A ball that is rolling out is beside the field for a few ticks.
    assert!(seconds <= time + 0.09 && seconds > time - 1.0, "{seconds} of {time}");
    assert_eq!(map.ends.iter().map(|(_, outcome)| *outcome).collect::<Vec<_>>(), outcomes);
    assert_eq!(map.trials, 2);
    assert_eq!(map.start.map(|start| (start.attackers.len(), start.opponents.len())), Some((2, 2)));
}

#[test]
fn maps_are_of_the_simulated_cells_of_a_plan() {
    let config = config(1);
    let evaluation = Evaluation {
        plan: EvaluationPlan::paper(1).with_trials(1),
        base: config.base,
        names: config.names.clone(),
        library: "four-legged".to_owned(),
        setup: Setup::default(),
        program: format!("{TEAM:?}"),
    };
    let maps = Map::of(&evaluation, 1).unwrap();
    let simulated = evaluation.plan.cells.iter().filter(|cell| cell.profile == Profile::Simulated);
    assert_eq!(maps.len(), simulated.count());
    assert!(maps.iter().all(|map| map.trials == 1));
}
