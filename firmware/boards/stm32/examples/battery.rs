//! `battery`: bench test of the battery voltage.
//!
//! Connect: the battery, or a supply in its place; motors and kicker unplugged. See: its voltage, within 2 %
//! of a meter's. If it differs, the divider is another (`src/analog.rs`). The governor brakes a robot whose
//! battery is low for a while (`firmware/brain/src/governor.rs`), so a wrong divider keeps it from driving at
//! all.
#![allow(unsafe_code, reason = "registers, interrupts and flash are reached by address")]
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
#[embassy_executor::main]
async fn main(spawner: embassy_executor::Spawner) {
    let _ = spawner;
    use board_kit::sampling::AnalogInputs as _;
    use board_stm32::drivers;

    let mut analog = drivers::analog(board_stm32::start().analog);
    loop {
        defmt::info!("{=f32} V", analog.battery());
        embassy_time::Timer::after_secs(1).await;
    }
}

#[cfg(not(target_os = "none"))]
fn main() {}
