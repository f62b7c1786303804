//! `robot`: the start of the robot's board, and what it has. The program names its radio.
//!
//! A step of the brain of 40,000 instructions, its budget, takes a fifth of a millisecond here. A control
//! step may be late by this time.

/// A robot's board with an STM32H743.
struct Stm32;

stm32_kit::robot_main!(
    Stm32 of board_stm32, sender: crate::radio::Sender, receiver: crate::radio::Receiver,
    radio: |who, parts| crate::radio::open(who, parts.radio, parts.chip)
);
