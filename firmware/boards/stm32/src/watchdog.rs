//! `watchdog`: the chip's independent watchdog, which has an oscillator of its own and cannot be stopped.

use embassy_stm32::Peri;
use embassy_stm32::peripherals::IWDG1;
use embassy_stm32::wdg::IndependentWatchdog;
use protocol::Duration;
use runtime::ports::Watchdog;

/// The chip's watchdog, once it is running.
pub struct BoardWatchdog(IndependentWatchdog<'static, IWDG1>);

impl BoardWatchdog {
    /// Starts it; from now on it must be fed, and only a reset ends it.
    pub fn start(watchdog: Peri<'static, IWDG1>) -> Self {
        let mut watchdog = IndependentWatchdog::new(watchdog, PATIENCE.0 as u32);
        watchdog.unleash();
        Self(watchdog)
    }
}

impl Watchdog for BoardWatchdog {
    const PATIENCE: Duration = PATIENCE;

    fn feed(&mut self) {
        self.0.pet();
    }
}

/// Time-out as on the emulated board: ten steps of the brain. Its oscillator is right within 6 %.
const PATIENCE: Duration = Duration::millis(100);
