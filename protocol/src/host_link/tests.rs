//! The host trusts a robot of the present boot epoch, and no recording of one.

extern crate std;

use std::vec::Vec;

use super::*;
use crate::Duration;
use crate::host::{Directive, HostCommand, RuleRole};
use crate::link::Link;
use crate::quantized::WirePose;
use crate::team::{Beacon, Progress, Role, Status};
use rules::Phase;

const TEAM: TeamId = TeamId(1);
const KEY: TeamKey = TeamKey([0x5a; 16]);

fn id(n: u8) -> RobotId {
    RobotId::new(n).unwrap()
}

fn ms(n: u64) -> Instant {
    Instant(n * 1000)
}

fn robot(n: u8, epoch: u32) -> Link {
    Link::new(TEAM, id(n), KEY.of_robot(id(n)), epoch)
}

fn report(link: &mut Link, now: Instant) -> Packet {
    let mut telemetry = Telemetry::default();
    link.report(now, &mut telemetry);
    link.seal(&TeamMessage::Telemetry(telemetry))
}

fn beacon(link: &mut Link) -> Packet {
    link.seal(&TeamMessage::Beacon(Beacon {
        pose: WirePose::default(),
        ball: None,
        status: Status::AVAILABLE,
        case_base: 0,
        cycle: None,
        progress: Progress::Idle,
        role: Role::None,
    }))
}

fn stand(to: u8) -> HostMessage {
    HostMessage::Command(HostCommand {
        to: id(to),
        defending: geometry::GoalEnd::Negative,
        phase: Phase::Run,
        rule_role: RuleRole::Player,
        directive: Directive::Stand,
    })
}

/// Telemetry, welcome, telemetry.
fn meet(host: &mut HostLink, link: &mut Link, n: u8, now: Instant) {
    assert!(matches!(host.open(now, &report(link, now)), Ok(Opened::Unauthenticated(..))));
    let welcome = HostMessage::Welcome(host.welcome(id(n)).unwrap());
    assert!(link.open(now, &host.seal(now, &welcome)).is_ok());
    assert!(matches!(host.open(now, &report(link, now)), Ok(Opened::Believed(..))));
}

#[test]
fn a_robot_is_believed_once_it_names_this_epoch_of_the_host() {
    let (mut host, mut link) = (HostLink::new(TEAM, KEY, 70), robot(2, 9));
    assert_eq!(host.open(ms(1), &beacon(&mut link)), Err(Refusal::Unauthenticated { epoch: 9 }));
    meet(&mut host, &mut link, 2, ms(2));
    assert!(matches!(host.open(ms(3), &beacon(&mut link)), Ok(Opened::Believed(..))));
    assert_eq!(host.boot_epoch(id(2)), Some(9));
}

#[test]
fn a_fresh_host_believes_no_recording() {
    let (mut old, mut link) = (HostLink::new(TEAM, KEY, 70), robot(2, 9));
    meet(&mut old, &mut link, 2, ms(2));
    let mut recorded = Vec::new();
    for n in 0..30 {
        recorded.extend([report(&mut link, ms(10 * n)), beacon(&mut link)]);
    }
    let mut fresh = HostLink::new(TEAM, KEY, 71);
    for packet in recorded.iter().chain(&recorded) {
        let opened = fresh.open(ms(5), packet);
        assert!(
            matches!(opened, Ok(Opened::Unauthenticated(..)) | Err(Refusal::Unauthenticated { epoch: 9 })),
            "{opened:?}"
        );
    }
    assert_eq!(fresh.boot_epoch(id(2)), None);
    // The robot itself is welcomed, and trusted.
    meet(&mut fresh, &mut link, 2, ms(400));
    // From then on its recordings are refused outright.
    for packet in &recorded {
        assert!(fresh.open(ms(500), packet).is_err());
    }
}

#[test]
fn a_recording_of_a_greater_boot_epoch_does_not_lock_the_robot_out() {
    // Its counter of starts was erased, or its number given to a spare.
    let (mut host, mut link) = (HostLink::new(TEAM, KEY, 70), robot(2, 9));
    let mut before = robot(2, 50);
    let recorded = report(&mut before, ms(0));
    assert!(matches!(host.open(ms(1), &recorded), Ok(Opened::Unauthenticated(..))));
    meet(&mut host, &mut link, 2, ms(2));
    assert!(matches!(host.open(ms(3), &recorded), Ok(Opened::Unauthenticated(..))));
    assert!(matches!(host.open(ms(4), &report(&mut link, ms(4))), Ok(Opened::Believed(..))));
}

#[test]
fn a_stolen_robot_cannot_speak_for_another_to_the_host() {
    let (mut host, mut link) = (HostLink::new(TEAM, KEY, 70), robot(2, 9));
    meet(&mut host, &mut link, 2, ms(2));
    let stolen = KEY.of_robot(id(3));
    let mut thief = Link::new(TEAM, id(2), stolen, u32::MAX);
    assert_eq!(host.open(ms(3), &report(&mut thief, ms(3))), Err(Refusal::Tag));
    // A forged beacon of robot 2 is possible, because all robots hold that key; telemetry of the genuine one
    // is received all the same.
    let mut thief = Link::new(TEAM, id(2), stolen, 9);
    (0..100).for_each(|_| drop(beacon(&mut thief)));
    assert!(host.open(ms(4), &beacon(&mut thief)).is_ok());
    assert!(matches!(host.open(ms(5), &report(&mut link, ms(5))), Ok(Opened::Believed(..))));
}

#[test]
fn the_counter_is_the_clock_and_rises_with_every_frame() {
    let mut host = HostLink::new(TEAM, KEY, 70);
    let counter = |packet: &Packet| Frame::parse(packet, TEAM).unwrap().counter;
    let mut burst = (0..40).map(|_| counter(&host.seal(ms(100), &stand(2)))).collect::<Vec<_>>();
    assert_eq!(burst[0], 100_000 / 64);
    burst.push(counter(&host.seal(ms(101), &stand(2))));
    assert!(burst.windows(2).all(|pair| pair[0] < pair[1]), "{burst:?}");
    assert_eq!(counter(&host.seal(ms(200), &stand(2))), 200_000 / 64);
}

#[test]
fn after_76_hours_a_new_epoch_begins_and_the_robot_is_welcomed_again() {
    let (mut host, mut link) = (HostLink::new(TEAM, KEY, 70), robot(2, 9));
    meet(&mut host, &mut link, 2, ms(2));
    let late = Instant(u64::from(u32::MAX) * 64) + Duration::millis(1);
    assert_eq!(link.open(late, &host.seal(late, &stand(2))), Err(Refusal::Unauthenticated { epoch: 71 }));
    meet(&mut host, &mut link, 2, late + Duration::millis(5));
    assert!(link.open(late + Duration::millis(6), &host.seal(late + Duration::millis(6), &stand(2))).is_ok());
}
