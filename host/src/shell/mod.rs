//! `shell`: the host's effects: network, serial line, processes, files.
//!
//! [`open`] takes the link that a team's settings name; [`Link`] carries whole frames and knows nothing of what is in them.
//! A [`Radio`](crate::radio::Radio) says what to send and reads what comes. [`key`] reads a team's key;
//! [`Recorder`](crate::record::Recorder) keeps a match.

pub mod epoch;
mod error;
mod hub;
pub mod key;
mod outbox;
mod serial;
mod sim;
mod udp;

use std::time::Duration;

use protocol::link::Packet;

use crate::config::RobotLink;
use crate::radio::{Relay, To};

pub use error::LinkError;
pub use outbox::{OutCounts, Outbox};
pub use serial::SerialLink;
pub use sim::{SimLink, SimSettings};
pub use udp::UdpLink;

/// A way to the robots.
pub trait Link: Send {
    /// Sends a frame. What cannot be sent at once is lost: news follows within 10 ms.
    fn send(&mut self, to: To, packet: &[u8]) -> Result<(), LinkError>;

    /// The next frame that came, waiting for it at most so long; `None` where none came.
    fn receive(&mut self, wait: Duration) -> Result<Option<Packet>, LinkError>;

    /// Who has to pass beacons on, over such a link.
    fn relay(&self) -> Relay;

    /// Something the people should know, each once: a robot's process that ended, a line that came back.
    fn notice(&mut self) -> Option<String> {
        None
    }

    /// Whether a frame would go out at once: while it would only wait on the way, it waits where newer ones replace it.
    fn has_room(&mut self) -> bool {
        true
    }

    /// Throws away what was taken and has not left yet: HALT comes.
    fn discard(&mut self) {}

    /// The rate of a line, where it has one.
    fn line_rate(&self) -> Option<LineRate> {
        None
    }

    /// What to look at where no robot is heard.
    fn advice(&self) -> String;
}

/// How fast a line is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LineRate {
    /// Its name.
    pub device: String,
    /// Bits a second; a byte takes [`BITS_PER_BYTE`](Self::BITS_PER_BYTE).
    pub baud: u32,
}

impl LineRate {
    /// Start bit, eight bits, stop bit.
    pub const BITS_PER_BYTE: u64 = 10;
    /// Bytes of a line beside the frame: COBS and the zero.
    pub const FRAME_OVERHEAD: u64 = 2;

    /// Bits a second that so much traffic in one second needs.
    pub const fn needed(frames: u64, bytes: u64) -> u64 {
        (bytes + frames * Self::FRAME_OVERHEAD) * Self::BITS_PER_BYTE
    }
}

/// Opens the link that `settings` name; virtual robots are started as `sim` says.
pub fn open(link: &RobotLink, sim: impl FnOnce(&str) -> SimSettings) -> Result<Box<dyn Link>, LinkError> {
    Ok(match link {
        RobotLink::Udp(address) => Box::new(UdpLink::open(address)?),
        RobotLink::Serial { device, baud } => Box::new(SerialLink::open(device, *baud)?),
        RobotLink::Simulator(host) => Box::new(SimLink::start(sim(host))?),
    })
}
