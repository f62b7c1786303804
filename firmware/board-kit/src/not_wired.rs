//! `not_wired`: parts of a new board that are not wired yet. Each keeps its trait's promise the safe way: no
//! current, no reading. `robot::log_not_wired` says so on the log.

use core::future::pending;

use embassy_time::{Duration, Timer};
use protocol::link::Packet;
use runtime::bring_up::LogRing;
use runtime::kicker::{KickerAct, KickerState};
use runtime::ports;
use runtime::wheel::WHEELS;

use crate::encoders::EncoderCounts;
use crate::imu::{Gyroscope, ImuError, Reading};
use crate::motors::MotorDrivers;
use crate::sampling::AnalogInputs;

/// A part that is not there.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct NotWired;

impl MotorDrivers for NotWired {
    fn drive(&mut self, _duty: [f32; WHEELS], _dribbler: f32) {}

    fn release(&mut self) {}

    /// Always a fault: no motor can be driven.
    fn has_fault(&mut self) -> bool {
        true
    }
}

impl EncoderCounts for NotWired {
    const RIM_PER_COUNT: f32 = 0.0;

    fn counts(&self) -> [u16; WHEELS] {
        [0; WHEELS]
    }
}

impl ports::Kicker for NotWired {
    /// Neither ball nor voltage: the interlock neither charges nor fires.
    fn state(&mut self) -> KickerState {
        KickerState { ball: false, volts: f32::NAN }
    }

    async fn act(&mut self, _act: KickerAct) {
        Timer::after(Duration::from_millis(1)).await;
    }
}

impl Gyroscope for NotWired {
    async fn start(&mut self) -> Result<(), ImuError> {
        Err(ImuError::NotWired)
    }

    fn reading(&mut self) -> Result<Reading, ImuError> {
        Err(ImuError::NotWired)
    }
}

impl AnalogInputs for NotWired {
    /// Not known, which brakes the robot.
    fn battery(&mut self) -> f32 {
        f32::NAN
    }

    fn capacitor(&mut self) -> f32 {
        f32::NAN
    }

    fn break_beam(&mut self) -> f32 {
        f32::NAN
    }

    fn light(&mut self, _lit: bool) {}
}

impl ports::RadioReceiver for NotWired {
    async fn receive(&mut self) -> Packet {
        pending().await
    }
}

impl ports::RadioSender for NotWired {
    async fn send(&mut self, _packet: Packet) {}
}

impl ports::Watchdog for NotWired {
    const TIMEOUT: protocol::Duration = protocol::Duration::millis(100);

    fn feed(&mut self) {}
}

impl LogRing for NotWired {
    /// Empty.
    fn look<T>(&self, read: impl FnOnce(&[u8], usize) -> T) -> T {
        read(&[], 0)
    }
}

impl embedded_hal::digital::ErrorType for NotWired {
    type Error = core::convert::Infallible;
}

impl embedded_hal::digital::OutputPin for NotWired {
    fn set_low(&mut self) -> Result<(), Self::Error> {
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Self::Error> {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wheels::Wheels;
    use ports::{Kicker as _, WheelsPort as _};
    use protocol::Instant;
    use protocol::robot_io::OmniKick;
    use runtime::kicker::Interlock;

    #[test]
    fn parts_that_are_not_wired_never_fire_and_count_as_broken() {
        let mut interlock = Interlock::new();
        for ms in 0..100 {
            let act = interlock.step(Instant(1000 * ms), OmniKick::Flat(6.0), NotWired.state());
            assert!(!matches!(act, KickerAct::Flat(_) | KickerAct::Chip(_) | KickerAct::Charge), "{act:?}");
        }
        assert!(NotWired.has_fault() && NotWired.battery().is_nan());
        let mut wheels = Wheels::new(NotWired, NotWired);
        wheels.drive([1.0; WHEELS], 1.0);
        wheels.release();
    }
}
