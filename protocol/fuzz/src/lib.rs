//! `fuzz`: fuzz targets of every reader of external bytes, for `cargo fuzz` and for the seeded loop of CI.
//!
//! A target panics where a reader does, where something without the key is accepted, or where a message
//! changes in an encoding round trip.
#![forbid(unsafe_code)]

use std::fmt::Debug;

use protocol::bring_up::{self, CheckState, Reporter};
use protocol::frame::{FRAME_LEN_MAX, Frame, SHORT_TAG_LEN, Sender, TAG_LEN, TeamKey, open_report};
use protocol::host::HostMessage;
use protocol::host_link::HostLink;
use protocol::link::{Link, Received, overhear, overhear_host};
use protocol::lockstep::{FromRobot, ToRobot};
use protocol::pulses::{self, PulseReport};
use protocol::robot_log::{self, LogReport};
use protocol::serial::{Lines, line as stuffed};
use protocol::station::{self, StationMessage};
use protocol::team::TeamMessage;
use protocol::{Instant, RobotId, TeamId};
use serde::Serialize;
use serde::de::DeserializeOwned;
use ssl::log::{MessageKind, Packet, guess};
use ssl::stream::FrameReader;

/// A target: its name, which is its corpus' directory too, and its function.
pub type Target = (&'static str, fn(&[u8]));

/// All fuzz targets, one a kind of input.
pub const TARGETS: [Target; 7] = [
    ("frame", frame),
    ("line", line),
    ("team", team),
    ("host", host),
    ("station", station),
    ("lockstep", lockstep),
    ("ssl", league),
];

/// Target: a radio frame.
pub fn frame(bytes: &[u8]) {
    let (team, key) = (TeamId(1), TeamKey([0x5a; 16]));
    if let Ok(frame) = Frame::parse(bytes, team) {
        let keys = TeamKey::ZERO.of_team();
        let (written, tags) = match frame.audience {
            None => (frame.emit(keys.team()), TAG_LEN),
            Some(audience) => (frame.emit_to_audience(&keys), SHORT_TAG_LEN * audience.len()),
        };
        let out = written.expect("a frame that was read can be written");
        assert_eq!(Frame::parse(&out, team), Ok(frame));
        let covered = out.len() - tags;
        assert_eq!(out[..covered], bytes[..covered]);
    }
    // The key belongs to no sender: every frame is refused.
    let (mut robot, now) = (Link::new(team, RobotId::ZERO, key.of_robot(RobotId::ZERO), 3), Instant(0));
    let opened = robot.open(now, bytes);
    assert!(matches!(opened, Err(_) | Ok(Received::Elsewhere)));
    assert!(HostLink::new(team, key, 3).open(now, bytes).is_err());
    assert_eq!(robot.refused().iter().sum::<u32>(), u32::from(opened.is_err()));
    let _message = overhear(bytes, team, &TeamKey::ZERO.of_team());
    let _message = overhear_host(bytes, team, &TeamKey::ZERO.of_robot(RobotId::ZERO), RobotId::ZERO);
}

/// Target: bytes of a serial line.
pub fn line(bytes: &[u8]) {
    let mut lines = Lines::new();
    for packet in bytes.iter().filter_map(|byte| lines.push(*byte)) {
        assert!(packet.len() <= FRAME_LEN_MAX);
        let mut again = Lines::new();
        let came: Vec<_> = stuffed(&packet).iter().filter_map(|byte| again.push(*byte)).collect();
        if !packet.is_empty() {
            assert_eq!(came, [packet]);
        }
    }
}

/// Target: a robot's message, or a report of a bring-up image, as it is and in a genuine frame.
pub fn team(bytes: &[u8]) {
    same_again::<TeamMessage>(bytes);
    let (team, keys, sender) = (TeamId(1), TeamKey::ZERO.of_team(), Sender::Robot(RobotId::ZERO));
    let frame = Frame { team, sender, audience: None, epoch: 1, counter: 1, payload: bytes };
    let genuine = frame.emit(keys.of(RobotId::ZERO));
    if let Some((_, _, report)) = genuine.iter().find_map(|packet| bring_up::open(packet, team, &keys).ok()) {
        assert!(bytes.first() == Some(&bring_up::KIND) && !format!("{report:?}").is_empty());
        if let CheckState::Failed(finding) = report.state {
            assert!(!format!("{}: {finding}", report.check).is_empty());
        }
    }
    if let Some(packet) = &genuine
        && let Ok((_, _, report)) = open_report::<PulseReport>(packet, (team, &keys), pulses::KIND)
    {
        assert!(bytes.first() == Some(&pulses::KIND) && !format!("{report:?}").is_empty());
    }
    if let Some(packet) = &genuine
        && let Ok((_, _, report)) = open_report::<LogReport>(packet, (team, &keys), robot_log::KIND)
    {
        assert!(bytes.first() == Some(&robot_log::KIND) && report.bytes.len() <= robot_log::PIECE_LEN_MAX);
    }
}

/// Target: the host's message, or its order of a pulse in a genuine frame.
pub fn host(bytes: &[u8]) {
    if let Some(message) = same_again::<HostMessage>(bytes) {
        let _sound = message.is_sound();
    }
    let (team, robot, key) = (TeamId(1), RobotId::ZERO, TeamKey::ZERO.of_robot(RobotId::ZERO).host);
    let frame = Frame { team, sender: Sender::Host, audience: None, epoch: 1, counter: 1, payload: bytes };
    let who = Reporter { team, robot, key, epoch: 1 };
    if frame.emit(&key).is_some_and(|packet| pulses::open_order(&packet, &who).is_some()) {
        assert_eq!(bytes.first(), Some(&pulses::KIND));
    }
}

/// Target: a message between host and base station, as it is and with its check.
pub fn station(bytes: &[u8]) {
    let _message = same_again::<StationMessage>(bytes);
    if let Some(message) = station::read(bytes) {
        assert_eq!(station::read(&station::packet(&message)).as_ref(), Some(&message));
    }
}

/// Target: a message between simulator and computer.
pub fn lockstep(bytes: &[u8]) {
    let question = postcard::take_from_bytes::<ToRobot<'_>>(bytes);
    let answer = postcard::take_from_bytes::<FromRobot<'_>>(bytes);
    assert!(format!("{question:?} {answer:?}").len() > 2);
}

/// Target: a packet of the league, as a datagram and as a stream.
pub fn league(bytes: &[u8]) {
    let guessed = guess(bytes);
    for kind in [
        MessageKind::Unknown,
        MessageKind::Vision2010,
        MessageKind::Vision2014,
        MessageKind::Refbox2013,
        MessageKind::Tracker2020,
    ] {
        let packet = Packet::decode(kind, bytes);
        assert!(guessed != Some(kind) || packet.is_ok());
    }
    let mut reader = FrameReader::new(4_096);
    reader.push(bytes);
    while let Ok(Some(message)) = reader.next_message() {
        assert!(message.len() <= bytes.len());
    }
}

/// If the bytes start with a message, it is the same after encoding and decoding.
fn same_again<T>(bytes: &[u8]) -> Option<T>
where
    T: Serialize + DeserializeOwned + PartialEq + Debug,
{
    let (message, _) = postcard::take_from_bytes::<T>(bytes).ok()?;
    let mut out = [0; 512];
    let again = postcard::to_slice(&message, &mut out).expect("what was read can be written");
    assert_eq!(postcard::from_bytes::<T>(again).as_ref(), Ok(&message));
    Some(message)
}
