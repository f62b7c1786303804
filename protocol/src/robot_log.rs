//! `robot_log`: a piece of the log of a robot with a bring-up image, for its host (protocol/SPEC.md,
//! LogReport).
//!
//! Its payload begins with [`KIND`], which is no [`TeamMessage`](crate::team::TeamMessage): match images have
//! no such frame and open none. Pieces are numbered by bytes, so that repeated ones do no harm and lost ones
//! leave a gap that shows.

use serde::{Deserialize, Serialize};

use crate::frame::OVERHEAD;
use crate::team::TEAM_MESSAGE_LEN_MAX;

/// The payload's first byte.
pub const KIND: u8 = crate::team::LOG;
/// Most bytes of the log in a report: the frame is no longer than a robot's message, and like a command's
/// takes two packets of a radio chip.
pub const PIECE_LEN_MAX: usize = 32;
/// Most bytes that a robot keeps to send them again: the length of defmt-rtt's ring.
pub const KEPT_MAX: u32 = 1_024;

/// Bytes of the log that follow each other.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct LogReport {
    /// Epoch of the newest frame of a host of its team, its tag not checked.
    #[serde(with = "postcard::fixint::le")]
    pub host: u32,
    /// Number of bytes of the log before these, since the robot's start.
    #[serde(with = "postcard::fixint::le")]
    pub at: u32,
    /// Number of bytes that are logged after these, at most [`KEPT_MAX`].
    pub rest: u16,
    /// The bytes, as the board wrote them.
    pub bytes: heapless::Vec<u8, PIECE_LEN_MAX>,
}

/// Kind, host, number of the first byte, rest (LEB128), length, bytes.
const REPORT_LEN_MAX: usize = 1 + 4 + 4 + 2 + 1 + PIECE_LEN_MAX;
const _: () = assert!(REPORT_LEN_MAX <= TEAM_MESSAGE_LEN_MAX && OVERHEAD + REPORT_LEN_MAX <= 64);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bring_up::Reporter;
    use crate::frame::{Refusal, TeamKey, open_report};
    use crate::host_link::HostLink;
    use crate::link::{Link, Received};
    use crate::{Instant, RobotId, TeamId};

    const TEAM: TeamId = TeamId(1);
    const KEY: TeamKey = TeamKey([9; 16]);

    fn robot(n: u8) -> RobotId {
        RobotId::new(n).unwrap()
    }

    fn longest() -> LogReport {
        let bytes = (0..PIECE_LEN_MAX as u8).map(|n| 255 - n).collect();
        LogReport { host: u32::MAX, at: u32::MAX, rest: KEPT_MAX as u16, bytes }
    }

    fn sealed(report: &LogReport) -> crate::link::Packet {
        let key = KEY.of_robot(robot(3)).host;
        Reporter { team: TEAM, robot: robot(3), key, epoch: 7 }.seal_as(4, KIND, report)
    }

    #[test]
    fn pieces_are_read_as_they_were_sent_and_the_longest_fits() {
        let empty = LogReport { host: 0, at: 0, rest: 0, bytes: heapless::Vec::new() };
        for report in [longest(), empty] {
            let packet = sealed(&report);
            let (frame, who, read) = open_report(&packet, (TEAM, &KEY.of_team()), KIND).unwrap();
            assert_eq!((frame.counter, who, read), (4, robot(3), report));
        }
        assert_eq!(sealed(&longest()).len(), OVERHEAD + REPORT_LEN_MAX);
    }

    #[test]
    fn teammates_do_not_open_a_piece_and_a_matchs_host_refuses_it() {
        let packet = sealed(&longest());
        let mut teammate = Link::new(TEAM, robot(4), KEY.of_robot(robot(4)), 1);
        assert_eq!(teammate.open(Instant(0), &packet), Ok(Received::Elsewhere));
        assert_eq!(teammate.refused().iter().sum::<u32>(), 0);
        assert_eq!(HostLink::new(TEAM, KEY, 9).open(Instant(0), &packet), Err(Refusal::Payload));
    }
}
