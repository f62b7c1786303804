//! How are robots reached through a base station at a serial line? Frames between zero bytes (`protocol::serial`).

use std::io;
use std::path::Path;
use std::time::{Duration, Instant};

use protocol::link::Packet;
use protocol::serial::{Lines, line};
use serial2::SerialPort;

use super::{Link, LinkError};
use crate::radio::{Relay, To};

/// How long a write may wait for room: the time of one picture. What does not fit by then is old.
const WRITE_MAX: Duration = Duration::from_millis(10);

/// A serial line.
#[derive(Debug)]
pub struct SerialLink {
    device: String,
    port: SerialPort,
    lines: Lines,
    /// Bytes read and not looked at yet.
    read: Vec<u8>,
    /// A line broke off: the next begins with a zero, so that the other side finds it.
    broken: bool,
}

impl SerialLink {
    /// Opens the line, 8 bits without parity, one stop bit, no flow control.
    pub fn open(device: &str, baud: u32) -> Result<Self, LinkError> {
        let mut port = SerialPort::open(device, baud).map_err(|error| why(device, error))?;
        port.set_write_timeout(WRITE_MAX).map_err(|error| why(device, error))?;
        Ok(Self {
            device: device.to_owned(),
            port,
            lines: Lines::new(),
            read: Vec::with_capacity(READ_LEN),
            broken: true,
        })
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
        let whole = if self.broken { self.port.write_all(&[0]) } else { Ok(()) };
        match whole.and_then(|()| self.port.write_all(&line)) {
            Ok(()) => {
                self.broken = false;
                Ok(())
            }
            Err(error) if error.kind() == io::ErrorKind::TimedOut => {
                self.broken = true;
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

    fn advice(&self) -> String {
        format!(
            "does the base station at {} run at this rate, and are the robots on its channel and of this team and key? {} pieces \
             between zeros were no frames",
            self.device,
            self.lines.dropped()
        )
    }
}

/// Bytes taken from the system at once.
const READ_LEN: usize = 1024;

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

    /// A line whose other end is in our hands.
    fn pair() -> (SerialPort, SerialLink) {
        let (ours, theirs) = SerialPort::pair().unwrap();
        let link = SerialLink {
            device: "pair".into(),
            port: theirs,
            lines: Lines::new(),
            read: Vec::new(),
            broken: true,
        };
        (ours, link)
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
        let mut heard = Vec::new();
        while heard.len() < 2 {
            let len = station.read(&mut bytes).unwrap();
            heard.extend(bytes[..len].iter().filter_map(|byte| lines.push(*byte)));
        }
        assert_eq!(heard, [frame.clone(), frame]);
    }

    #[test]
    fn a_line_that_is_not_there_is_named_with_those_that_are() {
        let error = SerialLink::open("/dev/no-such-line", 1_000_000).unwrap_err();
        assert!(matches!(error, LinkError::NoSuchLine { .. }), "{error}");
        assert!(error.to_string().contains("/dev/no-such-line"));
    }
}
