//! `pulses`: raw pulses, by which a kicker is measured: the host's order to a bring-up image, and its report
//! (protocol/SPEC.md, PulseOrder and PulseReport).
//!
//! Payloads in both directions begin with [`KIND`], which is neither a message of robots nor one of hosts:
//! match images open none. **An order is live**: it names the robot's start and the clock of its newest
//! report, so that no recording arms or fires.

use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::bring_up::Reporter;
use crate::frame::{Frame, Sender, decode};

/// The payload's first byte.
pub const KIND: u8 = crate::team::PULSES;

/// A raw pulse through a coil of the kicker.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Pulse {
    /// Another for each pulse of a host's start: one is fired once, however often it is ordered.
    pub number: u16,
    /// The chip kicker's coil, not the flat one's.
    pub chip: bool,
    /// Length, µs.
    pub micros: u16,
}

/// The host's order, repeated until a report answers it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct PulseOrder {
    /// The epoch of the robot's frames.
    pub boot_epoch: u32,
    /// Clock of its newest report.
    pub clock: u32,
    /// The pulse to fire, if armed; `None`: arm.
    pub fire: Option<Pulse>,
}

/// Why a pulse was not fired.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Error)]
pub enum PulseRefusal {
    /// Not armed since the start, the last pulse, or the host's last silence.
    #[error("the kicker is not armed")]
    Disarmed,
    /// The last order to arm is too old.
    #[error("the order to arm has expired")]
    Expired,
    /// Zero, or longer than this, the longest of the coil in `robot.toml`, µs.
    #[error("no pulse of this length: 1 to {0} µs by the robot.toml of its image")]
    Length(u16),
    /// The pause since the last pulse is not over.
    #[error("too soon after the last pulse (pause_ms of robot.toml)")]
    TooSoon,
    /// The capacitor's voltage, V; NaN: it cannot be read.
    #[error("the capacitor is not full: {0:.1} V")]
    NotCharged(f32),
}

/// A pulse that was fired.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Fired {
    /// The capacitor's voltage before it, V.
    pub before: f32,
    /// The same after it, before it is charged again.
    pub after: f32,
    /// The beam before the kicker was interrupted.
    pub ball: bool,
}

/// State of the kicker.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PulseReport {
    /// Epoch of the newest frame of a host of its team, its tag not checked; 0 without one.
    pub host: u32,
    /// The robot's clock, ms since its start.
    pub clock: u32,
    /// A pulse would be fired: armed, full, and the pause is over.
    pub ready: bool,
    /// The beam before the kicker is interrupted.
    pub ball: bool,
    /// The capacitor's voltage, V; NaN: it cannot be read.
    pub volts: f32,
    /// What became of the last pulse that this host ordered.
    pub last: Option<(Pulse, Result<Fired, PulseRefusal>)>,
}

/// Reads a genuine order to the robot `who`, with its epoch and counter. Whether it is live is the reader's
/// to judge.
pub fn open_order(packet: &[u8], who: &Reporter) -> Option<((u32, u32), PulseOrder)> {
    let frame = Frame::parse(packet, who.team).ok()?;
    let is_to_me = frame.sender == Sender::Host && frame.audience.is_none();
    let (KIND, order) = decode(frame.payload).filter(|_| is_to_me)? else { return None };
    frame.is_genuine(packet, &who.key, who.robot).then_some(((frame.epoch, frame.counter), order))
}

#[cfg(test)]
mod tests;
