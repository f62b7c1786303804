//! How do simulator and robot computer take turns? One question, one answer, a tick at a time (DESIGN §7).
//!
//! The simulator sends [`ToRobot::Setup`] once per life and then a [`ToRobot::Tick`] per brain step; the computer
//! answers each with one [`FromRobot`]. Time moves only by ticks: timers due by `now` run before the tick's packets,
//! packets in order, then the sensors. Over Ethernet each message is `length u16 LE | postcard` behind the 14-byte
//! header with [`ETHERTYPE`].

use serde::{Deserialize, Serialize};

use crate::Instant;
use crate::robot_io::{ActuatorFrame, SensorFrame};

/// Packets of the air handed to a robot in one tick; the simulator keeps the rest for the next.
pub const AIR_IN_MAX: usize = 12;
/// Packets a robot may send in one tick.
pub const AIR_OUT_MAX: usize = 6;
/// The longest message of this module, bytes; fits one Ethernet frame.
pub const MESSAGE_LEN_MAX: usize = 1_480;
/// Local experimental Ethernet type.
pub const ETHERTYPE: u16 = 0x88b5;

/// From the simulator to a robot's computer.
#[allow(clippy::large_enum_variant, reason = "one value at a time, on the stack, and no heap to box it on")]
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum ToRobot<'a> {
    /// Start a new life with this configuration (postcard of the brain's own type; this crate does not look inside).
    Setup {
        /// The brain's configuration.
        config: &'a [u8],
    },
    /// One step.
    #[serde(borrow)]
    Tick(TickIn<'a>),
}

/// What a robot's computer learns in one tick.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TickIn<'a> {
    /// Number of the tick; the answer carries it back.
    pub seq: u32,
    /// The time now.
    pub now: Instant,
    /// Packets that arrived, in order.
    #[serde(borrow)]
    pub air: heapless::Vec<&'a [u8], AIR_IN_MAX>,
    /// What the robot perceives now.
    pub sensors: SensorFrame,
}

/// From a robot's computer to the simulator.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum FromRobot<'a> {
    /// Awake, waiting for a set-up.
    Hello,
    /// Set up.
    Ready,
    /// The set-up could not be read, or the library in flash is not one.
    Unusable,
    /// A tick's answer.
    #[serde(borrow)]
    Tick(TickOut<'a>),
}

/// What a robot's computer answers in one tick.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TickOut<'a> {
    /// The tick answered.
    pub seq: u32,
    /// What the body shall do; `None` when nothing new was said.
    pub actuators: Option<ActuatorFrame>,
    /// Packets to send, in order.
    #[serde(borrow)]
    pub air: heapless::Vec<&'a [u8], AIR_OUT_MAX>,
    /// Guest instructions the tick took, where they can be counted; else 0.
    pub instructions: u32,
}
