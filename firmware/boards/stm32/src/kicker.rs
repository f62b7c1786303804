//! `kicker`: driver of the kicker board: charger and coils by timers that end by themselves; the capacitor
//! stays off its discharge resistor only as long as that is requested again.

use embassy_stm32::gpio::{Level, Output, Speed};
use embassy_time::{Duration, Timer};
use runtime::kicker::{KickerAct, KickerState};
use runtime::ports;

use crate::pins;
use crate::pulse::{self, Charger, Coil, Coils};
use crate::sampling;

/// Driver of charger, capacitor and both coils.
pub struct Kicker {
    coils: Coils,
    charger: Charger,
    /// High keeps the capacitor from its resistor.
    hold: Output<'static>,
}

impl Kicker {
    /// A kicker that discharges.
    pub fn new(parts: pins::Kicker) -> Self {
        let (coils, charger, hold) = pulse::of(parts);
        Self { coils, charger, hold: Output::new(hold, Level::Low, Speed::Low) }
    }

    async fn pulse(&mut self, coil: Coil, long: protocol::Duration) {
        self.charger.stop();
        if self.coils.fire(coil, long) {
            Timer::after(Duration::from_micros(long.0)).await;
        }
    }
}

impl ports::Kicker for Kicker {
    fn state(&mut self) -> KickerState {
        let newest = sampling::newest();
        KickerState { ball: newest.ball, volts: newest.capacitor }
    }

    async fn act(&mut self, act: KickerAct) {
        self.hold.set_level(if act == KickerAct::Bleed { Level::Low } else { Level::High });
        match act {
            KickerAct::Charge => self.charger.run(),
            KickerAct::Rest | KickerAct::Bleed => self.charger.stop(),
            KickerAct::Flat(long) => self.pulse(Coil::Flat, long).await,
            KickerAct::Chip(long) => self.pulse(Coil::Chip, long).await,
        }
        Timer::after(STEP).await;
    }
}

/// The kicker's step (`runtime::ports::Kicker`).
const STEP: Duration = Duration::from_millis(1);
