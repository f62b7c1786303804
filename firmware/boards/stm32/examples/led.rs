//! `led`: bench test of chip and log. The first thing to try on a new board.
//!
//! Connect: the probe and the board's supply, nothing else. See: green and red take turns, a second each, and
//! the log counts them. Check the second against a clock: if it differs, the quartz is another
//! (`src/clocks.rs`, feature `crystal`). If nothing happens, the quartz does not run, or the probe does not
//! reach the chip.
#![allow(unsafe_code, reason = "registers, interrupts and flash are reached by address")]
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
#[embassy_executor::main]
async fn main(spawner: embassy_executor::Spawner) {
    let _ = spawner;
    use embassy_stm32::gpio::{Level, Output, Speed};

    let lamps = board_stm32::start().lamps;
    let mut alive = Output::new(lamps.alive, Level::High, Speed::Low);
    let mut alarm = Output::new(lamps.alarm, Level::Low, Speed::Low);
    for second in 0_u32.. {
        defmt::info!("second {=u32}", second);
        embassy_time::Timer::after_secs(1).await;
        alive.toggle();
        alarm.toggle();
    }
}

#[cfg(not(target_os = "none"))]
fn main() {}
