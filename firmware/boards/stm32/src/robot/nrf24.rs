//! `nrf24`: the robot's radio: a chip nRF24L01+ on its bus.

use board_kit::nrf24;
use board_kit::robot::Identity;
use board_stm32::{drivers, pins};
use stm32_kit::lines;

/// Sending half of the radio chip.
pub(crate) type Sender = nrf24::ChipSender;
/// Receives, and serves the chip.
pub(crate) type Receiver = lines::RadioChipReceiver;

/// Both directions; `None`, and the reason on the log, where the chip does not answer.
pub(crate) fn open(who: &Identity, _line: pins::Radio, chip: pins::Chip) -> Option<(Sender, Receiver)> {
    let opened = nrf24::robot(who, drivers::radio_chip(chip));
    opened.inspect_err(|_| defmt::error!("the radio chip does not answer: check its supply and wiring")).ok()
}
