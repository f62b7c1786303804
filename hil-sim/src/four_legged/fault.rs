//! `fault`: faults injected into a trial. Crashes, returns, worse air, and a flipped bit; by tick number.

use geometry::{Twist, Vector};
use protocol::RobotId;
use protocol::robot_io::ActuatorFrame;

use crate::air::AirSettings;

/// Something that goes wrong (or right again) at the beginning of a tick.
#[derive(Clone, Debug, PartialEq)]
pub struct ScheduledFault {
    /// The tick.
    pub tick: u32,
    /// What happens.
    pub fault: Fault,
}

/// What can happen.
#[derive(Clone, Debug, PartialEq)]
pub enum Fault {
    /// A robot's computer stops; its body stands, and lets the ball go.
    Crash(RobotId),
    /// A robot's computer starts a new life; nothing happens where it runs.
    Return(RobotId),
    /// The air changes.
    Air(AirSettings),
    /// One bit of a robot's next order flips: bit `bit & 31` of the wanted speed ahead (or of the first wheel's).
    FlipOrderBit {
        /// Whose order.
        robot: RobotId,
        /// Which bit; 0 is the least significant of the mantissa.
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
        // No number, no bit.
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
