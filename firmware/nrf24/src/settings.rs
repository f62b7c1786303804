//! `settings`: the chip's registers as they were set, and whether the chip still holds them.
//!
//! A register that is upset (a dip of the supply, a spark of a motor or of the kicker) makes a radio deaf
//! for good, and nothing that is received tells so. The driver has no call that reads all registers: its
//! writes are noted as they pass to the bus, and each is read back.

use embedded_hal::spi::{ErrorType, Operation, SpiDevice};

/// The chip's bus, and what was written to its registers.
pub(crate) struct Settings<S> {
    bus: S,
    registers: [Register; REGISTERS],
}

/// Bytes that a register was set to: one, or the five of an address.
#[derive(Clone, Copy, Default)]
struct Register {
    bytes: [u8; ADDRESS_LEN],
    len: u8,
}

impl<S: SpiDevice> Settings<S> {
    pub(crate) fn new(bus: S) -> Self {
        Self { bus, registers: [Register::default(); REGISTERS] }
    }

    /// Notes the writing of a register; flags of events and what the chip counts are no settings.
    fn note(&mut self, transfer: &[u8]) {
        let Some((command, bytes)) = transfer.split_first() else { return };
        let Some(register) = command.checked_sub(WRITE).filter(|register| !STATES.contains(register)) else {
            return;
        };
        if let Some(register) = self.registers.get_mut(usize::from(register)) {
            for (to, byte) in register.bytes.iter_mut().zip(bytes) {
                *to = *byte;
            }
            register.len = bytes.len().min(ADDRESS_LEN) as u8;
        }
    }

    /// Whether the chip holds every register as it was set: 22 of them, 56 bytes on the bus.
    fn holds(&mut self) -> Result<bool, S::Error> {
        for (number, register) in (0_u8..).zip(&self.registers) {
            if register.len == 0 {
                continue;
            }
            let mut transfer = [0; 1 + ADDRESS_LEN];
            transfer[0] = number;
            let Some(read) = transfer.get_mut(..=usize::from(register.len)) else { continue };
            self.bus.transaction(&mut [Operation::TransferInPlace(read)])?;
            let mask = mask(number);
            if read.iter().skip(1).zip(&register.bytes).any(|(read, set)| (read ^ set) & mask != 0) {
                return Ok(false);
            }
        }
        Ok(true)
    }
}

impl<S: SpiDevice> ErrorType for Settings<S> {
    type Error = S::Error;
}

impl<S: SpiDevice> SpiDevice for Settings<S> {
    /// Passes on the driver's transfers. Where it reads the length of pipe 0's payloads, all registers are
    /// read, and the length is 0 if one of them is not as it was set.
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), S::Error> {
        let mut asks = false;
        for operation in operations.iter() {
            if let Operation::TransferInPlace(bytes) = operation {
                self.note(bytes);
                asks |= bytes.first() == Some(&PAYLOAD_LENGTH);
            }
        }
        self.bus.transaction(operations)?;
        if asks && !self.holds()? {
            for operation in operations {
                if let Operation::TransferInPlace(bytes) = operation {
                    bytes.iter_mut().skip(1).for_each(|byte| *byte = 0);
                }
            }
        }
        Ok(())
    }
}

/// Bits of a register that the chip gives back as they were written (PS 9.1); the lowest of `RF_SETUP` is
/// obsolete.
const fn mask(register: u8) -> u8 {
    match register {
        0x00 => 0x7f,
        0x03 => 0x03,
        0x06 => 0xbe,
        _ => 0xff,
    }
}

/// Registers: `FEATURE`, 0x1d, is the last.
const REGISTERS: usize = 0x1e;
/// First command that writes a register.
const WRITE: u8 = 0x20;
/// `RX_PW_P0`, and the command that reads it.
const PAYLOAD_LENGTH: u8 = 0x11;
/// `STATUS`, `OBSERVE_TX` and `RPD`: the chip's own.
const STATES: core::ops::RangeInclusive<u8> = 0x07..=0x09;
/// Longest register, bytes.
const ADDRESS_LEN: usize = 5;
