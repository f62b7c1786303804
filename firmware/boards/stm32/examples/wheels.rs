//! `wheels`: bench test of the motors: each turns, in the right place and direction. One at a time, at a
//! sixth of the battery's voltage.
//!
//! **The robot on a stand, wheels off the ground, no fingers near them; the kicker's board unplugged.**
//! Connect: motor drivers and battery, or a supply limited to 2 A. See: front right, back right, back left,
//! front left, then the dribbler; each wheel two seconds so that it would turn the robot counter-clockwise
//! (its rim runs to the left when seen from the robot's centre), then two seconds back. Wrong wheel: pins
//! swapped. Wrong direction: swap two phases, or the direction's wire. `a driver has switched itself off`:
//! its fault wire is low.
#![allow(unsafe_code, reason = "registers, interrupts and flash are reached by address")]
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
#[embassy_executor::main]
async fn main(spawner: embassy_executor::Spawner) {
    let _ = spawner;
    use board_kit::motors::MotorDrivers as _;
    use board_stm32::drivers;
    use embassy_time::Timer;

    const NAMES: [&str; 4] = ["front right", "back right", "back left", "front left"];
    /// Duty cycle, share of the battery's voltage: a wheel without load runs 1 m/s at the rim.
    const DUTY: f32 = 0.16;

    let mut drivers = drivers::motors(board_stm32::start().motors);
    Timer::after_secs(2).await;
    for (wheel, name) in NAMES.iter().enumerate() {
        for sign in [1.0, -1.0] {
            let mut duty = [0.0; 4];
            if let Some(one) = duty.get_mut(wheel) {
                *one = sign * DUTY;
            }
            defmt::info!("{=str}, {=str}", name, if sign > 0.0 { "counter-clockwise" } else { "clockwise" });
            drivers.drive(duty, 0.0);
            if drivers.has_fault() {
                defmt::error!("a driver has switched itself off");
            }
            Timer::after_secs(2).await;
            drivers.release();
            Timer::after_secs(1).await;
        }
    }
    defmt::info!("dribbler");
    drivers.drive([0.0; 4], 0.3);
    Timer::after_secs(2).await;
    drivers.release();
    defmt::info!("done; all without current");
}

#[cfg(not(target_os = "none"))]
fn main() {}
