//! The radio does not allocate after the first second of a match (docs/architecture.md §9).
#![allow(unsafe_code, reason = "an allocator that counts is one by an unsafe trait")]

mod allocations;

use geometry::{Angle, Field, GoalEnd, Point, Pose, Vector};
use host::radio::{Radio, RadioSettings, RadioSituation, Relay};
use host::world::{BallModels, Robot, World};
use protocol::frame::TeamKey;
use protocol::host::{Directive, HostCommand, RuleRole, Telemetry};
use protocol::link::{Link, Packet};
use protocol::quantized::WirePose;
use protocol::team::{Beacon, Progress, Role, Status, TeamMessage};
use protocol::{Instant, RobotId, TeamId, Who};
use rules::{Colour, Phase};

#[test]
fn eleven_robots_at_a_hundred_snapshots_a_second_need_no_heap() {
    let team = TeamId(1);
    let mut radio = Radio::new(RadioSettings { relay: Relay::ToEach, ..RadioSettings::new(team, 70) });
    let mut robots: Vec<Link> =
        RobotId::all().take(11).map(|id| Link::new(team, id, TeamKey::ZERO.of_robot(id), 5)).collect();
    let mut world = World::empty(Instant(0), BallModels::default());
    for colour in [Colour::Blue, Colour::Yellow] {
        for id in RobotId::all().take(11) {
            let pose = Pose { position: Point::<Field>::new(0.3, 0.1), heading: Angle::new(0.5) };
            let who = Who { colour, id };
            let (velocity, seen) = (Vector::new(0.5, 0.1), Instant(0));
            world.put(Robot { who, pose, velocity, angular: 0.1, confidence: 1.0, seen });
        }
    }
    let situation = RadioSituation { us: Colour::Blue, phase: Phase::Run, placement: None };
    let gameplay = Directive::Gameplay { hint: None };
    let commands: Vec<HostCommand> = RobotId::all()
        .take(11)
        .map(|to| HostCommand {
            to,
            defending: GoalEnd::Negative,
            phase: Phase::Run,
            rule_role: RuleRole::Player,
            directive: gameplay.clone(),
        })
        .collect();
    let (mut sent, mut received) = (0_u64, 0_u64);
    let mut second = |radio: &mut Radio, number: u64| {
        for n in 0..100 {
            let now = Instant(number * 1_000_000 + n * 10_000);
            world.time = now;
            radio.offer(now, &world, situation, &commands);
            let mut out: heapless::Vec<Packet, 400> = heapless::Vec::new();
            for (i, robot) in robots.iter_mut().enumerate() {
                let packet = send(robot, now, (n + i as u64).is_multiple_of(2));
                received += u64::from(radio.handle_packet(now, &packet).is_ok());
                while let Some((_, packet)) = radio.poll_packet() {
                    sent += 1;
                    let _ = out.push(packet);
                }
            }
            for packet in &out {
                for robot in &mut robots {
                    let _ = robot.open(now, packet);
                }
            }
        }
    };
    second(&mut radio, 0);
    let before = allocations::count();
    (1..10).for_each(|number| second(&mut radio, number));
    let during = allocations::count() - before;
    assert!(sent > 10 * 100 * 15 && received > 10 * 100 * 10, "{sent} sent, {received} heard");
    assert_eq!(radio.dropped(), 0);
    assert_eq!(during, 0, "allocations in nine seconds");
}

fn send(robot: &mut Link, now: Instant, beacon: bool) -> Packet {
    let message = if beacon {
        TeamMessage::Beacon(Beacon {
            pose: WirePose::default(),
            ball: None,
            status: Status::AVAILABLE,
            case_base: 7,
            cycle: None,
            progress: Progress::Idle,
            role: Role::None,
        })
    } else {
        let mut telemetry = Telemetry::default();
        robot.report(now, &mut telemetry);
        TeamMessage::Telemetry(telemetry)
    };
    robot.seal(&message)
}
