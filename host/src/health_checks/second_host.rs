//! `second_host`: detection of a second host of our team number on our robots' radio. Evidence: its frames
//! received by us, robots that followed us and now name another host, and frames that our robots refuse.

use protocol::{Instant, RobotId};
use thiserror::Error;

use crate::Host;
use crate::radio::{RadioWarning, RefusalReason};

const REMEDY: &str =
    "two `onetwo control` of one colour are running: end one of them (or give it another --colour and key)";

/// Another host of our team number, with its evidence.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum SecondHost {
    /// A host of this boot epoch, whose frames reach us.
    #[error("frames of a second host of our team are received (epoch {epoch}): {REMEDY}")]
    Received {
        /// Boot epoch of the second host.
        epoch: u32,
    },
    /// A robot that followed us follows it now.
    #[error("robot {robot} has left us for a second host of our team (epoch {epoch}): {REMEDY}")]
    TookOver {
        /// The robot that changed its host.
        robot: RobotId,
        /// The other host's epoch, later than ours.
        epoch: u32,
    },
    /// A host that started before us: robots that follow us refuse its frames.
    #[error("robot {robot} refuses frames of a second host of our team, which started earlier: {REMEDY}")]
    Refused {
        /// The lowest number of them.
        robot: RobotId,
    },
}

/// The strongest evidence there is now.
pub(super) fn look(now: Instant, host: &Host) -> Option<SecondHost> {
    let radio = host.radio();
    let led_before = |robot| radio.quality(robot).is_some_and(|quality| quality.telemetry().is_some());
    let evidence = radio.warnings(now).filter_map(|warning| match warning {
        RadioWarning::OtherHost(epoch) => Some((0, SecondHost::Received { epoch })),
        RadioWarning::LaterHost(robot, epoch) if led_before(robot) => {
            Some((1, SecondHost::TookOver { robot, epoch }))
        }
        RadioWarning::Refuses(robot, RefusalReason::Epoch) => Some((2, SecondHost::Refused { robot })),
        _ => None,
    });
    evidence.min_by_key(|(rank, _)| *rank).map(|(_, found)| found)
}
