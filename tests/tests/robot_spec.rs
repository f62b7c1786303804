//! `robot_spec`: our robots as `rules::RobotSpec` describes them, against those of the simulated leagues.
//!
//! The simulator's numbers are data with sources of their own (`hil-sim/data/`); where they differ from the
//! description, robots plan what no wheel does, or stand where no ball is.

use hil_sim::small_size::Parameters;
use rules::{League, RobotSpec};

const OURS: RobotSpec = RobotSpec::OURS;

fn simulated() -> impl Iterator<Item = (League, &'static Parameters)> {
    let leagues = [League::Ssl2013, League::DivisionB, League::DivisionA];
    leagues.into_iter().map(|league| (league, Parameters::of(league).expect("a league on wheels")))
}

#[test]
fn simulated_robots_have_the_shape_that_ours_are_described_with() {
    for (league, world) in simulated() {
        let body = world.robot;
        assert_eq!((body.radius, body.front), (OURS.hull.radius, OURS.hull.front), "{league:?}");
        assert_eq!(
            (body.wheels_deg, body.wheel_distance),
            (OURS.wheels.degrees, OURS.wheels.distance),
            "{league:?}"
        );
        assert_eq!(world.ball.radius, league.ball().radius, "{league:?}");
        assert_eq!(world.dribbler.full_rpm, OURS.dribbler.full_rpm, "{league:?}");
        assert_eq!(world.kick.chip_deg, OURS.kicker.chip_degrees, "{league:?}");
        assert_eq!(world.drive.rim_speed, OURS.wheels.free_speed, "{league:?}");
    }
}

#[test]
fn plans_ask_for_no_more_than_simulated_wheels_and_kickers_give() {
    for (league, world) in simulated() {
        let drive = world.drive;
        for plan in [OURS.plan, OURS.plan_holding] {
            assert!(plan.acceleration <= drive.forward.min(drive.side), "{league:?}: {plan:?}");
            assert!(plan.braking <= drive.brake && plan.speed <= drive.speed, "{league:?}: {plan:?}");
        }
        for turn in [OURS.turn, OURS.turn_holding] {
            assert!(turn.acceleration <= drive.turn && turn.rate <= drive.turn_speed, "{league:?}: {turn:?}");
        }
        assert!(OURS.governor.brake <= drive.brake, "{league:?}");
        assert!(OURS.kicker.fastest_in(league) <= world.kick.flat, "{league:?}");
        assert!(OURS.kicker.pause_ms as f32 <= 1000.0 * world.kick.recharge, "{league:?}");
    }
}
