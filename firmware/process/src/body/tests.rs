//! Tests: orders become the commands that every simulator understands, and answers become sensor frames.

use super::*;
use prost::Message as _;
use ssl::simulation::RobotFeedback;

fn id(n: u8) -> RobotId {
    RobotId::new(n).unwrap()
}

fn ms(n: u64) -> Instant {
    Instant(n * 1000)
}

fn order(twist: Twist<Body>, dribbler: f32, kick: OmniKick) -> ActuatorFrame {
    ActuatorFrame::Omni { wheels: Omni::default().rims(twist), dribbler, kick }
}

fn command(body: &SimulatedBody) -> RobotCommand {
    // As the simulator reads it.
    let bytes = body.control().encode_to_vec();
    let control = RobotControl::decode(&bytes[..]).unwrap();
    assert_eq!(control.robot_commands.len(), 1);
    control.robot_commands[0]
}

fn velocity(command: &RobotCommand) -> [f32; 3] {
    match command.move_command.unwrap().command.unwrap() {
        MoveCommand::LocalVelocity(v) => [v.forward, v.left, v.angular],
        other => panic!("{other:?}"),
    }
}

fn response(robots: &[(u32, Option<bool>)]) -> RobotControlResponse {
    let feedback = robots.iter().map(|(id, contact)| RobotFeedback {
        id: *id,
        dribbler_ball_contact: *contact,
        ..RobotFeedback::default()
    });
    RobotControlResponse { feedback: feedback.collect(), ..RobotControlResponse::default() }
}

#[test]
fn wheels_become_the_motion_they_make() {
    let mut body = SimulatedBody::new(id(3));
    body.obey(order(Twist { linear: Vector::new(1.5, -0.5), angular: 2.0 }, 0.5, OmniKick::None));
    let command = command(&body);
    assert_eq!(command.id, 3);
    let [forward, left, angular] = velocity(&command);
    assert!((forward - 1.5).abs() < 1e-5 && (left + 0.5).abs() < 1e-5 && (angular - 2.0).abs() < 1e-4);
    assert_eq!(command.dribbler_speed, Some(500.0));
    assert!((body.sensors(ms(0)).odometry.linear.x() - 1.5).abs() < 1e-5, "its own word");
}

#[test]
fn trap_09_every_command_holds_motion_and_dribbler_also_where_nothing_turns() {
    let body = SimulatedBody::new(id(0));
    let command = command(&body);
    assert_eq!(velocity(&command), [0.0; 3]);
    assert_eq!(command.dribbler_speed, Some(0.0));
}

#[test]
fn a_kick_speed_is_sent_only_while_a_kick_is_ordered() {
    let mut body = SimulatedBody::new(id(0));
    let mut kick_command = |kick| {
        body.obey(order(Twist::default(), 0.0, kick));
        let command = command(&body);
        (command.kick_speed, command.kick_angle)
    };
    assert_eq!(kick_command(OmniKick::Flat(6.0)), (Some(6.0), Some(0.0)));
    assert_eq!(kick_command(OmniKick::Chip(4.0)), (Some(4.0), Some(45.0)));
    for quiet in [OmniKick::None, OmniKick::Discharge, OmniKick::Flat(0.0), OmniKick::Chip(f32::NAN)] {
        assert_eq!(kick_command(quiet), (None, None), "{quiet:?}");
    }
}

#[test]
fn impossible_orders_make_the_robot_stand() {
    let mut body = SimulatedBody::new(id(0));
    body.obey(ActuatorFrame::Omni { wheels: [f32::NAN; 4], dribbler: f32::INFINITY, kick: OmniKick::None });
    let command = command(&body);
    assert_eq!((velocity(&command), command.dribbler_speed), ([0.0; 3], Some(0.0)));
    body.obey(ActuatorFrame::Omni { wheels: [f32::MAX; 4], dribbler: 9.0, kick: OmniKick::Flat(1e9) });
    let command = self::command(&body);
    assert!(velocity(&command).iter().all(|speed| speed.abs() <= TURN_MAX), "{command:?}");
    assert_eq!((command.dribbler_speed, command.kick_speed), (Some(1000.0), Some(10.0)));
}

#[test]
fn trap_09_our_feedback_is_found_among_all_and_a_lost_one_keeps_the_ball() {
    let mut body = SimulatedBody::new(id(2));
    let feels = |body: &SimulatedBody, at| body.sensors(ms(at)).ball_contact;
    assert!(!feels(&body, 0));
    body.handle_response(ms(10), &response(&[(0, Some(true)), (1, Some(false)), (2, Some(true)), (5, None)]));
    assert!(feels(&body, 10));
    // Response left out, or without ball contact, four times.
    for n in 2..6 {
        body.handle_response(ms(10 * n), &response(&[(0, Some(false)), (1, Some(false))]));
        body.handle_response(ms(10 * n), &response(&[(2, None)]));
    }
    assert!(feels(&body, 60));
    assert!(!feels(&body, 61), "what nobody confirms is over");
    body.handle_response(ms(70), &response(&[(2, Some(true))]));
    body.handle_response(ms(80), &response(&[(2, Some(false))]));
    assert!(!feels(&body, 80), "gone at once when told so");
    body.handle_response(ms(90), &response(&[(2, Some(false)), (3, Some(false)), (2, Some(true))]));
    assert!(feels(&body, 90), "of several the last is the newest");
}

#[test]
fn errors_of_the_simulator_are_counted_and_the_last_is_kept() {
    let mut body = SimulatedBody::new(id(2));
    let error = ssl::simulation::SimulatorError {
        code: Some("VELOCITY_TYPE".into()),
        message: Some("not that one".into()),
    };
    body.handle_response(ms(0), &RobotControlResponse { errors: vec![error], ..Default::default() });
    assert_eq!(body.errors(), (1, Some("VELOCITY_TYPE: not that one")));
}

#[test]
fn trap_09_the_answers_that_er_forces_simulator_really_gave_are_felt() {
    let recordings = [
        (
            "clean",
            include_str!(
                "../../../../protocol/ssl/tests/data/packets/robot_control_responses_divB_clean.hex.log"
            ),
        ),
        (
            "realistic",
            include_str!(
                "../../../../protocol/ssl/tests/data/packets/robot_control_responses_erforce_realistic.hex.log"
            ),
        ),
    ];
    for (name, text) in recordings {
        // The robot with most contact in the raw bytes, blue's port; each robot is `12 04 08 ID 10 CONTACT`.
        let lines: Vec<(u64, &str)> = text
            .lines()
            .filter_map(|line| {
                let mut fields = line.split_whitespace();
                let (at, port, hex) = (fields.next()?, fields.next()?, fields.next()?);
                (port == "10301").then(|| ((at.parse::<f64>().unwrap() * 1e6) as u64, hex))
            })
            .collect();
        assert!(lines.len() > 1_000, "{name}: {}", lines.len());
        let touches =
            |n: u8| lines.iter().filter(|(_, hex)| hex.contains(&format!("120408{n:02x}1001"))).count();
        let robot = (0..6).max_by_key(|n| touches(*n)).unwrap();
        let mut body = SimulatedBody::new(id(robot));
        let (mut felt, mut left_out, mut held) = (0, 0, 0);
        for (at, hex) in &lines {
            let now = Instant(*at);
            let bytes: Vec<u8> =
                (0..hex.len() / 2).map(|i| u8::from_str_radix(&hex[2 * i..2 * i + 2], 16).unwrap()).collect();
            let before = body.sensors(now).ball_contact;
            body.handle_response(now, &RobotControlResponse::decode(&bytes[..]).unwrap());
            let feels = body.sensors(now).ball_contact;
            let reports_contact = |contact: u8| hex.contains(&format!("120408{robot:02x}10{contact:02x}"));
            match (reports_contact(1), reports_contact(0)) {
                (true, _) => assert!(feels, "{name} at {at} µs"),
                (_, true) => assert!(!feels, "{name} at {at} µs"),
                _ => {
                    left_out += 1;
                    held += u32::from(feels);
                    assert_eq!(feels, before, "{name} at {at} µs: nothing was said");
                }
            }
            felt += usize::from(feels);
        }
        eprintln!(
            "{name}: robot {robot}, {} answers, {felt} with the ball, left out of {left_out}, held over {held}",
            lines.len()
        );
        assert!(felt >= touches(robot));
        if name == "realistic" {
            let share = f64::from(left_out) / lines.len() as f64;
            assert!((0.05..0.15).contains(&share), "left out of {share}");
        } else {
            assert_eq!(left_out, 0);
        }
        assert_eq!(body.errors().0, 0);
    }
}
