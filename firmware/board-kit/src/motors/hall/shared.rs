//! `shared`: a motor with hall sensors that the control loop and the interrupt of its sensors' edges share.
//!
//! A board has a static of four, wires a driver into each, gives references to
//! [`Bridges`](crate::motors::Bridges), and calls [`HallMotor::edge`] in the interrupt:
//!
//! ```text
//! static MOTORS: [HallMotor<Channel, Enable, Sensor>; 4] = [const { HallMotor::new() }; 4];
//!
//! MOTORS[n].wire(ThreePwm::new(pwm, enables, sensors)); // each, before its interrupt is enabled
//! let drivers = Bridges::new(MOTORS.each_ref(), dribbler, enable, fault);
//! let wheels = Wheels::new(drivers, MOTORS.each_ref()); // the edges are the encoders
//!
//! #[interrupt]
//! fn EXTI9_5() { /* clear the edge */ MOTORS[n].edge(); }
//! ```
//!
//! Each use takes a critical section of some 2 µs (estimate): six PWM and pin writes.

use core::cell::RefCell;

use embassy_sync::blocking_mutex::CriticalSectionMutex;
use embedded_hal::digital::{InputPin, OutputPin};
use embedded_hal::pwm::SetDutyCycle;

use rules::RobotSpec;
use runtime::wheel::WHEELS;

use super::ThreePwm;
use crate::encoders::EncoderCounts;
use crate::motors::Bridge;

/// A motor in a static; without a driver it takes no current and reports a fault.
pub struct HallMotor<P, E, H>(CriticalSectionMutex<RefCell<Option<ThreePwm<P, E, H>>>>);

impl<P, E, H> HallMotor<P, E, H> {
    /// A motor without a driver.
    pub const fn new() -> Self {
        Self(CriticalSectionMutex::new(RefCell::new(None)))
    }
}

impl<P, E, H> Default for HallMotor<P, E, H> {
    fn default() -> Self {
        Self::new()
    }
}

impl<P, E, H> core::fmt::Debug for HallMotor<P, E, H> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str("HallMotor")
    }
}

impl<P: SetDutyCycle, E: OutputPin, H: InputPin> HallMotor<P, E, H> {
    /// Gives it its driver, once, before its interrupt is enabled.
    pub fn wire(&self, driver: ThreePwm<P, E, H>) {
        self.0.lock(|motor| {
            // Never borrowed: every borrow ends with its lock.
            if let Ok(mut motor) = motor.try_borrow_mut() {
                *motor = Some(driver);
            }
        });
    }

    /// At each edge of one of its sensors, from their interrupt: switches the phases on. Whether sensors and
    /// driver answered; if not, all phases float, and the control loop's next call reports the fault.
    pub fn edge(&self) -> bool {
        self.with(ThreePwm::commutate).unwrap_or(false)
    }

    /// Edges of its sensors so far; they wrap.
    pub fn count(&self) -> u16 {
        self.with(|motor| motor.count()).unwrap_or(0)
    }

    fn with<T>(&self, does: impl FnOnce(&mut ThreePwm<P, E, H>) -> T) -> Option<T> {
        self.0.lock(|motor| motor.try_borrow_mut().ok()?.as_mut().map(does))
    }
}

impl<P: SetDutyCycle, E: OutputPin, H: InputPin> Bridge for &HallMotor<P, E, H> {
    fn set(&mut self, duty: f32) -> bool {
        self.with(|motor| motor.set(duty)).unwrap_or(false)
    }

    fn off(&mut self) {
        self.with(Bridge::off);
    }
}

/// The edges of four motors' sensors as encoders: the robot's description gives `counts_a_turn`, six for each
/// pair of poles times the gear.
impl<P: SetDutyCycle, E: OutputPin, H: InputPin> EncoderCounts for [&HallMotor<P, E, H>; WHEELS] {
    const RIM_PER_COUNT: f32 =
        2.0 * core::f32::consts::PI * RobotSpec::OURS.wheels.radius / RobotSpec::OURS.wheels.counts_a_turn;

    fn counts(&self) -> [u16; WHEELS] {
        self.map(HallMotor::count)
    }
}
