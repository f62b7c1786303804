//! `profiles`: tests of the compatibility profiles of the league's other simulators, with the numbers of
//! their deviations.

use super::*;

#[test]
fn trap_01_and_02_vision_has_the_clock_and_geometry_of_the_profile() {
    let mut grsim = server_like(Profile::Grsim);
    steps(&mut grsim, 100);
    let frames: Vec<_> = sent(&mut grsim).0.into_iter().filter_map(|packet| packet.detection).collect();
    assert!(frames.len() >= 16 && frames.len().is_multiple_of(4));
    assert!(frames.iter().all(|frame| frame.t_capture < 0.2), "seconds of the simulation");
    let mut erforce = server_like(Profile::ErForce);
    steps(&mut erforce, 100);
    let packets = sent(&mut erforce).0;
    assert!(packets.len() > 3 && packets.iter().all(|packet| packet.geometry.is_some()));
    assert!(packets.iter().all(|packet| packet.detection.as_ref().unwrap().t_capture > 1.7e9));
}

fn ids(answer: &RobotControlResponse) -> Vec<u32> {
    answer.feedback.iter().map(|feedback| feedback.id).collect()
}

#[test]
fn trap_09_answers_list_the_commanded_robots() {
    let gone = TeleportRobot { id: blue(0), present: Some(false), ..Default::default() };
    let gone = SimulatorControl { teleport_robot: vec![gone], ..Default::default() };
    let both = [ahead(0, 0.0), ahead(3, 0.0)];
    let mut grsim = server_like(Profile::Grsim);
    control(&mut grsim, gone.clone());
    let reported = answers(&mut grsim, &both);
    assert_eq!((reported.len(), ids(&reported[0])), (1, vec![0, 3]), "robot 0 is still named");
    assert!(reported[0].errors.is_empty());
    assert_eq!(ids(&answers(&mut grsim, &[])[0]), [0_u32; 0]);

    let mut erforce = server_like(Profile::ErForce);
    erforce.radio.answer_loss = 0.0;
    assert_eq!(codes(&mut erforce, &SimulatorCommand { control: Some(gone), config: None }), None);
    let reported = answers(&mut erforce, &both);
    assert_eq!((reported.len(), ids(&reported[0])), (1, vec![3]), "robot 0 is gone and says nothing");
    assert!(answers(&mut erforce, &[]).is_empty(), "no robot was commanded");
}

#[test]
fn trap_09_er_force_drops_a_tenth_of_its_answers() {
    let mut erforce = server_like(Profile::ErForce);
    let all: Vec<_> = (0..6).map(|id| ahead(id, 0.0)).collect();
    let reported: usize =
        (0..500).flat_map(|_| answers(&mut erforce, &all)).map(|reported| reported.feedback.len()).sum();
    // 3,000 draws of 0.9: deviation 16.
    assert!(reported.abs_diff(2_700) < 66, "{reported}");
}

#[test]
fn er_force_answers_errors_only_with_its_own_codes() {
    let mut erforce = server_like(Profile::ErForce);
    erforce.radio.answer_loss = 0.0;
    let ball = |teleport| SimulatorCommand {
        control: Some(SimulatorControl { teleport_ball: Some(teleport), ..Default::default() }),
        config: None,
    };
    let robot = |teleport| SimulatorCommand {
        control: Some(SimulatorControl { teleport_robot: vec![teleport], ..Default::default() }),
        config: None,
    };
    let at = |x, y| TeleportBall { x, y, ..Default::default() };
    let stand = TeleportRobot { id: blue(1), ..Default::default() };
    let cases = [
        (ball(at(Some(1.0), Some(0.5))), None),
        (ball(at(Some(2.0), None)), Some("PARTIAL_COORD")),
        (ball(at(None, Some(2.0))), Some("PARTIAL_COORD")),
        (ball(TeleportBall { z: Some(1.0), ..Default::default() }), Some("PARTIAL_COORD")),
        (ball(TeleportBall { vx: Some(1.0), ..Default::default() }), Some("PARTIAL_COORD")),
        (
            ball(TeleportBall { teleport_safely: Some(true), ..at(Some(2.0), None) }),
            Some("TELEPORT_SAFELY_PARTIAL"),
        ),
        (
            ball(TeleportBall {
                vx: Some(1.0),
                vy: Some(0.0),
                by_force: Some(true),
                ..at(Some(2.0), Some(0.0))
            }),
            Some("VELOCITY_FORCE"),
        ),
        (robot(TeleportRobot { x: Some(0.0), y: Some(0.0), ..stand }), Some("PARTIAL_COORD")),
        (robot(TeleportRobot { y: Some(0.0), ..stand }), Some("PARTIAL_COORD")),
        (robot(TeleportRobot { v_y: Some(0.0), ..stand }), Some("PARTIAL_COORD")),
        (robot(TeleportRobot { x: Some(0.0), y: Some(0.0), orientation: Some(1.0), ..stand }), None),
        (robot(TeleportRobot { id: blue(12), present: Some(true), ..stand }), Some("CREATE_UNSPEC_ROBOT")),
        (robot(TeleportRobot { present: Some(false), ..stand }), None),
        (robot(TeleportRobot { present: Some(true), ..stand }), Some("CREATE_NOPOS_ROBOT")),
        // No robot of that number is there: it reports nothing.
        (robot(TeleportRobot { id: blue(9), x: Some(1.0), y: Some(1.0), ..stand }), None),
        (SimulatorCommand::default(), None),
    ];
    for (command, code) in cases {
        let expected = code.map(|code| vec![code.to_owned()]);
        assert_eq!(codes(&mut erforce, &command), expected, "{command:?}");
    }
    let ball = erforce.world().ball.position;
    assert_eq!((ball.x(), ball.y()), (1.0, 0.5), "what was refused moved nothing");
    erforce.handle(Port::Simulator, from(), b"\xff\xff\xff");
    let answer = sent(&mut erforce).1.remove(0);
    let answer = SimulatorResponse::decode(&answer[..]).unwrap();
    assert_eq!(answer.errors[0].code.as_deref(), Some("UNREADABLE"));
    // Robots: errors and feedback come in separate packets; velocities in the robot's own frame alone.
    let wheels = ssl::simulation::MoveWheelVelocity {
        front_right: 1.0,
        back_right: 1.0,
        back_left: 1.0,
        front_left: 1.0,
    };
    let wheels = RobotMoveCommand { command: Some(MoveCommand::WheelVelocity(wheels)) };
    let reported = answers(&mut erforce, &[RobotCommand { move_command: Some(wheels), ..ahead(2, 0.0) }]);
    assert_eq!(reported.len(), 2);
    assert_eq!(reported[0].errors[0].code.as_deref(), Some("VELOCITY_TYPE"));
    assert_eq!((ids(&reported[1]), reported[1].errors.len()), (vec![2], 0));
    assert!(
        answers(&mut erforce, &[RobotCommand { kick_speed: Some(99.0), ..ahead(2, 0.0) }])[0]
            .errors
            .is_empty()
    );
}

#[test]
fn er_force_requires_complete_specifications() {
    let mut erforce = server_like(Profile::ErForce);
    let specs = |specs| SimulatorCommand {
        control: None,
        config: Some(SimulatorConfig { robot_specs: vec![specs], ..Default::default() }),
    };
    let some = RobotSpecs { id: blue(12), mass: Some(2.0), ..Default::default() };
    assert_eq!(codes(&mut erforce, &specs(some.clone())), Some(vec!["INVALID_SPEC".to_owned()]));
    let limits = RobotLimits {
        acc_speedup_absolute_max: Some(3.0),
        acc_speedup_angular_max: Some(30.0),
        acc_brake_absolute_max: Some(4.0),
        acc_brake_angular_max: Some(30.0),
        vel_absolute_max: Some(3.0),
        vel_angular_max: Some(20.0),
    };
    let custom = ssl::simulation::RobotSpecErForce { shoot_radius: Some(0.067), dribbler_width: Some(0.07) };
    let custom = Any {
        type_url: Some("type.googleapis.com/sslsim.RobotSpecErForce".into()),
        value: Some(custom.encode_to_vec()),
    };
    let whole =
        RobotSpecs { limits: Some(limits), center_to_dribbler: Some(0.073), custom: vec![custom], ..some };
    assert_eq!(codes(&mut erforce, &specs(whole)), None);
    let put = TeleportRobot {
        id: blue(12),
        present: Some(true),
        x: Some(-1.0),
        y: Some(2.5),
        orientation: Some(0.0),
        ..Default::default()
    };
    let put = SimulatorControl { teleport_robot: vec![put], ..Default::default() };
    assert_eq!(codes(&mut erforce, &SimulatorCommand { control: Some(put), config: None }), None);
    assert!(erforce.world().robot(own(12)).unwrap().present);
}

#[test]
fn trap_09_robots_brake_after_100_ms_without_commands() {
    let mut erforce = server_like(Profile::ErForce);
    for _ in 0..30 {
        answers(&mut erforce, &[ahead(2, 0.5)]);
        steps(&mut erforce, 10);
    }
    assert!(erforce.world().robot(own(2)).unwrap().velocity.norm() > 0.4);
    steps(&mut erforce, 250);
    assert!(erforce.world().robot(own(2)).unwrap().velocity.norm() < 0.01);
}

#[test]
fn trap_09_a_command_without_dribbler_speed_stops_it_only_in_er_force() {
    let after = |profile| {
        let mut server = server_like(profile);
        answers(&mut server, &[RobotCommand { dribbler_speed: Some(1_000.0), ..ahead(1, 0.0) }]);
        steps(&mut server, 5);
        answers(&mut server, &[ahead(1, 0.0)]);
        steps(&mut server, 5);
        server.world().robot(own(1)).unwrap().order().dribbler
    };
    assert_eq!((after(Profile::ErForce), after(Profile::Ours)), (0.0, 1.0));
}

#[test]
fn trap_10_grsim_accepts_robot_specifications_only() {
    let mut grsim = server_like(Profile::Grsim);
    let geometry = Some(grsim.cameras.geometry(grsim.world(), None));
    let asked = SimulatorConfig {
        geometry,
        robot_specs: vec![RobotSpecs { id: blue(1), mass: Some(3.0), ..Default::default() }],
        realism_config: Some(RealismConfig::default()),
        vision_port: Some(10_006),
    };
    assert_eq!(config(&mut grsim, asked), ["GRSIM_UNSUPPORTED_CONFIG"]);
    assert_eq!(grsim.world().robot(own(1)).unwrap().body.mass, 3.0);
    assert_eq!(grsim.vision_port, VISION_PORT);
    let ball = TeleportBall {
        x: Some(1.0),
        vx: Some(1.0),
        teleport_safely: Some(true),
        roll: Some(true),
        ..Default::default()
    };
    let codes = teleport_ball(&mut grsim, ball);
    assert_eq!(codes, ["GRSIM_UNSUPPORTED_TELEPORT_SAFELY", "GRSIM_UNSUPPORTED_ROLL_BALL"]);
    assert_eq!(grsim.world().ball.position.x(), 1.0, "the rest of it is done");
}

#[test]
fn trap_11_a_ball_far_outside_the_field_is_in_the_vision_packets() {
    let mut server = server();
    let ball = TeleportBall { x: Some(6.5), y: Some(0.2), ..Default::default() };
    assert!(teleport_ball(&mut server, ball).is_empty());
    steps(&mut server, 100);
    let frames: Vec<_> = sent(&mut server).0.into_iter().filter_map(|packet| packet.detection).collect();
    assert!(frames.iter().flat_map(|frame| &frame.balls).any(|ball| ball.x == 6_500.0));
    assert!(frames.iter().any(|frame| frame.balls.is_empty()));
}

#[test]
fn grsims_dribbler_is_on_above_0_rpm_and_robots_keep_their_velocity() {
    let mut grsim = server_like(Profile::Grsim);
    for (rpm, expected) in [(0.5, 1.0), (0.0, 0.0), (20_000.0, 1.0)] {
        lead(&mut grsim, &[RobotCommand { dribbler_speed: Some(rpm), ..ahead(1, 0.7) }]);
        steps(&mut grsim, 5);
        assert_eq!(grsim.world().robot(own(1)).unwrap().order().dribbler, expected);
    }
    let silent = RobotCommand { id: 1, ..Default::default() };
    assert!(lead(&mut grsim, &[silent]).errors.is_empty());
    let empty = RobotCommand { move_command: Some(RobotMoveCommand { command: None }), ..silent };
    let reported = lead(&mut grsim, &[empty]);
    assert_eq!(reported.errors[0].code.as_deref(), Some("GRSIM_UNSUPPORTED_MOVE_COMMAND"));
    steps(&mut grsim, 5);
    let order = *grsim.world().robot(own(1)).unwrap().order();
    assert_eq!((order.drive, order.dribbler), (drive_ahead(0.7), 1.0));
}

fn drive_ahead(speed: f32) -> crate::small_size::Drive {
    let linear = geometry::Vector::new(speed, 0.0);
    crate::small_size::Drive::Local(geometry::Twist { linear, angular: 0.0 })
}

#[test]
fn grsims_vision_has_the_true_ball_position_and_height() {
    let seen = |profile| {
        let mut server = server_like(profile);
        let up =
            TeleportBall { x: Some(1.0), y: Some(1.0), z: Some(0.5), vz: Some(2.0), ..Default::default() };
        teleport_ball(&mut server, up);
        steps(&mut server, 60);
        let frames = sent(&mut server).0.into_iter().filter_map(|packet| packet.detection);
        frames.flat_map(|frame| frame.balls).next().unwrap()
    };
    let ball = seen(Profile::Grsim);
    assert!(ball.z.is_some_and(|z| (500.0..650.0).contains(&z)), "{ball:?}");
    assert!((ball.x - 1000.0).abs() < 1.0 && (ball.y - 1000.0).abs() < 1.0, "{ball:?}");
    let other = seen(Profile::Ours);
    assert!(other.z.is_none() && (other.x - 1000.0).abs() > 10.0, "{other:?}");
    // On the field surface: the height of its centre.
    let mut grsim = server_like(Profile::Grsim);
    steps(&mut grsim, 30);
    let frames: Vec<_> = sent(&mut grsim).0.into_iter().filter_map(|packet| packet.detection).collect();
    assert!(frames.iter().flat_map(|frame| &frame.balls).all(|ball| ball.z == Some(21.5)));
}

#[test]
fn grsim_parks_robots_that_are_placed_far_off_the_field() {
    let mut grsim = server_like(Profile::Grsim);
    let put = |server: &mut Server, x: f32| {
        let robot = TeleportRobot { id: blue(4), x: Some(x), y: Some(-2.5), ..Default::default() };
        teleport_robot(server, robot)
    };
    assert!(put(&mut grsim, 100.0).is_empty());
    assert!(!grsim.world().robot(own(4)).unwrap().present);
    assert_eq!(ids(&answers(&mut grsim, &[ahead(4, 1.0)])[0]), [4], "it is parked, not gone");
    assert!(put(&mut grsim, 1.5).is_empty(), "and returns without `present`");
    assert!(grsim.world().robot(own(4)).unwrap().present);
    // Just outside the lines it stands on the field surface.
    assert!(put(&mut grsim, 4.7).is_empty());
    assert!(grsim.world().robot(own(4)).unwrap().present);
    assert_eq!(put(&mut server(), 100.0), ["ONETWO_OUTSIDE_HALL"]);
}
