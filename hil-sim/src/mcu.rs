//! `mcu`: interface of a robot's computer in the simulator. Something that answers a tick
//! (docs/architecture.md §7.2): natively, or as an image under QEMU.
//!
//! A tick is split into [`Mcu::post`] and [`Mcu::collect`], so that all robots of a team can think at the same time where they
//! are processes. A crash is a dropped `Mcu`; a return is a new one with a larger epoch, whose clock starts at zero.

use std::fmt;

use brain::BrainConfig;
use protocol::link::Packet;
use protocol::lockstep::{AIR_OUT_MAX, TickIn};
use protocol::robot_io::ActuatorFrame;

/// A robot's computer, set up and running.
pub trait Mcu {
    /// Gives it a tick. The robot's own clock is in the tick; nothing else moves its time.
    fn post(&mut self, tick: &TickIn<'_>) -> Result<(), McuError>;

    /// Its answer to the tick posted last.
    fn collect(&mut self) -> Result<Reply, McuError>;

    /// Both at once.
    fn exchange(&mut self, tick: &TickIn<'_>) -> Result<Reply, McuError> {
        self.post(tick)?;
        self.collect()
    }
}

/// What starts robots' computers.
pub trait Backend<'a> {
    /// Its word in options and reports.
    fn name(&self) -> &'static str;

    /// A computer that begins the life `config` describes; its clock stands at zero.
    fn boot(&mut self, config: &BrainConfig) -> Result<Box<dyn Mcu + 'a>, McuError>;
}

/// The answer to a tick.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reply {
    /// What the body shall do; `None` when nothing new was said.
    pub actuators: Option<ActuatorFrame>,
    /// Packets to send, in order.
    pub packets: heapless::Vec<Packet, AIR_OUT_MAX>,
    /// Guest instructions of the tick, where they can be counted; else 0.
    pub instructions: u32,
    /// Bytes of its stack that were ever used, where that can be seen; else 0.
    pub stack: u32,
}

/// Why a robot's computer cannot be used (any more).
#[derive(Debug)]
pub enum McuError {
    /// Something the back end needs is not on this machine.
    Missing {
        /// What.
        what: String,
        /// What to do about it.
        mend: String,
    },
    /// It could not be started.
    Start(std::io::Error),
    /// Talking to it failed.
    Io(std::io::Error),
    /// It did not answer in time.
    Silent {
        /// What it was asked.
        asked: &'static str,
        /// How long it was waited for, ms.
        waited_ms: u64,
    },
    /// It ended by itself.
    Ended {
        /// How, and what it last said.
        how: String,
    },
    /// Its answer is none.
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
            Self::Missing { what, mend } => write!(f, "{what} is missing: {mend}"),
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
