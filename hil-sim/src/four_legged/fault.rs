//! `fault`: faults injected into a trial, by tick number: crashes, reboots, other radio settings, and a
//! flipped bit.

use geometry::{Twist, Vector};
use protocol::RobotId;
use protocol::robot_io::ActuatorFrame;

use crate::air::AirSettings;

/// A fault, or its end, at the start of a tick.
#[derive(Clone, Debug, PartialEq)]
pub struct ScheduledFault {
    /// Number of the tick.
    pub tick: u32,
    /// The fault applied at its start.
    pub fault: Fault,
}

/// Faults of a robot's computer or of the radio.
#[derive(Clone, Debug, PartialEq)]
pub enum Fault {
    /// A robot's computer stops; its body stands, and releases the ball.
    Crash(RobotId),
    /// A robot's computer boots with a new epoch; no effect on a computer that runs.
    Return(RobotId),
    /// The radio settings change.
    Air(AirSettings),
    /// One bit of a robot's next order flips: bit `bit & 31` of the ordered forward speed (or of the first
    /// wheel's speed).
    FlipOrderBit {
        /// The robot whose order is changed.
        robot: RobotId,
        /// Number of the bit; 0 is the least significant of the mantissa.
        bit: u8,
    },
}

/// The order with one bit of its first number flipped.
pub(crate) fn flipped(order: ActuatorFrame, bit: u8) -> ActuatorFrame {
    let flip = |value: f32| f32::from_bits(value.to_bits() ^ (1 << (bit & 31)));
    match order {
        ActuatorFrame::Legged { walk, primitive } => {
            let linear = Vector::new(flip(walk.linear.x()), walk.linear.y());
            ActuatorFrame::Legged { walk: Twist { linear, ..walk }, primitive }
        }
        ActuatorFrame::Omni { wheels: [first, others @ ..], dribbler, kick } => {
            let [a, b, c] = others;
            ActuatorFrame::Omni { wheels: [flip(first), a, b, c], dribbler, kick }
        }
        // An order without numbers has no bit to flip.
        ActuatorFrame::Released => order,
    }
}

#[cfg(test)]
mod tests {
    use protocol::robot_io::{LeggedPrimitive, OmniKick};

    use super::*;

    #[test]
    fn one_bit_of_the_first_number_flips_and_flips_back() {
        let walk = Twist { linear: Vector::new(0.25, 0.5), angular: 1.0 };
        let legged = ActuatorFrame::Legged { walk, primitive: LeggedPrimitive::Grab };
        let omni = ActuatorFrame::Omni { wheels: [1.0; 4], dribbler: 0.0, kick: OmniKick::None };
        for order in [legged, omni] {
            for bit in 0..32 {
                assert_ne!(flipped(order, bit), order);
                let back = flipped(flipped(order, bit), bit);
                assert_eq!(format!("{back:?}"), format!("{order:?}"));
            }
        }
    }
}
