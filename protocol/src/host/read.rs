//! `read`: fast decoder of the host's messages. Parts of snapshots robot by robot, other messages by
//! `postcard`.
//!
//! Two parts come with every snapshot and are the longest frames there are. The fields before the robots are
//! read by `postcard`; each robot is eleven fixed bytes, read directly: 30 instructions of a Cortex-M4
//! instead of 170. The tests hold it to `postcard`, byte by byte.

use rules::{Phase, Side};
use serde::Deserialize;

use super::{HostMessage, PART_ROBOTS_MAX, WIRE_ROBOT_LEN, WireBall, WireRobot, WireWho, WorldPart};
use crate::frame::decode;
use crate::quantized::{WirePoint, WirePose};

impl HostMessage {
    /// Decodes a message that ends with the payload's last byte.
    pub(crate) fn read(payload: &[u8]) -> Option<Self> {
        match payload.split_first() {
            Some((0, part)) => WorldPart::read(part).map(Self::World),
            _ => decode(payload),
        }
    }
}

impl WorldPart {
    fn read(bytes: &[u8]) -> Option<Self> {
        let (head, rest) = postcard::take_from_bytes::<Head>(bytes).ok()?;
        let Head { snapshot, part, parts, phase, placement, ball } = head;
        let (count, rest) = rest.split_first()?;
        let (robots, []) = rest.as_chunks::<WIRE_ROBOT_LEN>() else { return None };
        if robots.len() != usize::from(*count) || robots.len() > PART_ROBOTS_MAX {
            return None;
        }
        let mut world = Self { snapshot, part, parts, phase, placement, ball, robots: heapless::Vec::new() };
        for robot in robots {
            // The capacity suffices: counted above.
            let _ = world.robots.push(WireRobot::read(robot)?);
        }
        Some(world)
    }
}

/// The fields before the robots in a part of a snapshot.
#[derive(Deserialize)]
struct Head {
    snapshot: u8,
    part: u8,
    parts: u8,
    phase: Phase<Side>,
    placement: Option<WirePoint>,
    ball: Option<WireBall>,
}

impl WireRobot {
    fn read(bytes: &[u8; WIRE_ROBOT_LEN]) -> Option<Self> {
        let [who, x0, x1, y0, y1, h0, h1, vx0, vx1, vy0, vy1] = *bytes;
        let number = |low, high| i16::from_le_bytes([low, high]);
        Some(Self {
            who: WireWho::try_from(who).ok()?,
            pose: WirePose {
                at: WirePoint { x: number(x0, x1), y: number(y0, y1) },
                heading: number(h0, h1),
            },
            vx: number(vx0, vx1),
            vy: number(vy0, vy1),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::RobotId;
    use crate::host::{DriveLimits, Welcome};

    fn part(robots: u8) -> HostMessage {
        let robot = |n: u8| WireRobot {
            who: WireWho {
                side: if n.is_multiple_of(2) { Side::Ours } else { Side::Theirs },
                id: RobotId::new(n).unwrap(),
            },
            pose: WirePose { at: WirePoint { x: -4000 + i16::from(n), y: 3000 }, heading: -3 * i16::from(n) },
            vx: 0x1234,
            vy: -0x1234,
        };
        let ball = WireBall { at: WirePoint { x: 1, y: -1 }, height: 300, vx: -2, vy: 0x0102 };
        HostMessage::World(WorldPart {
            snapshot: 7,
            part: 1,
            parts: 2,
            phase: Phase::BallPlacement(Side::Theirs),
            placement: (robots > 2).then_some(WirePoint { x: 5, y: 6 }),
            ball: (robots > 1).then_some(ball),
            robots: (0..robots).map(robot).collect(),
        })
    }

    #[test]
    fn the_reader_agrees_with_postcard_on_changed_and_cut_bytes() {
        let welcome =
            HostMessage::Welcome(Welcome { to: RobotId::new(3).unwrap(), boot_epoch: 9, offset: 7 });
        let limits = DriveLimits { to: RobotId::ZERO, speed: 1500, acceleration: 900 };
        let limits = HostMessage::Limits(limits);
        let (mut read, mut refused) = (0, 0);
        for message in (0..=PART_ROBOTS_MAX as u8).map(part).chain([welcome, limits]) {
            let mut bytes = [0; 128];
            let len = postcard::to_slice(&message, &mut bytes).unwrap().len();
            assert_eq!(HostMessage::read(&bytes[..len]), Some(message));
            for cut in 0..bytes.len() {
                assert_eq!(HostMessage::read(&bytes[..cut]), decode(&bytes[..cut]), "{cut} of {len} bytes");
            }
            for at in 0..len {
                for flip in 1..=u8::MAX {
                    bytes[at] ^= flip;
                    let ours = HostMessage::read(&bytes[..len]);
                    assert_eq!(ours, decode(&bytes[..len]), "byte {at} is {}", bytes[at]);
                    *if ours.is_some() { &mut read } else { &mut refused } += 1;
                    bytes[at] ^= flip;
                }
            }
        }
        assert!(read > 10_000 && refused > 10_000, "{read} read, {refused} refused");
    }
}
