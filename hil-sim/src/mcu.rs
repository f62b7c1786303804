//! `mcu`: interface of a robot's computer in the simulator. It answers a tick (docs/architecture.md §7.2):
//! natively, or as a firmware image under QEMU.
//!
//! A tick is split into [`Mcu::post`] and [`Mcu::collect`], so that all robots of a team can compute at the
//! same time where they are processes. A crash is a dropped `Mcu`; a reboot is a new one with a larger epoch,
//! whose clock starts at zero.

use brain::BrainConfig;
use protocol::decision::DecisionReport;
use protocol::link::Packet;
use protocol::lockstep::{AIR_OUT_MAX, TickIn};
use protocol::robot_io::ActuatorFrame;
use thiserror::Error;

/// A booted robot's computer.
pub trait Mcu {
    /// Sends it a tick. The robot's own clock is in the tick; nothing else advances its time.
    fn post(&mut self, tick: &TickIn<'_>) -> Result<(), McuError>;

    /// Answer to the tick posted last.
    fn collect(&mut self) -> Result<Reply, McuError>;

    /// Newest decision as coordinator, where the computer runs in this process: nothing is sent for it.
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
    /// Label in options and reports.
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

/// Failure of a robot's computer.
#[derive(Debug, Error)]
pub enum McuError {
    /// A program or file that the back end needs is missing on this machine.
    #[error("{what} is missing: {hint}")]
    Missing {
        /// The program or file.
        what: String,
        /// Command or package that provides it.
        hint: String,
    },
    /// The process could not be started.
    #[error("the robot's computer could not be started: {0}")]
    Start(#[source] std::io::Error),
    /// Communication with the process failed.
    #[error("talking to the robot's computer failed: {0}")]
    Io(#[source] std::io::Error),
    /// No answer in time.
    #[error("the robot's computer did not answer {asked} within {waited_ms} ms")]
    Silent {
        /// The request that stayed unanswered.
        asked: &'static str,
        /// Time that the simulator waited, ms.
        waited_ms: u64,
    },
    /// The process ended by itself.
    #[error("the robot's computer ended: {how}")]
    Ended {
        /// Exit status and last output of the process.
        how: String,
    },
    /// The answer cannot be decoded.
    #[error("the robot's computer gave no proper answer: {what}")]
    Malformed {
        /// The part that is wrong.
        what: String,
    },
    /// The computer refused the configuration or the case base.
    #[error("the robot's computer refused its configuration or its case base")]
    Unusable,
}
