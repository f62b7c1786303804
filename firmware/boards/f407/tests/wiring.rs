//! `wiring`: tests: the README's wiring equals the pins, a panic turns off what they say, and the flashed
//! profile equals the measured one.

#[path = "../../../stm32-kit/checks/wiring.rs"]
mod wiring;

// Taken: debug probe, crystals, and what starts the chip from another memory.
wiring::tests!(
    "board-f407",
    taken: ["PA13", "PA14", "PH0", "PH1", "PC14", "PC15", "PB2"],
    off: [
        ("timer: TIM1,", "set_tim1rst"),
        ("dribbler_timer: TIM11,", "set_tim11rst"),
        ("coils: TIM9,", "set_tim9rst"),
        ("charger: TIM12,", "set_tim12rst"),
        ("enable: PE0,", "pins low: GPIOE 0,"),
        ("hold: PE4,", "pins low: GPIOE 0, 4"),
    ]
);
