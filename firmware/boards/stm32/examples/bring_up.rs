//! `bring_up`: all checks of a robot's first start, one after the other: battery, sensors at rest, each wheel
//! both ways, radio, break-beam sensor. It takes a minute at most and ends by itself.
//!
//! **The robot on a stand, wheels off the ground, no fingers near them; the kicker's board unplugged.**
//! Connect: everything else, and let a host run. See: a line for each check on the log, what it measured, or
//! what is wrong and what to look at. At the last check hold a ball before the dribbler, then take it away.
#![allow(unsafe_code, reason = "registers, interrupts and flash are reached by address")]
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
#[embassy_executor::main]
async fn main(spawner: embassy_executor::Spawner) {
    use board_kit::wheels::Wheels;
    use board_stm32::drivers;

    // One task is enough.
    let _ = spawner;
    let parts = board_stm32::start();
    let wheels = Wheels::new(drivers::motors(parts.motors), drivers::encoders(parts.encoders));
    let Some((_, receiver)) = drivers::radio(parts.radio) else {
        defmt::error!("the radio's line cannot have this rate");
        return;
    };
    let (gyroscope, analog) = (drivers::imu(parts.imu), drivers::analog(parts.analog));
    board_kit::bring_up::run(wheels, receiver, gyroscope, analog).await;
}

#[cfg(not(target_os = "none"))]
fn main() {}
