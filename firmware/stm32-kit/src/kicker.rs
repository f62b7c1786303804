//! `kicker`: driver of the kicker board: charger and coils by timers that end by themselves; the capacitor
//! stays off its discharge resistor only as long as that is requested again.

use board_kit::sampling;
use embassy_stm32::Peri;
use embassy_stm32::gpio::{Level, Output, Pin, Speed};
use embassy_stm32::timer::GeneralInstance2Channel;
use embassy_time::{Duration, Timer};
use runtime::kicker::{KickerAct, KickerState};
use runtime::ports;

use crate::pulse::{Charger, Coil, Coils};

/// Driver of charger, capacitor and both coils.
#[allow(missing_debug_implementations, reason = "the chip's drivers have none")]
pub struct Kicker<C: GeneralInstance2Channel, P: Charger> {
    coils: Coils<C>,
    charger: P,
    /// High keeps the capacitor from its resistor.
    hold: Output<'static>,
}

impl<C: GeneralInstance2Channel, P: Charger> Kicker<C, P> {
    /// A kicker that discharges.
    pub fn new(coils: Coils<C>, charger: P, hold: Peri<'static, impl Pin>) -> Self {
        Self { coils, charger, hold: Output::new(hold, Level::Low, Speed::Low) }
    }

    async fn pulse(&mut self, coil: Coil, long: protocol::Duration) {
        self.charger.stop();
        if self.coils.fire(coil, long) {
            Timer::after(Duration::from_micros(long.0)).await;
        }
    }
}

impl<C: GeneralInstance2Channel, P: Charger> ports::Kicker for Kicker<C, P> {
    fn state(&mut self) -> KickerState {
        sampling::newest().kicker()
    }

    async fn act(&mut self, act: KickerAct) {
        self.hold.set_level(if act == KickerAct::Bleed { Level::Low } else { Level::High });
        match act {
            KickerAct::Charge => self.charger.run(),
            KickerAct::Rest | KickerAct::Bleed => self.charger.stop(),
            KickerAct::Flat(long) => self.pulse(Coil::Flat, long).await,
            KickerAct::Chip(long) => self.pulse(Coil::Chip, long).await,
        }
        Timer::after(KICKER_PERIOD).await;
    }
}

/// The kicker's step (`runtime::ports::Kicker`).
const KICKER_PERIOD: Duration = Duration::from_millis(1);
