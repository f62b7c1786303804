//! `scan`: the power on all channels, measured by a base station's chip while nothing is sent. Times in µs.

use embedded_hal::delay::DelayNs;
use embedded_hal::digital::OutputPin;
use embedded_hal::spi::SpiDevice;
use protocol::station::{SCANNED, StationMessage};
use protocol::{Duration, Instant};

use crate::chip::{Fault, Lines, Rate};

/// A scan that goes on, or is done.
pub(crate) struct Scan {
    sweeps: u8,
    done: u8,
    /// The channel that is measured, and since when.
    channel: u8,
    since: Option<Instant>,
    /// Sweeps in which each channel had power.
    counts: [u8; SCANNED],
}

impl Scan {
    pub(crate) fn new(sweeps: u8) -> Self {
        Self { sweeps, done: 0, channel: 0, since: None, counts: [0; SCANNED] }
    }

    pub(crate) fn is_done(&self) -> bool {
        self.done >= self.sweeps
    }

    /// What was found.
    pub(crate) fn spectrum(&self) -> StationMessage {
        StationMessage::Spectrum(self.done, self.counts.iter().copied().collect())
    }

    /// Reads the chip once it has listened long enough, and goes on to the next channel.
    pub(crate) fn serve<S: SpiDevice, C: OutputPin, D: DelayNs>(
        &mut self,
        now: Instant,
        lines: &mut Lines<S, C, D>,
    ) -> Result<(), Fault> {
        if let Some(since) = self.since {
            if now.since(since) < LISTEN_TIME || self.is_done() {
                return Ok(());
            }
            if lines.has_power()?
                && let Some(count) = self.counts.get_mut(usize::from(self.channel))
            {
                *count = count.saturating_add(1);
            }
            self.channel += 1;
            if usize::from(self.channel) == SCANNED {
                (self.channel, self.done) = (0, self.done + 1);
            }
        }
        self.since = Some(now);
        lines.listen_on(self.channel, Rate::Mbps2)
    }
}

/// Time on a channel: 130 µs until the chip listens and 40 µs of power until it is noticed (PS 6.4).
const LISTEN_TIME: Duration = Duration(200);
