//! `mutate`: mutation of packets. Seeds are true packets; each round breaks one and reads it as every message
//! of the league.

use rand_core::{RngCore, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use ssl::log::{LogReader, MessageKind, Packet, Summary, guess};
use ssl::stream::FrameReader;

use crate::messages::{Decode, decoder};

/// Counters of a run.
#[derive(Debug, Default, PartialEq, Eq)]
pub(crate) struct Counters {
    /// Packets broken and read.
    pub packets: u64,
    /// Number of those that still decode as their original message.
    pub decoded: u64,
    /// Those that do not.
    pub refused: u64,
    /// Broken packets that are still recognized as vision, referee or tracker.
    pub guessed: u64,
    /// Messages a log file of broken bytes gave.
    pub logged: u64,
    /// Messages a stream of broken bytes gave.
    pub framed: u64,
}

/// Breaks `count` packets and reads each; the same seed breaks the same ones. Panics where a decoder does, or
/// where a message does not survive being encoded.
pub(crate) fn run(seeds: &[Seed], count: u64, seed: u64) -> Counters {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
    let mut counters = Counters::default();
    for _ in 0..count {
        let (own, packet) = mutated(seeds, &mut random);
        counters.packets += 1;
        let read = if survives(own, &packet) { &mut counters.decoded } else { &mut counters.refused };
        *read += 1;
        for (package, name) in DATAGRAMS {
            survives(decoder(package, name), &packet);
        }
        counters.guessed += u64::from(guess(&packet).is_some());
        counters.logged += log(&packet, &mut random);
        counters.framed += stream(&packet, &mut random);
    }
    counters
}

/// What comes from outside as a whole: each packet is read as each of these too.
const DATAGRAMS: [(&str, &str); 9] = [
    ("vision", "SSL_WrapperPacket"),
    ("legacy", "SSL_WrapperPacket"),
    ("gc", "Referee"),
    ("tracker", "TrackerWrapperPacket"),
    ("sim", "SimulatorCommand"),
    ("sim", "SimulatorResponse"),
    ("sim", "RobotControl"),
    ("sim", "RobotControlResponse"),
    ("gc", "ControllerToTeam"),
];

/// Whether it is a message. If so, what we encode must decode to the same bytes. (`Debug` runs in between.)
fn survives(decode: Decode, bytes: &[u8]) -> bool {
    let Ok((_, encoded)) = decode(bytes) else { return false };
    let (_, again) = decode(&encoded).expect("what we encode decodes");
    assert_eq!(again, encoded, "a message changed on the way");
    true
}

/// A log file of the packet under any type, itself broken in a byte; every fourth with its header.
fn log(packet: &[u8], random: &mut impl RngCore) -> u64 {
    let mut file = b"SSL_LOG_FILE\0\0\0\x01".to_vec();
    for kind in [random.next_u32() as i32 & 7, 1] {
        file.extend(random.next_u64().to_be_bytes());
        file.extend(kind.to_be_bytes());
        file.extend((packet.len() as i32).to_be_bytes());
        file.extend(packet);
    }
    let from = if random.next_u32().is_multiple_of(4) { 0 } else { 16 };
    let at = from + below(random, file.len() - from);
    file[at] ^= 1 << below(random, 8);
    match LogReader::new(&file[..]) {
        Ok(mut reader) => {
            let summary = Summary::of(&mut reader);
            assert!(reader.end().is_some(), "no end was told");
            summary.counts.messages
        }
        Err(error) => u64::from(error.to_string().is_empty()),
    }
}

/// The packet twice on a stream, the first length perhaps broken, in pieces.
fn stream(packet: &[u8], random: &mut impl RngCore) -> u64 {
    let mut bytes = Vec::new();
    for _ in 0..2 {
        prost::encode_length_delimiter(packet.len(), &mut bytes).expect("room");
        bytes.extend(packet);
    }
    if random.next_u32().is_multiple_of(2) {
        bytes[below(random, 2)] ^= 1 << below(random, 8);
    }
    let mut reader = FrameReader::new(4096);
    let mut framed = 0;
    for piece in bytes.chunks(1 + below(random, bytes.len())) {
        reader.push(piece);
        while let Ok(Some(message)) = reader.next_message() {
            framed += 1;
            // Decoded or refused; both are fine.
            let _ = Packet::decode(MessageKind::Unknown, message);
        }
        assert!(reader.pending() <= bytes.len());
    }
    framed
}

/// A packet of the seeds with a few breaks, and how the whole one is read.
pub(crate) fn mutated(seeds: &[Seed], random: &mut impl RngCore) -> (Decode, Vec<u8>) {
    let (decode, packet) = &seeds[below(random, seeds.len())];
    let mut packet = packet.clone();
    // One break in most of them, up to four in the others.
    for _ in 0..=below(random, 4) * below(random, 2) {
        let at = below(random, packet.len().max(1));
        // Half of the breaks are one bit: much of the packet stays a message.
        match random.next_u32() % 16 {
            _ if packet.is_empty() => packet.push(random.next_u32() as u8),
            0..=7 => packet[at] ^= 1 << below(random, 8),
            8 => packet[at] = random.next_u32() as u8,
            9 => packet[at] = [0, 0x7f, 0x80, 0xff][below(random, 4)],
            10 => packet.truncate(at),
            11 => packet.insert(at, random.next_u32() as u8),
            12 => drop(packet.remove(at)),
            // A part of another packet replaces the tail.
            13 => {
                let (_, other) = &seeds[below(random, seeds.len())];
                packet.truncate(at);
                packet.extend(&other[below(random, other.len().max(1)).min(other.len())..]);
            }
            // A part comes twice.
            14 => {
                let part = packet[at..].to_vec();
                packet.extend(part);
            }
            // A length or number of ten bytes.
            _ => drop(packet.splice(at..=at, [0xff; 9].into_iter().chain([1]))),
        }
        packet.truncate(ssl::stream::DATAGRAM_MAX);
    }
    (*decode, packet)
}

fn below(random: &mut impl RngCore, bound: usize) -> usize {
    (random.next_u64() % bound as u64) as usize
}

/// A true packet, and its decoder.
pub(crate) type Seed = (Decode, Vec<u8>);

/// True packets: the golden ones, and every hundredth of two recordings.
pub(crate) fn seeds(tests: &std::path::Path) -> Vec<Seed> {
    let mut seeds = Vec::new();
    for package in ["gc", "google", "legacy", "sim", "tracker", "vision"] {
        let bytes = std::fs::read(tests.join(format!("golden/{package}.bin"))).expect("golden packets");
        let lines =
            std::fs::read_to_string(tests.join(format!("golden/{package}.jsonl"))).expect("their names");
        let mut reader = FrameReader::new(usize::MAX);
        reader.push(&bytes);
        for line in lines.lines() {
            let line: serde_json::Value = serde_json::from_str(line).expect("a line of JSON");
            let name = line["message"].as_str().expect("a message's name");
            let packet = reader.next_message().expect("sound").expect("a packet a line");
            seeds.push((decoder(package, name), packet.to_vec()));
        }
    }
    for name in ["grsim_divB_noisy_64s.log.gz", "erforce_divB_realistic_22s.log.gz"] {
        let reader = ssl::log::open(&tests.join("data").join(name)).expect("a recording");
        seeds.extend(reader.step_by(100).map(|record| {
            let decode = match record.kind {
                MessageKind::Refbox2013 => decoder("gc", "Referee"),
                MessageKind::Tracker2020 => decoder("tracker", "TrackerWrapperPacket"),
                _ => decoder("vision", "SSL_WrapperPacket"),
            };
            (decode, record.payload)
        }));
    }
    seeds
}
