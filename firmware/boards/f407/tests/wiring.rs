//! `wiring`: tests: the README's wiring equals the pins, a panic turns off what they say, and the flashed
//! profile equals the measured one.

#[path = "../../../stm32-kit/checks/wiring.rs"]
mod wiring;

const PINS: &str = include_str!("../src/pins.rs");
const README: &str = include_str!("../README.md");

#[test]
fn the_readme_shows_the_wiring_as_it_is() {
    wiring::readme_shows(PINS, README);
}

#[test]
fn no_pin_has_two_things_to_do_and_none_is_the_probes() {
    // Debug probe, crystals, and what starts the chip from another memory.
    let taken = ["PA13", "PA14", "PH0", "PH1", "PC14", "PC15", "PB2"];
    wiring::pins_are_distinct(PINS, &taken);
}

#[test]
fn a_panic_turns_off_the_timers_and_pins_of_the_table() {
    let pairs = [
        ("timer: TIM1,", "set_tim1rst"),
        ("dribbler_timer: TIM11,", "set_tim11rst"),
        ("coils: TIM9,", "set_tim9rst"),
        ("charger: TIM12,", "set_tim12rst"),
        ("enable: PE0,", "pins low: GPIOE 0,"),
        ("hold: PE4,", "pins low: GPIOE 0, 4"),
    ];
    wiring::panic_turns_off(PINS, include_str!("../src/off.rs"), &pairs);
}

#[test]
fn the_flashed_profile_equals_the_measured_one() {
    let workspace = include_str!("../../../../Cargo.toml");
    wiring::flashed_as_measured(include_str!("../.cargo/config.toml"), workspace, "board-f407");
}
