//! `legacy`: tests of grSim's older protocol, port 20011.

use ssl::simulation::{
    GrsimBallReplacement, GrsimCommands, GrsimPacket, GrsimReplacement, GrsimRobotCommand,
    GrsimRobotReplacement, RobotsStatus,
};

use super::*;

/// The states in the answer to a message of grSim's older protocol, by the port they go to.
fn states(server: &mut Server, packet: &GrsimPacket) -> Vec<(u16, RobotsStatus)> {
    while server.poll_transmit().is_some() {}
    server.handle(Port::Legacy, from(), &packet.encode_to_vec());
    let mut states = Vec::new();
    while let Some(Transmit { to, bytes }) = server.poll_transmit() {
        let Destination::Status(to) = to else { continue };
        assert_eq!(to.ip(), from().ip(), "to the sender of the commands");
        states.push((to.port(), RobotsStatus::decode(&bytes[..]).unwrap()));
    }
    states
}

#[test]
fn grsims_older_protocol_drives_kicks_and_places() {
    let mut grsim = server_like(Profile::Grsim);
    let command = |of: fn(&mut GrsimRobotCommand)| {
        let mut command = GrsimRobotCommand { id: 2, ..Default::default() };
        of(&mut command);
        let commands = GrsimCommands { timestamp: 0.0, isteamyellow: false, robot_commands: vec![command] };
        GrsimPacket { commands: Some(commands), replacement: None }
    };
    assert!(states(&mut grsim, &GrsimPacket::default()).is_empty(), "nothing has changed");
    let before = grsim.world().robot(own(2)).unwrap().pose.position;
    for _ in 0..50 {
        states(&mut grsim, &command(|c| (c.veltangent, c.velangular) = (1.0, 0.0)));
        steps(&mut grsim, 10);
    }
    let after = grsim.world().robot(own(2)).unwrap().pose.position;
    assert!(
        (after.x() - before.x() - 0.389).abs() < 0.01,
        "as by the league's protocol: {before:?} {after:?}"
    );
    // All wheels turn counter-clockwise: the robot turns on the spot.
    for _ in 0..50 {
        let wheels = |c: &mut GrsimRobotCommand| {
            c.wheelsspeed = true;
            (c.wheel1, c.wheel2, c.wheel3, c.wheel4) = (Some(10.0), Some(10.0), Some(10.0), Some(10.0));
        };
        states(&mut grsim, &command(wheels));
        steps(&mut grsim, 10);
    }
    let robot = grsim.world().robot(own(2)).unwrap();
    // 10 rad/s of a wheel of 27 mm, about 0.081 m from the middle.
    assert!(robot.turning > 2.5 && robot.velocity.norm() < 0.05, "{robot:?}");
    // The ball is placed in its dribbler opening by a replacement; a chip.
    let robot_at =
        GrsimRobotReplacement { x: 1.0, y: 1.0, dir: 90.0, id: 2, yellowteam: false, turnon: None };
    let reach = f64::from(robot.body.front + 0.0215 + 0.001);
    let ball = GrsimBallReplacement { x: Some(1.0), y: Some(1.0 + reach), vx: Some(0.0), vy: Some(0.0) };
    let replacement = Some(GrsimReplacement { ball: Some(ball), robots: vec![robot_at] });
    states(&mut grsim, &GrsimPacket { commands: None, replacement });
    steps(&mut grsim, 1);
    let reported = states(&mut grsim, &command(|_| {}));
    let [(30011, status)] = &reported[..] else { panic!("{reported:?}") };
    assert!(status.robots_status.len() == 1 && status.robots_status[0].infrared);
    states(&mut grsim, &command(|c| (c.kickspeedx, c.kickspeedz) = (3.0, 2.0)));
    steps(&mut grsim, 5);
    let reported = states(&mut grsim, &command(|_| {}));
    assert!(reported[0].1.robots_status[0].chip_kick, "{reported:?}");
    let ball = grsim.world().ball;
    assert!(ball.height > 0.0 && ball.velocity.y() > 2.0, "{ball:?}");
    steps(&mut grsim, 200);
    let reported = states(&mut grsim, &command(|_| {}));
    let state = reported[0].1.robots_status[0];
    assert!(!state.chip_kick && !state.infrared);
    // Switched off: gone from the field, and back.
    let replace = |turnon| {
        let robot = GrsimRobotReplacement { turnon, ..robot_at };
        let replacement = Some(GrsimReplacement { ball: None, robots: vec![robot] });
        GrsimPacket { commands: None, replacement }
    };
    states(&mut grsim, &replace(Some(false)));
    assert!(!grsim.world().robot(own(2)).unwrap().present);
    states(&mut grsim, &replace(None));
    assert!(grsim.world().robot(own(2)).unwrap().present);
    // Undecodable bytes, invalid ids, NaN.
    grsim.handle(Port::Legacy, from(), b"\xff\xff");
    let nonsense = |c: &mut GrsimRobotCommand| (c.id, c.veltangent) = (99, f32::NAN);
    states(&mut grsim, &command(nonsense));
    states(&mut grsim, &command(|c| (c.veltangent, c.kickspeedx) = (f32::NAN, f32::INFINITY)));
    steps(&mut grsim, 100);
    assert!(grsim.world().robots().iter().all(|robot| robot.pose.position.is_finite()));
}
