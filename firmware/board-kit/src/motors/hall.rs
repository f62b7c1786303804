//! `hall`: six-step commutation of a brushless motor by its three hall sensors, for drivers with three PWM
//! inputs and three enables (one half bridge each).
//!
//! The sensors stand at the zero crossings of the voltages between two terminals, as makers draw them: bit 0
//! is high while terminal A is above B when the motor is turned forwards, bit 1 while B is above C, bit 2
//! while C is above A. A motor with other sensors has other names for its wires, in one of six orders; none
//! of them but the right one turns it evenly both ways.
//!
//! **Timing.** [`ThreePwm::commutate`] belongs into the interrupt of the sensors' edges, not into the control
//! loop: a motor with `p` pairs of poles needs it `6 p` times a turn. [`HallMotor`] is a driver in a static
//! that both reach.

mod shared;

use embedded_hal::digital::{InputPin, OutputPin};
use embedded_hal::pwm::SetDutyCycle;

use super::{Bridge, share};

pub use shared::HallMotor;

/// Number of phases of a brushless motor.
pub const PHASES: usize = 3;

/// Output of a half bridge until the next commutation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PhaseOutput {
    /// Switched between battery and ground by the duty cycle.
    High,
    /// Connected to ground for its whole duration.
    Low,
    /// Connected to neither battery nor ground.
    Floating,
}

/// The outputs for the sensors' code (bit 0 is the first sensor), forwards or backwards; `None` for 0 and 7,
/// which no turning motor shows: a sensor or its cable is broken.
pub const fn commutation(code: u8, backwards: bool) -> Option<[PhaseOutput; PHASES]> {
    use PhaseOutput::{Floating, High, Low};
    let forwards = match code {
        0b001 => [High, Low, Floating],
        0b011 => [High, Floating, Low],
        0b010 => [Floating, High, Low],
        0b110 => [Low, High, Floating],
        0b100 => [Low, Floating, High],
        0b101 => [Floating, Low, High],
        _ => return None,
    };
    if !backwards {
        return Some(forwards);
    }
    let [a, b, c] = forwards;
    Some([turned(a), turned(b), turned(c)])
}

const fn turned(output: PhaseOutput) -> PhaseOutput {
    match output {
        PhaseOutput::High => PhaseOutput::Low,
        PhaseOutput::Low => PhaseOutput::High,
        PhaseOutput::Floating => PhaseOutput::Floating,
    }
}

/// Counts the sensors' edges: six a turn and pair of poles, up when the motor turns forwards.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct HallCounter {
    place: Option<i8>,
    count: u16,
}

impl HallCounter {
    /// The count after this code. A code that is none, or a jump over half a turn, is not counted.
    pub fn step(&mut self, code: u8) -> u16 {
        let place = ORDER.iter().position(|known| *known == code).map(|place| place as i8);
        if let (Some(now), Some(before)) = (place, self.place) {
            let steps = match (now - before).rem_euclid(SIXTHS) {
                forwards @ (0..=2) => i16::from(forwards),
                backwards @ (4..) => i16::from(backwards - SIXTHS),
                // Half a turn: the direction is unknown.
                _ => 0,
            };
            self.count = self.count.wrapping_add_signed(steps);
        }
        self.place = place.or(self.place);
        self.count
    }
}

/// The codes as they follow each other when the motor turns forwards.
const ORDER: [u8; 6] = [0b001, 0b011, 0b010, 0b110, 0b100, 0b101];
/// Steps of an electrical turn.
const SIXTHS: i8 = ORDER.len() as i8;

/// A motor's driver with three PWMs and three enables, and the motor's sensors.
#[derive(Debug)]
pub struct ThreePwm<P, E, H> {
    pwm: [P; PHASES],
    enables: [E; PHASES],
    sensors: [H; PHASES],
    counter: HallCounter,
    duty: f32,
}

impl<P: SetDutyCycle, E: OutputPin, H: InputPin> ThreePwm<P, E, H> {
    /// A driver whose PWMs run already; all phases float.
    pub fn new(pwm: [P; PHASES], enables: [E; PHASES], sensors: [H; PHASES]) -> Self {
        let mut new = Self { pwm, enables, sensors, counter: HallCounter::default(), duty: 0.0 };
        new.off();
        new
    }

    /// Applies the present share to the phases that the sensors ask for; whether sensors and driver answered.
    /// To be called at each edge of a sensor.
    pub fn commutate(&mut self) -> bool {
        let Some(code) = self.code() else { return self.float() };
        self.counter.step(code);
        let Some(outputs) = commutation(code, self.duty < 0.0) else { return self.float() };
        if self.duty.is_nan() {
            self.float();
            return true;
        }
        let floating = |output: &PhaseOutput| *output == PhaseOutput::Floating;
        let phases = || outputs.iter().zip(0..);
        // The phase that ends first, so that never two are switched against each other.
        let order = phases().filter(|(o, _)| floating(o)).chain(phases().filter(|(o, _)| !floating(o)));
        let mut taken = true;
        for (output, phase) in order {
            taken &= self.apply(phase, *output);
        }
        taken || self.float()
    }

    /// Edges of the sensors so far, for an encoder of six counts a turn and pair of poles; they wrap.
    pub fn count(&self) -> u16 {
        self.counter.count
    }

    fn code(&mut self) -> Option<u8> {
        let bit =
            |(place, sensor): (usize, &mut H)| sensor.is_high().ok().map(|high| u8::from(high) << place);
        self.sensors.iter_mut().enumerate().map(bit).sum()
    }

    fn apply(&mut self, phase: usize, output: PhaseOutput) -> bool {
        let (Some(pwm), Some(enable)) = (self.pwm.get_mut(phase), self.enables.get_mut(phase)) else {
            return false;
        };
        let full = pwm.max_duty_cycle();
        let duty = if output == PhaseOutput::High { share(self.duty, full) } else { 0 };
        let floats = output == PhaseOutput::Floating;
        let (before, after) = (!floats || enable.set_low().is_ok(), pwm.set_duty_cycle(duty).is_ok());
        before && after && (floats || enable.set_high().is_ok())
    }

    /// No current; returns `false`.
    fn float(&mut self) -> bool {
        for (enable, pwm) in self.enables.iter_mut().zip(&mut self.pwm) {
            // The common enable wire is the other lock.
            let _ = enable.set_low();
            let _ = pwm.set_duty_cycle_fully_off();
        }
        false
    }
}

impl<P: SetDutyCycle, E: OutputPin, H: InputPin> Bridge for ThreePwm<P, E, H> {
    fn set(&mut self, duty: f32) -> bool {
        self.duty = duty;
        self.commutate()
    }

    fn off(&mut self) {
        // NaN: the next edge finds no share to apply.
        self.duty = f32::NAN;
        self.float();
    }
}

#[cfg(test)]
mod tests;
