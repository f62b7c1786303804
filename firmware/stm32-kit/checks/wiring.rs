//! `wiring`: what the tests of STM32 boards check: README's wiring against the pins, a panic's list against
//! them, and the flashed profile against the measured one.

use std::collections::BTreeSet;

/// The checks as tests of a board: its package, pins that are the board's own, and what a panic turns off.
macro_rules! tests {
    ($package:literal, taken: [$($taken:literal),+ $(,)?], off: [$($pair:expr),+ $(,)?]) => {
        const README: &str = include_str!("../README.md");
        const PINS: &str = include_str!("../src/pins.rs");

        #[test]
        fn the_readme_shows_the_wiring_as_it_is() {
            wiring::readme_shows(PINS, README);
        }

        #[test]
        fn no_pin_has_two_things_to_do_and_none_is_the_probes() {
            wiring::pins_are_distinct(PINS, &[$($taken),+]);
        }

        #[test]
        fn a_panic_turns_off_the_timers_and_pins_of_the_table() {
            wiring::panic_turns_off(PINS, include_str!("../src/off.rs"), &[$($pair),+]);
        }

        #[test]
        fn the_flashed_profile_equals_the_measured_one() {
            let workspace = include_str!("../../../../Cargo.toml");
            wiring::flashed_as_measured(include_str!("../.cargo/config.toml"), workspace, $package);
        }
    };
}
pub(crate) use tests;

/// `name: PE9, "what";`, of pins only.
fn wires_of_the_source(pins: &str) -> Vec<(String, String)> {
    let wire = |line: &str| {
        let (_, rest) = line.trim().split_once(": ")?;
        let (pin, what) = rest.split_once(", \"")?;
        is_pin(pin).then(|| (pin.to_owned(), what.trim_end_matches("\";").to_owned()))
    };
    pins.lines().filter(|line| !line.trim().starts_with("//")).filter_map(wire).collect()
}

/// `| PE9 | what |`.
fn wires_of_the_readme(readme: &str) -> Vec<(String, String)> {
    let wire = |line: &str| {
        let [_, pin, what, _] = line.split('|').map(str::trim).collect::<Vec<_>>()[..] else { return None };
        is_pin(pin).then(|| (pin.to_owned(), what.to_owned()))
    };
    readme.lines().filter_map(wire).collect()
}

fn is_pin(name: &str) -> bool {
    let mut letters = name.chars();
    letters.next() == Some('P')
        && letters.next().is_some_and(|port| port.is_ascii_uppercase())
        && letters.as_str().parse::<u8>().is_ok_and(|number| number < 16)
}

pub(crate) fn readme_shows(pins: &str, readme: &str) {
    let source = wires_of_the_source(pins);
    assert!(source.len() > 30, "{} wires read", source.len());
    assert_eq!(wires_of_the_readme(readme), source);
}

/// No pin has two things to do, and none is one of these.
pub(crate) fn pins_are_distinct(pins: &str, taken: &[&str]) {
    let pins: Vec<_> = wires_of_the_source(pins).into_iter().map(|(pin, _)| pin).collect();
    let distinct: BTreeSet<_> = pins.iter().map(String::as_str).collect();
    assert_eq!(distinct.len(), pins.len());
    let twice: Vec<_> = taken.iter().filter(|pin| distinct.contains(*pin)).collect();
    assert!(twice.is_empty(), "{twice:?} are the board's own");
}

/// Fails unless a panic turns off what the pins name: timers in reset, and two pins of port E low.
pub(crate) fn panic_turns_off(pins: &str, off: &str, pairs: &[(&str, &str)]) {
    for (pin, turned_off) in pairs {
        assert!(pins.contains(&format!("        {pin} \"")), "{pin} is elsewhere now; mend off.rs too");
        assert!(off.contains(turned_off), "{turned_off}");
    }
    assert!(off.contains("stm32_kit::emergency_stop!"));
}

/// Fails unless what is flashed from the board's directory (`here` is its `.cargo/config.toml`) is compiled
/// as what is measured: the workspace's profile, and the board's own package small (`Board::profile`).
pub(crate) fn flashed_as_measured(here: &str, workspace: &str, package: &str) {
    let settings = |text: &str, head: &str| -> Option<BTreeSet<String>> {
        let lines = text.lines().skip_while(|line| *line != head).skip(1);
        let lines = lines.take_while(|line| !line.starts_with('[')).filter(|line| line.contains(" = "));
        let settings: BTreeSet<_> =
            lines.filter(|line| !line.starts_with("inherits")).map(str::to_owned).collect();
        (!settings.is_empty()).then_some(settings)
    };
    for part in ["", ".package.board-kit", ".package.stm32-kit", ".package.embassy-stm32"] {
        let measured = settings(workspace, &format!("[profile.firmware{part}]"));
        assert!(measured.is_some(), "{part}");
        assert_eq!(settings(here, &format!("[profile.release{part}]")), measured, "{part}");
    }
    let own = settings(here, &format!("[profile.release.package.{package}]"));
    assert_eq!(own, Some(BTreeSet::from(["opt-level = \"z\"".to_owned()])));
}
