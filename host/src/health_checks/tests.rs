//! Findings of a whole host in virtual time: frames of robots and of another host arrive as datagrams.

use protocol::frame::{Refusal, TeamKey};
use protocol::host::{HostMessage, Telemetry, Welcome};
use protocol::host_link::HostLink;
use protocol::link::Link;
use protocol::team::TeamMessage;
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
            Finding::SecondHost(found) => Some((ms, found)),
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
        matches!(found[..], [Finding::VisionPort(VisionPort::Foreign { packets })] if packets > 40),
        "{found:?}"
    );
}
