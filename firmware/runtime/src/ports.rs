//! What must a board be able to do? Hear and speak on the air, sense, and move.
//!
//! Each half is owned by the task that waits for it; a board that has both on one chip shares the chip itself.
#![allow(
    async_fn_in_trait,
    reason = "all tasks of a robot run on one executor in one thread: nobody asks for Send"
)]

use protocol::link::Packet;
use protocol::robot_io::{ActuatorFrame, SensorFrame};

/// The ear of a radio.
pub trait RadioReceiver {
    /// The next packet of the air, as it came: nobody has checked it yet.
    async fn receive(&mut self) -> Packet;
}

/// The mouth of a radio.
pub trait RadioSender {
    /// Puts a packet on the air; returns when the next may follow. Whether anybody hears it is not known.
    async fn send(&mut self, packet: Packet);
}

/// What a robot perceives with.
pub trait Senses {
    /// The next picture of the world, at the pace of the control loop.
    async fn sense(&mut self) -> SensorFrame;
}

/// What a robot moves with.
pub trait Body {
    /// Does what is wanted from now on, until the next call.
    async fn act(&mut self, wanted: ActuatorFrame);
}
