//! `robot`: the start of the robot's board, and what it has.
//!
//! A step of the brain of 40,000 instructions, its budget, takes half a millisecond here, where no more than
//! two cycles go to one. A control step may be late by this time.

use stm32_kit::lines;

/// A robot's board with an STM32F407.
struct F407;

stm32_kit::robot_main!(
    F407 of board_f407, sender: lines::Sender, receiver: lines::Receiver,
    radio: |_who, parts| board_f407::drivers::radio(parts.radio)
);
