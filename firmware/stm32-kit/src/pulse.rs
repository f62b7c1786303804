//! `pulse`: one-shot hardware pulses of exact length, even if the program stops. A timer that counts once to
//! its end and stops (one-pulse mode: RM0433, 39.3.15; RM0090, 19.3.10).
//!
//! The driver of embassy-stm32 starts such a pulse from a pin only, and supports no timers of one or two
//! channels; these are started by the program and end by themselves. A microsecond is a tick.

use embassy_stm32::Peri;
use embassy_stm32::gpio::{AfType, Flex, OutputType, Pin, Speed};
use embassy_stm32::time::Hertz;
use embassy_stm32::timer::low_level::Timer;
use embassy_stm32::timer::{
    AdvancedInstance1Channel, AdvancedInstance2Channel, GeneralInstance1Channel, GeneralInstance2Channel,
};
use protocol::Duration;

/// The coil that a pulse fires.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coil {
    /// The coil of the flat kicker.
    Flat,
    /// The coil of the chip kicker.
    Chip,
}

/// One pulse at a time into one of two coils.
#[allow(missing_debug_implementations, reason = "the chip's drivers have none")]
pub struct Coils<T: GeneralInstance2Channel> {
    timer: Timer<'static, T>,
    _pins: [Option<Flex<'static>>; 2],
}

impl<T: GeneralInstance2Channel> Coils<T> {
    /// Both coils without current, on a timer without a main output enable. The pins: [`wire`].
    pub fn new(timer: Peri<'static, T>, flat: Flex<'static>, chip: Flex<'static>) -> Self {
        Self::on(timer, [Some(flat), Some(chip)])
    }

    fn on(timer: Peri<'static, T>, pins: [Option<Flex<'static>>; 2]) -> Self {
        let mut timer = Timer::new(timer);
        timer.set_tick_freq(Hertz::mhz(1));
        let registers = timer.regs_2ch();
        registers.cr1().modify(|control| {
            control.set_opm(true);
            control.set_arpe(false);
        });
        // Low until the count reaches the compare value, then high to the end. With a compare value that is
        // never reached there is no pulse.
        registers.ccmr_output(0).modify(|mode| {
            mode.set_ocm(0, PWM_MODE2.into());
            mode.set_ocm(1, PWM_MODE2.into());
        });
        for channel in 0..2 {
            registers.ccr(channel).write(|compare| compare.set_ccr(COMPARE_NEVER));
            registers.ccer().modify(|enable| enable.set_cce(channel, true));
        }
        // Applies the new prescaler.
        timer.generate_update_event();
        Self { timer, _pins: pins }
    }

    /// Coils as of [`Self::new`], on a timer whose outputs need their main enable.
    pub fn with_main_output(timer: Peri<'static, T>, flat: Flex<'static>, chip: Flex<'static>) -> Self
    where
        T: AdvancedInstance2Channel,
    {
        let new = Self::new(timer, flat, chip);
        new.timer.regs_2ch_cmp().bdtr().modify(|outputs| outputs.set_moe(true));
        new
    }

    /// Current into that coil for the time `long`, at most [`PULSE_MAX`]; `false` and nothing while a pulse
    /// runs.
    pub fn fire(&mut self, coil: Coil, long: Duration) -> bool {
        let registers = self.timer.regs_2ch();
        if registers.cr1().read().cen() {
            return false;
        }
        let micros = long.0.clamp(1, PULSE_MAX.0) as u16;
        let compare = match coil {
            Coil::Flat => [1, COMPARE_NEVER],
            Coil::Chip => [COMPARE_NEVER, 1],
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

/// The charger, which runs on for [`CHARGE_HOLD_TIME`] after each request.
pub trait Charger {
    /// Runs for [`CHARGE_HOLD_TIME`] from now.
    fn run(&mut self);

    /// Switches off at once.
    fn stop(&mut self);
}

/// The charger's wire, on a timer of one channel with a main output enable.
#[allow(missing_debug_implementations, reason = "the chip's drivers have none")]
pub struct MainOutputCharger<T: AdvancedInstance1Channel> {
    timer: Timer<'static, T>,
    _pin: Flex<'static>,
}

impl<T: AdvancedInstance1Channel> MainOutputCharger<T> {
    /// Charger switched off. The pin: [`wire`].
    pub fn new(timer: Peri<'static, T>, pin: Flex<'static>) -> Self {
        let mut timer = Timer::new(timer);
        timer.set_tick_freq(Hertz::mhz(1));
        let registers = timer.regs_1ch_cmp();
        registers.cr1().modify(|control| {
            control.set_opm(true);
            control.set_arpe(false);
        });
        registers.ccmr_output(0).modify(|mode| mode.set_ocm(0, PWM_MODE2.into()));
        registers.ccr(0).write(|compare| compare.set_ccr(1));
        registers.arr().write(|end| end.set_arr(CHARGE_HOLD_TIME.0 as u16));
        registers.ccer().modify(|enable| enable.set_cce(0, true));
        timer.generate_update_event();
        registers.bdtr().modify(|outputs| outputs.set_moe(true));
        Self { timer, _pin: pin }
    }
}

impl<T: AdvancedInstance1Channel> Charger for MainOutputCharger<T> {
    fn run(&mut self) {
        restart(&self.timer);
    }

    fn stop(&mut self) {
        halt(&self.timer);
    }
}

/// The charger's wire, on the first channel of a timer of two.
#[allow(missing_debug_implementations, reason = "the chip's drivers have none")]
pub struct TwoChannelCharger<T: GeneralInstance2Channel> {
    pulses: Coils<T>,
}

impl<T: GeneralInstance2Channel> TwoChannelCharger<T> {
    /// Charger switched off. The pin: [`wire`].
    pub fn new(timer: Peri<'static, T>, pin: Flex<'static>) -> Self {
        let pulses = Coils::on(timer, [Some(pin), None]);
        let registers = pulses.timer.regs_2ch();
        registers.ccr(0).write(|compare| compare.set_ccr(1));
        registers.arr().write(|end| end.set_arr(CHARGE_HOLD_TIME.0 as u16));
        Self { pulses }
    }
}

impl<T: GeneralInstance2Channel> Charger for TwoChannelCharger<T> {
    fn run(&mut self) {
        restart(&self.pulses.timer);
    }

    fn stop(&mut self) {
        halt(&self.pulses.timer);
    }
}

/// Runs the timer to its end, from the count at which its output rises.
fn restart<T: GeneralInstance1Channel>(timer: &Timer<'static, T>) {
    let registers = timer.regs_1ch();
    registers.cnt().write(|count| count.set_cnt(1));
    registers.cr1().modify(|control| control.set_cen(true));
}

fn halt<T: GeneralInstance1Channel>(timer: &Timer<'static, T>) {
    let registers = timer.regs_1ch();
    registers.cr1().modify(|control| control.set_cen(false));
    registers.cnt().write(|count| count.set_cnt(0));
}

/// A pin that its timer drives, by the number of its alternate function (the chip's data sheet).
pub fn wire(pin: Peri<'static, impl Pin>, function: u8) -> Flex<'static> {
    let mut pin = Flex::new(pin);
    pin.set_as_af_unchecked(function, AfType::output(OutputType::PushPull, Speed::Low));
    pin
}

/// No pulse is longer, for any request; the kicker's own table ends there.
pub const PULSE_MAX: Duration = Duration::millis(6);
/// Time for which the charger runs on without another request: three steps of the kicker.
pub const CHARGE_HOLD_TIME: Duration = Duration::millis(3);
/// Output compare mode, low until the compare value, then high (OC1M; its type has another name on each
/// family).
const PWM_MODE2: u8 = 7;
/// A count that no pulse reaches.
const COMPARE_NEVER: u16 = u16::MAX;
