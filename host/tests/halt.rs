//! `halt`: tests: the host sends HALT in the call that receives it, and the replay of a trace with two
//! referees gives the same decisions.

use host::radio::To;
use host::record::header::RecordingHeader;
use host::record::recheck::Recheck;
use host::record::trace::{Record, RecordKind};
use host::referee::{SenderAddress, SourcePin};
use host::{Host, HostSettings, Input};
use protocol::frame::TeamKey;
use protocol::host::{HostMessage, Telemetry};
use protocol::link::{Link, overhear_host};
use protocol::team::TeamMessage;
use protocol::{Instant, RobotId, TeamId};
use rules::{Colour, League, Phase};
use ssl::Message;
use ssl::referee::{Command as Wire, Referee, TeamInfo};
use ssl::vision::{DetectionFrame, DetectionRobot, WrapperPacket};

const MS: u64 = 1_000;
const EPOCH: u64 = 1_795_220_000_000_000;

fn settings() -> HostSettings {
    HostSettings::new(Colour::Blue, League::DivisionB, 7)
}

fn camera_frame(number: u32, now: u64) -> Vec<u8> {
    let robot = DetectionRobot {
        confidence: 1.0,
        robot_id: Some(3),
        x: 10.0 * number as f32,
        orientation: Some(0.0),
        ..DetectionRobot::default()
    };
    let detection = DetectionFrame {
        frame_number: number,
        t_capture: now as f64 * 1e-6,
        robots_blue: vec![robot],
        ..DetectionFrame::default()
    };
    WrapperPacket { detection: Some(detection), ..WrapperPacket::default() }.encode_to_vec()
}

fn packet(now: u64, command: Wire, counter: u32) -> Vec<u8> {
    let team = |name: &str| TeamInfo { name: name.into(), ..TeamInfo::default() };
    let packet = Referee {
        packet_timestamp: EPOCH + now,
        command: command as i32,
        command_counter: counter,
        command_timestamp: EPOCH + now,
        yellow: team("yellow"),
        blue: team("blue"),
        source_identifier: Some("gc".into()),
        ..Referee::default()
    };
    packet.encode_to_vec()
}

fn machine(number: u8) -> SenderAddress {
    SenderAddress::new(([10, 0, 0, number], 40_000).into())
}

fn three() -> RobotId {
    RobotId::new(3).unwrap()
}

/// The radio side of robot 3: a host sends only to robots that it knows.
fn robot() -> Link {
    Link::new(TeamId::of(Colour::Blue), three(), TeamKey::ZERO.of_robot(three()), 1)
}

/// Telemetry of that robot.
fn telemetry(robot: &mut Link, now: u64) -> Vec<u8> {
    let mut telemetry = Telemetry::default();
    robot.report(Instant(now), &mut telemetry);
    robot.seal(&TeamMessage::Telemetry(telemetry)).to_vec()
}

/// Makes the robot known to the host from `now` on, for a second.
fn join(host: &mut Host, robot: &mut Link, now: u64) {
    for _ in 0..2 {
        let packet = telemetry(robot, now);
        host.handle(Instant(now), Input::Robot(&packet));
        while let Some((_, packet)) = host.poll_packet() {
            let _ = robot.open(Instant(now), &packet);
        }
    }
    assert!(host.radio().present(Instant(now)).any(|robot| robot == three()));
}

fn read(packet: &[u8]) -> Option<HostMessage> {
    let keys = TeamKey::ZERO.of_robot(three());
    overhear_host(packet, TeamId::of(Colour::Blue), &keys, three()).ok()
}

/// Phases of the world's parts that the host has queued.
fn phases(host: &mut Host) -> Vec<Phase<rules::Side>> {
    let mut phases = Vec::new();
    while let Some((_, packet)) = host.poll_packet() {
        if let Some(HostMessage::World(part)) = read(&packet) {
            phases.push(part.phase);
        }
    }
    phases
}

#[test]
fn halt_leaves_in_the_call_that_brings_it_whenever_the_last_snapshot_left() {
    // Time since a snapshot: the radio's rate would let the next one go after 10 ms.
    for after in [0, 1, 5 * MS, 9 * MS, 12 * MS] {
        for by_operator in [false, true] {
            let mut host = Host::new(settings(), Instant(0));
            join(&mut host, &mut robot(), 0);
            host.handle(Instant(0), Input::Referee(&packet(0, Wire::ForceStart, 1), machine(1)));
            for number in 0..20 {
                let now = u64::from(number) * 16 * MS;
                host.handle(Instant(now), Input::Vision(&camera_frame(number, now)));
            }
            assert_eq!(phases(&mut host).last(), Some(&Phase::Run));
            let now = 19 * 16 * MS + after;
            let halt = packet(now, Wire::Halt, 2);
            let input = if by_operator { Input::Halt } else { Input::Referee(&halt, machine(1)) };
            host.handle(Instant(now), input);
            assert!(host.is_halting());
            assert_eq!(
                phases(&mut host),
                [Phase::Halt],
                "{after} µs after a snapshot, by operator: {by_operator}"
            );
        }
    }
}

#[test]
fn commands_in_turns_at_line_rate_plan_no_oftener_than_camera_frames_do() {
    let mut host = Host::new(settings(), Instant(0));
    join(&mut host, &mut robot(), 0);
    host.handle(Instant(0), Input::Vision(&camera_frame(0, 0)));
    let (mut sent, mut counter) = (0, 1);
    // 10,000 packets in a second, HALT and FORCE_START in turns.
    for now in (0..1_000 * MS).step_by(100) {
        counter += 1;
        let command = if counter % 2 == 0 { Wire::Halt } else { Wire::ForceStart };
        host.handle(Instant(now), Input::Referee(&packet(now, command, counter), machine(1)));
        sent += phases(&mut host).len();
    }
    assert!(sent <= 450, "{sent} snapshots in a second");
}

/// Inputs with two referees, and the packets a host sends on them.
fn recorded(settings: HostSettings) -> Vec<Record> {
    let mut host = Host::new(settings, Instant(0));
    let mut records = Vec::new();
    let mut robot = robot();
    for step in 0..400_u32 {
        let now = u64::from(step) * 10 * MS;
        let (kind, from, bytes) = match step % 4 {
            0 => (RecordKind::Referee, machine(1), packet(now, Wire::ForceStart, 1)),
            // From the second second on another machine sends HALT with the same identifier, for a second.
            1 if (100..200).contains(&step) => (RecordKind::Referee, machine(2), packet(now, Wire::Halt, 1)),
            2 => (RecordKind::Robot, SenderAddress::INTERNAL, telemetry(&mut robot, now)),
            _ => (RecordKind::Vision, SenderAddress::INTERNAL, camera_frame(step, now)),
        };
        let input = match kind {
            RecordKind::Referee => Input::Referee(&bytes, from),
            RecordKind::Robot => Input::Robot(&bytes),
            _ => Input::Vision(&bytes),
        };
        host.handle(Instant(now), input);
        records.push(Record { at: Instant(now), host: 0, kind, from, bytes });
        while let Some((to, packet)) = host.poll_packet() {
            let _ = robot.open(Instant(now), &packet);
            let to = if let To::One(robot) = to { robot.number() } else { u8::MAX };
            let bytes = [&[to], &packet[..]].concat();
            records.push(Record {
                at: Instant(now),
                host: 0,
                kind: RecordKind::Sent,
                from: SenderAddress::INTERNAL,
                bytes,
            });
        }
    }
    records
}

fn same_again(settings: &HostSettings, records: &[Record]) -> bool {
    let header = RecordingHeader::from_json(&RecordingHeader::of(settings).to_json()).unwrap();
    let mut recheck = Recheck::new(&header, TeamKey::ZERO).unwrap();
    for record in records {
        assert!(recheck.feed(record));
    }
    recheck.finish(false);
    recheck.results().all(|(counts, difference)| counts.same > 100 && difference.is_none())
}

#[test]
fn from_a_trace_with_two_referees_a_host_decides_the_same_again() {
    let pinned = HostSettings { referee: Some(SourcePin::of("10.0.0.1")), ..settings() };
    let records = [recorded(settings()), recorded(pinned.clone())];
    let halts = |records: &[Record]| {
        let reported = records
            .iter()
            .filter(|record| record.kind == RecordKind::Sent)
            .filter_map(|record| read(&record.bytes[1..]));
        reported
            .filter(|message| matches!(message, HostMessage::World(part) if part.phase == Phase::Halt))
            .count()
    };
    assert!(halts(&records[0]) > 50 && halts(&records[1]) == 0);
    assert!(same_again(&settings(), &records[0]));
    assert!(same_again(&pinned, &records[1]));
    // The decisions depend on the sender and on the pin.
    assert!(!same_again(&settings(), &records[1]));
    let mut nameless = records[0].clone();
    for record in &mut nameless {
        record.from = SenderAddress::INTERNAL;
    }
    assert!(!same_again(&settings(), &nameless));
}
