//! Can a host be tried against the ways of the league's other simulators? The traps by their numbers.

use super::*;

#[test]
fn trap_01_and_02_vision_is_as_the_other_simulators_send_it() {
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

#[test]
fn trap_09_answers_name_robots_that_are_gone_and_lack_some_that_are_there() {
    let gone = TeleportRobot { id: blue(0), present: Some(false), ..Default::default() };
    let mut grsim = server_like(Profile::Grsim);
    control(&mut grsim, SimulatorControl { teleport_robot: vec![gone], ..Default::default() });
    assert_eq!(lead(&mut grsim, Colour::Blue, &[]).feedback.len(), 6, "robot 0 is still named");

    let mut erforce = server_like(Profile::ErForce);
    let answers: Vec<_> = (0..500).map(|_| lead(&mut erforce, Colour::Blue, &[]).feedback.len()).collect();
    let named: usize = answers.iter().sum();
    // 3,000 chances of 0.9: deviation 16.
    assert!(named.abs_diff(2_700) < 66, "{named}");
    assert!(answers.iter().any(|count| *count < 6));
}

#[test]
fn trap_09_without_commands_for_a_tenth_of_a_second_robots_stand_by() {
    let mut erforce = server_like(Profile::ErForce);
    for _ in 0..30 {
        lead(&mut erforce, Colour::Blue, &[ahead(2, 0.5)]);
        steps(&mut erforce, 10);
    }
    assert!(erforce.world().robot(own(2)).unwrap().velocity.norm() > 0.4);
    steps(&mut erforce, 250);
    assert!(erforce.world().robot(own(2)).unwrap().velocity.norm() < 0.01);
}

#[test]
fn trap_09_a_command_without_a_dribblers_speed_resets_it_there_and_leaves_it_here() {
    let after = |profile| {
        let mut server = server_like(profile);
        lead(&mut server, Colour::Blue, &[RobotCommand { dribbler_speed: Some(1_000.0), ..ahead(1, 0.0) }]);
        steps(&mut server, 5);
        lead(&mut server, Colour::Blue, &[ahead(1, 0.0)]);
        steps(&mut server, 5);
        server.world().robot(own(1)).unwrap().order().dribbler
    };
    assert_eq!((after(Profile::ErForce), after(Profile::Ours)), (0.0, 1.0));
}

#[test]
fn trap_10_grsim_takes_nothing_but_robots_specifications() {
    let mut grsim = server_like(Profile::Grsim);
    let geometry = Some(grsim.cameras.geometry(grsim.world(), None));
    let asked = SimulatorConfig {
        geometry,
        robot_specs: vec![RobotSpecs { id: blue(1), mass: Some(3.0), ..Default::default() }],
        realism_config: Some(RealismConfig::default()),
        vision_port: Some(10_006),
    };
    assert_eq!(config(&mut grsim, asked), ["GRSIM_UNSUPPORTED_CONFIG"; 3]);
    assert_eq!(grsim.world().robot(own(1)).unwrap().body.mass, 3.0);
    assert_eq!(grsim.vision_port, VISION_PORT);
    let ball = TeleportBall {
        x: Some(1.0),
        vx: Some(1.0),
        teleport_safely: Some(true),
        roll: Some(true),
        ..Default::default()
    };
    let codes = control(&mut grsim, SimulatorControl { teleport_ball: Some(ball), ..Default::default() });
    assert_eq!(codes, ["GRSIM_UNSUPPORTED_TELEPORT"; 2]);
    assert_eq!(grsim.world().ball.position.x(), 1.0, "the rest of it is done");
}

#[test]
fn trap_11_a_ball_may_be_put_far_outside_and_vision_tells_it() {
    let mut server = server();
    let ball = TeleportBall { x: Some(6.5), y: Some(0.2), ..Default::default() };
    assert!(
        control(&mut server, SimulatorControl { teleport_ball: Some(ball), ..Default::default() }).is_empty()
    );
    steps(&mut server, 100);
    let frames: Vec<_> = sent(&mut server).0.into_iter().filter_map(|packet| packet.detection).collect();
    assert!(frames.iter().flat_map(|frame| &frame.balls).any(|ball| ball.x == 6_500.0));
    assert!(frames.iter().any(|frame| frame.balls.is_empty()));
}
