//! `station`: a base station: the host's serial line on one side, the radio on the other. Sans-IO towards the
//! line: bytes in, lines out, as `protocol::serial` has them. Times in µs.

use embedded_hal::delay::DelayNs;
use embedded_hal::digital::OutputPin;
use embedded_hal::spi::SpiDevice;
use protocol::Instant;
use protocol::serial::{Line, Lines, line};

use crate::base::{Base, BaseCounts};
use crate::chip::Fault;

/// Base station between the host's serial line and the chip.
#[allow(missing_debug_implementations, reason = "the chip's driver has none")]
pub struct Station<S, C, D> {
    base: Base<S, C, D>,
    lines: Lines,
    refused: u32,
}

impl<S: SpiDevice, C: OutputPin, D: DelayNs> Station<S, C, D> {
    /// A station with a radio that is set up.
    pub fn new(base: Base<S, C, D>) -> Self {
        Self { base, lines: Lines::new(), refused: 0 }
    }

    /// Takes bytes of the host.
    pub fn push(&mut self, now: Instant, bytes: &[u8]) {
        for byte in bytes {
            if let Some(frame) = self.lines.push(*byte)
                && self.base.send(now, &frame).is_err()
            {
                self.refused = self.refused.saturating_add(1);
            }
        }
    }

    /// Serves the radio as [`Base::poll`]; returns a line for the host.
    pub fn poll(&mut self, now: Instant) -> Result<Option<Line>, Fault> {
        Ok(self.base.poll(now)?.map(|frame| line(&frame)))
    }

    /// Counts of the radio so far.
    pub fn counts(&self) -> BaseCounts {
        self.base.counts()
    }

    /// Pieces between zeros on the host's line that were no frames.
    pub fn refused(&self) -> u32 {
        self.lines.dropped().saturating_add(self.refused)
    }
}
