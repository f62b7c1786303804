//! `base`: a base station: the host's serial line where a robot has its modem, and a radio chip nRF24L01+.
//!
//! The green lamp blinks once the host has spoken and the chip works; the red one is lit for a second before
//! it starts again because the chip does not answer. It has no page and no keys.
#![allow(unsafe_code, reason = "registers, interrupts and flash are reached by address")]
#![allow(
    clippy::large_futures,
    clippy::used_underscore_binding,
    reason = "the executor's macro keeps the main task, 19 kB, in static memory and names its argument"
)]
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
#[embassy_executor::main]
async fn main(spawner: embassy_executor::Spawner) {
    let _ = spawner;
    use board_stm32::drivers;
    use stm32_kit::pwm::low;

    let parts = board_stm32::start();
    board_kit::robot::log_crash(&board_stm32::fault::crash_record());
    let (mut alarm, alive) = (low(parts.lamps.alarm), low(parts.lamps.alive));
    if let Some((to_host, from_host)) = drivers::radio(parts.radio) {
        let chip = drivers::radio_chip(parts.chip);
        let _fault = board_kit::base_station::run(from_host, to_host, chip, alive).await;
        defmt::error!("the radio chip does not answer: check its supply and wiring");
    }
    alarm.set_high();
    embassy_time::Timer::after_secs(1).await;
    cortex_m::peripheral::SCB::sys_reset();
}

#[cfg(not(target_os = "none"))]
fn main() {}
