//! `station`: a base station: the host's serial line on one side, the radio on the other. Sans-IO towards the
//! line: bytes in, lines out, as `protocol::serial` has them. Times in µs.

use embedded_hal::delay::DelayNs;
use embedded_hal::digital::OutputPin;
use embedded_hal::spi::SpiDevice;
use protocol::serial::{Line, Lines, line};
use protocol::station::{self, StationMessage, StationReport};
use protocol::{Instant, RobotId};

use crate::base::{Base, BaseCounts};
use crate::chip::{Channel, Fault};

/// No robot has this number.
const NO_REPORT: u8 = RobotId::COUNT as u8;

/// Base station between the host's serial line and the chip.
#[allow(missing_debug_implementations, reason = "the chip's driver has none")]
pub struct Station<S, C, D> {
    base: Base<S, C, D>,
    lines: Lines,
    refused: u32,
    /// Number of the next robot to report; [`RobotId::COUNT`] while no report is due.
    report: u8,
    /// An answer to the host that is ready.
    answer: Option<StationMessage>,
}

impl<S: SpiDevice, C: OutputPin, D: DelayNs> Station<S, C, D> {
    /// A station with a radio that is set up.
    pub fn new(base: Base<S, C, D>) -> Self {
        Self { base, lines: Lines::new(), refused: 0, report: NO_REPORT, answer: None }
    }

    /// Takes bytes of the host.
    pub fn push(&mut self, now: Instant, bytes: &[u8]) {
        for byte in bytes {
            let Some(frame) = self.lines.push(*byte) else { continue };
            if station::is_message(&frame) {
                self.take(now, station::read(&frame).as_ref());
            } else if self.base.send(now, &frame).is_err() {
                self.refused = self.refused.saturating_add(1);
            }
        }
    }

    /// Serves the radio as [`Base::poll`]; returns a line for the host.
    pub fn poll(&mut self, now: Instant) -> Result<Option<Line>, Fault> {
        if let Some(frame) = self.base.poll(now)? {
            return Ok(Some(line(&frame)));
        }
        let answer = self.base.take_spectrum().or_else(|| self.answer.take()).or_else(|| self.next_report());
        Ok(answer.map(|message| line(&station::packet(&message))))
    }

    /// Takes a message of the host; what was corrupted is counted.
    fn take(&mut self, now: Instant, message: Option<&StationMessage>) {
        match message {
            Some(StationMessage::Plan(team, plan)) => {
                self.base.tune(now, Channel::of(*team, *plan));
                self.report = 0;
            }
            Some(StationMessage::Scan(sweeps)) => {
                if !self.base.scan(now, *sweeps) {
                    self.answer = Some(StationMessage::Spectrum(0, heapless::Vec::new()));
                }
            }
            _ => self.refused = self.refused.saturating_add(1),
        }
    }

    /// The report on the next robot that was sent to; on robot 0 always, so that the host knows the plan.
    fn next_report(&mut self) -> Option<StationMessage> {
        while let Some(robot) = RobotId::new(self.report) {
            self.report += 1;
            let packets = self.base.packets(robot);
            if robot == RobotId::ZERO || packets.sent > 0 {
                let (plan, restarts) = (self.base.channel().plan(), self.base.counts().restarts);
                return Some(StationMessage::Report(StationReport { plan, restarts, robot, packets }));
            }
        }
        None
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
