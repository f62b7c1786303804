//! `watchdog`: the chip's independent watchdog, which has an oscillator of its own and cannot be stopped.

use embassy_stm32::Peri;
use embassy_stm32::wdg::{IndependentWatchdog, Instance};
use protocol::Duration;
use runtime::ports::Watchdog;

/// The chip's watchdog, once it is running.
#[allow(missing_debug_implementations, reason = "the chip's drivers have none")]
pub struct BoardWatchdog<T: Instance + 'static>(IndependentWatchdog<'static, T>);

impl<T: Instance + 'static> BoardWatchdog<T> {
    /// Starts it; from now on it must be fed, and only a reset ends it.
    pub fn start(watchdog: Peri<'static, T>) -> Self {
        let mut watchdog = IndependentWatchdog::new(watchdog, TIMEOUT.0 as u32);
        watchdog.unleash();
        Self(watchdog)
    }
}

impl<T: Instance + 'static> Watchdog for BoardWatchdog<T> {
    const TIMEOUT: Duration = TIMEOUT;

    fn feed(&mut self) {
        self.0.pet();
    }
}

/// Time-out as on the emulated board: ten steps of the brain. Its oscillator is right within 6 % on an
/// STM32H7; on an STM32F4 it runs between 17 and 47 kHz, so that the time is 70 to 190 ms.
const TIMEOUT: Duration = Duration::millis(100);
