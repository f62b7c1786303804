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
fn what_a_panic_turns_off_is_what_the_pins_say() {
    let pairs = [
        ("timer: TIM1,", "set_tim1rst(true)"),
        ("dribbler_timer: TIM11,", "set_tim11rst(true)"),
        ("coils: TIM9,", "set_tim9rst(true)"),
        ("charger: TIM12,", "set_tim12rst(true)"),
        ("enable: PE0,", "set_br(0, true)"),
        ("hold: PE4,", "set_br(4, true)"),
    ];
    wiring::panic_turns_off(PINS, include_str!("../src/off.rs"), &pairs);
}

#[test]
fn what_is_flashed_from_this_directory_is_compiled_as_what_is_measured() {
    let workspace = include_str!("../../../../Cargo.toml");
    wiring::flashed_as_measured(include_str!("../.cargo/config.toml"), workspace, "board-f407");
}
