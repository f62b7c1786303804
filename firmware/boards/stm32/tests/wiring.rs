//! `wiring`: tests: the README's wiring equals the pins, a panic turns off what they say, and the flashed
//! profile equals the measured one.

#[path = "../../../stm32-kit/checks/wiring.rs"]
mod wiring;

// Taken: debug probe, quartz, and a NUCLEO's Ethernet, USB and virtual serial line.
wiring::tests!(
    "board-stm32",
    taken: [
        "PA13", "PA14", "PH0", "PH1", "PA1", "PA2", "PA7", "PB13", "PC1", "PC4", "PC5", "PG11", "PG13", "PA8",
        "PA9", "PA10", "PA11", "PA12", "PD8", "PD9",
    ],
    off: [
        ("timer: TIM1,", "set_tim1rst"),
        ("dribbler_timer: TIM5,", "set_tim5rst"),
        ("coils: TIM15,", "set_tim15rst"),
        ("charger: TIM16,", "set_tim16rst"),
        ("enable: PE0,", "pins low: GPIOE 0,"),
        ("hold: PE4,", "pins low: GPIOE 0, 4"),
    ]
);

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
    assert_eq!(seen, 9);
}
