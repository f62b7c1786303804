//! `packets`: sequences of packets with their times, from a recorded match and mutated, into a whole host:
//! vision, referee, robots' frames, answers of a strategy, the page's requests, HALT. µs.

use arena::game::{self, GameConfig, Watcher, header};
use hil_sim::{NativeBackend, Stream};
use host::health_checks::HealthChecks;
use host::record::header::RecordingHeader;
use host::record::trace::{Record, RecordKind, Writer};
use host::referee::SenderAddress;
use host::{Host, Input};
use protocol::frame::{FRAME_LEN_MAX, TeamKey};
use protocol::{Duration, Instant};
use rules::{Colour, League};
use ssl::Message as _;
use ssl::referee::{Point, Referee};
use ssl::vision::WrapperPacket;

use super::{Labels, Material, label};

/// A recorded match: its header, and what blue's host received.
#[derive(Debug)]
pub struct Packets {
    header: RecordingHeader,
    records: Vec<Record>,
}

impl Packets {
    /// Plays a match and keeps it.
    ///
    /// # Errors
    /// It cannot be played, in words.
    pub fn record() -> Result<Self, String> {
        let config = GameConfig::new(League::DivisionB, SEED, MATCH_S);
        let mut records = Blue(Vec::new());
        let mut backend = NativeBackend::new(host::cases_of(config.league));
        game::play(&config, &mut backend, &mut records).map_err(|error| error.to_string())?;
        Ok(Self { header: header("", "", &config), records: records.0 })
    }
}

/// A trace of the first inputs of a match.
pub(super) fn short_trace() -> Result<Vec<u8>, String> {
    let Packets { header, records } = Packets::record()?;
    let written = Writer::new(Vec::new(), &header.to_json()).and_then(|mut writer| {
        for record in records.iter().take(TRACE_RECORDS) {
            let (from, bytes) = (record.from.to_bytes(), &record.bytes[..]);
            let is_referee = record.kind == RecordKind::Referee;
            let parts = if is_referee { &[&from[..], bytes][..] } else { &[bytes] };
            writer.write(record.at, 1, record.kind, parts)?;
        }
        writer.finish()
    });
    written.map_err(|error| error.to_string())
}

struct Blue(Vec<Record>);

impl Watcher for Blue {
    fn input(&mut self, at: Instant, host: Colour, input: Input<'_>) {
        let (kind, from, bytes) = match input {
            Input::Vision(bytes) => (RecordKind::Vision, SenderAddress::INTERNAL, bytes),
            Input::Referee(bytes, from) => (RecordKind::Referee, from, bytes),
            Input::Robot(bytes) => (RecordKind::Robot, SenderAddress::INTERNAL, bytes),
            _ => return,
        };
        if host == Colour::Blue {
            self.0.push(Record { at, host: 0, kind, from, bytes: bytes.to_vec() });
        }
    }
}

pub(super) fn play(material: &Material, recipe: &[u64], labels: &mut Labels) -> Result<u64, String> {
    let Packets { header, records } = &material.packets;
    let mut chance = Stream::new(recipe.first().copied().unwrap_or_default(), "soak match");
    // A part of the match, so that recipes begin in every phase of it.
    let length = records.len().min(chance.whole(100, PART as u32) as usize);
    let from = chance.whole(0, (records.len() - length) as u32) as usize;
    let mut part = records[from..from + length].to_vec();
    for seed in recipe {
        mutate(&mut part, &mut Stream::new(*seed, "soak packets"));
    }
    let began = part.first().map_or(Instant(0), |first| first.at);
    let own = header.hosts.iter().find(|host| host.colour() == Ok(Colour::Blue));
    let mut settings = own
        .ok_or("no blue host")?
        .settings(League::DivisionB, None, TeamKey::ZERO)
        .map_err(|error| error.to_string())?;
    settings.external = chance.chance(0.3);
    settings.learns = chance.chance(0.5);
    Run { host: Host::new(settings, began), health: HealthChecks::default(), labels }.all(&part)
}

/// A host and what it showed so far.
struct Run<'a> {
    host: Host,
    health: HealthChecks,
    labels: &'a mut Labels,
}

impl Run<'_> {
    fn all(mut self, part: &[Record]) -> Result<u64, String> {
        for (number, record) in part.iter().enumerate() {
            for _ in 0..TIMEOUTS_MAX {
                let Some(due) = self.host.poll_timeout().filter(|due| *due <= record.at) else { break };
                self.step(due, Input::Timeout)?;
            }
            self.step(record.at, input(record))?;
            if number % LOOK_EVERY == 0 {
                let faults = self.health.look(record.at, &self.host);
                self.labels.extend(faults.iter().map(|fault| format!("fault {}", label(&fault.matter()))));
                self.labels.insert(format!("phase {}", label(&format!("{:?}", self.host.game().phase))));
            }
        }
        Ok(part.len() as u64)
    }

    /// An input, and what must hold after it: frames fit, orders are finite, HALT lasts.
    fn step(&mut self, now: Instant, input: Input<'_>) -> Result<(), String> {
        let halted = matches!(input, Input::Halt);
        let verdict = self.host.handle(now, input);
        self.labels.insert(format!("verdict {}", label(&format!("{verdict:?}"))));
        while let Some((_, packet)) = self.host.poll_packet() {
            if packet.len() > FRAME_LEN_MAX {
                return Err(format!("at {} µs a frame of {} bytes", now.0, packet.len()));
            }
        }
        while self.host.poll_request().is_some() {}
        self.host.poll_view();
        let orders = format!("{:?}", self.host.orders());
        if orders.contains("NaN") || orders.contains("inf,") || orders.contains("inf ") {
            return Err(format!("at {} µs an order without a finite number: {orders}", now.0));
        }
        if halted && !self.host.is_halting() {
            return Err(format!("at {} µs HALT does not hold", now.0));
        }
        Ok(())
    }
}

fn input(record: &Record) -> Input<'_> {
    match record.kind {
        RecordKind::Vision => Input::Vision(&record.bytes),
        RecordKind::Referee => Input::Referee(&record.bytes, record.from),
        RecordKind::Robot => Input::Robot(&record.bytes),
        RecordKind::Orders => Input::Orders(&record.bytes),
        RecordKind::Parameter => Input::Parameter(&record.bytes),
        RecordKind::Test => Input::Test(&record.bytes),
        RecordKind::Halt => Input::Halt,
        RecordKind::Timeout | RecordKind::Sent | RecordKind::Lost => Input::Timeout,
    }
}

/// One to eight changes of a sequence; times never go back.
fn mutate(part: &mut Vec<Record>, chance: &mut Stream) {
    for _ in 0..=chance.whole(0, 7) {
        let at = chance.whole(0, part.len().saturating_sub(1) as u32) as usize;
        let Some(record) = part.get(at).cloned() else { return };
        match chance.whole(0, 7) {
            0 => drop(part.drain(at..part.len().min(at + chance.whole(1, 200) as usize))),
            1 => {
                let pause = chance.whole(0, 3_000_000);
                part[at..].iter_mut().for_each(|later| later.at += Duration(u64::from(pause)));
            }
            2 => {
                let to = (at + chance.whole(1, 100) as usize).min(part.len() - 1);
                let late = Record { at: part[to].at, ..record };
                part.insert(to + 1, late);
            }
            3 => part[at].bytes = flipped(record.bytes, chance),
            4 => part[at].bytes = changed(&record, chance),
            5 => {
                // The same change for a while: a camera, a referee or a robot that stays wrong.
                let seed = u64::from(chance.whole(0, u32::MAX));
                for later in part[at..].iter_mut().filter(|later| later.kind == record.kind).take(100) {
                    later.bytes = changed(later, &mut Stream::new(seed, "soak change"));
                }
            }
            _ => {
                let (kind, bytes) = request(chance);
                part.insert(at, Record { kind, bytes, ..record });
            }
        }
    }
}

fn flipped(mut bytes: Vec<u8>, chance: &mut Stream) -> Vec<u8> {
    for _ in 0..=chance.whole(0, 3) {
        if !bytes.is_empty() {
            let at = chance.whole(0, bytes.len() as u32 - 1) as usize;
            bytes[at] ^= 1 << chance.whole(0, 7);
        }
    }
    bytes
}

/// The same message with other contents.
fn changed(record: &Record, chance: &mut Stream) -> Vec<u8> {
    match record.kind {
        RecordKind::Referee => Referee::decode(&record.bytes[..])
            .map_or_else(|_| record.bytes.clone(), |packet| refereed(packet, chance).encode_to_vec()),
        RecordKind::Vision => WrapperPacket::decode(&record.bytes[..])
            .map_or_else(|_| record.bytes.clone(), |packet| seen(packet, chance).encode_to_vec()),
        _ => flipped(record.bytes.clone(), chance),
    }
}

fn refereed(mut packet: Referee, chance: &mut Stream) -> Referee {
    match chance.whole(0, 6) {
        0 => {
            packet.command = chance.whole(0, 20) as i32;
            packet.command_counter = packet.command_counter.wrapping_add(chance.whole(0, 3));
        }
        1 => packet.stage = chance.whole(0, 15) as i32,
        2 => {
            let [x, y] = [0; 2].map(|_: i32| odd(chance) * 1000.0);
            packet.designated_position = Some(Point { x, y });
        }
        3 => packet.blue.goalkeeper = chance.whole(0, 20),
        4 => packet.blue.max_allowed_bots = Some(chance.whole(0, 12)),
        5 => packet.blue_team_on_positive_half = Some(chance.chance(0.5)),
        _ => {
            packet.command_timestamp =
                packet.command_timestamp.wrapping_add(u64::from(chance.whole(0, 10_000_000)));
        }
    }
    packet
}

fn seen(mut packet: WrapperPacket, chance: &mut Stream) -> WrapperPacket {
    let Some(frame) = &mut packet.detection else { return packet };
    match chance.whole(0, 6) {
        0 => frame
            .balls
            .iter_mut()
            .for_each(|ball| (ball.x, ball.y) = (odd(chance) * 1000.0, odd(chance) * 1000.0)),
        1 => frame.balls.clear(),
        2 => frame.robots_blue.iter_mut().for_each(|robot| robot.robot_id = Some(chance.whole(0, 17))),
        3 => frame
            .robots_yellow
            .iter_mut()
            .for_each(|robot| (robot.x, robot.orientation) = (odd(chance) * 1000.0, Some(odd(chance)))),
        4 => frame.robots_blue.retain(|_| chance.chance(0.5)),
        5 => frame.t_capture += f64::from(odd(chance)),
        _ => frame.camera_id = chance.whole(0, 9),
    }
    packet
}

/// A number that occurs, or one that should not.
fn odd(chance: &mut Stream) -> f32 {
    match chance.whole(0, 5) {
        0 => f32::from_bits(chance.whole(0, u32::MAX)),
        1 => chance.between(-100.0, 100.0),
        _ => chance.between(-5.0, 5.0),
    }
}

/// A line of a strategy, or a request of the page; half of them damaged.
fn request(chance: &mut Stream) -> (RecordKind, Vec<u8>) {
    let (kind, text) = REQUESTS[chance.whole(0, REQUESTS.len() as u32 - 1) as usize];
    let bytes = text.as_bytes().to_vec();
    (kind, if chance.chance(0.5) { flipped(bytes, chance) } else { bytes })
}

/// Requests that hosts accept, and some that they refuse.
const REQUESTS: [(RecordKind, &str); 14] = [
    (
        RecordKind::Orders,
        r#"{"orders":[{"robot":3,"task":{"kick":{"at":[4.5,0.2],"speed":6.0}}},{"robot":5,"task":"stand"}]}"#,
    ),
    (RecordKind::Orders, r#"{"orders":[{"robot":1,"task":{"go_to":{"at":[-4.4,0.0],"face":1e30}}}]}"#),
    (
        RecordKind::Orders,
        r#"{"orders":[{"robot":2,"task":{"pass":{"at":[1,1],"receiver":4,"speed":4,"chip":true}}}]}"#,
    ),
    (
        RecordKind::Orders,
        r#"{"orders":[{"robot":4,"task":{"receive":{"at":[1,1],"then":[4.5,0]}}}],"values":{"a":1}}"#,
    ),
    (RecordKind::Orders, r#"{"orders":[{"robot":0,"task":{"block":{"from":[0,0],"to":[0,0]}}}]}"#),
    (RecordKind::Orders, r#"{"orders":[{"robot":0,"task":{"place_ball":{"at":[20,20]}}}]}"#),
    (RecordKind::Parameter, r#"{"key":"ball.roll","value":0.05}"#),
    (RecordKind::Parameter, r#"{"key":"calibration.kick","robot":3,"value":2.0}"#),
    (RecordKind::Parameter, r#"{"key":"tactics","value":"all"}"#),
    (RecordKind::Test, r#"{"kick":{"robot":3,"kicks":5}}"#),
    (RecordKind::Test, r#"{"drive":{"robot":2,"velocity":[2.0,0.0,1.0],"dribbler":true,"kick":6.0}}"#),
    (RecordKind::Test, r#""stand""#),
    (RecordKind::Test, r#""end""#),
    (RecordKind::Halt, ""),
];
/// The recorded match: with kick-off, passes, balls out and free kicks.
const SEED: u64 = 5;
/// Its length, s.
const MATCH_S: f64 = 60.0;
/// Most records a recipe: some 4 s of the match.
const PART: usize = 2_500;
/// Records of the example of a trace.
const TRACE_RECORDS: usize = 300;
/// Records between two looks at the host's faults.
const LOOK_EVERY: usize = 50;
/// Most deadlines between two inputs: 3 s of pauses at 100 Hz.
const TIMEOUTS_MAX: usize = 400;
