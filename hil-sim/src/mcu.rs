//! `mcu`: interface of a robot's computer in the simulator. It answers a tick (docs/architecture.md §7.2):
//! natively, or as a firmware image under QEMU.
//!
//! A tick is split into [`Mcu::post`] and [`Mcu::collect`], so that all robots of a team can compute at the
//! same time where they are processes. A crash is a dropped `Mcu`; a reboot is a new one with a larger epoch,
//! whose clock starts at zero.

use std::fmt;

use brain::BrainConfig;
use protocol::decision::DecisionReport;
use protocol::link::Packet;
use protocol::lockstep::{AIR_OUT_MAX, TickIn};
use protocol::robot_io::ActuatorFrame;

/// A booted robot's computer.
pub trait Mcu {
    /// Sends it a tick. The robot's own clock is in the tick; nothing else advances its time.
    fn post(&mut self, tick: &TickIn<'_>) -> Result<(), McuError>;

    /// Its answer to the tick posted last.
    fn collect(&mut self) -> Result<Reply, McuError>;

    /// Its newest decision as coordinator, where the computer can be looked into: nothing is sent for it.
    fn decision(&self) -> Option<DecisionReport> {
        None
    }

    /// Posts a tick and collects the answer.
    fn exchange(&mut self, tick: &TickIn<'_>) -> Result<Reply, McuError> {
        self.post(tick)?;
        self.collect()
    }
}

/// Boots robots' computers of one kind: native or under QEMU.
pub trait Backend<'a> {
    /// Its label in options and reports.
    fn name(&self) -> &'static str;

    /// Boots a computer in the epoch of `config`; its clock is at zero.
    fn boot(&mut self, config: &BrainConfig) -> Result<Box<dyn Mcu + 'a>, McuError>;
}

/// The answer to a tick.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reply {
    /// The order to the body; `None` where the computer sent no new one.
    pub actuators: Option<ActuatorFrame>,
    /// Packets to send, in order.
    pub packets: heapless::Vec<Packet, AIR_OUT_MAX>,
    /// Guest instructions of the tick, where they can be counted; else 0.
    pub instructions: u32,
    /// Maximum stack use so far, bytes, where it can be measured; else 0.
    pub stack: u32,
}

/// Why a robot's computer cannot be used.
#[derive(Debug)]
pub enum McuError {
    /// A program or file that the back end needs is missing on this machine.
    Missing {
        /// The program or file.
        what: String,
        /// How to get it.
        hint: String,
    },
    /// The process could not be started.
    Start(std::io::Error),
    /// Communication with the process failed.
    Io(std::io::Error),
    /// It did not answer in time.
    Silent {
        /// The request that stayed unanswered.
        asked: &'static str,
        /// How long the simulator waited, ms.
        waited_ms: u64,
    },
    /// The process ended by itself.
    Ended {
        /// Its exit status and its last output.
        how: String,
    },
    /// Its answer cannot be decoded.
    Malformed {
        /// What is wrong with it.
        what: String,
    },
    /// It refused the configuration or the case base.
    Unusable,
}

impl fmt::Display for McuError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Missing { what, hint } => write!(f, "{what} is missing: {hint}"),
            Self::Start(e) => write!(f, "the robot's computer could not be started: {e}"),
            Self::Io(e) => write!(f, "talking to the robot's computer failed: {e}"),
            Self::Silent { asked, waited_ms } => {
                write!(f, "the robot's computer did not answer {asked} within {waited_ms} ms")
            }
            Self::Ended { how } => write!(f, "the robot's computer ended: {how}"),
            Self::Malformed { what } => write!(f, "the robot's computer gave no proper answer: {what}"),
            Self::Unusable => f.write_str("the robot's computer refused its configuration or its case base"),
        }
    }
}

impl std::error::Error for McuError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Start(e) | Self::Io(e) => Some(e),
            _ => None,
        }
    }
}
