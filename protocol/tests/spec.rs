//! The code writes the bytes of `SPEC.md`: every worked example there is named and checked, in both
//! directions.

use geometry::{GoalEnd, Vector};
use protocol::bring_up::{self, BringUpReport, Check, CheckState, Finding, Reporter};
use protocol::decision::{DecisionReport, Grounds};
use protocol::frame::{Audience, Frame, Key, Sender, TeamKey, open_report};
use protocol::host::{
    Condition, Directive, DriveLimits, Hint, HostCommand, HostMessage, KickOrder, RuleRole, Telemetry,
    Welcome, WireBall, WireRobot, WireWho, WorldPart,
};
use protocol::host_link::HostLink;
use protocol::parts::{Part, PartState, PartsReport};
use protocol::pulses::{self, Fired, Pulse, PulseOrder, PulseReport};
use protocol::quantized::{WirePoint, WirePose};
use protocol::robot_log::{self, LogReport};
use protocol::serial::{Lines, line};
use protocol::station::{self, PacketCounts, RadioPlan, StationMessage, StationReport};
use protocol::team::{
    AbortReason, BallQuality, BallReport, Beacon, Bond, Closure, CycleState, Decision, Handshake, KnownEpoch,
    Play, Progress, Role, Status, TeamMessage,
};
use protocol::version::VersionReport;
use protocol::{CaseId, CycleId, Duration, Instant, RobotId, TeamId};
use rules::{Phase, Side};

const SPEC: &str = include_str!("../SPEC.md");

/// The bytes of the block that starts with ```` ```hex NAME ````: two hexadecimal digits a byte, `|` and text
/// after `;` are for the reader.
fn worked(name: &str) -> Vec<u8> {
    let block = SPEC
        .split("```")
        .find(|block| block.lines().next() == Some(&format!("hex {name}")))
        .unwrap_or_else(|| panic!("SPEC.md has no example {name}"));
    block
        .lines()
        .skip(1)
        .flat_map(|line| line.split(';').next().unwrap_or("").split_whitespace())
        .filter(|byte| *byte != "|")
        .map(|byte| u8::from_str_radix(byte, 16).unwrap_or_else(|_| panic!("{name}: {byte} is no byte")))
        .collect()
}

fn robot(n: u8) -> RobotId {
    RobotId::new(n).unwrap()
}

fn quiet() -> Beacon {
    Beacon {
        pose: WirePose { at: WirePoint { x: -700, y: 0 }, heading: 1571 },
        ball: None,
        status: Status::default(),
        case_base: 0x0403_0201,
        cycle: None,
        progress: Progress::Idle,
        role: Role::None,
    }
}

fn playing() -> Beacon {
    let quality = BallQuality::new(0.12, Duration::millis(40), Vector::new(-0.5, 0.25));
    Beacon {
        ball: Some(BallReport { at: WirePoint { x: -600, y: 10 }, distance: 100, quality }),
        status: Status::AVAILABLE.with(Status::RETRIEVER),
        cycle: Some(CycleState {
            id: CycleId { counter: 7, proposer: robot(1) },
            coordinator: robot(3),
            decision: Decision::Play(Play {
                case: CaseId(12),
                ball: WirePoint { x: -600, y: 10 },
                robots: [robot(1), robot(3)].into_iter().collect(),
            }),
        }),
        progress: Progress::Execute { done: 2 },
        ..quiet()
    }
}

fn aborted() -> Beacon {
    Beacon {
        cycle: Some(CycleState {
            id: CycleId { counter: 7, proposer: robot(1) },
            coordinator: robot(3),
            decision: Decision::Closed(Closure::Aborted { by: robot(1), reason: AbortReason::PathBlocked }),
        }),
        status: Status::AVAILABLE,
        ..quiet()
    }
}

fn point(x: i16, y: i16) -> WirePoint {
    WirePoint { x, y }
}

fn pose(x: i16, y: i16, heading: i16) -> WirePose {
    WirePose { at: point(x, y), heading }
}

fn worlds() -> [(&'static str, HostMessage); 2] {
    let ours = WireRobot {
        who: WireWho { side: Side::Ours, id: robot(3) },
        pose: pose(-720, 0, 1571),
        vx: 0,
        vy: 0,
    };
    let theirs = WireRobot {
        who: WireWho { side: Side::Theirs, id: robot(0) },
        pose: pose(100, -50, -3142),
        vx: -300,
        vy: 0,
    };
    let world = WorldPart {
        snapshot: 7,
        part: 1,
        parts: 2,
        phase: Phase::Run,
        placement: None,
        ball: Some(WireBall { at: point(-600, 10), height: 0, vx: 1500, vy: -20 }),
        robots: [ours, theirs].into_iter().collect(),
    };
    let placement = WorldPart {
        snapshot: 255,
        part: 0,
        parts: 1,
        phase: Phase::BallPlacement(Side::Theirs),
        placement: Some(point(-3000, 2000)),
        ball: None,
        robots: heapless::Vec::new(),
    };
    [("world", HostMessage::World(world)), ("placement", HostMessage::World(placement))]
}

fn commands() -> [(&'static str, Phase<Side>, RuleRole, Directive); 11] {
    use Directive::{Block, Dribble, Gameplay, GetBall, GoTo, Kick, Pass, PlaceBall, Receive, Stand};
    let (run, ours, player) = (Phase::Run, Side::Ours, RuleRole::Player);
    let (pass_point, goal) = (point(1000, 900), point(4500, 0));
    let hint = Hint {
        case: CaseId(300),
        robots: [robot(3), robot(5)].into_iter().collect(),
        pass_point: Some(pass_point),
    };
    [
        ("stand", Phase::Halt, player, Stand),
        ("go-to", run, player, GoTo { pose: pose(-720, 0, 1571) }),
        ("get-ball", Phase::FreeKick(ours), RuleRole::Kicker, GetBall { face: Some(goal) }),
        ("kick", run, player, Kick { at: point(4500, -200), kick: KickOrder::Flat(630) }),
        (
            "pass",
            run,
            player,
            Pass { at: pass_point, receiver: robot(4), kick: KickOrder::Chip(100), ready: false },
        ),
        ("receive", run, player, Receive { at: pass_point, then: Some(goal) }),
        ("dribble", run, player, Dribble { pose: pose(0, -1, -3142) }),
        ("block", Phase::Stop, RuleRole::Keeper, Block { from: point(-4400, 400), to: point(-4400, -400) }),
        ("place-ball", Phase::BallPlacement(ours), RuleRole::Kicker, PlaceBall { at: point(-3000, 2000) }),
        ("gameplay", run, player, Gameplay { hint: Some(hint) }),
        ("gameplay-free", run, player, Gameplay { hint: None }),
    ]
}

fn stand() -> HostMessage {
    let (phase, rule_role, directive) = (Phase::Halt, RuleRole::Player, Directive::Stand);
    HostMessage::Command(HostCommand {
        to: robot(3),
        defending: GoalEnd::Negative,
        phase,
        rule_role,
        directive,
    })
}

/// The message is these bytes, and these bytes are the message.
fn both_ways<T>(name: &str, message: &T)
where
    T: serde::Serialize + serde::de::DeserializeOwned + PartialEq + std::fmt::Debug,
{
    let mut out = [0; 128];
    let bytes = postcard::to_slice(message, &mut out).unwrap();
    assert_eq!(bytes, &worked(name)[..], "{name}: {}", hex(bytes));
    assert_eq!(postcard::from_bytes::<T>(&worked(name)).as_ref(), Ok(message), "{name}");
}

#[test]
fn robots_messages_have_the_bytes_of_the_specification() {
    for (name, beacon) in [("quiet", quiet()), ("playing", playing()), ("aborted", aborted())] {
        both_ways(name, &TeamMessage::Beacon(beacon));
    }
    let telemetry = Telemetry {
        condition: Condition::BALL_CONTACT.with(Condition::KICKER_READY),
        battery: 1640,
        received: 500,
        lost: 3,
        refused: [0, 0, 2, 0, 0, 1, 0, 0, 258, 4],
        snapshot: 249,
        silence: 73,
        host: 0x6500_0000,
        clock: 0x0001_e848,
    };
    both_ways("telemetry", &TeamMessage::Telemetry(telemetry));
    let teammate = |who, boot_epoch, bond| KnownEpoch { who: robot(who), boot_epoch, bond };
    let teammates =
        [teammate(1, 9, Bond::Received), teammate(3, 258, Bond::Believed), teammate(12, 1, Bond::Mutual)];
    let report = DecisionReport {
        cycle: CycleId { counter: 7, proposer: robot(1) },
        grounds: Grounds::Retrieved,
        case: None,
        defending: GoalEnd::Negative,
        ball: WirePoint { x: -600, y: 10 },
        teammates: [(robot(3), WirePoint { x: -700, y: 0 })].into_iter().collect(),
        opponents: [WirePoint { x: 100, y: 0 }].into_iter().collect(),
    };
    both_ways("decision", &TeamMessage::Decision(report.packed().part(0)));
    both_ways("handshake", &TeamMessage::Handshake(Handshake { teammates: teammates.into_iter().collect() }));
}

#[test]
fn a_report_of_a_first_start_has_the_bytes_of_the_specification() {
    let (check, state) =
        (Check::Wheel { wheel: 0, forwards: true }, CheckState::Failed(Finding::CountedBy(1, 0.96)));
    let report = BringUpReport { host: 0x6500_0000, check, state };
    let key = team_key().of_robot(robot(3)).host;
    let packet = Reporter { team: TeamId(1), robot: robot(3), key, epoch: 9 }.seal(1, &report);
    let (frame, who, read) = bring_up::open(&packet, TeamId(1), &team_key().of_team()).unwrap();
    assert_eq!((who, read), (robot(3), report));
    assert_eq!(frame.payload, &worked("bring-up")[..], "{}", hex(frame.payload));
    assert!(postcard::from_bytes::<TeamMessage>(frame.payload).is_err(), "no message to a team");
}

#[test]
fn orders_of_pulses_and_their_reports_have_the_bytes_of_the_specification() {
    let (key, keys) = (team_key().of_robot(robot(3)).host, team_key().of_team());
    let who = Reporter { team: TeamId(1), robot: robot(3), key, epoch: 9 };
    let pulse = Pulse { number: 7, chip: false, micros: 1_500 };
    let order = PulseOrder { boot_epoch: 9, clock: 5_000, fire: Some(pulse) };
    let packet = HostLink::new(TeamId(1), team_key(), 5).seal_order(Instant(0), robot(3), &order);
    let payload = Frame::parse(&packet, TeamId(1)).unwrap().payload;
    assert_eq!(payload, &worked("pulse-order")[..], "{}", hex(payload));
    assert_eq!(pulses::open_order(&packet, &who), Some(((5, 1), order)));
    assert!(postcard::from_bytes::<HostMessage>(payload).is_err(), "no message of a host");
    let last = Some((pulse, Ok(Fired { before: 201.5, after: 160.5, ball: true })));
    let (host, clock, volts) = (0x6500_0000, 5_020, 160.5);
    let report = PulseReport { host, clock, ready: false, ball: false, volts, last };
    let packet = who.seal_as(1, pulses::KIND, &report);
    let (frame, _, read) = open_report(&packet, (TeamId(1), &keys), pulses::KIND).unwrap();
    assert_eq!((read, frame.payload), (report, &worked("pulse-report")[..]), "{}", hex(frame.payload));
    assert!(postcard::from_bytes::<TeamMessage>(frame.payload).is_err(), "no message to a team");
}

#[test]
fn a_piece_of_a_log_has_the_bytes_of_the_specification() {
    let key = team_key().of_robot(robot(3)).host;
    let who = Reporter { team: TeamId(1), robot: robot(3), key, epoch: 9 };
    let bytes = [0x7f, 0, 3, 0x2c, 0x81].into_iter().collect();
    let report = LogReport { host: 0x6500_0000, at: 1_030, rest: 300, bytes };
    let packet = who.seal_as(1, robot_log::KIND, &report);
    let keys = team_key().of_team();
    let (frame, _, read) = open_report(&packet, (TeamId(1), &keys), robot_log::KIND).unwrap();
    assert_eq!((read, frame.payload), (report, &worked("log")[..]), "{}", hex(frame.payload));
    assert!(postcard::from_bytes::<TeamMessage>(frame.payload).is_err(), "no message to a team");
}

#[test]
fn a_report_of_what_a_robot_runs_has_the_bytes_of_the_specification() {
    let report = VersionReport { version: [0, 2, 1], image: 0x0102_0304, robot: 5, case_base: u32::MAX };
    assert_eq!(report.payload(), worked("version")[..], "{}", hex(&report.payload()));
    assert!(postcard::from_bytes::<TeamMessage>(&report.payload()).is_err(), "no message to a team");
}

#[test]
fn a_report_of_parts_has_the_bytes_of_the_specification() {
    let report = PartsReport { part: 5, evidence: 930, since: 17, ..PartsReport::new() };
    let report = report.with(Part::encoder(1), PartState::Failed);
    assert_eq!(report.payload(), worked("parts")[..], "{}", hex(&report.payload()));
    assert!(postcard::from_bytes::<TeamMessage>(&report.payload()).is_err(), "no message to a team");
}

#[test]
fn messages_of_a_base_station_have_the_bytes_of_the_specification() {
    let plan = RadioPlan { channel: 40, megabits: 2, address: 0xbeef };
    let packets = PacketCounts { sent: 500, acknowledged: 490, repeats: 60, lost: 10 };
    let report = StationReport { plan, restarts: 1, robot: robot(3), packets };
    for (name, message) in [
        ("station-plan", StationMessage::Plan(TeamId(2), plan)),
        ("station-report", StationMessage::Report(report)),
    ] {
        let packet = station::packet(&message);
        assert_eq!(packet[..], worked(name)[..], "{name}: {}", hex(&packet));
        assert_eq!(station::read(&worked(name)), Some(message));
    }
}

#[test]
fn the_hosts_messages_have_the_bytes_of_the_specification() {
    for (name, world) in worlds() {
        both_ways(name, &world);
    }
    for (name, phase, rule_role, directive) in commands() {
        both_ways(
            name,
            &HostMessage::Command(HostCommand {
                to: robot(3),
                defending: GoalEnd::Negative,
                phase,
                rule_role,
                directive,
            }),
        );
    }
    both_ways("welcome", &HostMessage::Welcome(Welcome { to: robot(3), boot_epoch: 9, offset: 0xffff_ff38 }));
    let limits = DriveLimits { to: robot(3), speed: 1500, acceleration: DriveLimits::NONE };
    both_ways("limits", &HostMessage::Limits(limits));
}

/// Robot 3's keys of the team key 00 01 02 … 0f.
fn team_key() -> TeamKey {
    TeamKey(std::array::from_fn(|i| i as u8))
}

#[test]
fn derived_keys_have_the_bytes_of_the_specification() {
    let keys = team_key().of_robot(robot(3));
    assert_eq!(keys.host.0[..], worked("host-key")[..], "{}", hex(&keys.host.0));
    assert_eq!(keys.team.0[..], worked("team-key")[..], "{}", hex(&keys.team.0));
}

#[test]
fn frames_have_the_bytes_of_the_specification() {
    let payload = worked("quiet");
    let (sender, audience) = (Sender::Robot(robot(3)), None);
    let frame = Frame { team: TeamId(1), sender, audience, epoch: 1, counter: 258, payload: &payload };
    let out = frame.emit(&team_key().of_robot(robot(3)).team).unwrap();
    assert_eq!(out[..], worked("frame")[..], "{}", hex(&out));
    assert_eq!(Frame::parse(&worked("frame"), TeamId(1)), Ok(frame));
}

#[test]
fn a_frame_of_the_host_has_the_bytes_of_the_specification_on_the_air_and_on_a_line() {
    let key = team_key().of_robot(robot(3)).host;
    let bytes = worked("host-frame");
    let mut payload = [0; 8];
    let payload = &*postcard::to_slice(&stand(), &mut payload).unwrap();
    let (sender, audience, epoch) = (Sender::Host, None, 0x6500_0000);
    let frame = Frame { team: TeamId(1), sender, audience, epoch, counter: 4097, payload };
    let out = frame.emit(&key).unwrap();
    assert_eq!(out[..], bytes[..], "{}", hex(&out));
    let genuine = |key: &Key| frame.is_genuine(&bytes, key, robot(3));
    assert!(genuine(&key) && !genuine(&team_key().of_robot(robot(4)).host));
    assert_eq!(line(&bytes)[..], worked("line")[..], "{}", hex(&line(&bytes)));
    let mut lines = Lines::new();
    let frames: Vec<_> = worked("line").into_iter().filter_map(|byte| lines.push(byte)).collect();
    assert_eq!(frames.len(), 1);
    assert_eq!(frames[0][..], bytes[..]);
}

#[test]
fn a_frame_to_several_robots_has_the_bytes_of_the_specification() {
    let payload = worked("placement");
    let audience = Some(Audience(1 << 3 | 1 << 5));
    let (sender, epoch) = (Sender::Host, 0x6500_0000);
    let frame = Frame { team: TeamId(1), sender, audience, epoch, counter: 4098, payload: &payload };
    let out = frame.emit_to_audience(&team_key().of_team()).unwrap();
    assert_eq!(out[..], worked("host-frame-to-several")[..], "{}", hex(&out));
    assert_eq!(Frame::parse(&out, TeamId(1)), Ok(frame));
}

#[test]
fn every_example_of_the_specification_is_checked() {
    let examples = SPEC.matches("```hex ").count();
    // Eleven of robots, two of a base station, two worlds, a pulse, a welcome, limits, two keys, three
    // frames, a line.
    assert_eq!(examples, 11 + 2 + worlds().len() + 3 + 2 + 4 + commands().len());
}

fn hex(bytes: &[u8]) -> String {
    use std::fmt::Write as _;
    bytes.iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x} ");
        text
    })
}
