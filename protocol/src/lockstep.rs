//! `lockstep`: lockstep between simulator and robot computer: one request, one answer, a tick at a time
//! (docs/architecture.md §7.2).
//!
//! The simulator sends [`ToRobot::Setup`] once per boot epoch and then a [`ToRobot::Tick`] per brain step;
//! the computer answers each with one [`FromRobot`]. Time moves only by ticks: timers due by `now` run before
//! the tick's packets, packets in order, then the sensors. Over Ethernet each message is `length u16 LE |
//! postcard` behind the 14-byte header with [`ETHERTYPE`].

use serde::{Deserialize, Serialize};

use crate::Instant;
use crate::robot_io::{ActuatorFrame, SensorFrame};

/// Radio packets handed to a robot in one tick; the simulator keeps further ones for the next. Eleven robots'
/// world in four parts, a command, a welcome and a beacon of each of ten teammates.
pub const AIR_IN_MAX: usize = 16;
/// Bytes of packets passed to a robot in one tick; with as many lengths and the longest [`SensorFrame`] it
/// stays within [`MESSAGE_LEN_MAX`].
pub const AIR_IN_BYTES_MAX: usize = 1_280;
/// Packets a robot may send in one tick.
pub const AIR_OUT_MAX: usize = 6;
/// The longest message of this module, bytes; fits one Ethernet frame.
pub const MESSAGE_LEN_MAX: usize = 1_480;
/// Local experimental Ethernet type.
pub const ETHERTYPE: u16 = 0x88b5;

/// Message from the simulator to a robot's computer.
#[allow(clippy::large_enum_variant, reason = "one value at a time, on the stack, and no heap to box it on")]
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum ToRobot<'a> {
    /// Start a new boot epoch with this configuration (postcard of the brain's own type; this crate does not
    /// look inside).
    Setup {
        /// The brain's configuration, postcard of the brain's own type.
        config: &'a [u8],
    },
    /// Inputs of one brain step.
    #[serde(borrow)]
    Tick(TickIn<'a>),
}

/// Input of a robot's computer in one tick.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TickIn<'a> {
    /// Number of the tick; the answer returns it.
    pub seq: u32,
    /// Time of the tick.
    pub now: Instant,
    /// Packets that arrived, in order.
    #[serde(borrow)]
    pub air: heapless::Vec<&'a [u8], AIR_IN_MAX>,
    /// The sensor frame of this tick.
    pub sensors: SensorFrame,
}

/// Message from a robot's computer to the simulator.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum FromRobot<'a> {
    /// Started, waiting for a set-up.
    Hello,
    /// The set-up was accepted.
    Ready,
    /// The set-up, or the library in flash, could not be read.
    Unusable,
    /// Outputs of one brain step.
    #[serde(borrow)]
    Tick(TickOut<'a>),
}

/// Output of a robot's computer in one tick.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TickOut<'a> {
    /// Number of the tick that is answered.
    pub seq: u32,
    /// The actuator orders; `None` without new ones.
    pub actuators: Option<ActuatorFrame>,
    /// Packets to send, in order.
    #[serde(borrow)]
    pub air: heapless::Vec<&'a [u8], AIR_OUT_MAX>,
    /// Guest instructions of the tick, where they can be counted; else 0.
    pub instructions: u32,
    /// Bytes of its stack that were ever used, as measured last; 0 where it is not measured.
    pub stack: u32,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Duration;
    use crate::robot_io::{BallSight, CameraFrame, Health, LandmarkSight, OPPONENTS_SEEN_MAX, Sight};
    use geometry::{Angle, Point, Pose, Twist};

    #[test]
    fn the_fullest_tick_fits_into_a_message() {
        let far = Point::new(f32::MAX, f32::MIN);
        let sight = Sight::new(60.0, Angle::new(-3.0));
        let sensors = SensorFrame {
            pose: Some(Pose { position: far, heading: Angle::new(1.0) }),
            ball: Some(BallSight { position: far, sigma: 1.0, age: Duration(u64::MAX) }),
            opponents: [far; OPPONENTS_SEEN_MAX].into_iter().collect(),
            ball_contact: true,
            busy: true,
            odometry: Twist::default(),
            health: Health { battery: Some(1.0), ..Health::default() },
            camera: Some(CameraFrame {
                landmarks: [LandmarkSight { landmark: u8::MAX, sight }; 4].into_iter().collect(),
                ball: Some(sight),
            }),
        };
        let packet = [0; AIR_IN_BYTES_MAX / AIR_IN_MAX];
        let air = [&packet[..]; AIR_IN_MAX].into_iter().collect();
        let tick = TickIn { seq: u32::MAX, now: Instant(u64::MAX), air, sensors };
        let mut out = [0; MESSAGE_LEN_MAX];
        let written = postcard::to_slice(&ToRobot::Tick(tick), &mut out).map(|bytes| bytes.len());
        // Two bytes of length go before it.
        assert!(written.as_ref().is_ok_and(|len| len + 2 <= MESSAGE_LEN_MAX), "{written:?}");
    }
}
