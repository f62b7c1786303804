//! `robot_spec`: the robot that is built, as `rules::RobotSpec` has it, against the simulated leagues, the
//! description's text and the documentation.
//!
//! The simulator's numbers are data with sources of their own (`hil-sim/data/`), written for the reference
//! robot; where they differ from the description, robots plan what no wheel does, or stand where no ball is.

use hil_sim::small_size::Parameters;
use match_tests::workspace::{Source, root};
use robots::{BUILT_IN, Description, KEYS};
use rules::{HullSpec, League, RobotSpec};

const OURS: RobotSpec = RobotSpec::OURS;

fn leagues() -> impl Iterator<Item = League> {
    [League::Ssl2013, League::DivisionB, League::DivisionA].into_iter()
}

fn simulated() -> impl Iterator<Item = (League, &'static Parameters)> {
    leagues().map(|league| (league, Parameters::of(league).expect("a league on wheels")))
}

fn reference() -> (Description, RobotSpec) {
    let (name, text) = BUILT_IN[0];
    (Description::read(name, text).expect("a built-in description"), RobotSpec::REFERENCE)
}

#[test]
fn the_leagues_files_have_the_robot_of_the_reference_description() {
    let (description, reference) = reference();
    for league in leagues() {
        let world = Parameters::of_file(league).expect("a league on wheels");
        let (body, drive, kick) = (world.robot, world.drive, world.kick);
        assert_eq!((body.radius, body.front), (reference.hull.radius, reference.hull.front), "{league:?}");
        assert_eq!(body.wheels_deg, reference.wheels.degrees, "{league:?}");
        assert_eq!(body.wheel_distance, reference.wheels.distance, "{league:?}");
        for (path, simulated) in [
            ("body.height", body.height),
            ("body.mouth", body.mouth),
            ("body.mass", body.mass),
            ("wheels.free_speed", drive.rim_speed),
            ("hardware.turn_speed", drive.turn_speed),
            ("hardware.forward", drive.forward),
            ("hardware.side", drive.side),
            ("hardware.brake", drive.brake),
            ("hardware.turn", drive.turn),
            ("hardware.rim_acceleration", drive.rim_acceleration),
            ("hardware.flat", kick.flat),
            ("hardware.chip", kick.chip),
            ("hardware.recharge", kick.recharge),
            ("hardware.pull", world.dribbler.pull),
            ("dribbler.full_rpm", world.dribbler.full_rpm),
            ("kicker.chip_degrees", kick.chip_deg),
            ("battery.low", world.battery.empty),
        ] {
            assert_eq!(description.number(path), simulated, "{league:?}: {path}");
        }
        // The robots of 2013 were slower (paper 2).
        assert!(drive.speed <= reference.hardware.speed, "{league:?}");
        assert_eq!(world.ball.radius, league.ball().radius, "{league:?}");
    }
    assert_eq!(
        Parameters::of_file(League::DivisionB).map(|world| world.drive.speed),
        Some(reference.hardware.speed)
    );
}

#[test]
fn simulated_robots_have_the_described_shape() {
    let near = |a: f32, b: f32| (a - b).abs() < 1e-4 * a.abs().max(1.0);
    for (league, world) in simulated() {
        let (body, HullSpec { radius, front, .. }) = (world.robot, OURS.hull);
        assert!(near(body.radius, radius) && near(body.front, front), "{league:?}: {body:?}");
        let angles = body.wheels_deg.into_iter().zip(OURS.wheels.degrees);
        assert!(angles.into_iter().all(|(a, b)| near(a, b)), "{league:?}: {body:?}");
        assert!(near(body.wheel_distance, OURS.wheels.distance), "{league:?}: {body:?}");
        assert!(near(world.dribbler.full_rpm, OURS.dribbler.full_rpm), "{league:?}");
        assert!(near(world.kick.chip_deg, OURS.kicker.chip_degrees), "{league:?}");
        assert!(near(world.drive.rim_speed, OURS.wheels.free_speed), "{league:?}");
    }
}

#[test]
fn plans_stay_within_what_simulated_wheels_and_kickers_can_do() {
    // Rounding of a ratio.
    let most = |limit: f32| limit * 1.000_01;
    for (league, world) in simulated() {
        let drive = world.drive;
        for plan in [OURS.plan, OURS.plan_holding] {
            assert!(plan.acceleration <= most(drive.forward.min(drive.side)), "{league:?}: {plan:?}");
            assert!(
                plan.braking <= most(drive.brake) && plan.speed <= most(drive.speed),
                "{league:?}: {plan:?}"
            );
        }
        for turn in [OURS.turn, OURS.turn_holding] {
            assert!(turn.acceleration <= most(drive.turn), "{league:?}: {turn:?}");
            assert!(turn.rate <= most(drive.turn_speed), "{league:?}: {turn:?}");
        }
        assert!(OURS.governor.brake <= most(drive.brake), "{league:?}");
        assert!(OURS.kicker.fastest_in(league) <= most(world.kick.flat), "{league:?}");
        assert!(OURS.kicker.pause_ms as f32 <= most(1000.0 * world.kick.recharge), "{league:?}");
    }
}

#[test]
fn the_documentation_lists_every_key_with_its_unit_range_and_meaning() {
    let page = Source::read(&root().join("docs/robots.md")).text;
    for key in KEYS {
        let unit = if key.unit.is_empty() { "–" } else { key.unit };
        let row = format!("| `{}` | {unit} | {} | {} |", key.path, key.allowed(), key.meaning);
        assert!(page.contains(&row), "docs/robots.md lacks the row\n{row}");
    }
    for (name, _) in BUILT_IN {
        assert!(page.contains(&format!("robots/{name}.toml")), "docs/robots.md does not name {name}");
    }
}
