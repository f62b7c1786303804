//! `imu`: bench test of the IMU: the gyroscope answers, and its z axis points up.
//!
//! Connect: the IMU. See: lying still, the acceleration is about (0, 0, 1) g and every rate within 0.02 rad/s
//! of 0. Turn the board counter-clockwise (seen from above): the third rate is positive. On its side: the
//! third acceleration is about 0. `Unauthenticated(0)` or `Unauthenticated(255)`: no answer, check clock,
//! data and select; another number: another sensor.
#![allow(unsafe_code, reason = "registers, interrupts and flash are reached by address")]
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
#[embassy_executor::main]
async fn main(spawner: embassy_executor::Spawner) {
    let _ = spawner;
    use board_kit::imu::Gyroscope as _;
    use board_stm32::drivers;
    use embassy_time::Timer;

    let mut imu = drivers::imu(board_stm32::start().imu);
    loop {
        match imu.start().await {
            Ok(()) => break,
            Err(error) => defmt::error!("{}", error),
        }
        Timer::after_secs(1).await;
    }
    loop {
        match imu.reading() {
            Ok(reading) => defmt::info!("{} g, {} rad/s", reading.acceleration, reading.rate),
            Err(error) => defmt::error!("{}", error),
        }
        Timer::after_millis(200).await;
    }
}

#[cfg(not(target_os = "none"))]
fn main() {}
