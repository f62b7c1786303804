//! `tests`: of orders of pulses and their reports: their frames, and that neither teammates nor a match's
//! host take them.

use super::*;
use crate::frame::{OVERHEAD, Refusal, TeamKey, open_report};
use crate::host_link::HostLink;
use crate::link::{Link, Packet, Received};
use crate::{Instant, RobotId, TeamId};

const TEAM: TeamId = TeamId(1);
const KEY: TeamKey = TeamKey([9; 16]);
const PULSE: Pulse = Pulse { number: u16::MAX, chip: true, micros: u16::MAX };

fn robot(n: u8) -> RobotId {
    RobotId::new(n).unwrap()
}

fn reporter(n: u8) -> Reporter {
    Reporter { team: TEAM, robot: robot(n), key: KEY.of_robot(robot(n)).host, epoch: 7 }
}

fn order(fire: Option<Pulse>) -> (PulseOrder, Packet) {
    let order = PulseOrder { boot_epoch: u32::MAX, clock: u32::MAX, fire };
    (order, HostLink::new(TEAM, KEY, 9).seal_order(Instant(64_000), robot(3), &order))
}

fn reports() -> [PulseReport; 3] {
    let fired = Fired { before: 201.5, after: 150.25, ball: true };
    [Ok(fired), Err(PulseRefusal::NotCharged(12.5)), Err(PulseRefusal::Length(u16::MAX))].map(|result| {
        let last = Some((PULSE, result));
        PulseReport { host: u32::MAX, clock: u32::MAX, ready: true, ball: true, volts: 201.5, last }
    })
}

#[test]
fn orders_and_reports_are_read_as_they_were_sent_and_the_longest_fit() {
    for fire in [None, Some(PULSE)] {
        let (order, packet) = order(fire);
        assert_eq!(open_order(&packet, &reporter(3)), Some(((9, 1_000), order)));
        assert!(packet.len() <= 40);
    }
    for report in reports() {
        let packet = reporter(3).seal_as(4, KIND, &report);
        let (frame, who, read) = open_report(&packet, (TEAM, &KEY.of_team()), KIND).unwrap();
        assert_eq!((frame.counter, who, read), (4, robot(3), report));
        assert!(packet.len() <= 64 && frame.payload.len() + OVERHEAD == packet.len());
    }
}

#[test]
fn orders_with_a_changed_bit_or_to_another_and_reports_are_no_orders() {
    let (_, whole) = order(Some(PULSE));
    for bit in 0..8 * whole.len() {
        let mut packet = whole.clone();
        packet[bit / 8] ^= 1 << (bit % 8);
        assert_eq!(open_order(&packet, &reporter(3)), None, "bit {bit}");
    }
    assert_eq!(open_order(&whole, &reporter(4)), None);
    // The robot's own key makes no order in the robot's name.
    let (order, _) = order(None);
    assert_eq!(open_order(&reporter(3).seal_as(1, KIND, &order), &reporter(3)), None);
}

#[test]
fn match_images_open_no_order_and_their_host_no_report() {
    let mut playing = Link::new(TEAM, robot(3), KEY.of_robot(robot(3)), u32::MAX);
    for fire in [None, Some(PULSE)] {
        assert_eq!(playing.open(Instant(0), &order(fire).1), Ok(Received::Elsewhere));
    }
    let mut teammate = Link::new(TEAM, robot(4), KEY.of_robot(robot(4)), 1);
    for report in reports() {
        let packet = reporter(3).seal_as(1, KIND, &report);
        assert_eq!(teammate.open(Instant(0), &packet), Ok(Received::Elsewhere));
        assert_eq!(HostLink::new(TEAM, KEY, 9).open(Instant(0), &packet), Err(Refusal::Payload));
    }
    assert_eq!([playing.refused(), teammate.refused()].map(|all| all.iter().sum::<u32>()), [0, 0]);
}
