//! `drivers`: the board's parts as drivers, each from its pins.

use embassy_stm32::adc::SampleTime;
use embassy_stm32::mode::Blocking;
use embassy_stm32::peripherals::{IWDG1, TIM1, TIM2, TIM3, TIM4, TIM5, TIM8, TIM15, TIM16};
use embassy_stm32::spi::Spi;
use embassy_stm32::timer::simple_pwm::SimplePwmChannel;
use embassy_stm32::usart;
use embassy_stm32::{bind_interrupts, dma, peripherals};
use stm32_kit::analog::AnalogSettings;
use stm32_kit::pulse::{Coils, MainOutputCharger, wire};
use stm32_kit::{encoders, kicker, lines, pwm, watchdog};

use crate::pins;

bind_interrupts!(struct Interrupts {
    USART2 => usart::InterruptHandler<peripherals::USART2>;
    DMA1_STREAM0 => dma::InterruptHandler<peripherals::DMA1_CH0>;
    DMA1_STREAM1 => dma::InterruptHandler<peripherals::DMA1_CH1>;
});

/// PWM and direction for four wheels, PWM for the dribbler.
pub type Drivers = pwm::Drivers<TIM1, SimplePwmChannel<'static, TIM5>>;
/// Counters of the four wheels' encoders.
pub type Encoders = encoders::Encoders<TIM2, TIM3, TIM4, TIM8>;
/// Charger and coils of the kicker.
pub type Kicker = kicker::Kicker<TIM15, MainOutputCharger<TIM16>>;
/// Independent watchdog of the chip.
pub type BoardWatchdog = watchdog::BoardWatchdog<IWDG1>;

stm32_kit::drivers!(
    dribbler: |parts| pwm::dribbler(parts.dribbler_timer, PwmPin::new(parts.dribbler, PushPull)),
    interrupts: Interrupts,
    analog: ANALOG
);

/// A kicker that discharges.
pub fn kicker(parts: pins::Kicker) -> Kicker {
    let (flat, chip) = (wire(parts.flat, COILS_FUNCTION), wire(parts.chip, COILS_FUNCTION));
    let coils = Coils::with_main_output(parts.coils, flat, chip);
    let charger = MainOutputCharger::new(parts.charger, wire(parts.charge, CHARGER_FUNCTION));
    Kicker::new(coils, charger, parts.hold)
}

/// Wires of the radio chip on its bus.
pub fn radio_chip(parts: pins::Chip) -> lines::RadioChip {
    let bus: Spi<'static, Blocking, _> =
        Spi::new_blocking(parts.bus, parts.clock, parts.to, parts.from, lines::chip_config());
    lines::chip(bus, parts.select, parts.enable, parts.news)
}

/// TIM15 on PE5 and PE6, TIM16 on PB8 (DS12110, tables 10 and 13).
const COILS_FUNCTION: u8 = 4;
const CHARGER_FUNCTION: u8 = 1;
/// Converter of 16 bits; dividers of 100 kΩ over 10 kΩ (36 V is full range) and of 1 MΩ over 10 kΩ (333 V).
const ANALOG: AnalogSettings = AnalogSettings {
    time: SampleTime::CYCLES64_5,
    full: u16::MAX,
    supply: 3.3,
    battery: 11.0,
    capacitor: 101.0,
};
