//! `serial`: robots through a base station at a serial line. Frames between zero bytes (`protocol::serial`).
//!
//! Bytes that the system has taken can neither be replaced nor overtaken, and their number is not available
//! on every system (a pseudo terminal and some USB adapters always report 0). So the link hands over no more
//! than the line carries at its rate: at most [`BUFFERED_TIME`] waits behind it, and HALT discards even that.

use std::io;
use std::path::Path;
use std::time::{Duration, Instant};

use protocol::link::Packet;
use protocol::serial::{Lines, line};
use serial2::SerialPort;

use super::{LineRate, Link, LinkError};
use crate::radio::{Relay, To};

/// Longest time a write may wait for room: the period of one snapshot. Bytes that do not fit by then are out
/// of date.
const WRITE_MAX: Duration = Duration::from_millis(10);
/// Transmission time kept in the system's buffer: twice the period in which the link's thread checks, so that
/// the line does not pause. At 115,200 bit/s these are 35 bytes.
const BUFFERED_TIME: Duration = Duration::from_millis(3);
/// Interval of reports that the line takes less than its rate.
const STUCK_REPORT_EVERY: Duration = Duration::from_secs(10);
/// Bytes taken from the system at once.
const READ_LEN: usize = 1024;

/// A base station at a serial line.
#[derive(Debug)]
pub struct SerialLink {
    device: String,
    port: SerialPort,
    lines: Lines,
    /// Bytes read and not decoded yet.
    read: Vec<u8>,
    /// A line broke off within a frame: the next frame starts with a zero, so that the receiver
    /// resynchronises.
    broken: bool,
    baud: u32,
    /// When the line has sent all bytes given to it, by its rate.
    busy_until: Instant,
    /// Number of writes without room, and when that was last reported.
    stuck: (u32, Option<Instant>),
}

impl SerialLink {
    /// Opens the line, 8 bits without parity, one stop bit, no flow control.
    pub fn open(device: &str, baud: u32) -> Result<Self, LinkError> {
        let mut port = SerialPort::open(device, baud).map_err(|error| why(device, error))?;
        port.set_write_timeout(WRITE_MAX).map_err(|error| why(device, error))?;
        Ok(Self::over(device, port, baud))
    }

    fn over(device: &str, port: SerialPort, baud: u32) -> Self {
        Self {
            device: device.to_owned(),
            port,
            lines: Lines::new(),
            read: Vec::with_capacity(READ_LEN),
            broken: true,
            baud,
            busy_until: Instant::now(),
            stuck: (0, None),
        }
    }

    /// Accounts for `bytes` more to send.
    fn give(&mut self, bytes: usize) {
        let bits = bytes as u64 * LineRate::BITS_PER_BYTE;
        let takes = Duration::from_micros((bits * 1_000_000).div_ceil(u64::from(self.baud.max(1))));
        self.busy_until = self.busy_until.max(Instant::now()) + takes;
    }

    fn take(&mut self) -> Option<Packet> {
        let Self { read, lines, .. } = self;
        let mut taken = 0;
        let found = read.iter().find_map(|byte| {
            taken += 1;
            lines.push(*byte)
        });
        read.drain(..taken);
        found
    }
}

impl Link for SerialLink {
    fn send(&mut self, _to: To, packet: &[u8]) -> Result<(), LinkError> {
        let line = line(packet);
        self.give(line.len() + usize::from(self.broken));
        let whole = if self.broken { self.port.write_all(&[0]) } else { Ok(()) };
        match whole.and_then(|()| self.port.write_all(&line)) {
            Ok(()) => {
                self.broken = false;
                Ok(())
            }
            Err(error) if error.kind() == io::ErrorKind::TimedOut => {
                // The line takes less than its rate: the bytes queued there are out of date.
                self.stuck.0 = self.stuck.0.saturating_add(1);
                self.discard();
                Ok(())
            }
            Err(error) => {
                Err(LinkError::Line { device: self.device.clone(), doing: "write to".into(), error })
            }
        }
    }

    fn receive(&mut self, wait: Duration) -> Result<Option<Packet>, LinkError> {
        let broken = |device: &str, error| LinkError::Line {
            device: device.to_owned(),
            doing: "read from".into(),
            error,
        };
        let until = Instant::now() + wait;
        loop {
            if let Some(packet) = self.take() {
                return Ok(Some(packet));
            }
            let left = until.saturating_duration_since(Instant::now());
            let mut bytes = [0; READ_LEN];
            self.port
                .set_read_timeout(left.max(Duration::from_millis(1)))
                .map_err(|error| broken(&self.device, error))?;
            match self.port.read(&mut bytes) {
                Ok(0) => {
                    return Err(broken(&self.device, io::Error::from(io::ErrorKind::UnexpectedEof)));
                }
                Ok(len) => self.read.extend_from_slice(bytes.get(..len).unwrap_or(&[])),
                Err(error) if error.kind() == io::ErrorKind::TimedOut => return Ok(None),
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => return Err(broken(&self.device, error)),
            }
        }
    }

    fn relay(&self) -> Relay {
        Relay::ToAll
    }

    fn has_room(&mut self) -> bool {
        self.busy_until.saturating_duration_since(Instant::now()) <= BUFFERED_TIME
    }

    fn discard(&mut self) {
        // A line may break off within a frame: the next starts with a zero, so that the receiver
        // resynchronises.
        let _ = self.port.discard_output_buffer();
        self.broken = true;
        self.busy_until = Instant::now();
    }

    fn line_rate(&self) -> Option<LineRate> {
        Some(LineRate { device: self.device.clone(), baud: self.baud })
    }

    fn notice(&mut self) -> Option<String> {
        let (stuck, reported) = self.stuck;
        if stuck == 0 || reported.is_some_and(|at| at.elapsed() < STUCK_REPORT_EVERY) {
            return None;
        }
        self.stuck = (0, Some(Instant::now()));
        Some(format!(
            "{} takes less than its {} bit/s: {stuck} frames found no room and were dropped; is the base station running, and \
             does it run at this rate (serial:{}:BAUD)?",
            self.device, self.baud, self.device
        ))
    }

    fn advice(&self) -> String {
        format!(
            "does the base station at {} run at this rate, and are the robots on its channel and of this team and key? {} pieces \
             between zeros were no frames",
            self.device,
            self.lines.dropped()
        )
    }
}

fn why(device: &str, error: io::Error) -> LinkError {
    let device = device.to_owned();
    match error.kind() {
        io::ErrorKind::PermissionDenied => LinkError::NotAllowed { device },
        io::ErrorKind::NotFound => {
            let found = SerialPort::available_ports().unwrap_or_default();
            let present = found.iter().map(|path: &std::path::PathBuf| path.display().to_string());
            LinkError::NoSuchLine { present: present.collect(), device }
        }
        // A file that is no line.
        _ if !Path::new(&device).exists() => LinkError::NoSuchLine { device, present: Vec::new() },
        _ => LinkError::Line { device, doing: "open".into(), error },
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    const SECOND: Duration = Duration::from_secs(1);

    /// A line whose other end is in the test.
    fn pair() -> (SerialPort, SerialLink) {
        let (ours, theirs) = SerialPort::pair().unwrap();
        (ours, SerialLink::over("pair", theirs, 1_000_000))
    }

    #[test]
    fn frames_survive_the_line_and_garbage_on_it() {
        let (mut station, mut link) = pair();
        station.set_read_timeout(SECOND).unwrap();
        let frame = Packet::from_slice(&[1, 0, 0, 7, 0]).unwrap();
        station.write_all(b"garbage \x05\x06").unwrap();
        station.write_all(&[0]).unwrap();
        for _ in 0..3 {
            station.write_all(&line(&frame)).unwrap();
        }
        for _ in 0..3 {
            assert_eq!(link.receive(SECOND).unwrap().as_ref(), Some(&frame));
        }
        assert_eq!(link.receive(Duration::from_millis(3)).unwrap(), None);
        link.send(To::All, &frame).unwrap();
        link.send(To::All, &frame).unwrap();
        let mut bytes = [0; 64];
        let mut lines = Lines::new();
        let mut received = Vec::new();
        while received.len() < 2 {
            let len = station.read(&mut bytes).unwrap();
            received.extend(bytes[..len].iter().filter_map(|byte| lines.push(*byte)));
        }
        assert_eq!(received, [frame.clone(), frame]);
    }

    #[test]
    fn a_line_that_is_not_there_is_named_with_those_that_are() {
        let error = SerialLink::open("/dev/no-such-line", 1_000_000).unwrap_err();
        assert!(matches!(error, LinkError::NoSuchLine { .. }), "{error}");
        assert!(error.to_string().contains("/dev/no-such-line"));
    }
}
