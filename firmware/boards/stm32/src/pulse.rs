//! `pulse`: one-shot hardware pulses of exact length, even if the program stops. A timer that counts once to
//! its end and stops (RM0433, 39.3.15: one-pulse mode).
//!
//! The driver of embassy-stm32 starts such a pulse from a pin only, and supports no timers of one or two
//! channels; these are started by the program and end by themselves. A microsecond is a tick.

use embassy_stm32::Peri;
use embassy_stm32::gpio::{AfType, Flex, OutputType, Pin, Speed};
use embassy_stm32::pac::timer::vals::{Ocm, OcmLimited};
use embassy_stm32::peripherals::{TIM15, TIM16};
use embassy_stm32::time::Hertz;
use embassy_stm32::timer::low_level::Timer;
use protocol::Duration;

use crate::pins;

/// The coil that a pulse fires.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coil {
    /// The coil of the flat kicker.
    Flat,
    /// The coil of the chip kicker.
    Chip,
}

/// One pulse at a time into one of two coils.
pub struct Coils {
    timer: Timer<'static, TIM15>,
    _pins: [Flex<'static>; 2],
}

impl Coils {
    /// Both coils without current.
    fn new(timer: Peri<'static, TIM15>, flat: Flex<'static>, chip: Flex<'static>) -> Self {
        let mut timer = Timer::new(timer);
        timer.set_tick_freq(Hertz::mhz(1));
        let registers = timer.regs_2ch_cmp();
        registers.cr1().modify(|control| {
            control.set_opm(true);
            control.set_arpe(false);
        });
        // Low until the count reaches the compare value, then high to the end. With a compare value that is
        // never reached there is no pulse.
        registers.ccmr_output().modify(|mode| {
            mode.set_ocm(0, Ocm::PWM_MODE2);
            mode.set_ocm(1, Ocm::PWM_MODE2);
        });
        for channel in 0..2 {
            registers.ccr(channel).write(|compare| compare.set_ccr(NEVER));
            registers.ccer().modify(|enable| enable.set_cce(channel, true));
        }
        // Applies the new prescaler.
        timer.generate_update_event();
        registers.bdtr().modify(|outputs| outputs.set_moe(true));
        Self { timer, _pins: [flat, chip] }
    }

    /// Current into that coil for the time `long`, at most [`PULSE_MAX`]; `false` and nothing while a pulse
    /// runs.
    pub fn fire(&mut self, coil: Coil, long: Duration) -> bool {
        let registers = self.timer.regs_2ch_cmp();
        if registers.cr1().read().cen() {
            return false;
        }
        let micros = long.0.clamp(1, PULSE_MAX.0) as u16;
        let compare = match coil {
            Coil::Flat => [1, NEVER],
            Coil::Chip => [NEVER, 1],
        };
        for (channel, compare) in compare.into_iter().enumerate() {
            registers.ccr(channel).write(|register| register.set_ccr(compare));
        }
        registers.arr().write(|end| end.set_arr(micros));
        registers.cnt().write(|count| count.set_cnt(0));
        registers.cr1().modify(|control| control.set_cen(true));
        true
    }
}

/// The charger, which runs on for three milliseconds after each request.
pub struct Charger {
    timer: Timer<'static, TIM16>,
    _pin: Flex<'static>,
}

impl Charger {
    /// Charger switched off.
    fn new(timer: Peri<'static, TIM16>, pin: Flex<'static>) -> Self {
        let mut timer = Timer::new(timer);
        timer.set_tick_freq(Hertz::mhz(1));
        let registers = timer.regs_1ch_cmp();
        registers.cr1().modify(|control| {
            control.set_opm(true);
            control.set_arpe(false);
        });
        registers.ccmr_output(0).modify(|mode| mode.set_ocm(0, OcmLimited::PWM_MODE2));
        registers.ccr(0).write(|compare| compare.set_ccr(1));
        registers.arr().write(|end| end.set_arr(CHARGE_RUNS_ON.0 as u16));
        registers.ccer().modify(|enable| enable.set_cce(0, true));
        timer.generate_update_event();
        registers.bdtr().modify(|outputs| outputs.set_moe(true));
        Self { timer, _pin: pin }
    }

    /// Runs for [`CHARGE_RUNS_ON`] from now.
    pub fn run(&mut self) {
        let registers = self.timer.regs_1ch_cmp();
        registers.cnt().write(|count| count.set_cnt(1));
        registers.cr1().modify(|control| control.set_cen(true));
    }

    /// Switches off at once.
    pub fn stop(&mut self) {
        let registers = self.timer.regs_1ch_cmp();
        registers.cr1().modify(|control| control.set_cen(false));
        registers.cnt().write(|count| count.set_cnt(0));
    }
}

/// Coils and charger of the board.
pub fn of(parts: pins::Kicker) -> (Coils, Charger, Peri<'static, embassy_stm32::peripherals::PE4>) {
    let coils = Coils::new(parts.coils, wire(parts.flat, COILS_FUNCTION), wire(parts.chip, COILS_FUNCTION));
    (coils, Charger::new(parts.charger, wire(parts.charge, CHARGER_FUNCTION)), parts.hold)
}

/// A pin that its timer drives.
fn wire(pin: Peri<'static, impl Pin>, function: u8) -> Flex<'static> {
    let mut pin = Flex::new(pin);
    pin.set_as_af_unchecked(function, AfType::output(OutputType::PushPull, Speed::Low));
    pin
}

/// No pulse is longer, for any request; the kicker's own table ends there.
pub const PULSE_MAX: Duration = Duration::millis(6);
/// How long the charger runs on without another request: three steps of the kicker.
pub const CHARGE_RUNS_ON: Duration = Duration::millis(3);
/// A count that no pulse reaches.
const NEVER: u16 = u16::MAX;
/// TIM15 on PE5 and PE6, TIM16 on PB8 (DS12110, tables 10 and 13).
const COILS_FUNCTION: u8 = 4;
const CHARGER_FUNCTION: u8 = 1;
