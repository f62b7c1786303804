//! `clocks`: clock tree. 168 MHz, the chip's maximum, from a crystal of 8 MHz.

use embassy_stm32::Config;
use embassy_stm32::rcc::{
    AHBPrescaler, APBPrescaler, Hse, HseMode, LsConfig, Pll, PllMul, PllPDiv, PllPreDiv, PllSource, Sysclk,
};
use embassy_stm32::time::Hertz;

/// Core 168 MHz, APB1 42 MHz (its timers 84 MHz), APB2 84 MHz (its timers 168 MHz), converter 21 MHz
/// (RM0090, 6.2 and 13.13.16).
pub fn config() -> Config {
    let mut config = Config::default();
    let rcc = &mut config.rcc;
    rcc.hse = Some(Hse { freq: CRYSTAL, mode: HseMode::Oscillator });
    rcc.pll_src = PllSource::HSE;
    // 8 MHz / 4 × 168 = 336 MHz.
    rcc.pll = Some(Pll {
        prediv: PllPreDiv::DIV4,
        mul: PllMul::MUL168,
        divp: Some(PllPDiv::DIV2),
        divq: None,
        divr: None,
    });
    rcc.sys = Sysclk::PLL1_P;
    rcc.ahb_pre = AHBPrescaler::DIV1;
    rcc.apb1_pre = APBPrescaler::DIV4;
    rcc.apb2_pre = APBPrescaler::DIV2;
    // No calendar; its registers keep the record of the last boot epoch (`fault`), and the watchdog starts
    // its own oscillator.
    rcc.ls = LsConfig::off();
    config
}

/// Frequency of the crystal on an STM32F407G-DISC1, as on most robots' boards.
const CRYSTAL: Hertz = Hertz(8_000_000);
