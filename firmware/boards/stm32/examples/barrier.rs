//! `break_beam`: bench test of the break-beam sensor.
//!
//! Connect: lamp and receiver of the break-beam sensor. See: `free`, and what the receiver sees with the lamp
//! lit and dark; with a ball, or a hand, in the beam `ball`, as long as it is there. Lit and dark are alike
//! with nothing in the beam: lamp or receiver point elsewhere. Dark is over 0.8: too much daylight, the
//! receiver's resistor is too large. The two thresholds stand in `runtime::sense`.
#![allow(unsafe_code, reason = "registers, interrupts and flash are reached by address")]
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
#[embassy_executor::main]
async fn main(spawner: embassy_executor::Spawner) {
    let _ = spawner;
    use board_kit::sampling::AnalogInputs as _;
    use board_stm32::drivers;
    use embassy_time::Timer;
    use runtime::sense::BreakBeam;

    let mut analog = drivers::analog(board_stm32::start().analog);
    let mut break_beam = BreakBeam::new();
    loop {
        let (mut ball, mut seen) = (false, [0.0; 2]);
        for (lit, seen) in [false, true].into_iter().zip(&mut seen) {
            analog.light(lit);
            Timer::after_millis(1).await;
            *seen = analog.break_beam();
            ball = break_beam.step(lit, *seen);
        }
        let [dark, lit] = seen;
        defmt::info!("{=str} (dark {=f32}, lit {=f32})", if ball { "ball" } else { "free" }, dark, lit);
        Timer::after_millis(100).await;
    }
}

#[cfg(not(target_os = "none"))]
fn main() {}
