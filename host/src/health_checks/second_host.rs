//! `second_host`: detection of a second host of our team number on our robots' radio. Evidence: its frames
//! received by us, robots that followed us and now name another host, and frames that our robots refuse.

use std::fmt;

use protocol::{Instant, RobotId};

use crate::Host;
use crate::radio::{RadioWarning, RefusalReason};

/// Another host of our team number, with its evidence.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SecondHost {
    /// A host of this boot epoch, whose frames reach us.
    Received {
        /// Boot epoch of the second host.
        epoch: u32,
    },
    /// A robot that followed us follows it now.
    TookOver {
        /// The robot that changed its host.
        robot: RobotId,
        /// The other host's epoch, later than ours.
        epoch: u32,
    },
    /// A host that started before us: robots that follow us refuse its frames.
    Refused {
        /// The lowest number of them.
        robot: RobotId,
    },
}

impl fmt::Display for SecondHost {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let remedy = "two `onetwo control` of one colour are running: end one of them (or give it another --colour and key)";
        match self {
            Self::Received { epoch } => {
                write!(f, "frames of a second host of our team are received (epoch {epoch}): {remedy}")
            }
            Self::TookOver { robot, epoch } => {
                write!(f, "robot {robot} has left us for a second host of our team (epoch {epoch}): {remedy}")
            }
            Self::Refused { robot } => {
                write!(
                    f,
                    "robot {robot} refuses frames of a second host of our team, which started earlier: {remedy}"
                )
            }
        }
    }
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
