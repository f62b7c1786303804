//! `radio`: bench test of the radio's serial line. Received bytes are sent back.
//!
//! Connect: the radio modem; or a USB serial adapter of 3.3 V instead of it, crossed (its TX to our RX). See:
//! from the other end (1 Mbit/s, 8N1) all typed characters come back, and the log counts it. `line errors`
//! rise: another rate, or noise. Nothing comes: TX and RX are not crossed.
#![allow(unsafe_code, reason = "registers, interrupts and flash are reached by address")]
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
#[embassy_executor::main]
async fn main(spawner: embassy_executor::Spawner) {
    let _ = spawner;
    use board_kit::radio;
    use board_stm32::drivers;

    let Some((mut sender, mut receiver)) = drivers::radio(board_stm32::start().radio) else {
        defmt::error!("the line cannot have this rate");
        return;
    };
    let mut received = 0_u32;
    loop {
        let bytes = receiver.bytes().await;
        received = received.wrapping_add(bytes.len() as u32);
        sender.send_bytes(bytes).await;
        defmt::info!("{=u32} bytes, line errors {=u32}", received, radio::line_errors());
    }
}

#[cfg(not(target_os = "none"))]
fn main() {}
