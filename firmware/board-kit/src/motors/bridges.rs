//! `bridges`: motors that each have wires of their own, with a common enable and a common fault wire.

use embedded_hal::digital::{InputPin, OutputPin};
use embedded_hal::pwm::SetDutyCycle;
use runtime::wheel::WHEELS;

use super::{MotorDrivers, share};

/// The driver of one motor.
pub trait Bridge {
    /// Applies a share of the battery's voltage, −1 to 1, until the next call; NaN is no current. Whether the
    /// driver took it.
    fn set(&mut self, duty: f32) -> bool;

    /// Takes the current off.
    fn off(&mut self);
}

/// Four motors of one scheme and the dribbler, which turns one way; one wire that takes the current off all
/// of them, and one on which a driver reports that it has switched itself off.
#[derive(Debug)]
pub struct Bridges<B, D, E, F> {
    wheels: [B; WHEELS],
    dribbler: D,
    enable: E,
    fault: F,
    is_mute: bool,
}

impl<B: Bridge, D: SetDutyCycle, E: OutputPin, F: InputPin> Bridges<B, D, E, F> {
    /// All motors without current. `enable` is high for current, `fault` low where a driver has switched
    /// itself off.
    pub fn new(wheels: [B; WHEELS], dribbler: D, enable: E, fault: F) -> Self {
        let mut new = Self { wheels, dribbler, enable, fault, is_mute: false };
        new.release();
        new
    }
}

impl<B: Bridge, D: SetDutyCycle, E: OutputPin, F: InputPin> MotorDrivers for Bridges<B, D, E, F> {
    fn drive(&mut self, duty: [f32; WHEELS], dribbler: f32) {
        if self.has_fault() {
            return self.release();
        }
        // `fold`, because all of them must be set, not only those up to the first that fails.
        let wheels =
            self.wheels.iter_mut().zip(duty).fold(true, |taken, (wheel, duty)| wheel.set(duty) && taken);
        let full = self.dribbler.max_duty_cycle();
        let dribbler = self.dribbler.set_duty_cycle(share(dribbler.max(0.0), full)).is_ok();
        self.is_mute = !(wheels && dribbler);
        if self.is_mute || self.enable.set_high().is_err() {
            self.release();
        }
    }

    fn release(&mut self) {
        // A wire that cannot be set here has its pull-down, and `has_fault` remembers the failure.
        self.is_mute |= self.enable.set_low().is_err();
        self.wheels.iter_mut().for_each(Bridge::off);
        self.is_mute |= self.dribbler.set_duty_cycle_fully_off().is_err();
    }

    fn has_fault(&mut self) -> bool {
        // A wire that cannot be read is no leave to drive.
        self.is_mute || self.fault.is_low().unwrap_or(true)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motors::PwmDir;
    use crate::motors::testing::{Pin, Pwm};

    fn wheels() -> ([Pwm; WHEELS], [Pin; WHEELS]) {
        (core::array::from_fn(|_| Pwm::new()), core::array::from_fn(|_| Pin::new()))
    }

    #[test]
    fn shares_reach_their_wheels_and_a_fault_takes_the_current_off_all() {
        let (pwm, dir) = wheels();
        let (dribbler, enable, fault) = (Pwm::new(), Pin::new(), Pin::new());
        fault.put(true);
        let each = core::array::from_fn(|n| PwmDir::new(pwm[n].clone(), dir[n].clone()));
        let mut bridges = Bridges::new(each, dribbler.clone(), enable.clone(), fault.clone());
        assert!(!enable.is_set());
        bridges.drive([0.5, -0.25, f32::NAN, 2.0], 0.1);
        assert_eq!(pwm.each_ref().map(Pwm::duty), [500, 250, 0, 1000]);
        assert_eq!(dir.each_ref().map(Pin::is_set), [false, true, false, false]);
        assert!(enable.is_set() && dribbler.duty() == 100);
        fault.put(false);
        bridges.drive([1.0; WHEELS], 1.0);
        assert!(bridges.has_fault() && !enable.is_set() && dribbler.duty() == 0);
        assert_eq!(pwm.each_ref().map(Pwm::duty), [0; WHEELS]);
        fault.put(true);
        bridges.drive([0.1; WHEELS], -1.0);
        assert!(enable.is_set() && dribbler.duty() == 0, "the dribbler turns one way");
    }

    #[test]
    fn a_driver_that_refuses_its_order_stops_all() {
        let (pwm, dir) = wheels();
        let (enable, fault) = (Pin::new(), Pin::new());
        fault.put(true);
        let each = core::array::from_fn(|n| PwmDir::new(pwm[n].clone(), dir[n].clone()));
        let mut bridges = Bridges::new(each, Pwm::new(), enable.clone(), fault);
        pwm[2].break_it();
        bridges.drive([0.5; WHEELS], 0.0);
        assert!(!enable.is_set() && bridges.has_fault());
        assert_eq!((pwm[0].duty(), pwm[3].duty()), (0, 0));
    }
}
