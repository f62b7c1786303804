//! `tests`: of reports of a robot's first start: their frames, and what others make of them.

use std::string::ToString as _;
use std::vec::Vec;

use super::*;
use crate::Instant;
use crate::frame::{TAG_LEN, TeamKey};
use crate::host_link::HostLink;
use crate::link::{Link, Received};

const TEAM: TeamId = TeamId(1);
const KEY: TeamKey = TeamKey([9; 16]);

fn robot() -> RobotId {
    RobotId::new(3).unwrap()
}

fn reporter() -> Reporter {
    Reporter { team: TEAM, robot: robot(), key: KEY.of_robot(robot()).host, epoch: 7 }
}

fn report(check: Check, state: CheckState) -> BringUpReport {
    BringUpReport { host: 0x6500_0000, check, state }
}

/// A finding of each kind, with the longest numbers there are.
fn findings() -> [Finding; 19] {
    use Finding::*;
    [
        NoVoltage,
        Voltage(12.4),
        NoGyroscope,
        Drifts(-0.2),
        Tipped,
        MovesAlone(3, 0.3),
        NoEncoder(2),
        NoMotion,
        Reversed(-1.0),
        CountedBy(3, 1.0),
        MovesToo(0, 1.0),
        Speed(0.4, 1.0),
        KeepsTurning(0.5),
        Silent,
        Loses(u32::MAX, u32::MAX),
        LineErrors(u32::MAX, u32::MAX),
        Blocked,
        NeverInterrupted,
        StaysInterrupted,
    ]
}

fn every_state() -> Vec<CheckState> {
    let some = [CheckState::Running, CheckState::Passed(f32::MIN)];
    some.into_iter().chain(findings().map(CheckState::Failed)).collect()
}

#[test]
fn every_check_in_every_state_is_read_as_it_was_sent_and_the_longest_fits() {
    let keys = KEY.of_team();
    let mut longest = 0;
    for (number, check) in CHECKS.into_iter().enumerate() {
        assert_eq!(check.number(), Some(number));
        for state in every_state() {
            let packet = reporter().seal(5, &report(check, state));
            let (frame, who, read) = open(&packet, TEAM, &keys).unwrap();
            assert_eq!((frame.epoch, frame.counter, who, read), (7, 5, robot(), report(check, state)));
            longest = longest.max(frame.payload.len());
        }
    }
    // A wheel's check with two counts does not occur, but fits.
    assert_eq!(longest, REPORT_LEN_MAX);
}

#[test]
fn changed_bits_other_keys_other_teams_and_impossible_wheels_are_refused() {
    let keys = KEY.of_team();
    let whole = reporter().seal(5, &report(CHECKS[4], CheckState::Passed(1.0)));
    for bit in 0..8 * whole.len() {
        let mut packet = whole.clone();
        packet[bit / 8] ^= 1 << (bit % 8);
        assert!(open(&packet, TEAM, &keys).is_err(), "bit {bit}");
    }
    assert_eq!(open(&whole, TEAM, &TeamKey([8; 16]).of_team()).unwrap_err(), Refusal::Tag);
    assert_eq!(open(&whole, TeamId(2), &keys).unwrap_err(), Refusal::Team(TEAM));
    let fifth = Check::Wheel { wheel: 4, forwards: true };
    let packet = reporter().seal(5, &report(fifth, CheckState::Running));
    assert_eq!(open(&packet, TEAM, &keys).unwrap_err(), Refusal::Payload);
    assert!(fifth.to_string().starts_with("no wheel"));
    assert!(open(&whole[..whole.len() - TAG_LEN], TEAM, &keys).is_err());
}

#[test]
fn a_teammate_does_not_open_it_and_a_host_in_play_refuses_it_for_its_payload() {
    let packet = reporter().seal(5, &report(Check::Radio, CheckState::Failed(Finding::Loses(70, 30))));
    let other = RobotId::new(4).unwrap();
    let mut teammate = Link::new(TEAM, other, KEY.of_robot(other), 1);
    assert_eq!(teammate.open(Instant(0), &packet), Ok(Received::Elsewhere));
    assert_eq!(teammate.refused().iter().sum::<u32>(), 0);
    assert_eq!(teammate.poll_handshake(Instant(0)), None, "it is nobody's teammate");
    let mut host = HostLink::new(TEAM, KEY, 9);
    assert_eq!(host.open(Instant(0), &packet), Err(Refusal::Payload));
    assert_eq!((host.welcome(robot()), host.boot_epoch(robot())), (None, None));
}

#[test]
fn every_fault_says_what_to_look_at() {
    for finding in findings() {
        let text = finding.to_string();
        assert!(text.len() > 20 && !text.contains("the no wheel"), "{text}");
    }
}
