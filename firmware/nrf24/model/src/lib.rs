//! `nrf24_model`: a model of the radio chip nRF24L01+ and of the air between several of them, for tests. A
//! driver talks to it byte by byte over `embedded-hal`, as to the chip. Times in ns.
//!
//! Sections cited as "PS" are those of Nordic's *nRF24L01+ Preliminary Product Specification v1.0* (2008).
//!
//! | modelled | not modelled |
//! |---|---|
//! | registers, FIFOs of three, both ends of a packet with acknowledgement, retransmission, packet identity | addresses of 3 or 4 bytes, start of the crystal (1.5 ms), carrier test |
//! | settling of 130 µs before every packet, length of packets on the air at 1 and 2 Mbit/s | field strength: two packets at once on a channel are both lost to everyone |
//! | loss, damage that passes the check sum, copies that come again later, carriers of others for the power register | neighbouring channels |
//!
//! SPI transfers take no time of the air; [`Chip::take_spent`] gives what they would have taken, and a test
//! that runs the processors lets each wait that long.
#![forbid(unsafe_code)]

mod air;
mod chip;
mod wires;

pub use air::{Air, AirCounts, Faults};
pub use wires::{ChipEnable, Pause, Spi};

use std::cell::RefCell;
use std::rc::Rc;

/// Time in ns for a processor and its chip to settle before sending or receiving (PS 6.1.7, table 16).
pub const SETTLING: u64 = 130_000;
/// Bits of a packet around its payload: preamble 8, address 40, control field 9, check sum 16 (PS 7.3).
pub const FRAMING_BITS: u64 = 8 + 40 + 9 + 16;

/// One chip in the air of a test.
#[derive(Clone, Debug)]
pub struct Chip {
    medium: Rc<RefCell<air::Medium>>,
    index: usize,
}

impl Chip {
    /// The SPI lines, chip select included.
    pub fn spi(&self) -> Spi {
        Spi(self.clone())
    }

    /// The line CE.
    pub fn chip_enable(&self) -> ChipEnable {
        ChipEnable(self.clone())
    }

    /// Waiting of the processor at this chip: takes no time of the air, see [`Chip::take_spent`].
    pub fn pause(&self) -> Pause {
        Pause(self.clone())
    }

    /// Whether the line IRQ asks for attention (active low on the chip).
    pub fn wants_attention(&self) -> bool {
        self.medium.borrow().chips[self.index].wants_attention()
    }

    /// What SPI transfers and pauses since the last call take, ns.
    pub fn take_spent(&self) -> u64 {
        std::mem::take(&mut self.medium.borrow_mut().chips[self.index].spent)
    }

    /// Takes the supply away, or gives it back: without it the chip answers zeros, and afterwards it has
    /// forgotten everything.
    pub fn power(&self, on: bool) {
        self.medium.borrow_mut().power(self.index, on);
    }

    /// A register's first byte, as the chip has it.
    pub fn register(&self, register: u8) -> u8 {
        self.medium.borrow().chips[self.index].register(register)
    }
}
