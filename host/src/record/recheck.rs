//! `recheck`: replay check of a host's decisions. Feeds a trace's inputs to hosts built from its header and
//! compares every packet they send with the record, byte for byte (docs/architecture.md §7.4).

use std::collections::VecDeque;
use std::fmt;

use protocol::frame::TeamKey;
use protocol::{Instant, RobotId};

use crate::radio::To;
use crate::record::header::{HeaderError, RecordingHeader};
use crate::record::trace::{Record, RecordKind};
use crate::{Host, Input};

/// The hosts of a recording, fed with its inputs again.
#[derive(Debug)]
pub struct Recheck {
    hosts: Vec<Checked>,
}

/// One host, built again.
#[derive(Debug)]
struct Checked {
    host: Host,
    sent_bytes: VecDeque<(Instant, Vec<u8>)>,
    counts: RecheckCounts,
    difference: Option<Difference>,
}

/// Counts of one host under check.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RecheckCounts {
    /// Number of inputs fed.
    pub inputs: u64,
    /// Packets that were the same.
    pub same: u64,
}

/// Difference between record and host. Times on the host's clock.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Difference {
    /// The host sends another packet than recorded.
    Other {
        /// When it was recorded.
        at: Instant,
        /// Number of packets that were the same before.
        after: u64,
        /// The packet recorded: the robot it is for (255: all), then the frame.
        recorded: Vec<u8>,
        /// The host's packet, and when it sent it.
        sent_bytes: (Instant, Vec<u8>),
    },
    /// The record has a packet that the host does not send.
    Missing {
        /// When it was recorded.
        at: Instant,
        /// Number of packets that were the same before.
        after: u64,
        /// Number of the receiving robot; 255 for all.
        to: u8,
    },
    /// The host sends a packet that is not in the record.
    Extra {
        /// When the host sent it.
        at: Instant,
        /// Number of packets that were the same before.
        after: u64,
        /// Number of the receiving robot; 255 for all.
        to: u8,
    },
}

impl Difference {
    /// When the record and the host differ first.
    pub fn at(&self) -> Instant {
        match self {
            Self::Other { at, .. } | Self::Missing { at, .. } | Self::Extra { at, .. } => *at,
        }
    }
}

fn whom(to: u8) -> String {
    RobotId::new(to).map_or_else(|| "all robots".to_owned(), |robot| format!("robot {}", robot.number()))
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let seconds = self.at().0 as f64 * 1e-6;
        match self {
            Self::Other { after, recorded, sent_bytes: (at, sent_bytes), .. } => {
                let byte = recorded.iter().zip(sent_bytes).take_while(|(a, b)| a == b).count();
                let to = whom(recorded.first().copied().unwrap_or(u8::MAX));
                write!(f, "at {seconds:.6} s, after {after} packets that are the same: the packet to {to} ")?;
                if byte == recorded.len() && byte == sent_bytes.len() {
                    write!(f, "is sent at {:.6} s", at.0 as f64 * 1e-6)
                } else {
                    write!(
                        f,
                        "differs from byte {} on ({} bytes recorded, {} sent)",
                        byte.max(1) - 1,
                        recorded.len() - 1,
                        sent_bytes.len() - 1
                    )
                }
            }
            Self::Missing { after, to, .. } => write!(
                f,
                "at {seconds:.6} s, after {after} packets that are the same: the packet to {} is not sent again",
                whom(*to)
            ),
            Self::Extra { after, to, .. } => write!(
                f,
                "at {seconds:.6} s, after {after} packets that are the same: a packet to {} is sent that was not recorded",
                whom(*to)
            ),
        }
    }
}

impl Recheck {
    /// The hosts of a recording as they started; `key` opens sealed frames.
    pub fn new(header: &RecordingHeader, key: TeamKey) -> Result<Self, HeaderError> {
        let (league, cases) = (header.league()?, header.cases()?);
        let build = |host: &crate::record::header::HostHeader| {
            let settings = host.settings(league, cases, if host.keyed { key } else { TeamKey::ZERO })?;
            Ok(Checked {
                host: Host::new(settings, host.began()),
                sent_bytes: VecDeque::new(),
                counts: RecheckCounts::default(),
                difference: None,
            })
        };
        Ok(Self { hosts: header.hosts.iter().map(build).collect::<Result<_, _>>()? })
    }

    /// Feeds the next record. False: its host is not in the header.
    pub fn feed(&mut self, record: &Record) -> bool {
        let Some(checked) = self.hosts.get_mut(usize::from(record.host)) else { return false };
        match record.kind {
            RecordKind::Sent => checked.compare(record),
            RecordKind::Vision => checked.feed_input(record.at, Input::Vision(&record.bytes)),
            RecordKind::Referee => checked.feed_input(record.at, Input::Referee(&record.bytes, record.from)),
            RecordKind::Robot => checked.feed_input(record.at, Input::Robot(&record.bytes)),
            RecordKind::Timeout => checked.feed_input(record.at, Input::Timeout),
            RecordKind::Orders => checked.feed_input(record.at, Input::Orders(&record.bytes)),
            RecordKind::Parameter => checked.feed_input(record.at, Input::Parameter(&record.bytes)),
            RecordKind::Test => checked.feed_input(record.at, Input::Test(&record.bytes)),
            RecordKind::Halt => checked.feed_input(record.at, Input::Halt),
            RecordKind::Lost => {}
        }
        true
    }

    /// The record is over. With `cut`, packets may be missing at its end.
    pub fn finish(&mut self, cut: bool) {
        for checked in self.hosts.iter_mut().filter(|_| !cut) {
            checked.expect_nothing_left();
        }
    }

    /// Whether a host sent packets that are not in the record after its last input, and at no earlier time:
    /// the record of a match that was cut there.
    pub fn is_unfinished(&self) -> bool {
        self.hosts.iter().any(|checked| checked.difference.is_none() && !checked.sent_bytes.is_empty())
    }

    /// Host by host, in the header's order: the numbers of its inputs and packets, and where it differs from
    /// the record.
    pub fn results(&self) -> impl Iterator<Item = (RecheckCounts, Option<&Difference>)> {
        self.hosts.iter().map(|checked| (checked.counts, checked.difference.as_ref()))
    }

    /// A host as it is now.
    pub fn host(&self, number: usize) -> Option<&Host> {
        self.hosts.get(number).map(|checked| &checked.host)
    }
}

impl Checked {
    fn feed_input(&mut self, at: Instant, input: Input<'_>) {
        self.expect_nothing_left();
        self.counts.inputs += 1;
        self.host.handle(at, input);
        while let Some((to, packet)) = self.host.poll_packet() {
            let mut bytes = vec![match to {
                To::All => u8::MAX,
                To::One(robot) => robot.number(),
            }];
            bytes.extend_from_slice(&packet);
            self.sent_bytes.push_back((at, bytes));
        }
    }

    fn compare(&mut self, record: &Record) {
        let sent_bytes = self.sent_bytes.pop_front();
        if self.difference.is_some() {
            return;
        }
        let (at, after) = (record.at, self.counts.same);
        match sent_bytes {
            Some((when, bytes)) if when == at && bytes == record.bytes => self.counts.same += 1,
            Some(sent_bytes) => {
                self.difference =
                    Some(Difference::Other { at, after, recorded: record.bytes.clone(), sent_bytes });
            }
            None => {
                let to = record.bytes.first().copied().unwrap_or(u8::MAX);
                self.difference = Some(Difference::Missing { at, after, to });
            }
        }
    }

    fn expect_nothing_left(&mut self) {
        if let Some((at, bytes)) = self.sent_bytes.pop_front() {
            self.sent_bytes.clear();
            let to = bytes.first().copied().unwrap_or(u8::MAX);
            self.difference.get_or_insert(Difference::Extra { at, after: self.counts.same, to });
        }
    }
}

#[cfg(test)]
mod tests {
    use protocol::Duration;
    use rules::{Colour, League};
    use ssl::Message;
    use ssl::vision::{DetectionFrame, DetectionRobot, WrapperPacket};

    use super::*;
    use crate::HostSettings;
    use crate::referee::SenderAddress;

    fn header() -> RecordingHeader {
        RecordingHeader::of(&HostSettings::new(Colour::Blue, League::DivisionB, 7))
    }

    fn image(number: u32) -> Vec<u8> {
        let robot = DetectionRobot {
            confidence: 1.0,
            robot_id: Some(3),
            x: 10.0 * number as f32,
            orientation: Some(0.0),
            ..DetectionRobot::default()
        };
        let image = DetectionFrame {
            frame_number: number,
            t_capture: f64::from(number) * 0.016,
            robots_blue: vec![robot],
            ..DetectionFrame::default()
        };
        WrapperPacket { detection: Some(image), ..WrapperPacket::default() }.encode_to_vec()
    }

    /// A second of vision as input of a host of this header, with the packets that it sends.
    fn recorded() -> Vec<Record> {
        let settings = header().hosts[0].settings(League::DivisionB, None, TeamKey::ZERO).unwrap();
        let mut host = Host::new(settings, Instant(0));
        let mut records = Vec::new();
        for number in 0..60 {
            let at = Instant(1_000_000) + Duration(u64::from(number) * 16_000);
            let bytes = image(number);
            host.handle(at, Input::Vision(&bytes));
            records.push(Record {
                at,
                host: 0,
                kind: RecordKind::Vision,
                from: SenderAddress::INTERNAL,
                bytes,
            });
            while let Some((to, packet)) = host.poll_packet() {
                let to = if let To::One(robot) = to { robot.number() } else { u8::MAX };
                let bytes = [&[to], &packet[..]].concat();
                records.push(Record {
                    at,
                    host: 0,
                    kind: RecordKind::Sent,
                    from: SenderAddress::INTERNAL,
                    bytes,
                });
            }
        }
        records
    }

    fn check(records: &[Record]) -> (RecheckCounts, Option<Difference>) {
        let mut recheck = Recheck::new(&header(), TeamKey::ZERO).unwrap();
        for record in records {
            assert!(recheck.feed(record));
        }
        recheck.finish(false);
        recheck.results().map(|(counts, difference)| (counts, difference.cloned())).next().unwrap()
    }

    #[test]
    fn the_same_inputs_give_the_same_packets() {
        let records = recorded();
        let sent = records.iter().filter(|record| record.kind == RecordKind::Sent).count() as u64;
        assert!(sent > 50, "{sent}");
        assert_eq!(check(&records), (RecheckCounts { inputs: 60, same: sent }, None));
    }

    #[test]
    fn one_byte_that_differs_is_found_with_its_time() {
        let mut records = recorded();
        let place = records.iter().rposition(|record| record.kind == RecordKind::Sent).unwrap();
        records[place].bytes[15] ^= 1;
        let (_, difference) = check(&records);
        let difference = difference.unwrap();
        assert_eq!(difference.at(), records[place].at);
        assert!(difference.to_string().contains("differs from byte 14 on"), "{difference}");
    }

    #[test]
    fn a_packet_too_few_or_too_many_is_reported() {
        let records = recorded();
        let place = records.iter().rposition(|record| record.kind == RecordKind::Sent).unwrap();
        let mut fewer = records.clone();
        fewer.remove(place);
        assert!(matches!(check(&fewer).1, Some(Difference::Extra { .. } | Difference::Other { .. })));
        let mut more = records.clone();
        more.push(records[place].clone());
        assert!(matches!(check(&more).1, Some(Difference::Missing { .. })));
    }

    #[test]
    fn a_record_of_no_host_is_not_fed() {
        let mut recheck = Recheck::new(&header(), TeamKey::ZERO).unwrap();
        let from = SenderAddress::INTERNAL;
        let stray = Record { at: Instant(0), host: 9, kind: RecordKind::Timeout, from, bytes: Vec::new() };
        assert!(!recheck.feed(&stray));
    }
}
