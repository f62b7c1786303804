//! A virtual robot keeps its rate and survives any input, with a simulated clock and with the system's.

use std::net::UdpSocket;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant as Clock};

use brain::BrainConfig;
use casebase::CaseBase;
use prost::Message as _;
use protocol::frame::TeamKey;
use protocol::host_link::{HostLink, Opened};
use protocol::{Instant, RobotId, TeamId};
use rules::{Colour, League};
use ssl::simulation::{RobotControl, RobotControlResponse, RobotFeedback};
use virtual_robot::{Options, ProcessEnd, VirtualRobot, run};

const KEY: TeamKey = TeamKey([9; 16]);

fn id() -> RobotId {
    RobotId::new(3).unwrap()
}

fn config() -> BrainConfig {
    BrainConfig { epoch: 77, ..BrainConfig::hosted(id(), TeamId::of(Colour::Blue), League::DivisionB) }
}

fn base() -> CaseBase<'static> {
    case_library::division_b()
}

#[test]
fn a_robot_without_a_host_orders_its_body_100_times_a_second_to_stand() {
    let mut robot = VirtualRobot::new(Instant(0), &config(), base(), KEY.of_robot(id()));
    let (mut commands, mut frames) = (0, 0);
    while robot.poll_timeout() < Instant(1_000_000) {
        let now = robot.poll_timeout();
        robot.handle_timeout(now);
        frames += std::iter::from_fn(|| robot.poll_frame(now)).count();
        if let Some(bytes) = robot.poll_control() {
            let control = RobotControl::decode(&bytes[..]).unwrap();
            assert_eq!(control.robot_commands.len(), 1);
            assert_eq!((control.robot_commands[0].id, control.robot_commands[0].kick_speed), (3, None));
            commands += 1;
        }
    }
    assert_eq!(commands, 100);
    assert!(frames > 0, "a host must learn that the robot is there");
}

#[test]
fn ticks_that_were_missed_are_over() {
    let mut robot = VirtualRobot::new(Instant(0), &config(), base(), KEY.of_robot(id()));
    robot.handle_timeout(Instant(0));
    robot.handle_timeout(Instant(500_000));
    assert!(robot.poll_control().is_some());
    assert!(robot.poll_timeout() > Instant(500_000));
}

#[test]
fn random_datagrams_are_survived_and_counted() {
    let mut robot = VirtualRobot::new(Instant(0), &config(), base(), KEY.of_robot(id()));
    let mut state = 3_u64;
    for n in 0..20_000_u64 {
        let mut bytes = [0; 160];
        for byte in &mut bytes {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            *byte = (state >> 56) as u8;
        }
        let bytes = &bytes[..usize::from(bytes[159]) % 160];
        let now = Instant(n * 100);
        robot.handle_frame(now, bytes);
        robot.handle_response(now, bytes);
        robot.handle_timeout(now);
    }
    assert!(robot.unreadable() > 10_000);
    let refused: u32 = robot.station().link().refused().iter().sum();
    // What no step has time for stays unopened.
    assert!(refused > 500);
    assert_eq!(refused + robot.station().brain().unopened(), 20_000);
}

#[test]
fn over_sockets_a_robot_reaches_host_and_simulator_and_ends_on_request() {
    let socket = || {
        let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
        socket.set_read_timeout(Some(Duration::from_secs(5))).unwrap();
        socket
    };
    let (host, simulator) = (socket(), socket());
    let options = Options {
        brain: config(),
        keys: KEY.of_robot(id()),
        host: host.local_addr().unwrap(),
        simulator: simulator.local_addr().unwrap(),
    };
    let end = AtomicBool::new(false);
    std::thread::scope(|scope| {
        let began = Clock::now();
        let robot = scope.spawn(|| run(&options, base(), &end));
        let mut link = HostLink::new(TeamId::of(Colour::Blue), KEY, 1);
        let mut bytes = [0; 1024];
        let (len, from) = host.recv_from(&mut bytes).unwrap();
        assert!(matches!(link.open(Instant(0), &bytes[..len]), Ok(Opened::Unauthenticated(..))));
        assert_eq!(link.welcome(id()).map(|welcome| welcome.boot_epoch), Some(77));
        for _ in 0..20 {
            let (len, sender) = simulator.recv_from(&mut bytes).unwrap();
            assert_eq!(sender, from, "one socket");
            assert_eq!(RobotControl::decode(&bytes[..len]).unwrap().robot_commands[0].id, 3);
            let feedback =
                vec![RobotFeedback { id: 3, dribbler_ball_contact: Some(true), ..Default::default() }];
            let answer = RobotControlResponse { feedback, ..Default::default() };
            simulator.send_to(&answer.encode_to_vec(), sender).unwrap();
        }
        // The twentieth tick is due 190 ms after the robot's start, and never comes much earlier.
        assert!(began.elapsed() > Duration::from_millis(120), "{:?}", began.elapsed());
        end.store(true, Ordering::Relaxed);
        assert_eq!(robot.join().unwrap().unwrap(), ProcessEnd::Asked);
    });
}
