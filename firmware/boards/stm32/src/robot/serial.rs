//! `serial`: the robot's radio: a modem on the serial line.

use board_kit::robot::Identity;
use board_stm32::{drivers, pins};
use stm32_kit::lines;

pub(crate) type Sender = lines::Sender;
pub(crate) type Receiver = lines::Receiver;

/// Both directions; `None` where the line cannot have its rate.
pub(crate) fn open(_who: &Identity, line: pins::Radio, _chip: pins::Chip) -> Option<(Sender, Receiver)> {
    drivers::radio(line)
}
