//! `unlike`: what differs between two records, two orders or two places, as text. Places in m, field frame;
//! times in s on the hosts' clock.

use std::fmt::Debug;

use foreign::{excerpt, printable};
use host::record::trace::{Record, RecordKind};
use host::world::World;
use protocol::{RobotId, Who};
use rules::Colour;
use serde::Serialize;
use ssl::Message;
use ssl::referee::Referee;
use ssl::vision::WrapperPacket;

use super::trace_file::record_label;

/// Bytes of a packet that are printed from the first that differs on.
const BYTES_SHOWN: usize = 8;
/// Longest part of a value from a file that is printed, characters.
const VALUE_LEN: usize = 200;

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum What {
    /// An input or output of a host.
    Record,
    /// A robot's order, with its reason.
    Order,
    /// Position, heading or velocity of a robot or the ball, as tracked.
    Position,
    /// A coordinator's decision on a case.
    Decision,
    /// One trace goes on where the other has ended.
    Length,
}

impl What {
    pub(super) const fn label(self) -> &'static str {
        match self {
            Self::Record => "record",
            Self::Order => "order",
            Self::Position => "position",
            Self::Decision => "decision on a case",
            Self::Length => "length",
        }
    }
}

/// A difference between two traces, with both values.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct Unlike {
    pub(super) at_s: f64,
    /// Number of the tick of 10 ms.
    pub(super) tick: u64,
    pub(super) what: What,
    /// The robot, the ball, or the kind of the record and its field.
    pub(super) of: String,
    /// The value in the first trace.
    pub(super) a: String,
    /// The value in the second trace.
    pub(super) b: String,
}

impl Unlike {
    /// Three lines: what and when, then both values below each other.
    pub(super) fn text(&self) -> String {
        let Self { at_s, tick, what, of, a, b } = self;
        format!("{}: {of}, at {at_s:.6} s (tick {tick})\n  A: {a}\n  B: {b}\n", what.label())
    }
}

pub(super) fn host_name(number: u8, colours: &[Colour]) -> String {
    colours.get(usize::from(number)).map_or_else(
        || format!("host {number}, which the header does not name"),
        |colour| colour.label().to_owned(),
    )
}

/// Difference between two records in the same place: the field, and both values.
pub(super) fn records(a: &Record, b: &Record, colours: &[Colour]) -> (String, String, String) {
    let both = |of: String, value: &dyn Fn(&Record) -> String| (of, value(a), value(b));
    if (a.kind, a.host) != (b.kind, b.host) {
        return both("kind".to_owned(), &|record| whole(record, colours));
    }
    let of = format!("{} of {}", record_label(a.kind), host_name(a.host, colours));
    if a.at != b.at {
        return both(format!("{of}, time"), &|record| format!("{:.6} s", record.at.0 as f64 * 1e-6));
    }
    if a.from != b.from {
        return both(format!("{of}, sender"), &|record| record.from.to_string());
    }
    let fields = match a.kind {
        RecordKind::Vision => field::<WrapperPacket>(a, b),
        RecordKind::Referee => field::<Referee>(a, b),
        RecordKind::Orders | RecordKind::Parameter | RecordKind::Test => {
            let text = |record: &Record| excerpt(&String::from_utf8_lossy(&record.bytes), VALUE_LEN);
            Some(("line".to_owned(), text(a), text(b)))
        }
        _ => None,
    };
    match fields {
        Some((name, a, b)) => (format!("{of}, {name}"), a, b),
        None => bytes(&of, a, b),
    }
}

pub(super) fn whole(record: &Record, colours: &[Colour]) -> String {
    let (kind, host) = (record_label(record.kind), host_name(record.host, colours));
    format!("{kind} of {host} at {:.6} s, {} bytes", record.at.0 as f64 * 1e-6, record.bytes.len())
}

/// The first byte that differs; in a packet to robots the first byte is the robot that it is for.
fn bytes(of: &str, a: &Record, b: &Record) -> (String, String, String) {
    let at = a.bytes.iter().zip(&b.bytes).take_while(|(a, b)| a == b).count();
    let to = match (a.kind, a.bytes.first().copied().map(RobotId::new)) {
        (RecordKind::Sent, Some(Some(robot))) => format!(" to robot {}", robot.number()),
        (RecordKind::Sent, Some(None)) => " to all robots".to_owned(),
        _ => String::new(),
    };
    let value = |record: &Record| {
        let shown = record.bytes.iter().skip(at).take(BYTES_SHOWN);
        let shown: Vec<_> = shown.map(|byte| format!("{byte:02x}")).collect();
        format!("{} bytes, from byte {at} on: {}", record.bytes.len(), shown.join(" "))
    };
    (format!("{of}{to}, byte {at}"), value(a), value(b))
}

/// The first field of a league message that differs; none where one cannot be read.
fn field<M: Message + Debug + Default>(a: &Record, b: &Record) -> Option<(String, String, String)> {
    let text = |record: &Record| M::decode(&record.bytes[..]).ok().map(|packet| format!("{packet:#?}"));
    first_line(&text(a)?, &text(b)?)
}

/// The first line that differs between two values in `Debug`'s layout, with the names of what it is in:
/// such a line ends with a bracket, and what is in it stands farther to the right. Elements of lists have
/// numbers.
fn first_line(a: &str, b: &str) -> Option<(String, String, String)> {
    let (mut left, mut right) = (a.lines(), b.lines());
    // Depth and name; of a list also the number of its elements so far.
    let mut above: Vec<(usize, String, Option<usize>)> = Vec::new();
    loop {
        let (a, b) = (left.next(), right.next());
        let line = a.or(b)?;
        let depth = line.len() - line.trim_start().len();
        above.retain(|(other, ..)| *other < depth);
        let (name, _) = line.trim().split_once(": ").unwrap_or_default();
        if a != b {
            let names = above.iter().map(|(_, name, _)| &**name).chain([name]);
            let path = names.filter(|name| !name.is_empty()).collect::<Vec<_>>().join(" ");
            let value = |line: Option<&str>| {
                let line = line.map_or("nothing more", str::trim).trim_end_matches(',');
                let value = line.strip_prefix(name).and_then(|rest| rest.strip_prefix(": "));
                excerpt(value.unwrap_or(line), VALUE_LEN)
            };
            return Some((printable(&path).into_owned(), value(a), value(b)));
        }
        if line.ends_with(['{', '(', '[']) {
            let number = above.last_mut().and_then(|(_, _, count)| count.as_mut()).map(|count| {
                *count += 1;
                count.to_string()
            });
            let name = number.unwrap_or_else(|| name.to_owned());
            above.push((depth, name, line.ends_with('[').then_some(0)));
        }
    }
}

/// The first of ball and robots whose state differs, with both states.
pub(super) fn worlds(a: &World, b: &World) -> Option<(String, String, String)> {
    let (left, right) = (ball_text(a), ball_text(b));
    if left != right {
        return Some(("ball".to_owned(), left, right));
    }
    [Colour::Blue, Colour::Yellow]
        .into_iter()
        .flat_map(|colour| RobotId::all().map(move |id| Who { colour, id }))
        .filter(|who| a.robot(*who) != b.robot(*who))
        .map(|who| (who, robot_text(a, who), robot_text(b, who)))
        .find(|(_, left, right)| left != right)
        .map(|(who, left, right)| (format!("{} {}", who.colour.label(), who.id.number()), left, right))
}

fn ball_text(world: &World) -> String {
    let Some(ball) = &world.ball else { return "not seen".to_owned() };
    let (at, v) = (ball.position, ball.velocity);
    format!("at ({}, {}) m, {} m high, ({}, {}) m/s", at.x(), at.y(), ball.height, v.x(), v.y())
}

fn robot_text(world: &World, who: Who) -> String {
    let Some(robot) = world.robot(who) else { return "not seen".to_owned() };
    let (at, v, heading) = (robot.pose.position, robot.velocity, robot.pose.heading.radians());
    format!("at ({}, {}) m, heading {heading} rad, ({}, {}) m/s", at.x(), at.y(), v.x(), v.y())
}

#[cfg(test)]
mod tests {
    use host::referee::SenderAddress;
    use protocol::Instant;
    use ssl::vision::{DetectionFrame, DetectionRobot};

    use super::*;

    fn image(x: f32) -> Record {
        let robot = |id, x| DetectionRobot { robot_id: Some(id), x, ..DetectionRobot::default() };
        let robots_blue = vec![robot(1, 0.0), robot(3, x)];
        let image = DetectionFrame { frame_number: 7, robots_blue, ..DetectionFrame::default() };
        let bytes = WrapperPacket { detection: Some(image), ..WrapperPacket::default() }.encode_to_vec();
        let from = SenderAddress::INTERNAL;
        Record { at: Instant(20_000), host: 0, kind: RecordKind::Vision, from, bytes }
    }

    #[test]
    fn the_field_of_a_camera_frame_that_differs_is_named_with_both_values() {
        let (of, a, b) = records(&image(120.0), &image(121.0), &[Colour::Blue]);
        assert_eq!((&*a, &*b), ("120.0", "121.0"), "{of}");
        assert_eq!(of, "vision of blue, detection robots_blue 2 x");
    }

    #[test]
    fn a_packet_is_compared_byte_by_byte_and_names_its_robot() {
        let sent = |last| Record { kind: RecordKind::Sent, bytes: vec![4, 1, 2, last], ..image(0.0) };
        let (of, a, b) = records(&sent(3), &sent(9), &[Colour::Blue]);
        assert_eq!(of, "sent of blue to robot 4, byte 3");
        assert_eq!((&*a, &*b), ("4 bytes, from byte 3 on: 03", "4 bytes, from byte 3 on: 09"));
    }

    #[test]
    fn what_cannot_be_read_is_compared_byte_by_byte() {
        let broken = |last| Record { bytes: vec![255, last], ..image(0.0) };
        let (of, ..) = records(&broken(1), &broken(2), &[]);
        assert_eq!(of, "vision of host 0, which the header does not name, byte 1");
    }

    #[test]
    fn equal_worlds_do_not_differ() {
        assert_eq!(worlds(&World::default(), &World::default()), None);
    }
}
