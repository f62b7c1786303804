//! `wires`: the chip's lines as `embedded-hal` has them: SPI with chip select, CE, and the processor's
//! pauses.

use std::convert::Infallible;

use embedded_hal::delay::DelayNs;
use embedded_hal::digital::{self, OutputPin};
use embedded_hal::spi::{self, Operation, SpiDevice};

use crate::Chip;
use crate::chip::Exchange;

/// ns of a byte at 8 MHz, the fastest the chip allows at 10 MHz with the board's dividers (PS 8.3.2).
const BYTE: u64 = 1_000;
/// ns of an SPI transaction besides its bytes, an estimate: chip select, and the driver's own instructions.
const TRANSACTION: u64 = 2_000;

/// The SPI lines of a chip.
#[derive(Debug)]
pub struct Spi(pub(crate) Chip);

/// The line CE of a chip.
#[derive(Debug)]
pub struct ChipEnable(pub(crate) Chip);

/// Pauses of the processor at a chip.
#[derive(Debug)]
pub struct Pause(pub(crate) Chip);

impl spi::ErrorType for Spi {
    type Error = Infallible;
}

impl digital::ErrorType for ChipEnable {
    type Error = Infallible;
}

impl SpiDevice for Spi {
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), Infallible> {
        let mut medium = self.0.medium.borrow_mut();
        medium.sense(self.0.index);
        let chip = &mut medium.chips[self.0.index];
        let mut exchange = Exchange::default();
        chip.spent += TRANSACTION;
        for operation in operations {
            match operation {
                Operation::Read(words) => {
                    for word in words.iter_mut() {
                        *word = chip.exchange(&mut exchange, 0);
                    }
                    chip.spent += BYTE * words.len() as u64;
                }
                Operation::Write(words) => {
                    for word in *words {
                        chip.exchange(&mut exchange, *word);
                    }
                    chip.spent += BYTE * words.len() as u64;
                }
                Operation::Transfer(read, write) => {
                    for at in 0..read.len().max(write.len()) {
                        let answer = chip.exchange(&mut exchange, write.get(at).copied().unwrap_or(0));
                        if let Some(word) = read.get_mut(at) {
                            *word = answer;
                        }
                    }
                    chip.spent += BYTE * read.len().max(write.len()) as u64;
                }
                Operation::TransferInPlace(words) => {
                    for word in words.iter_mut() {
                        *word = chip.exchange(&mut exchange, *word);
                    }
                    chip.spent += BYTE * words.len() as u64;
                }
                Operation::DelayNs(ns) => chip.spent += u64::from(*ns),
            }
        }
        chip.deselect(exchange);
        medium.wake(self.0.index);
        Ok(())
    }
}

impl OutputPin for ChipEnable {
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.set(false);
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        self.set(true);
        Ok(())
    }
}

impl ChipEnable {
    fn set(&mut self, high: bool) {
        let mut medium = self.0.medium.borrow_mut();
        medium.chips[self.0.index].enabled = high;
        medium.wake(self.0.index);
    }
}

impl DelayNs for Pause {
    fn delay_ns(&mut self, ns: u32) {
        self.0.medium.borrow_mut().chips[self.0.index].spent += u64::from(ns);
    }
}
