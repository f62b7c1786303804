//! `net`: sockets of the league's network, for multicast and unicast, opened as the league's own programs do.
//!
//! [`Receiver`] receives a multicast group beside other programs on the same machine, [`Sender`] sends to
//! one, [`Port`] is a UDP port of one's own (simulators, robots); [`NetReceiver`] and [`NetSender`] take
//! either kind of address. [`Connection`] is a dialogue with the game controller. Every error names the fix.
//!
//! **No async runtime.** A receive waits for at most the given time and allocates no memory, so one thread a
//! socket, or one loop over all with a wait of zero, is simple and enough: a match has four to eight sockets
//! and under a thousand datagrams a second. A program with a runtime calls these from a blocking task.

mod address;
mod connection;
mod endpoint;
mod error;
mod interfaces;
mod probe;
mod sockets;

pub use address::{resolve, resolve_destination, split_address};
pub use connection::Connection;
pub use endpoint::{NetReceiver, NetSender};
pub use error::NetError;
pub use interfaces::{Interface, Interfaces, interfaces};
pub use probe::{LoopbackProbe, probe_loopback, route};
pub use sockets::{Datagram, Port, Receiver, Sender};

/// Addresses and ports of the league's programs.
pub mod addresses {
    use std::net::{Ipv4Addr, SocketAddrV4};

    const VISION_GROUP: Ipv4Addr = Ipv4Addr::new(224, 5, 23, 2);
    const REFEREE_GROUP: Ipv4Addr = Ipv4Addr::new(224, 5, 23, 1);

    /// [`WrapperPacket`](crate::vision::WrapperPacket) of a real field (SSL-Vision, vision-processor).
    pub const VISION: SocketAddrV4 = SocketAddrV4::new(VISION_GROUP, 10006);
    /// [`vision::legacy::WrapperPacket`](crate::vision::legacy::WrapperPacket), until 2014.
    pub const VISION_LEGACY: SocketAddrV4 = SocketAddrV4::new(VISION_GROUP, 10005);
    /// The same as [`VISION`] of a simulator, so that it disturbs no tournament's network (grSim, ER-Force).
    pub const VISION_SIMULATED: SocketAddrV4 = SocketAddrV4::new(VISION_GROUP, 10020);
    /// Packets of the game controller: [`Referee`](crate::referee::Referee).
    pub const REFEREE: SocketAddrV4 = SocketAddrV4::new(REFEREE_GROUP, 10003);
    /// Packets of trackers: [`TrackerWrapperPacket`](crate::tracker::TrackerWrapperPacket).
    pub const TRACKER: SocketAddrV4 = SocketAddrV4::new(VISION_GROUP, 10010);
    /// Game controller's TCP port for automatic referees.
    pub const AUTOREF_PORT: u16 = 10007;
    /// Game controller's TCP port for teams.
    pub const TEAM_PORT: u16 = 10008;
    /// TCP port of the game controller for teams' remote controls.
    pub const REMOTE_PORT: u16 = 10011;
    /// A simulator's UDP port for [`SimulatorCommand`](crate::simulation::SimulatorCommand).
    pub const SIMULATOR_PORT: u16 = 10300;
    /// A simulator's UDP port for the blue team's [`RobotControl`](crate::simulation::RobotControl).
    pub const ROBOTS_BLUE_PORT: u16 = 10301;
    /// A simulator's UDP port for the yellow team's [`RobotControl`](crate::simulation::RobotControl).
    pub const ROBOTS_YELLOW_PORT: u16 = 10302;
    /// grSim's UDP port for [`GrsimPacket`](crate::simulation::GrsimPacket).
    pub const GRSIM_PORT: u16 = 20011;
    /// UDP port to which grSim sends blue's [`RobotsStatus`](crate::simulation::RobotsStatus).
    pub const GRSIM_BLUE_STATUS_PORT: u16 = 30011;
    /// UDP port to which grSim sends yellow's [`RobotsStatus`](crate::simulation::RobotsStatus).
    pub const GRSIM_YELLOW_STATUS_PORT: u16 = 30012;
}
