//! `motors`: motor schemes behind one trait, [`MotorDrivers`]: PWM and direction into a driver ([`PwmDir`]),
//! three PWMs and hall sensors ([`ThreePwm`]), and a smart driver on a serial line or SPI ([`Smart`]).
//!
//! | scheme | wires to a motor's driver | who commutates | measured speed |
//! |---|---|---|---|
//! | [`PwmDir`] | PWM, direction | the driver, or brushes | encoder |
//! | [`ThreePwm`] | three PWMs, three enables, three hall sensors | [`HallMotor`], from the hall sensors' interrupt | encoder, or hall edges |
//! | [`Smart`] | one serial line or SPI for all | the driver | encoder, or the driver's counts |

mod bridges;
pub mod hall;
mod pwm_dir;
pub mod smart;

use runtime::wheel::WHEELS;

pub use bridges::{Bridge, Bridges};
pub use hall::{HallMotor, ThreePwm};
pub use pwm_dir::PwmDir;
pub use smart::Smart;

/// The drivers of a robot's motors: four wheels and the dribbler.
pub trait MotorDrivers {
    /// Applies shares of the battery's voltage, −1 to 1, in the order of the wheels on the wire, and 0 to 1
    /// for the dribbler, until the next call. NaN is no current.
    fn drive(&mut self, duty: [f32; WHEELS], dribbler: f32);

    /// No current in any of them: the wheels roll freely.
    fn release(&mut self);

    /// Returns whether a driver has switched itself off, or cannot be reached.
    fn has_fault(&mut self) -> bool;
}

/// A share of a duty cycle's full range; none for NaN.
fn share(duty: f32, full: u16) -> u16 {
    // The cast saturates, and turns NaN into 0.
    ((duty.abs() * f32::from(full)) as u16).min(full)
}

#[cfg(test)]
mod testing;
