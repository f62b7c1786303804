//! `analog`: ADC inputs: battery, capacitor and break-beam sensor. Three voltages, read one after the other,
//! some 10 µs each.

use board_kit::sampling::AnalogInputs;
use embassy_stm32::Peri;
use embassy_stm32::adc::{Adc, AdcChannel, AnyAdcChannel, SampleTime};
use embassy_stm32::gpio::{Level, Output, Pin, Speed};
use embassy_stm32::peripherals::ADC1;

/// The converter, its three inputs, and the lamp.
#[allow(missing_debug_implementations, reason = "the chip's drivers have none")]
pub struct Analog {
    converter: Adc<'static, ADC1>,
    settings: AnalogSettings,
    battery: AnyAdcChannel<'static, ADC1>,
    capacitor: AnyAdcChannel<'static, ADC1>,
    break_beam: AnyAdcChannel<'static, ADC1>,
    lamp: Output<'static>,
}

/// Choices of a board about its analog inputs.
#[derive(Clone, Copy)]
#[allow(missing_debug_implementations, reason = "the chip's types have none")]
pub struct AnalogSettings {
    /// Sampling time; dividers of some 10 kΩ need half a microsecond.
    pub time: SampleTime,
    /// Reading at the supply's voltage.
    pub full: u16,
    /// Reference of the converter, the chip's own supply, V.
    pub supply: f32,
    /// Ratio of the battery's divider.
    pub battery: f32,
    /// Ratio of the capacitor's divider.
    pub capacitor: f32,
}

impl Analog {
    /// Calibrates the converter; the lamp is dark.
    pub fn new(
        converter: Peri<'static, ADC1>,
        battery: impl AdcChannel<ADC1> + 'static,
        capacitor: impl AdcChannel<ADC1> + 'static,
        break_beam: impl AdcChannel<ADC1> + 'static,
        lamp: Peri<'static, impl Pin>,
        settings: AnalogSettings,
    ) -> Self {
        Self {
            converter: Adc::new(converter),
            settings,
            battery: battery.degrade_adc(),
            capacitor: capacitor.degrade_adc(),
            break_beam: break_beam.degrade_adc(),
            lamp: Output::new(lamp, Level::Low, Speed::Low),
        }
    }

    fn share(&self, raw: u16) -> f32 {
        f32::from(raw) / f32::from(self.settings.full)
    }
}

impl AnalogInputs for Analog {
    fn battery(&mut self) -> f32 {
        let raw = self.converter.blocking_read(&mut self.battery, self.settings.time);
        self.share(raw) * self.settings.supply * self.settings.battery
    }

    fn capacitor(&mut self) -> f32 {
        let raw = self.converter.blocking_read(&mut self.capacitor, self.settings.time);
        self.share(raw) * self.settings.supply * self.settings.capacitor
    }

    fn break_beam(&mut self) -> f32 {
        let raw = self.converter.blocking_read(&mut self.break_beam, self.settings.time);
        self.share(raw)
    }

    fn light(&mut self, lit: bool) {
        self.lamp.set_level(if lit { Level::High } else { Level::Low });
    }
}
