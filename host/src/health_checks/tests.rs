//! Findings of a whole host in virtual time: frames of robots and of another host arrive as datagrams.

use protocol::frame::{Refusal, TeamKey};
use protocol::host::{HostMessage, Telemetry, Welcome};
use protocol::host_link::HostLink;
use protocol::link::Link;
use protocol::team::TeamMessage;
use protocol::version::VersionReport;
use protocol::{Instant, RobotId, TeamId};
use rules::{Colour, League};

use super::*;
use crate::{HostSettings, Input};

/// Boot epoch of our host.
const EPOCH: u32 = 70;

fn id() -> RobotId {
    RobotId::new(3).unwrap()
}

fn host() -> Host {
    Host::new(HostSettings::new(Colour::Blue, League::DivisionB, EPOCH), Instant(0))
}

/// The first time at which a second host is found, ms, with its evidence; every 100 ms `report` feeds the
/// host its inputs.
fn second_host(mut report: impl FnMut(u64, &mut Host)) -> Option<(u64, SecondHost)> {
    let (mut host, mut sanity) = (host(), HealthChecks::default());
    (0..8_000).step_by(100).find_map(|ms| {
        report(ms, &mut host);
        sanity.look(Instant(ms * 1_000), &host).into_iter().find_map(|found| match found {
            Fault::SecondHost(found) => Some((ms, found)),
            _ => None,
        })
    })
}

/// Telemetry of a robot that follows the host of that epoch.
fn telemetry(robot: &mut Link, follows: u32, refused_epochs: u16) -> protocol::link::Packet {
    let mut refused = [0; Refusal::KINDS];
    refused[Refusal::Epoch { seen: 0, current: 0 }.kind()] = refused_epochs;
    robot.seal(&TeamMessage::Telemetry(Telemetry { host: follows, refused, ..Telemetry::default() }))
}

fn runs(image: u32) -> VersionReport {
    VersionReport { version: [0, 2, 0], image, robot: 3, case_base: 4 }
}

fn robot() -> Link {
    Link::new(TeamId::of(Colour::Blue), id(), TeamKey::ZERO.of_robot(id()), 5)
}

#[test]
fn a_second_hosts_frames_are_a_finding_within_two_seconds_and_our_echo_is_not() {
    for (epoch, expected) in [(EPOCH + 9, true), (EPOCH - 9, true), (EPOCH, false)] {
        let mut other = HostLink::new(TeamId::of(Colour::Blue), TeamKey::ZERO, epoch);
        let found = second_host(|ms, host| {
            // It starts after a second, with ten frames every 100 ms.
            for n in 0..10 {
                let now = Instant((ms + n) * 1_000);
                let packet =
                    other.seal(now, &HostMessage::Welcome(Welcome { to: id(), boot_epoch: 1, offset: 0 }));
                if ms >= 1_000 {
                    host.handle(now, Input::Robot(&packet));
                }
            }
        });
        assert_eq!(found.is_some(), expected, "epoch {epoch}");
        if let Some((ms, found)) = found {
            assert!(ms <= 3_000 && found == SecondHost::Received { epoch }, "{ms} ms: {found:?}");
            assert!(found.to_string().contains("end one of them"), "{found}");
        }
    }
}

#[test]
fn a_robot_that_leaves_us_for_a_later_host_is_a_finding_within_two_seconds() {
    let mut robot = robot();
    let found = second_host(|ms, host| {
        let follows = if ms < 2_000 { EPOCH } else { EPOCH + 1 };
        host.handle(Instant(ms * 1_000), Input::Robot(&telemetry(&mut robot, follows, 0)));
    });
    let (ms, found) = found.unwrap();
    assert!((2_000..=4_000).contains(&ms), "{ms} ms");
    assert_eq!(found, SecondHost::TookOver { robot: id(), epoch: EPOCH + 1 });
}

#[test]
fn refused_frames_of_an_earlier_host_are_a_finding_within_two_seconds() {
    let mut robot = robot();
    let found = second_host(|ms, host| {
        let refused = (ms.saturating_sub(2_000) / 100 * 6) as u16;
        host.handle(Instant(ms * 1_000), Input::Robot(&telemetry(&mut robot, EPOCH, refused)));
    });
    let (ms, found) = found.unwrap();
    assert!(
        (2_000..=4_000).contains(&ms) && found == SecondHost::Refused { robot: id() },
        "{ms} ms: {found:?}"
    );
}

#[test]
fn robots_that_follow_us_alone_tell_of_no_second_host() {
    let mut robot = robot();
    let found = second_host(|ms, host| {
        // A few frames of the previous host were still in transit.
        let refused = if ms < 300 { (ms / 100) as u16 } else { 3 };
        host.handle(Instant(ms * 1_000), Input::Robot(&telemetry(&mut robot, EPOCH, refused)));
    });
    assert_eq!(found, None);
}

#[test]
fn another_programs_packets_on_visions_port_are_a_finding_within_two_seconds() {
    let (mut host, mut sanity) = (host(), HealthChecks::default());
    let mut first = None;
    for ms in (0..5_000).step_by(20) {
        let now = Instant(ms * 1_000);
        // A message of another kind: its only field is unknown to vision's messages, and is skipped.
        host.handle(now, Input::Vision(&[0x7a, 0x02, 0x08, 0x01]));
        let found = sanity.look(now, &host);
        if !found.is_empty() {
            first = first.or(Some((ms, found)));
        }
    }
    let (ms, found) = first.unwrap();
    assert!(ms <= 2_000, "{ms} ms");
    assert!(
        matches!(found[..], [Fault::VisionPort(VisionPort::Foreign { packets })] if packets > 40),
        "{found:?}"
    );
}

/// One fault of each kind, in the order of the table in docs/start.md.
fn one_of_each() -> Vec<Fault> {
    use crate::referee::{SenderAddress, SourceKey, Warning};
    let [one, two] = [4_711, 5_012].map(|port| std::net::SocketAddr::from(([10, 0, 0, 2], port)));
    let key = |address| SourceKey { identifier: None, address: SenderAddress::new(address) };
    let (us, league) = (Colour::Blue, League::DivisionB);
    let text = |what: &str| what.to_owned();
    let side = WrongSide {
        defending: geometry::GoalEnd::Negative,
        reported: true,
        evidence: SideEvidence::OurKeeper(id()),
    };
    let refused = StrategyFault::Refused { answers: 3, reason: text("unknown key kik") };
    let silent = StrategyFault::Silent { since: Duration::millis(2_000), ever: false };
    let other = TeamFault::OtherColour { name: text("A"), us, other: text("B") };
    vec![
        Fault::VisionPort(VisionPort::Nothing),
        Fault::VisionPort(VisionPort::Foreign { packets: 3 }),
        Fault::VisionPort(VisionPort::NoFrames),
        Fault::SecondVision(SecondVision { camera: 0, followed: one, other: two }),
        Fault::Camera(CameraFault::Clock { camera: 1, ahead_ms: -120 }),
        Fault::Camera(CameraFault::Late { camera: 1, by_ms: 80 }),
        Fault::Camera(CameraFault::Unused { camera: 1, by_ms: 900 }),
        Fault::Camera(CameraFault::Slow { camera: 0, rate: 3.2 }),
        Fault::Field(OtherField { league, announced: [12.0, 9.0], fits: Some(League::DivisionA) }),
        Fault::Team(TeamFault::Division { allowed: 11, league, of_league: 6 }),
        Fault::Robots(TooManyRobots { team: us, ours: true, on_field: 7, allowed: 6, league }),
        Fault::Side(side),
        Fault::Team(other),
        Fault::Team(TeamFault::NoKeeper { keeper: id() }),
        Fault::Team(TeamFault::Placement { place: Some(geometry::Point::new(7.0, 0.0)) }),
        Fault::Team(TeamFault::Placement { place: None }),
        Fault::Team(TeamFault::Command { number: 18 }),
        Fault::Team(TeamFault::Unseen(id())),
        Fault::Team(TeamFault::Unheard(id())),
        Fault::Team(TeamFault::OtherNumber { shell: id(), radio: id() }),
        Fault::Team(TeamFault::OtherImage { robot: id(), runs: runs(1), expected: runs(2) }),
        Fault::SecondHost(SecondHost::Received { epoch: 7 }),
        Fault::Referee(Warning::Several { followed: key(one), other: key(two) }),
        Fault::Strategy(refused),
        Fault::Strategy(silent),
        Fault::Stall(Stall::Host { lasted: Duration::millis(400) }),
        Fault::Stall(Stall::Vision { since: Duration::millis(400) }),
        Fault::Stall(Stall::RadioUp { since: Duration::millis(400) }),
        Fault::Flood { what: "vision packets", dropped: 4 },
        Fault::SlowLine(text("/dev/ttyACM0 is too slow: use fewer robots")),
        Fault::Missing(text("waiting for robots: none is received; are they on?")),
    ]
}

#[test]
fn every_finding_has_what_evidence_and_remedy_and_says_since_when() {
    let faults = one_of_each();
    let mut since = Since::default();
    let first = since.date(Instant(1_000_000), faults.clone());
    let again = since.date(Instant(2_000_000), faults);
    for (first, again) in first.iter().zip(&again) {
        let json = again.to_json();
        for key in ["part", "what", "evidence", "remedy"] {
            assert!(json[key].as_str().is_some_and(|text| !text.trim().is_empty()), "{key}: {json}");
        }
        assert_eq!(json["since_s"], 1.0, "{json}");
        assert_eq!(first.fault.matter(), again.fault.matter());
        let line = again.to_string();
        assert!(line.contains(&again.remedy()) && line.contains(&again.evidence()), "{line}");
    }
    let matters: std::collections::BTreeSet<_> = first.iter().map(|finding| finding.fault.matter()).collect();
    // Three states of vision's port and two of a placement are one matter each.
    assert_eq!(matters.len(), first.len() - 3, "{matters:?}");
}

#[test]
fn each_finding_is_in_the_table_of_the_start_page() {
    let page = include_str!("../../../docs/start.md");
    for fault in one_of_each() {
        // Lines of links and missing sources have their own words there.
        if matches!(fault, Fault::SlowLine(_) | Fault::Missing(_)) {
            continue;
        }
        let text = fault.to_string();
        let known = page.lines().filter(|line| line.starts_with("| `")).any(|line| {
            let messages = line.split('`').skip(1).step_by(2);
            let mut words = messages.map(|message| {
                let plain = message.trim_start_matches(['…', ' ']);
                plain.split(|c: char| c.is_ascii_digit() || "(:…".contains(c)).next().unwrap_or(plain).trim()
            });
            words.any(|words| words.len() > 3 && text.contains(words.trim_end_matches([' ', 'N'])))
        });
        let counted = [
            "packets came",
            "answers of the strategy",
            "vision packets",
            "blue robots",
            "placed without a place",
        ];
        let counted = counted.iter().any(|words| text.contains(words) && page.contains(words));
        assert!(known || counted || text.contains("without a place"), "not in docs/start.md: {text}");
    }
}

#[test]
fn a_robot_with_another_number_than_its_shell_is_found_and_a_parameter_joins_both() {
    use ssl::Message as _;
    let (mut host, mut checks, mut robot) = (host(), HealthChecks::default(), robot());
    let shell = RobotId::new(4).unwrap();
    let found = |ms: std::ops::Range<u64>, host: &mut Host, robot: &mut Link, checks: &mut HealthChecks| {
        let mut last = Vec::new();
        for ms in ms.step_by(20) {
            let now = Instant(ms * 1_000);
            let seen =
                ssl::vision::DetectionRobot { robot_id: Some(4), confidence: 1.0, ..Default::default() };
            let frame = ssl::vision::DetectionFrame {
                t_capture: ms as f64 * 1e-3,
                frame_number: ms as u32,
                camera_id: 1,
                robots_blue: vec![seen],
                ..Default::default()
            };
            let packet = ssl::vision::WrapperPacket { detection: Some(frame), ..Default::default() };
            host.handle(now, Input::Vision(&packet.encode_to_vec()));
            if ms % 100 == 0 {
                host.handle(now, Input::Robot(&telemetry(robot, EPOCH, 0)));
                last = checks.look(now, host);
            }
        }
        last.retain(|fault| matches!(fault, Fault::Team(_)));
        last
    };
    let faults = found(0..3_000, &mut host, &mut robot, &mut checks);
    assert_eq!(faults, [Fault::Team(TeamFault::OtherNumber { shell, radio: id() })]);
    let glance = crate::glance::robots(&host, Instant(3_000_000));
    assert_eq!(glance.iter().map(|robot| robot.shell).collect::<Vec<_>>(), [3, 4], "one for each number");
    assert!(glance[0].cameras.is_empty() && glance[1].heard_ms.is_none(), "{glance:?}");

    let set = br#"{"key":"numbers.radio","robot":4,"value":3}"#;
    assert_eq!(host.handle(Instant(3_000_000), Input::Parameter(set)), crate::InputVerdict::Changed);
    assert_eq!(found(3_000..6_000, &mut host, &mut robot, &mut checks), []);
    let glance = crate::glance::robots(&host, Instant(6_000_000));
    let [one] = &glance[..] else { panic!("{glance:?}") };
    assert_eq!((one.shell, one.radio, one.heard_ms, &one.cameras[..]), (4, 3, Some(100), &[(1, 20)][..]));
    let table = crate::glance::table(&glance);
    assert!(table.contains("    4     3  1 (20)"), "{table}");
}

#[test]
fn a_robot_with_another_image_is_named_with_the_remedy_and_one_as_expected_is_not() {
    let settings = HostSettings::new(Colour::Blue, League::DivisionB, EPOCH);
    for (expected, differs) in [(Some(runs(9)), true), (Some(runs(1)), false), (None, false)] {
        let mut host = Host::new(HostSettings { expected, ..settings.clone() }, Instant(0));
        let mut robot = robot();
        let refused = host.handle(Instant(0), Input::Robot(&robot.seal_version(&runs(1))));
        assert!(matches!(refused, crate::InputVerdict::Refused(_)), "{refused:?}");
        host.handle(Instant(1), Input::Robot(&telemetry(&mut robot, EPOCH, 0)));
        let silent = crate::glance::robots(&host, Instant(2)).remove(0).wrong;
        assert_eq!(
            silent.iter().any(|text| text.contains("reports no version")),
            expected.is_some(),
            "{silent:?}"
        );
        host.handle(Instant(2), Input::Robot(&robot.seal_version(&runs(1))));
        let faults = HealthChecks::default().look(Instant(3), &host);
        let named = faults.iter().map(ToString::to_string).find(|text| text.contains("another image"));
        assert_eq!(named.is_some(), differs, "{faults:?}");
        assert!(named.is_none_or(|text| text.contains("robot 3 runs") && text.contains("firmware flash")));
        let glance = crate::glance::robots(&host, Instant(3)).remove(0);
        assert!(glance.version.is_some_and(|version| version.starts_with("0.2.0 (image 00000001")));
        assert_eq!(glance.wrong.len(), usize::from(differs), "{:?}", glance.wrong);
    }
}
