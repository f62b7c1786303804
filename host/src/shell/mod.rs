//! `shell`: the host's input and output: network, serial line, processes, files.
//!
//! [`open`] opens the link that a team's settings name; [`Link`] carries whole frames without decoding them.
//! A [`Radio`](crate::radio::Radio) makes the frames to send and decodes those received. [`key`] reads a
//! team's key; [`Recorder`](crate::record::Recorder) records a match.

pub mod epoch;
mod error;
mod hub;
pub mod key;
mod outbox;
mod serial;
mod sim;
mod strategy_process;
mod udp;

use std::time::Duration;

use protocol::TeamId;
use protocol::link::Packet;
use protocol::station::RadioPlan;

use crate::config::RobotLink;
use crate::radio::{Relay, To};

pub use error::LinkError;
pub use outbox::{OutCounts, Outbox};
pub use serial::SerialLink;
pub use sim::{SimLink, SimSettings};
pub use strategy_process::StrategyProcess;
pub use udp::UdpLink;

/// A link to the robots.
pub trait Link: Send {
    /// Sends a frame. A frame that cannot be sent at once is lost: newer ones follow within 10 ms.
    fn send(&mut self, to: To, packet: &[u8]) -> Result<(), LinkError>;

    /// The next frame received, waiting for at most `wait`; `None` where none came.
    fn receive(&mut self, wait: Duration) -> Result<Option<Packet>, LinkError>;

    /// Forwarding of beacons that such a link needs.
    fn relay(&self) -> Relay;

    /// A message to the operator, each once: a robot's process that ended, a line that came back.
    fn notice(&mut self) -> Option<String> {
        None
    }

    /// Whether a frame would go out at once: if not, it waits in the outbox, where newer ones replace it.
    fn has_room(&mut self) -> bool {
        true
    }

    /// Discards frames taken and not yet sent: HALT comes.
    fn discard(&mut self) {}

    /// The rate of a line, where it has one.
    fn line_rate(&self) -> Option<LineRate> {
        None
    }

    /// Advice where no robot is received.
    fn advice(&self) -> String;
}

/// Rate of a serial line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LineRate {
    /// The line's device, such as `/dev/ttyUSB0`.
    pub device: String,
    /// Bits a second; a byte takes [`BITS_PER_BYTE`](Self::BITS_PER_BYTE).
    pub baud: u32,
}

impl LineRate {
    /// Start bit, eight bits, stop bit.
    pub const BITS_PER_BYTE: u64 = 10;
    /// Bytes on the line in addition to the frame: COBS and the zero.
    pub const FRAME_OVERHEAD: u64 = 2;

    /// Bits a second that this traffic of one second needs.
    pub const fn needed(frames: u64, bytes: u64) -> u64 {
        (bytes + frames * Self::FRAME_OVERHEAD) * Self::BITS_PER_BYTE
    }
}

/// Opens the link that `settings` name; virtual robots are started with the settings of `sim`, a base station
/// gets its team's plan.
pub fn open(
    link: &RobotLink,
    (team, plan): (TeamId, RadioPlan),
    sim: impl FnOnce(&str) -> SimSettings,
) -> Result<Box<dyn Link>, LinkError> {
    Ok(match link {
        RobotLink::Udp(address) => Box::new(UdpLink::open(address)?),
        RobotLink::Serial { device, baud } => Box::new(SerialLink::open(device, *baud)?.planned(team, plan)),
        RobotLink::Simulator(host) => Box::new(SimLink::start(sim(host))?),
    })
}
