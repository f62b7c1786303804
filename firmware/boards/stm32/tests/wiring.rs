//! `wiring`: tests: the README's wiring equals the pins, and the flashed profile equals the measured one.
//! README.md's table against `src/pins.rs`, no pin for two things, this directory's `release` against the
//! workspace's `firmware`.

use std::collections::BTreeSet;

const PINS: &str = include_str!("../src/pins.rs");
const README: &str = include_str!("../README.md");

/// `name: PE9, "what";`, of pins only.
fn wires_of_the_source() -> Vec<(String, String)> {
    let wire = |line: &str| {
        let (_, rest) = line.trim().split_once(": ")?;
        let (pin, what) = rest.split_once(", \"")?;
        is_pin(pin).then(|| (pin.to_owned(), what.trim_end_matches("\";").to_owned()))
    };
    PINS.lines().filter(|line| !line.trim().starts_with("//")).filter_map(wire).collect()
}

/// `| PE9 | what |`.
fn wires_of_the_readme() -> Vec<(String, String)> {
    let wire = |line: &str| {
        let [_, pin, what, _] = line.split('|').map(str::trim).collect::<Vec<_>>()[..] else { return None };
        is_pin(pin).then(|| (pin.to_owned(), what.to_owned()))
    };
    README.lines().filter_map(wire).collect()
}

fn is_pin(label: &str) -> bool {
    let mut letters = label.chars();
    letters.next() == Some('P')
        && letters.next().is_some_and(|port| port.is_ascii_uppercase())
        && letters.as_str().parse::<u8>().is_ok_and(|number| number < 16)
}

#[test]
fn the_readme_shows_the_wiring_as_it_is() {
    let source = wires_of_the_source();
    assert!(source.len() > 30, "{} wires read", source.len());
    assert_eq!(wires_of_the_readme(), source);
}

#[test]
fn no_pin_has_two_things_to_do_and_none_is_the_probes() {
    let pins: Vec<_> = wires_of_the_source().into_iter().map(|(pin, _)| pin).collect();
    let distinct: BTreeSet<_> = pins.iter().map(String::as_str).collect();
    assert_eq!(distinct.len(), pins.len());
    // Debug probe, quartz, and a NUCLEO's Ethernet, USB and virtual serial line.
    let taken = [
        "PA13", "PA14", "PH0", "PH1", "PA1", "PA2", "PA7", "PB13", "PC1", "PC4", "PC5", "PG11", "PG13",
        "PA8", "PA9", "PA10", "PA11", "PA12", "PD8", "PD9",
    ];
    assert!(taken.iter().all(|pin| !distinct.contains(pin)));
}

#[test]
fn what_a_panic_turns_off_is_what_the_pins_say() {
    let off = include_str!("../src/off.rs");
    for (pin, turned_off) in [
        ("timer: TIM1,", "set_tim1rst(true)"),
        ("dribbler_timer: TIM5,", "set_tim5rst(true)"),
        ("coils: TIM15,", "set_tim15rst(true)"),
        ("charger: TIM16,", "set_tim16rst(true)"),
        ("enable: PE0,", "set_br(0, true)"),
        ("hold: PE4,", "set_br(4, true)"),
    ] {
        assert!(PINS.contains(&format!("        {pin} \"")), "{pin} is elsewhere now; mend off.rs too");
        assert!(off.contains(turned_off), "{turned_off}");
    }
    assert!(off.contains("pac::GPIOE.bsrr()"));
}

#[test]
fn what_is_flashed_from_this_directory_is_compiled_as_what_is_measured() {
    let settings = |text: &str, head: &str| -> Option<BTreeSet<String>> {
        let lines = text.lines().skip_while(|line| *line != head).skip(1);
        let lines = lines.take_while(|line| !line.starts_with('[')).filter(|line| line.contains(" = "));
        let settings: BTreeSet<_> =
            lines.filter(|line| !line.starts_with("inherits")).map(str::to_owned).collect();
        (!settings.is_empty()).then_some(settings)
    };
    let (here, workspace) = (include_str!("../.cargo/config.toml"), include_str!("../../../../Cargo.toml"));
    for package in ["", ".package.board-stm32", ".package.embassy-stm32"] {
        let measured = settings(workspace, &format!("[profile.firmware{package}]"));
        assert!(measured.is_some(), "{package}");
        assert_eq!(settings(here, &format!("[profile.release{package}]")), measured, "{package}");
    }
}

#[test]
fn every_example_is_in_the_readme_and_says_what_to_connect_and_what_to_see() {
    let directory = concat!(env!("CARGO_MANIFEST_DIR"), "/examples");
    let mut seen = 0;
    for entry in std::fs::read_dir(directory).unwrap() {
        let path = entry.unwrap().path();
        let (name, text) =
            (path.file_stem().unwrap().to_str().unwrap(), std::fs::read_to_string(&path).unwrap());
        assert!(README.contains(&format!("| [`{name}`](examples/{name}.rs) |")), "{name}");
        assert!(text.contains("Connect: ") && text.contains(" See:"), "{name}");
        seen += 1;
    }
    assert_eq!(seen, 8);
}
