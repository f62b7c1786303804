//! Tests: the server follows the league's simulation protocol and answers requests that it cannot carry out.
//! Bytes in, bytes out.

mod codes;
mod legacy;
mod profiles;

use ssl::common::{Any, RobotId as WireId, Team};
use ssl::simulation::{
    MoveCommand, MoveLocalVelocity, RealismConfig, RealismConfigErForce, RobotCommand, RobotLimits,
    RobotMoveCommand, RobotSpecs, SimulatorConfig, SimulatorControl, TeleportBall, TeleportRobot,
};
use ssl::vision::WrapperPacket;

use super::*;
use crate::small_size::{NoiseParameters, Parameters};
use geometry::Point;

fn from() -> SocketAddr {
    SocketAddr::from(([127, 0, 0, 1], 40_000))
}

fn server_like(profile: Profile) -> Server {
    let mut settings = ServerSettings::of(League::DivisionB, profile, 1, 1_795_220_511.0).unwrap();
    settings.model.parameters.noise = NoiseParameters::NONE;
    Server::new(&settings)
}

fn server() -> Server {
    server_like(Profile::Ours)
}

fn sent(server: &mut Server) -> (Vec<WrapperPacket>, Vec<Vec<u8>>) {
    let (mut vision, mut answers) = (Vec::new(), Vec::new());
    while let Some(Transmit { to, bytes }) = server.poll_transmit() {
        match to {
            Destination::Vision(_) => vision.push(WrapperPacket::decode(&bytes[..]).unwrap()),
            Destination::Reply { .. } => answers.push(bytes),
            Destination::Status(_) => {}
        }
    }
    (vision, answers)
}

/// The codes in the answer to a message to the simulator's port; `None`: it is not answered.
fn codes(server: &mut Server, command: &SimulatorCommand) -> Option<Vec<String>> {
    sent(server);
    server.handle(Port::Simulator, from(), &command.encode_to_vec());
    let answer = SimulatorResponse::decode(&sent(server).1.pop()?[..]).unwrap();
    Some(answer.errors.into_iter().map(|error| error.code.unwrap()).collect())
}

fn control(server: &mut Server, control: SimulatorControl) -> Vec<String> {
    codes(server, &SimulatorCommand { control: Some(control), config: None }).unwrap()
}

fn teleport_ball(server: &mut Server, ball: TeleportBall) -> Vec<String> {
    control(server, SimulatorControl { teleport_ball: Some(ball), ..Default::default() })
}

fn teleport_robot(server: &mut Server, robot: TeleportRobot) -> Vec<String> {
    control(server, SimulatorControl { teleport_robot: vec![robot], ..Default::default() })
}

fn config(server: &mut Server, config: SimulatorConfig) -> Vec<String> {
    codes(server, &SimulatorCommand { control: None, config: Some(config) }).unwrap()
}

/// The answers to a message to blue's port, datagram by datagram.
fn answers(server: &mut Server, commands: &[RobotCommand]) -> Vec<RobotControlResponse> {
    sent(server);
    let control = RobotControl { robot_commands: commands.to_vec() };
    server.handle(Port::Team(Colour::Blue), from(), &control.encode_to_vec());
    sent(server).1.iter().map(|bytes| RobotControlResponse::decode(&bytes[..]).unwrap()).collect()
}

/// The first of them.
fn lead(server: &mut Server, commands: &[RobotCommand]) -> RobotControlResponse {
    answers(server, commands).remove(0)
}

/// Blue's robot drives ahead on a command every 10 ms.
fn drive(server: &mut Server, id: u32, speed: f32, commands: u32) {
    for _ in 0..commands {
        lead(server, &[ahead(id, speed)]);
        steps(server, 10);
    }
}

fn ahead(id: u32, speed: f32) -> RobotCommand {
    let local = MoveLocalVelocity { forward: speed, left: 0.0, angular: 0.0 };
    let command = Some(MoveCommand::LocalVelocity(local));
    RobotCommand { id, move_command: Some(RobotMoveCommand { command }), ..RobotCommand::default() }
}

fn blue(id: u32) -> WireId {
    WireId { id: Some(id), team: Some(Team::Blue as i32) }
}

fn own(id: u8) -> Who {
    Who::blue(RobotId::new(id).unwrap())
}

fn steps(server: &mut Server, count: u32) {
    for _ in 0..count {
        server.step();
    }
}

#[test]
fn a_commanded_robot_drives_and_the_answer_lists_the_robots_present() {
    let mut server = server();
    let before = server.world().robot(own(2)).unwrap().pose.position;
    for _ in 0..50 {
        let answer = lead(&mut server, &[ahead(2, 1.0)]);
        assert!(answer.errors.is_empty());
        let ids: Vec<_> = answer.feedback.iter().map(|feedback| feedback.id).collect();
        assert_eq!(ids, [0, 1, 2, 3, 4, 5]);
        steps(&mut server, 10);
    }
    let after = server.world().robot(own(2)).unwrap().pose.position;
    // ½·1²/4.5 m are lost in accelerating to 1 m/s for half a second.
    assert!((after.x() - before.x() - 0.389).abs() < 0.01, "{before:?} {after:?}");
    assert_eq!(server.counts().control, 50);
}

#[test]
fn feedback_has_the_break_beam_sensor() {
    let mut server = server();
    let robot = server.world().robot(own(1)).unwrap();
    let (p, reach) = (robot.pose.position, robot.body.front + 0.0215);
    let ball = TeleportBall { x: Some(p.x() + reach + 0.001), y: Some(p.y()), ..TeleportBall::default() };
    assert!(teleport_ball(&mut server, ball).is_empty());
    server.step();
    let contacts: Vec<_> = (lead(&mut server, &[]).feedback.iter())
        .map(|feedback| feedback.dribbler_ball_contact.unwrap())
        .collect();
    assert_eq!(contacts, [false, true, false, false, false, false]);
}

#[test]
fn time_follows_the_pace_and_skips_more_than_250_ms_of_delay() {
    let mut server = server();
    let (sec, mut now) = (1_000_000, Instant(5_000_000));
    let run = |server: &mut Server, now: &mut Instant, us: u64| {
        let before = server.world().now();
        for _ in 0..us / 5_000 {
            now.0 += 5_000;
            server.advance(*now);
        }
        server.world().now() - before
    };
    server.advance(now);
    assert_eq!(run(&mut server, &mut now, sec), 1_000);
    let pace = |server: &mut Server, speed| {
        control(server, SimulatorControl { simulation_speed: Some(speed), ..Default::default() })
    };
    assert!(pace(&mut server, 0.0).is_empty());
    assert_eq!((run(&mut server, &mut now, sec), server.poll_timeout()), (0, None));
    assert!(pace(&mut server, 2.5).is_empty());
    assert_eq!(run(&mut server, &mut now, sec), 2_500);
    assert!(pace(&mut server, 1.0).is_empty());
    let before = server.world().now();
    now.0 += 10 * sec;
    server.advance(now);
    assert_eq!(server.world().now() - before, 250);
    assert_eq!(server.counts().skipped, 9_750);
    let next = server.poll_timeout().unwrap();
    assert!(next > now && next.0 - now.0 <= 1_001);
}

#[test]
fn vision_goes_to_the_port_that_was_set() {
    let mut server = server();
    assert!(
        config(&mut server, SimulatorConfig { vision_port: Some(10_006), ..Default::default() }).is_empty()
    );
    steps(&mut server, 100);
    let mut packets = 0;
    while let Some(transmit) = server.poll_transmit() {
        assert_eq!(transmit.to, Destination::Vision(10_006));
        packets += 1;
    }
    // 65 ms of two cameras at 75 Hz, and the field once.
    assert!((9..=12).contains(&packets), "{packets}");
}

#[test]
fn fields_missing_in_a_teleport_stay_unchanged() {
    let mut server = server();
    let ball =
        TeleportBall { x: Some(1.0), y: Some(0.5), vx: Some(2.0), vy: Some(-1.0), ..Default::default() };
    teleport_ball(&mut server, ball);
    let up = TeleportBall { z: Some(0.5), roll: Some(true), ..Default::default() };
    teleport_ball(&mut server, up);
    let ball = server.world().ball;
    assert_eq!((ball.position.x(), ball.position.y(), ball.height), (1.0, 0.5, 0.5));
    assert_eq!((ball.velocity.x(), ball.velocity.y()), (2.0, -1.0));
    assert_eq!(ball.spin, ball.velocity, "roll was set");

    let turn = TeleportRobot { id: blue(3), orientation: Some(1.0), ..Default::default() };
    let before = server.world().robot(own(3)).unwrap().pose;
    teleport_robot(&mut server, turn);
    let after = server.world().robot(own(3)).unwrap().pose;
    assert_eq!(after.position, before.position);
    assert_eq!(after.heading.radians(), 1.0);
}

#[test]
fn robots_are_removed_returned_and_pulled() {
    let mut server = server();
    let gone = TeleportRobot { id: blue(0), present: Some(false), ..Default::default() };
    assert!(teleport_robot(&mut server, gone).is_empty());
    let answer = lead(&mut server, &[ahead(0, 1.0)]);
    assert_eq!(answer.errors[0].code.as_deref(), Some("ONETWO_UNKNOWN_ROBOT"));
    assert_eq!(answer.feedback.len(), 5, "who is not there answers nothing");
    let back = TeleportRobot { present: Some(true), x: Some(0.3), y: Some(0.2), v_x: Some(1.0), ..gone };
    assert!(teleport_robot(&mut server, back).is_empty());
    assert_eq!(server.world().robot(own(0)).unwrap().velocity.x(), 1.0);
    let new = TeleportRobot {
        id: blue(15),
        present: Some(true),
        x: Some(-4.0),
        y: Some(2.0),
        ..Default::default()
    };
    assert!(teleport_robot(&mut server, new).is_empty());
    let pulled = TeleportRobot {
        id: blue(15),
        by_force: Some(true),
        x: Some(-3.0),
        y: Some(2.0),
        ..Default::default()
    };
    assert!(teleport_robot(&mut server, pulled).is_empty());
    steps(&mut server, 2_000);
    let place = |server: &Server| server.world().robot(own(15)).unwrap().pose.position;
    assert!((place(&server).x() + 3.0).abs() < 0.02, "one message is enough: {:?}", place(&server));
    // It stays pulled, whatever its orders are ...
    drive(&mut server, 15, 1.0, 100);
    assert!((place(&server).x() + 3.0).abs() < 0.02, "{:?}", place(&server));
    // ... until a message without force, which moves nothing.
    let before = place(&server);
    assert!(teleport_robot(&mut server, TeleportRobot { id: blue(15), ..Default::default() }).is_empty());
    assert_eq!(place(&server), before);
    drive(&mut server, 15, 1.0, 100);
    assert!(place(&server).x() > -2.7, "{:?}", place(&server));
}

#[test]
fn a_ball_is_pulled_and_held_until_it_is_let_go() {
    let mut server = server();
    let by_force = |x, y| TeleportBall { x, y, by_force: Some(true), ..Default::default() };
    assert!(teleport_ball(&mut server, by_force(Some(0.0), Some(2.0))).is_empty());
    steps(&mut server, 3_000);
    let place = |server: &Server| server.world().ball.position;
    assert!(place(&server).distance(Point::new(0.0, 2.0)) < 0.01, "{:?}", place(&server));
    // A robot that drives through it does not push it away.
    server.world_mut().put(own(0), geometry::Pose::from_mm_deg(-300.0, 2000.0, 0.0));
    drive(&mut server, 0, 0.5, 200);
    assert!(place(&server).distance(Point::new(0.0, 2.0)) < 0.15, "{:?}", place(&server));
    // One coordinate alone: the other keeps its requested value.
    assert!(teleport_ball(&mut server, by_force(Some(1.0), None)).is_empty());
    steps(&mut server, 3_000);
    assert!(place(&server).distance(Point::new(1.0, 2.0)) < 0.15, "{:?}", place(&server));
    let before = server.world().ball;
    assert!(teleport_ball(&mut server, TeleportBall::default()).is_empty());
    assert_eq!(server.world().ball, before, "nothing is moved by letting go");
    let kicked = TeleportBall { vx: Some(0.0), vy: Some(-2.0), ..Default::default() };
    assert!(teleport_ball(&mut server, kicked).is_empty());
    steps(&mut server, 500);
    assert!(place(&server).y() < 1.5, "{:?}", place(&server));
}

#[test]
fn a_ball_put_down_safely_pushes_robots_aside() {
    let mut server = server();
    let p = server.world().robot(own(4)).unwrap().pose.position;
    let safely = |on| TeleportBall {
        x: Some(p.x() + 0.01),
        y: Some(p.y()),
        teleport_safely: Some(on),
        ..Default::default()
    };
    teleport_ball(&mut server, safely(true));
    let robot = server.world().robot(own(4)).unwrap().pose.position;
    assert!(robot.distance(server.world().ball.position) > 0.111, "{robot:?}");
}

#[test]
fn a_specification_changes_only_its_robot() {
    let mut server = server();
    let limits = RobotLimits { vel_absolute_max: Some(0.5), ..Default::default() };
    let specs = RobotSpecs {
        id: blue(1),
        mass: Some(3.0),
        max_linear_kick_speed: Some(4.0),
        limits: Some(limits),
        ..Default::default()
    };
    assert!(
        config(&mut server, SimulatorConfig { robot_specs: vec![specs], ..Default::default() }).is_empty()
    );
    let [one, other] = [1, 2].map(|id| server.world().robot(own(id)).unwrap().clone());
    assert_eq!((one.body.mass, one.limits().speed, one.kick_limits[0]), (3.0, 0.5, 4.0));
    assert_eq!((other.body.mass, other.limits().speed, other.kick_limits[0]), (2.5, 3.5, 8.0));
}

#[test]
fn a_new_geometry_changes_the_field_and_the_vision_packets() {
    let mut server = server();
    let a = World::new(League::DivisionA, Parameters::of(League::DivisionA).unwrap(), 0);
    let reported = Cameras::of(Profile::Ours, 0.0, &a, 0).geometry(&a, None);
    let codes =
        config(&mut server, SimulatorConfig { geometry: Some(reported.clone()), ..Default::default() });
    assert_eq!(codes, ["ONETWO_UNSUPPORTED"], "where cameras hang is the simulator's business");
    assert_eq!(server.world().pitch().field, League::DivisionA.field());
    steps(&mut server, 30);
    let vision = sent(&mut server).0;
    let received = vision.into_iter().find_map(|packet| packet.geometry).unwrap();
    assert_eq!(received.field, reported.field);
}

#[test]
fn er_forces_realism_settings_change_noise_delay_and_loss() {
    let mut server = server();
    let asked = RealismConfigErForce {
        stddev_ball_p: Some(0.01),
        vision_delay: Some(20_000_000),
        robot_command_loss: Some(1.0),
        ..Default::default()
    };
    let custom = Any {
        type_url: Some("type.googleapis.com/RealismConfigErForce".into()),
        value: Some(asked.encode_to_vec()),
    };
    let realism_config = Some(RealismConfig { custom: vec![custom] });
    assert!(config(&mut server, SimulatorConfig { realism_config, ..Default::default() }).is_empty());
    let settings = *server.cameras.settings();
    assert_eq!((settings.noise.ball, settings.noise.robot), (0.01, 0.0));
    assert!((settings.camera.delay - 0.02).abs() < 1e-6);
    let before = server.world().robot(own(2)).unwrap().pose;
    drive(&mut server, 2, 1.0, 20);
    assert_eq!(server.world().robot(own(2)).unwrap().pose, before, "every command was lost");
    assert_eq!(server.counts().lost, 20);
}

#[test]
fn in_synchronous_mode_time_advances_by_the_requested_step() {
    let mut server = server();
    let request = SimulationSyncRequest {
        sim_step: Some(0.02),
        simulator_command: None,
        robot_control: Some(RobotControl { robot_commands: vec![ahead(0, 1.0)] }),
    };
    let mut looked = Vec::new();
    let answer = server.synchronous(Colour::Blue, &request, |world| looked.push(world.now()));
    assert_eq!(server.world().now(), 20);
    assert_eq!(answer.detection.len(), 2);
    assert!((answer.detection[0].t_capture - 1_795_220_511.02).abs() < 1e-6);
    assert_eq!(answer.robot_control_response.unwrap().feedback.len(), 6);
    assert_eq!(looked, (1..=20).collect::<Vec<u64>>(), "a referee sees every step");
    assert!(server.poll_transmit().is_none(), "vision goes into the answer alone");
    let none = SimulationSyncRequest { sim_step: None, ..Default::default() };
    assert_eq!(server.synchronous(Colour::Yellow, &none, |_| {}).detection.len(), 2);
    assert_eq!(server.world().now(), 20, "no step, no time");
}

#[test]
fn the_same_requests_give_the_same_answers() {
    let play = || {
        let settings = ServerSettings::of(League::DivisionB, Profile::Ours, 5, 0.0).unwrap();
        let mut server = Server::new(&settings);
        let mut bytes = Vec::new();
        for step in 0..200_u16 {
            let request = SimulationSyncRequest {
                sim_step: Some(0.016),
                simulator_command: None,
                robot_control: Some(RobotControl {
                    robot_commands: vec![ahead(0, f32::from(step % 9) * 0.2)],
                }),
            };
            bytes.extend(server.synchronous(Colour::Blue, &request, |_| {}).encode_to_vec());
        }
        bytes
    };
    assert_eq!(play(), play());
}

#[test]
fn the_same_messages_give_the_same_bytes() {
    let play = || {
        let settings = ServerSettings::of(League::DivisionA, Profile::Ours, 9, 0.0).unwrap();
        let mut server = Server::new(&settings);
        let mut bytes = Vec::new();
        for step in 0..500_u16 {
            if step % 10 == 0 {
                let commands: Vec<_> = (0..11).map(|id| ahead(id, f32::from(step % 70) * 0.05)).collect();
                let control = RobotControl { robot_commands: commands };
                server.handle(Port::Team(Colour::Yellow), from(), &control.encode_to_vec());
            }
            server.step();
            while let Some(transmit) = server.poll_transmit() {
                bytes.extend(transmit.bytes);
            }
        }
        bytes
    };
    assert_eq!(play(), play());
}

#[test]
fn every_corrupted_datagram_gets_one_answer() {
    let mut server = server();
    let mut chance = Stream::new(4, "test");
    let seeds = [
        RobotControl { robot_commands: vec![ahead(1, 1.0), ahead(9, f32::NAN)] }.encode_to_vec(),
        SimulatorCommand {
            control: Some(SimulatorControl {
                teleport_ball: Some(TeleportBall { x: Some(1.0), vx: Some(3.0), ..Default::default() }),
                teleport_robot: vec![TeleportRobot { id: blue(1), x: Some(0.1), ..Default::default() }],
                simulation_speed: Some(1.0),
            }),
            config: Some(SimulatorConfig { vision_port: Some(1), ..Default::default() }),
        }
        .encode_to_vec(),
    ];
    for round in 0..20_000_usize {
        let mut bytes = seeds[round % 2].clone();
        for _ in 0..chance.whole(1, 6) {
            let at = chance.whole(0, bytes.len() as u32 - 1) as usize;
            bytes[at] = chance.whole(0, 255) as u8;
        }
        bytes.truncate(chance.whole(1, 2 * bytes.len() as u32) as usize);
        let port = [Port::Simulator, Port::Team(Colour::Blue), Port::Team(Colour::Yellow)][round % 3];
        server.handle(port, from(), &bytes);
        if round % 20 == 0 {
            server.step();
        }
        assert_eq!(sent(&mut server).1.len(), 1, "one answer to each");
    }
    let ball = server.world().ball;
    assert!(ball.position.is_finite() && ball.velocity.is_finite());
    assert!(server.world().robots().iter().all(|robot| robot.pose.position.is_finite()));
    assert!(server.counts().undecodable > 1_000);
}
