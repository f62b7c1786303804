//! `analog`: ADC inputs: battery, capacitor and break-beam sensor. Three voltages, read one after the other,
//! some 10 µs each.

use embassy_stm32::adc::{Adc, AdcChannel, AnyAdcChannel, SampleTime};
use embassy_stm32::gpio::{Level, Output, Speed};
use embassy_stm32::peripherals::ADC1;

use crate::pins;

/// The converter, its three inputs, and the lamp.
pub struct Analog {
    converter: Adc<'static, ADC1>,
    battery: AnyAdcChannel<'static, ADC1>,
    capacitor: AnyAdcChannel<'static, ADC1>,
    break_beam: AnyAdcChannel<'static, ADC1>,
    lamp: Output<'static>,
}

impl Analog {
    /// Calibrates the converter; the lamp is dark.
    pub fn new(parts: pins::Analog) -> Self {
        Self {
            converter: Adc::new(parts.converter),
            battery: parts.battery.degrade_adc(),
            capacitor: parts.capacitor.degrade_adc(),
            break_beam: parts.break_beam.degrade_adc(),
            lamp: Output::new(parts.lamp, Level::Low, Speed::Low),
        }
    }

    /// Battery voltage, V, from that behind the input's divider; blocks some 10 µs.
    pub fn battery(&mut self) -> f32 {
        share(self.converter.blocking_read(&mut self.battery, TIME)) * SUPPLY * BATTERY_DIVIDER
    }

    /// Voltage of the kicker's capacitor, V.
    pub fn capacitor(&mut self) -> f32 {
        share(self.converter.blocking_read(&mut self.capacitor, TIME)) * SUPPLY * CAPACITOR_DIVIDER
    }

    /// Light at the receiver of the break-beam sensor, 0 to 1.
    pub fn break_beam(&mut self) -> f32 {
        share(self.converter.blocking_read(&mut self.break_beam, TIME))
    }

    /// Switches the lamp of the break-beam sensor; visible with the next step, because a receiver needs some
    /// 100 µs.
    pub fn light(&mut self, lit: bool) {
        self.lamp.set_level(if lit { Level::High } else { Level::Low });
    }
}

/// Share of full range, 16 bits.
fn share(raw: u16) -> f32 {
    f32::from(raw) * (1.0 / 65_535.0)
}

/// Sampling time for dividers of some 10 kΩ.
const TIME: SampleTime = SampleTime::CYCLES64_5;
/// Reference of the converter, the chip's own supply, V.
const SUPPLY: f32 = 3.3;
/// Ratio of 100 kΩ over 10 kΩ: 36 V is full range.
const BATTERY_DIVIDER: f32 = 11.0;
/// Ratio of 1 MΩ over 10 kΩ: 333 V is full range.
const CAPACITOR_DIVIDER: f32 = 101.0;
