//! How do frames get to robots and back? The effects of the host: network, serial line, processes, files.
//!
//! [`open`] takes the link that a team's settings name; [`Link`] carries whole frames and knows nothing of what is in them.
//! A [`Radio`](crate::radio::Radio) says what to send and reads what comes. [`key`] reads a team's key;
//! [`Recorder`] keeps a match.

pub mod epoch;
mod error;
mod hub;
pub mod key;
mod recorder;
mod serial;
mod sim;
mod udp;

use std::time::Duration;

use protocol::link::Packet;

use crate::config::RobotLink;
use crate::radio::{Relay, To};

pub use error::LinkError;
pub use recorder::Recorder;
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

    /// What to look at where no robot is heard.
    fn advice(&self) -> String;
}

/// Opens the link that `settings` name; virtual robots are started as `sim` says.
pub fn open(link: &RobotLink, sim: impl FnOnce(&str) -> SimSettings) -> Result<Box<dyn Link>, LinkError> {
    Ok(match link {
        RobotLink::Udp(address) => Box::new(UdpLink::open(address)?),
        RobotLink::Serial { device, baud } => Box::new(SerialLink::open(device, *baud)?),
        RobotLink::Simulator(host) => Box::new(SimLink::start(sim(host))?),
    })
}
