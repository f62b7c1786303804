//! `clocks`: clock tree. 400 MHz from a quartz of 8 MHz: the maximum for every revision of the chip (480 MHz
//! is for later ones).

use embassy_stm32::Config;
use embassy_stm32::rcc::{
    AHBPrescaler, APBPrescaler, Hse, HseMode, LsConfig, Pll, PllDiv, PllMul, PllPreDiv, PllSource, Sysclk,
    VoltageScale, mux,
};
use embassy_stm32::time::Hertz;

/// Core 400 MHz, buses 200 MHz, peripherals 100 MHz, timers 200 MHz (RM0433, 8.5).
pub fn config() -> Config {
    let mut config = Config::default();
    let rcc = &mut config.rcc;
    rcc.hse = Some(Hse { freq: QUARTZ, mode: QUARTZ_MODE });
    // 8 MHz / 2 × 200 = 800 MHz.
    rcc.pll1 = Some(Pll {
        source: PllSource::HSE,
        prediv: PllPreDiv::DIV2,
        mul: PllMul::MUL200,
        fracn: None,
        divp: Some(PllDiv::DIV2),
        // SPI: 200 MHz.
        divq: Some(PllDiv::DIV4),
        divr: None,
    });
    rcc.sys = Sysclk::PLL1_P;
    rcc.voltage_scale = VoltageScale::Scale1;
    rcc.ahb_pre = AHBPrescaler::DIV2;
    rcc.apb1_pre = APBPrescaler::DIV2;
    rcc.apb2_pre = APBPrescaler::DIV2;
    rcc.apb3_pre = APBPrescaler::DIV2;
    rcc.apb4_pre = APBPrescaler::DIV2;
    // The analogue converters by the chip's own 64 MHz.
    rcc.mux.adcsel = mux::Adcsel::PER;
    // No calendar; its registers keep the record of the last boot epoch (`fault`), and the watchdog starts
    // its own oscillator.
    rcc.ls = LsConfig::off();
    config
}

/// Frequency of the quartz on a NUCLEO-H743ZI2, as on most robots' boards.
const QUARTZ: Hertz = Hertz(8_000_000);
const QUARTZ_MODE: HseMode = if cfg!(feature = "crystal") { HseMode::Oscillator } else { HseMode::Bypass };
