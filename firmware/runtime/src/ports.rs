//! `ports`: traits that a board implements: radio, sensors, actuators.
//!
//! The first four are all that a board in lockstep needs; the others are a robot's own. Each half is owned by
//! the task that waits for it; a board that has both on one chip shares the chip itself.
#![allow(
    async_fn_in_trait,
    reason = "all tasks of a robot run on one executor in one thread: Send is not needed"
)]

use protocol::Duration;
use protocol::link::Packet;
use protocol::robot_io::{ActuatorFrame, SensorFrame};

use crate::kicker::{KickerAct, KickerState};
use crate::wheel::WHEELS;

/// The receiver of a radio.
pub trait RadioReceiver {
    /// The next packet received, not yet authenticated.
    async fn receive(&mut self) -> Packet;

    /// Faults since the start: restarts of a chip, errors of a line.
    fn faults(&self) -> u32 {
        0
    }
}

/// The sender of a radio.
pub trait RadioSender {
    /// Sends a packet; returns when the next may follow. Whether it was received is not known.
    async fn send(&mut self, packet: Packet);
}

/// Sensors of a robot.
pub trait Senses {
    /// The next sensor frame, at the pace of the control loop.
    async fn sense(&mut self) -> SensorFrame;
}

/// Actuators of a robot.
pub trait BodyPort {
    /// Executes `orders` until the next call.
    async fn act(&mut self, orders: ActuatorFrame);
}

/// Four wheels with their motors, and the dribbler.
pub trait WheelsPort {
    /// Rim speeds since the last call, m/s; NaN where an encoder is known to be broken.
    fn measured(&mut self) -> [f32; WHEELS];

    /// Applies the wheels' duty cycles, −1 to 1 of the battery's voltage, and the dribbler's share of its
    /// full speed, 0 to 1, until the next call.
    fn drive(&mut self, duty: [f32; WHEELS], dribbler: f32);

    /// Takes the current off wheels and dribbler.
    fn release(&mut self);
}

/// The kicker's capacitor and coils.
pub trait Kicker {
    /// Readings of the kicker's sensors.
    fn state(&mut self) -> KickerState;

    /// Executes `act`; returns when a pulse is over, or after a step of about a millisecond. Nothing may stay
    /// switched on longer than the pulse, even if the task stops: the board's timer ends it, not the program.
    async fn act(&mut self, act: KickerAct);
}

/// Sensors of a wheeled robot, besides its encoders.
pub trait Probes {
    /// All readings at this moment.
    fn look(&mut self) -> Seen;
}

/// Readings of the probes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// Turning rate of the body, rad/s; `None` without a gyroscope.
    pub turn: Option<f32>,
    /// The beam at the dribbler is interrupted.
    pub ball: bool,
    /// The robot lies on its side.
    pub tipped: bool,
    /// Battery voltage, V; `None` where it is not measured.
    pub battery: Option<f32>,
    /// True if the kicker is charged.
    pub kicker_ready: bool,
}

/// A watchdog that resets the computer unless it is fed.
pub trait Watchdog {
    /// Time without feeding after which it resets the chip.
    const TIMEOUT: Duration;

    /// Restarts the time-out of the watchdog.
    fn feed(&mut self);
}
