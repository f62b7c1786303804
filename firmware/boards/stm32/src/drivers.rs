//! `drivers`: the board's parts as drivers, each from its pins.

use embassy_stm32::adc::SampleTime;
use embassy_stm32::gpio::OutputType::PushPull;
use embassy_stm32::mode::Blocking;
use embassy_stm32::peripherals::{IWDG1, TIM1, TIM2, TIM3, TIM4, TIM5, TIM8, TIM15, TIM16};
use embassy_stm32::spi::Spi;
use embassy_stm32::timer::qei::{Config, Qei};
use embassy_stm32::timer::simple_pwm::{PwmPin, SimplePwmChannel};
use embassy_stm32::usart::{self, Uart};
use embassy_stm32::{bind_interrupts, dma, peripherals};
use stm32_kit::analog::AnalogSettings;
use stm32_kit::pulse::{Coils, MainOutputCharger, wire};
use stm32_kit::pwm::{self, WheelPins, low};
use stm32_kit::{analog, encoders, kicker, lines, watchdog};

use crate::pins;

bind_interrupts!(struct Interrupts {
    USART2 => usart::InterruptHandler<peripherals::USART2>;
    DMA1_STREAM0 => dma::InterruptHandler<peripherals::DMA1_CH0>;
    DMA1_STREAM1 => dma::InterruptHandler<peripherals::DMA1_CH1>;
});

/// PWM and direction for four wheels, PWM for the dribbler.
pub type Drivers = pwm::Drivers<TIM1, SimplePwmChannel<'static, TIM5>>;
/// The wheels' counters.
pub type Encoders = encoders::Encoders<TIM2, TIM3, TIM4, TIM8>;
/// Charger and coils.
pub type Kicker = kicker::Kicker<TIM15, MainOutputCharger<TIM16>>;
/// The chip's watchdog.
pub type BoardWatchdog = watchdog::BoardWatchdog<IWDG1>;
/// The drivers of all five motors, without current.
pub fn motors(parts: pins::Motors) -> Drivers {
    let directions = [
        low(parts.dir_front_right),
        low(parts.dir_back_right),
        low(parts.dir_back_left),
        low(parts.dir_front_left),
    ];
    let pins = WheelPins {
        front_right: PwmPin::new(parts.pwm_front_right, PushPull),
        back_right: PwmPin::new(parts.pwm_back_right, PushPull),
        back_left: PwmPin::new(parts.pwm_back_left, PushPull),
        front_left: PwmPin::new(parts.pwm_front_left, PushPull),
    };
    let enable = low(parts.enable);
    let dribbler = pwm::dribbler(parts.dribbler_timer, PwmPin::new(parts.dribbler, PushPull));
    pwm::drivers(parts.timer, pins, directions, dribbler, enable, parts.fault)
}

/// The four quadrature counters, at zero.
pub fn encoders(parts: pins::Encoders) -> Encoders {
    let config = Config::default();
    Encoders {
        front_right: Qei::new(parts.front_right, parts.front_right_a, parts.front_right_b, config),
        back_right: Qei::new(parts.back_right, parts.back_right_a, parts.back_right_b, config),
        back_left: Qei::new(parts.back_left, parts.back_left_a, parts.back_left_b, config),
        front_left: Qei::new(parts.front_left, parts.front_left_a, parts.front_left_b, config),
    }
}

/// A kicker that discharges.
pub fn kicker(parts: pins::Kicker) -> Kicker {
    let (flat, chip) = (wire(parts.flat, COILS_FUNCTION), wire(parts.chip, COILS_FUNCTION));
    let coils = Coils::with_main_output(parts.coils, flat, chip);
    let charger = MainOutputCharger::new(parts.charger, wire(parts.charge, CHARGER_FUNCTION));
    Kicker::new(coils, charger, parts.hold)
}

/// The IMU, not started yet.
pub fn imu(parts: pins::Imu) -> lines::BoardImu {
    let bus: Spi<'static, Blocking, _> =
        Spi::new_blocking(parts.bus, parts.clock, parts.to, parts.from, lines::imu_config());
    lines::imu(bus, parts.select)
}

/// The measured voltages; the lamp of the break-beam sensor is dark.
pub fn analog(parts: pins::Analog) -> analog::Analog {
    let pins::Analog { converter, battery, capacitor, break_beam, lamp } = parts;
    analog::Analog::new(converter, battery, capacitor, break_beam, lamp, ANALOG)
}

/// Both directions of the radio's line; `None` where it cannot have this rate. Call once.
pub fn radio(parts: pins::Radio) -> Option<(lines::Sender, lines::Receiver)> {
    let config = lines::radio_config();
    let line =
        Uart::new(parts.line, parts.rx, parts.tx, parts.tx_dma, parts.rx_dma, Interrupts, config).ok()?;
    Some(lines::radio(line))
}

/// The radio chip's wires.
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
