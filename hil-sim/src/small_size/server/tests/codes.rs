//! `codes`: tests: every error code is returned for the message that causes it.

use std::collections::BTreeSet;

use ssl::simulation::{RobotWheelAngles, SimulatorError};
use ssl::vision::{BallModelStraightTwoPhase, GeometryData, GeometryModels};

use super::*;

fn codes_of(errors: &[SimulatorError]) -> Vec<&str> {
    errors.iter().filter_map(|error| error.code.as_deref()).collect()
}

#[test]
fn every_error_code_of_robot_commands_has_its_cause_and_a_hint() {
    let kick =
        |speed, angle| RobotCommand { kick_speed: Some(speed), kick_angle: Some(angle), ..ahead(1, 0.0) };
    let dribble = |rpm| RobotCommand { dribbler_speed: Some(rpm), ..ahead(1, 0.0) };
    let cases: [(&[RobotCommand], &[&str]); 13] = [
        (&[ahead(16, 0.0)], &["NO_SUCH_ID"]),
        (&[ahead(4_000_000_000, 0.0)], &["NO_SUCH_ID"]),
        (&[ahead(9, 0.0)], &["UNKNOWN_ROBOT"]),
        (&[ahead(1, 0.0), ahead(1, 1.0)], &["COMMANDED_TWICE"]),
        (&[RobotCommand { id: 1, ..Default::default() }], &["MISSING_MOVE_COMMAND"]),
        (&[ahead(1, f32::INFINITY)], &["NOT_A_NUMBER"]),
        (&[kick(f32::NAN, 0.0)], &["NOT_A_NUMBER"]),
        (&[kick(9.0, 0.0)], &["KICK_TOO_FAST"]),
        (&[kick(7.0, 45.0)], &["KICK_TOO_FAST"]),
        (&[kick(-1.0, 0.0)], &["KICK_BACKWARDS"]),
        (&[kick(3.0, 91.0)], &["KICK_ANGLE"]),
        (&[dribble(-5.0)], &["DRIBBLER_BACKWARDS"]),
        (&[dribble(f32::NAN), kick(2.0, 30.0)], &["NOT_A_NUMBER", "COMMANDED_TWICE"]),
    ];
    for (commands, expected) in cases {
        let answer = lead(&mut server(), commands);
        let expected: Vec<_> = expected.iter().map(|code| format!("ONETWO_{code}")).collect();
        assert_eq!(codes_of(&answer.errors), expected, "{commands:?}");
        assert!(answer.errors.iter().all(|error| error.message.as_ref().is_some_and(|m| m.len() > 20)));
        assert_eq!(answer.feedback.len(), 6, "errors or not, the robots answer");
    }
}

#[test]
fn every_error_code_of_teleports_and_pace_has_its_cause() {
    let robot = |id, of: fn(&mut TeleportRobot)| {
        let mut teleport = TeleportRobot { id, ..Default::default() };
        of(&mut teleport);
        SimulatorControl { teleport_robot: vec![teleport], ..Default::default() }
    };
    let ball = |of: fn(&mut TeleportBall)| {
        let mut teleport = TeleportBall::default();
        of(&mut teleport);
        SimulatorControl { teleport_ball: Some(teleport), ..Default::default() }
    };
    let pace = |speed| SimulatorControl { simulation_speed: Some(speed), ..Default::default() };
    let without_number = WireId { id: None, team: Some(Team::Blue as i32) };
    let teamless = WireId { id: Some(1), team: Some(Team::Unknown as i32) };
    let controls = [
        (ball(|t| (t.vx, t.vy) = (Some(30.0), Some(0.0))), "TOO_FAST"),
        (ball(|t| t.vz = Some(-30.0)), "TOO_FAST"),
        (ball(|t| (t.z, t.by_force) = (Some(1.0), Some(true))), "UNSUPPORTED"),
        (robot(blue(1), |t| (t.v_x, t.v_y) = (Some(9.0), Some(0.0))), "TOO_FAST"),
        (robot(blue(1), |t| t.v_angular = Some(-900.0)), "TOO_FAST"),
        (robot(without_number, |_| {}), "NO_SUCH_ID"),
        (robot(blue(16), |_| {}), "NO_SUCH_ID"),
        (robot(teamless, |_| {}), "NO_TEAM"),
        (robot(blue(14), |t| t.x = Some(1.0)), "UNKNOWN_ROBOT"),
        (robot(blue(1), |t| t.x = Some(f32::NAN)), "NOT_A_NUMBER"),
        (robot(blue(1), |t| t.x = Some(1500.0)), "OUTSIDE_HALL"),
        (ball(|t| t.vz = Some(f32::INFINITY)), "NOT_A_NUMBER"),
        (ball(|t| t.y = Some(-3_000.0)), "OUTSIDE_HALL"),
        (ball(|t| t.z = Some(-0.1)), "OUTSIDE_HALL"),
        (pace(-1.0), "SIMULATION_SPEED"),
        (pace(f32::NAN), "SIMULATION_SPEED"),
    ];
    for (command, code) in controls {
        assert_eq!(control(&mut server(), command.clone()), [format!("ONETWO_{code}")], "{command:?}");
    }
}

fn geometry(of: fn(&mut GeometryData)) -> SimulatorConfig {
    let server = server();
    let mut reported = server.cameras.geometry(server.world(), None);
    reported.calib.clear();
    of(&mut reported);
    SimulatorConfig { geometry: Some(reported), ..Default::default() }
}

fn specs(of: fn(&mut RobotSpecs)) -> SimulatorConfig {
    let mut specs = RobotSpecs { id: blue(1), ..Default::default() };
    of(&mut specs);
    SimulatorConfig { robot_specs: vec![specs], ..Default::default() }
}

fn custom(url: &str, value: Vec<u8>) -> SimulatorConfig {
    let custom = vec![Any { type_url: Some(url.into()), value: Some(value) }];
    SimulatorConfig { realism_config: Some(RealismConfig { custom }), ..Default::default() }
}

fn realism(of: fn(&mut RealismConfigErForce)) -> SimulatorConfig {
    let mut asked = RealismConfigErForce::default();
    of(&mut asked);
    custom("type.googleapis.com/RealismConfigErForce", asked.encode_to_vec())
}

#[test]
fn every_error_code_of_settings_has_its_cause_and_changes_nothing() {
    let port = |port| SimulatorConfig { vision_port: Some(port), ..Default::default() };
    let singular = |s: &mut RobotSpecs| {
        let angles = RobotWheelAngles { front_right: 0.0, back_right: 0.0, back_left: 0.0, front_left: 0.0 };
        s.wheel_angles = Some(angles);
    };
    let hollow = |g: &mut GeometryData| {
        let flat = BallModelStraightTwoPhase { acc_slide: -4.0, acc_roll: -0.3, k_switch: 0.6 };
        g.models = Some(GeometryModels { straight_two_phase: Some(flat), chip_fixed_loss: None });
    };
    let cases = [
        (specs(|s| s.radius = Some(5.0)), "ROBOT_SPECS"),
        (specs(singular), "ROBOT_SPECS"),
        (specs(|s| s.max_linear_kick_speed = Some(f32::NAN)), "ROBOT_SPECS"),
        (geometry(|g| g.field.field_length = 3), "GEOMETRY"),
        (geometry(hollow), "BALL_MODEL"),
        (realism(|r| r.missing_ball_detections = Some(2.0)), "REALISM"),
        (realism(|r| r.robot_command_loss = Some(-1.0)), "REALISM"),
        (realism(|r| r.camera_position_error = Some(0.1)), "UNSUPPORTED"),
        (realism(|r| r.command_delay = Some(u64::MAX)), "REALISM"),
        (custom("type.googleapis.com/Weather", Vec::new()), "UNKNOWN_CUSTOM"),
        (custom("type.googleapis.com/RealismConfigErForce", vec![0xff]), "BROKEN_CUSTOM"),
        (port(0), "VISION_PORT"),
        (port(65_536), "VISION_PORT"),
    ];
    for (command, code) in cases {
        let mut server = server();
        let (field, settings) = (server.world().pitch().field, *server.cameras.settings());
        let body = server.world().robot(own(1)).unwrap().body;
        assert_eq!(config(&mut server, command.clone()), [format!("ONETWO_{code}")], "{command:?}");
        assert_eq!(server.world().pitch().field, field);
        assert_eq!(
            (server.cameras.settings().noise, server.cameras.settings().camera),
            (settings.noise, settings.camera)
        );
        assert_eq!(server.world().robot(own(1)).unwrap().body, body);
        assert_eq!(server.vision_port, VISION_PORT);
        assert_eq!(server.world().parameters().ball, Parameters::of(League::DivisionB).unwrap().ball);
    }
}

#[test]
fn an_unsupported_k_switch_is_an_error_and_the_rest_takes_effect() {
    for (k_switch, reported) in [(5.0 / 7.0, false), (0.7143, false), (0.69, true), (0.7, true)] {
        let mut server = server();
        let mut geometry = server.cameras.geometry(server.world(), None);
        geometry.calib.clear();
        let flat = BallModelStraightTwoPhase { acc_slide: -4.5, acc_roll: -0.31, k_switch };
        geometry.models = Some(GeometryModels { straight_two_phase: Some(flat), chip_fixed_loss: None });
        let codes = config(&mut server, SimulatorConfig { geometry: Some(geometry), ..Default::default() });
        let expected: &[&str] = if reported { &["ONETWO_BALL_SWITCH"] } else { &[] };
        assert_eq!(codes, expected, "{k_switch}");
        let ball = server.world().parameters().ball;
        assert_eq!((ball.slide, ball.roll), (4.5, 0.31));
    }
}

#[test]
fn undecodable_datagrams_are_answered_with_an_error_on_each_port() {
    let mut server = server();
    server.handle(Port::Simulator, from(), b"\xff\xff\xff");
    server.handle(Port::Team(Colour::Yellow), from(), b"\xff\xff\xff");
    let answers = sent(&mut server).1;
    let first = SimulatorResponse::decode(&answers[0][..]).unwrap();
    let second = RobotControlResponse::decode(&answers[1][..]).unwrap();
    assert_eq!(codes_of(&first.errors), ["ONETWO_UNDECODABLE"]);
    assert_eq!(codes_of(&second.errors), ["ONETWO_UNDECODABLE"]);
    assert_eq!((server.counts().undecodable, server.counts().refused), (2, 2));
}

#[test]
fn an_invalid_synchronous_step_is_refused() {
    for sim_step in [-1.0, f32::NAN, 11.0] {
        let mut server = server();
        let request = SimulationSyncRequest { sim_step: Some(sim_step), ..Default::default() };
        let answer = server.synchronous(Colour::Blue, &request, |_| {}).robot_control_response.unwrap();
        assert_eq!(codes_of(&answer.errors), ["ONETWO_SYNC_STEP"]);
        assert_eq!(server.world().now(), 0);
    }
}

#[test]
fn no_two_refusals_share_a_code() {
    assert_eq!(BTreeSet::from(Refusal::LABELS).len(), Refusal::LABELS.len());
}
