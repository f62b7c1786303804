//! `encoders`: bench test of the encoders: each counts, in the right direction. Turned by hand.
//!
//! Connect: the encoders and their supply; motors without current. See: four counts and four rim speeds, five
//! times a second. Turn each wheel so that it would turn the robot counter-clockwise: its count rises, by
//! 4,096 a turn (`src/encoders.rs` holds the number of your encoders), and its speed is positive. If it
//! falls, swap A and B. If it alternates up and down: A or B is not connected.
#![allow(unsafe_code, reason = "registers, interrupts and flash are reached by address")]
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
#[embassy_executor::main]
async fn main(spawner: embassy_executor::Spawner) {
    let _ = spawner;
    use board_kit::not_wired::NotWired;
    use board_kit::wheels::Wheels;
    use board_stm32::drivers;
    use embassy_time::Timer;
    use runtime::ports::WheelsPort as _;

    // Without motors no wheel counts as stuck.
    let counters = drivers::encoders(board_stm32::start().encoders);
    let mut wheels = Wheels::new(NotWired, counters);
    loop {
        let rims = wheels.measured();
        defmt::info!(
            "counts {}, rims {} m/s (front right, back right, back left, front left)",
            wheels.counts(),
            rims
        );
        Timer::after_millis(200).await;
    }
}

#[cfg(not(target_os = "none"))]
fn main() {}
