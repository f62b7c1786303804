//! `drivers`: the board's parts as drivers, each from its pins.

use embassy_stm32::adc::SampleTime;
use embassy_stm32::peripherals::{IWDG, TIM1, TIM2, TIM3, TIM4, TIM8, TIM9, TIM11, TIM12};
use embassy_stm32::usart;
use embassy_stm32::{bind_interrupts, dma, peripherals};
use stm32_kit::analog::AnalogSettings;
use stm32_kit::pulse::{Coils, TwoChannelCharger, wire};
use stm32_kit::pwm::{self, OneChannelPwm};
use stm32_kit::{encoders, kicker, watchdog};

use crate::pins;

bind_interrupts!(struct Interrupts {
    USART2 => usart::InterruptHandler<peripherals::USART2>;
    DMA1_STREAM5 => dma::InterruptHandler<peripherals::DMA1_CH5>;
    DMA1_STREAM6 => dma::InterruptHandler<peripherals::DMA1_CH6>;
});

/// PWM and direction for four wheels, PWM for the dribbler.
pub type Drivers = pwm::Drivers<TIM1, OneChannelPwm<TIM11>>;
/// Counters of the four wheels' encoders.
pub type Encoders = encoders::Encoders<TIM2, TIM3, TIM4, TIM8>;
/// Charger and coils of the kicker.
pub type Kicker = kicker::Kicker<TIM9, TwoChannelCharger<TIM12>>;
/// Independent watchdog of the chip.
pub type BoardWatchdog = watchdog::BoardWatchdog<IWDG>;

stm32_kit::drivers!(
    dribbler: |parts| OneChannelPwm::new(parts.dribbler_timer, wire(parts.dribbler, DRIBBLER_FUNCTION)),
    interrupts: Interrupts,
    analog: ANALOG
);

/// A kicker that discharges.
pub fn kicker(parts: pins::Kicker) -> Kicker {
    let (flat, chip) = (wire(parts.flat, COILS_FUNCTION), wire(parts.chip, COILS_FUNCTION));
    let coils = Coils::new(parts.coils, flat, chip);
    let charger = TwoChannelCharger::new(parts.charger, wire(parts.charge, CHARGER_FUNCTION));
    Kicker::new(coils, charger, parts.hold)
}

/// TIM9 on PE5 and PE6, TIM12 on PB14, TIM11 on PB9 (DS8626, table 9).
const COILS_FUNCTION: u8 = 3;
const CHARGER_FUNCTION: u8 = 9;
const DRIBBLER_FUNCTION: u8 = 3;
/// Converter of 12 bits; dividers of 100 kΩ over 10 kΩ (36 V is full range) and of 1 MΩ over 10 kΩ (333 V).
const ANALOG: AnalogSettings =
    AnalogSettings { time: SampleTime::CYCLES56, full: 4095, supply: 3.3, battery: 11.0, capacitor: 101.0 };
