//! `pwm_dir`: a motor's driver with two wires: PWM and direction.

use embedded_hal::digital::OutputPin;
use embedded_hal::pwm::SetDutyCycle;

use super::{Bridge, share};

/// PWM, and a wire that is high for backwards.
#[derive(Debug)]
pub struct PwmDir<P, D> {
    pwm: P,
    direction: D,
}

impl<P: SetDutyCycle, D: OutputPin> PwmDir<P, D> {
    /// A driver whose PWM runs already.
    pub fn new(pwm: P, direction: D) -> Self {
        Self { pwm, direction }
    }
}

impl<P: SetDutyCycle, D: OutputPin> Bridge for PwmDir<P, D> {
    fn set(&mut self, duty: f32) -> bool {
        let turned = self.direction.set_state((duty < 0.0).into()).is_ok();
        let full = self.pwm.max_duty_cycle();
        // With the direction unknown no current at all.
        let duty = if turned { share(duty, full) } else { 0 };
        self.pwm.set_duty_cycle(duty).is_ok() && turned
    }

    fn off(&mut self) {
        // The enable wire is what takes the current off; this is the second lock.
        let _ = self.pwm.set_duty_cycle_fully_off();
    }
}
