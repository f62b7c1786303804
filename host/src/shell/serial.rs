//! `serial`: robots through a base station at a serial line. Frames between zero bytes (`protocol::serial`).
//!
//! Bytes that the system has taken can neither be replaced nor overtaken, and their number is not available
//! on every system (a pseudo terminal and some USB adapters always report 0). So the link hands over no more
//! than the line carries at its rate: at most [`BUFFERED_TIME`] waits behind it, and HALT discards even that.

use std::io;
use std::path::Path;
use std::time::{Duration, Instant};

use protocol::TeamId;
use protocol::link::Packet;
use protocol::serial::{Lines, line};
use protocol::station::{self, RadioPlan, StationMessage};
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
/// Interval at which the base station gets its channel and rate, and reports its counts.
const PLAN_EVERY: Duration = Duration::from_secs(1);
/// Time after which a base station that does not answer is reported.
const ANSWER_WITHIN: Duration = Duration::from_secs(5);
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
    planned: Planned,
}

/// The plan sent to the base station, and its answer.
#[derive(Debug, Default)]
struct Planned {
    plan: Option<(TeamId, RadioPlan)>,
    /// When the plan was sent first, and last.
    sent: Option<(Instant, Instant)>,
    /// The plan that it follows, by its newest report.
    follows: Option<RadioPlan>,
    /// Whether a frame of a robot came: through a modem too, which answers to no plan.
    hears_robots: bool,
    /// What was last said of it to the operator.
    said: Option<Said>,
}

/// A difference between the plan and the base station.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Said {
    NoAnswer,
    Elsewhere(RadioPlan),
}

impl Planned {
    /// The line with the plan, if it is due.
    fn due(&mut self) -> Option<Packet> {
        let (team, plan) = self.plan?;
        let now = Instant::now();
        if self.sent.is_some_and(|(_, last)| now.duration_since(last) < PLAN_EVERY) {
            return None;
        }
        self.sent = Some((self.sent.map_or(now, |(first, _)| first), now));
        Some(station::packet(&StationMessage::Plan(team, plan)))
    }

    /// What the operator should know, each once.
    fn notice(&mut self, device: &str) -> Option<String> {
        let (_, plan) = self.plan?;
        let (first, _) = self.sent?;
        let said = match self.follows {
            Some(follows) if follows == plan => None,
            Some(follows) => Some(Said::Elsewhere(follows)),
            None if self.hears_robots || first.elapsed() < ANSWER_WITHIN => return None,
            None => Some(Said::NoAnswer),
        };
        if said == self.said {
            return None;
        }
        self.said = said;
        Some(match said? {
            Said::NoAnswer => format!(
                "{device}: no robot is heard, and no base station answers to radio settings: one of before 0.2 is on its team's default \
                 channel, where robots of this release do not hear it (flash it again); a modem never answers"
            ),
            Said::Elsewhere(follows) => format!(
                "{device}: the base station is on channel {} at {} Mbit/s, not on {} at {}: no robot followed it there; are they on, \
                 and is that channel free (onetwo robot scan)?",
                follows.channel, follows.megabits, plan.channel, plan.megabits
            ),
        })
    }
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
            planned: Planned::default(),
        }
    }

    /// Sends the base station its team's channel and rate from now on.
    #[must_use]
    pub fn planned(mut self, team: TeamId, plan: RadioPlan) -> Self {
        self.planned.plan = Some((team, plan));
        self
    }

    fn send_plan(&mut self) -> Result<(), LinkError> {
        self.planned.due().map_or(Ok(()), |packet| self.send(To::All, &packet))
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
        if let Some(StationMessage::Report(report)) = found.as_deref().and_then(station::read) {
            self.planned.follows = Some(report.plan);
        }
        self.planned.hears_robots |= found.as_deref().is_some_and(|packet| !station::is_message(packet));
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
        self.send_plan()?;
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
        if let Some(notice) = self.planned.notice(&self.device) {
            return Some(notice);
        }
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
    fn a_base_station_gets_its_plan_and_what_it_does_else_is_said_once() {
        let (mut station, link) = pair();
        let plan = RadioPlan { channel: 40, megabits: 2, address: 7 };
        let mut link = link.planned(TeamId(2), plan);
        station.set_read_timeout(SECOND).unwrap();
        assert_eq!(link.receive(Duration::from_millis(1)).unwrap(), None);
        let (mut bytes, mut lines) = ([0; 64], Lines::new());
        let len = station.read(&mut bytes).unwrap();
        let sent =
            bytes[..len].iter().find_map(|byte| lines.push(*byte)).and_then(|line| station::read(&line));
        assert_eq!(sent, Some(StationMessage::Plan(TeamId(2), plan)));
        for (channel, expected) in [(6, true), (6, false), (40, false), (6, true)] {
            let plan = RadioPlan { channel, ..plan };
            let (robot, packets) = (protocol::RobotId::ZERO, station::PacketCounts::default());
            let report = station::StationReport { plan, restarts: 0, robot, packets };
            station.write_all(&line(&station::packet(&StationMessage::Report(report)))).unwrap();
            assert!(link.receive(SECOND).unwrap().is_some());
            let notice = link.notice();
            assert_eq!(notice.is_some(), expected, "{channel}: {notice:?}");
            assert!(notice.is_none_or(|text| text.contains("is on channel 6 at 2 Mbit/s, not on 40")));
        }
    }

    #[test]
    fn a_base_station_that_does_not_answer_is_said_once_and_not_where_robots_are_heard() {
        let plan = Some((TeamId(2), RadioPlan::of_team(TeamId(2))));
        let sent = Instant::now().checked_sub(2 * ANSWER_WITHIN).map(|first| (first, first));
        let mut silent = Planned { plan, sent, ..Planned::default() };
        assert!(silent.notice("tty").unwrap().contains("no base station answers"));
        assert_eq!(silent.notice("tty"), None);
        let mut modem = Planned { plan, sent, hears_robots: true, ..Planned::default() };
        assert_eq!(modem.notice("tty"), None);
    }

    #[test]
    fn a_line_that_is_not_there_is_named_with_those_that_are() {
        let error = SerialLink::open("/dev/no-such-line", 1_000_000).unwrap_err();
        assert!(matches!(error, LinkError::NoSuchLine { .. }), "{error}");
        assert!(error.to_string().contains("/dev/no-such-line"));
    }
}
