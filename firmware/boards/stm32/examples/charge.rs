//! `charge`: bench test of the kicker's capacitor: it charges, its voltage is right, and it discharges.
//! Nothing is fired.
//!
//! **Up to 60 V on the kicker's board: touch nothing, one hand in the pocket; both coils unplugged, and a
//! voltmeter on the capacitor that you trust.** Set the charger's own limit first. Connect: the kicker's
//! board and its supply. See: the voltage rises to 50 V within some tenths of a second, in the log as on the
//! meter, then falls to under 30 V, and again, three times. If log and meter differ, the divider is another
//! (`src/analog.rs`). If it does not fall, the resistor or its wire `hold` is not connected, **do not go
//! on**. If it does not rise, the test gives up after two seconds.
#![allow(unsafe_code, reason = "registers, interrupts and flash are reached by address")]
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
#[embassy_executor::main]
async fn main(spawner: embassy_executor::Spawner) {
    let _ = spawner;
    use board_kit::sampling::AnalogInputs as _;
    use board_stm32::drivers;
    use embassy_time::{Duration, Instant, Timer};
    use runtime::kicker::KickerAct;
    use runtime::ports::Kicker as _;

    /// Voltage to charge to, V: below extra-low voltage's 60 V.
    const CHARGED_V: f32 = 50.0;
    const EMPTY: f32 = 30.0;

    let parts = board_stm32::start();
    let (mut kicker, mut analog) = (drivers::kicker(parts.kicker), drivers::analog(parts.analog));
    for round in 1..=3_u8 {
        let begun = Instant::now();
        while analog.capacitor() < CHARGED_V && begun.elapsed() < Duration::from_secs(2) {
            kicker.act(KickerAct::Charge).await;
        }
        let took = begun.elapsed().as_millis();
        defmt::info!("round {=u8}: {=f32} V after {=u64} ms", round, analog.capacitor(), took);
        let begun = Instant::now();
        while analog.capacitor() >= EMPTY && begun.elapsed() < Duration::from_secs(30) {
            kicker.act(KickerAct::Bleed).await;
        }
        let took = begun.elapsed().as_millis();
        defmt::info!(
            "round {=u8}: {=f32} V after {=u64} ms of running empty",
            round,
            analog.capacitor(),
            took
        );
    }
    loop {
        kicker.act(KickerAct::Bleed).await;
        defmt::info!("{=f32} V; measure before you touch anything", analog.capacitor());
        Timer::after_secs(1).await;
    }
}

#[cfg(not(target_os = "none"))]
fn main() {}
