//! `hostile`: random bytes for every reader. Seeded bytes for the same targets as `cargo fuzz`
//! (`protocol/fuzz`), and for brains.
//!
//! Most are valid messages of the corpus with a few changes, so that readers decode most of them; the others
//! are noise. A run is determined by its seed.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::{fs, io};

use brain::{Brain, BrainConfig};
use hil_sim::Stream;
use protocol::host::HostMessage;
use protocol::robot_io::{ActuatorFrame, Health, SensorFrame};
use protocol::team::TeamMessage;
use protocol::{Duration, Instant, RobotId, TeamId};
use rules::League;

#[path = "../../protocol/fuzz/src/lib.rs"]
pub mod targets;

/// Valid messages by target.
pub type Corpus = Vec<(targets::Target, Vec<Vec<u8>>)>;

/// The committed corpus, in the order of names.
pub fn corpus() -> io::Result<Corpus> {
    let directory = Path::new(env!("CARGO_MANIFEST_DIR")).join("../protocol/fuzz/corpus");
    let of = |target: targets::Target| {
        let mut files: Vec<_> = fs::read_dir(directory.join(target.0))?
            .map(|file| file.map(|file| file.path()))
            .collect::<Result<_, _>>()?;
        files.sort();
        Ok((target, files.iter().map(fs::read).collect::<Result<_, _>>()?))
    };
    targets::TARGETS.into_iter().map(of).collect()
}

/// A target that panicked, and the bytes that caused it.
#[derive(Clone, Debug)]
pub struct Panicked {
    /// Name of the target that panicked.
    pub target: &'static str,
    /// The bytes that caused it.
    pub bytes: Vec<u8>,
}

/// `count` byte strings, spread over all targets; the first that causes a panic.
pub fn run(corpus: &Corpus, seed: u64, count: u64) -> Result<(), Panicked> {
    let mut chance = Stream::new(seed, "hostile bytes");
    let mut minds = Minds::new();
    for number in 0..count {
        let ((name, target), seeds) = &corpus[number as usize % corpus.len()];
        let bytes = drawn(seeds, &mut chance);
        let read = catch_unwind(AssertUnwindSafe(|| {
            target(&bytes);
            minds.think(&bytes);
        }));
        if read.is_err() {
            return Err(Panicked { target: name, bytes });
        }
    }
    Ok(())
}

fn drawn(seeds: &[Vec<u8>], chance: &mut Stream) -> Vec<u8> {
    let any = |chance: &mut Stream| chance.whole(0, 255) as u8;
    if seeds.is_empty() || chance.chance(0.2) {
        let length = chance.whole(0, 160);
        return (0..length).map(|_| any(chance)).collect();
    }
    let mut bytes = seeds[chance.whole(0, seeds.len() as u32 - 1) as usize].clone();
    for _ in 0..=chance.whole(0, 3) {
        let place = chance.whole(0, bytes.len() as u32) as usize;
        match chance.whole(0, 4) {
            0 if place < bytes.len() => bytes[place] ^= 1 << chance.whole(0, 7),
            1 if place < bytes.len() => bytes[place] = any(chance),
            2 => bytes.truncate(place),
            3 => bytes.insert(place, any(chance)),
            _ => {
                let other = &seeds[chance.whole(0, seeds.len() as u32 - 1) as usize];
                bytes.truncate(place);
                bytes.extend(&other[other.len().min(place)..]);
            }
        }
    }
    bytes
}

/// Brains that receive all messages that can be decoded: a sender with the key may still send invalid
/// content.
struct Minds {
    brain: Brain<'static>,
    now: Instant,
    reported: u32,
}

impl Minds {
    fn new() -> Self {
        let config = BrainConfig::hosted(RobotId::ZERO, TeamId(1), League::DivisionB);
        let now = Instant(0);
        Self { brain: Brain::new(now, &config, case_library::division_b()), now, reported: 0 }
    }

    fn think(&mut self, bytes: &[u8]) {
        let (brain, now) = (&mut self.brain, self.now);
        if let Ok(message) = postcard::from_bytes::<HostMessage>(bytes) {
            brain.handle_host_message(now, Duration(0), &message);
            self.reported += 1;
        }
        if let Ok(message) = postcard::from_bytes::<TeamMessage>(bytes) {
            brain.handle_team_message(
                now,
                RobotId::new((now.0 % 16) as u8).unwrap_or(RobotId::ZERO),
                &message,
            );
            self.reported += 1;
        }
        if self.reported < MESSAGES_A_STEP {
            return;
        }
        (self.now, self.reported) = (Instant(now.0 + 10_000), 0);
        let sensors = SensorFrame {
            ball_contact: now.0 % 70_000 == 0,
            health: Health { battery: Some(16.0), tipped: false, kicker_ready: true },
            ..SensorFrame::default()
        };
        while let Some(due) = brain.poll_timeout().filter(|due| *due <= self.now) {
            brain.handle_timeout(due);
        }
        brain.handle_sensors(self.now, &sensors);
        while brain.poll_message(self.now).is_some() {}
        if let Some(ActuatorFrame::Omni { wheels, .. }) = brain.poll_actuators(self.now) {
            assert!(wheels.iter().all(|rim| rim.abs() < 5.01), "{wheels:?}");
        }
    }
}

/// Number of messages that a brain receives in a step, as in a match.
const MESSAGES_A_STEP: u32 = 4;
