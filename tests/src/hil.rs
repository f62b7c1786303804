//! One match twice: once with six robots of ours as firmware images under QEMU, once with native brains; both
//! against six native ones, alternating tick by tick in one run, so that hashes and wall time can be
//! compared.

use std::fmt;
use std::path::Path;
use std::time::{Duration, Instant};

use arena::game::{Game, GameConfig, GameError, NoWatcher};
use hil_sim::{ByTeam, McuError, Meter, Metered, NativeBackend, QemuBackend};
use protocol::TeamId;
use rules::{Colour, League};

/// Selects one of the two matches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// All brains are native.
    Native = 0,
    /// Ours in firmware images.
    Emulated = 1,
}

/// Both matches; in the second, blue robots are firmware images, yellow ones native.
pub struct Pair {
    games: Vec<Game<'static>>,
    meter: Meter,
    ticks: u32,
}

/// Results of the two.
#[derive(Clone, Debug)]
pub struct Reported {
    /// Ticks of 10 ms played.
    pub ticks: u32,
    /// The hash of each at its end.
    pub hashes: [String; 2],
    /// Wall time of each.
    pub took: [Duration; 2],
    /// The worst step of a firmware image, guest instructions.
    pub worst_instructions: u32,
    /// The maximum stack use of a firmware image, bytes.
    pub worst_stack: u32,
}

impl Reported {
    /// Speed of a side relative to real time.
    pub fn speed(&self, side: Side) -> f64 {
        f64::from(self.ticks) * 0.01 / self.took[side as usize].as_secs_f64().max(1e-9)
    }
}

impl fmt::Display for Reported {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let seconds = f64::from(self.ticks) * 0.01;
        let [native, emulated] = &self.hashes;
        let equal = if native == emulated { "equal" } else { "NOT equal" };
        write!(f, "{seconds:.2} s of six against six: hashes {native} and {emulated}, {equal}; ")?;
        write!(f, "native {:.1} x real time, ", self.speed(Side::Native))?;
        write!(f, "six images in QEMU {:.2} x, ", self.speed(Side::Emulated))?;
        let ratio = self.speed(Side::Native) / self.speed(Side::Emulated).max(1e-9);
        write!(
            f,
            "{ratio:.0} times slower; worst step {} instructions, deepest stack {} B",
            self.worst_instructions, self.worst_stack
        )
    }
}

impl Pair {
    /// Both matches at kick-off, of the same seed; `image` is the firmware.
    pub fn new(seed: u64, seconds: f64, image: &Path) -> Result<Self, GameError> {
        let config = GameConfig::new(League::DivisionB, seed, seconds);
        let base = case_library::division_b();
        let mut native = NativeBackend::new(base);
        let broken = |error: McuError| GameError::League(error.to_string());
        let qemu = QemuBackend::new(image).with_library(base.bytes()).map_err(broken)?;
        let meter = Meter::default();
        let team = TeamId::of(Colour::Blue);
        let its = Metered::new(qemu, &meter);
        let mut mixed = ByTeam { team, its, others: NativeBackend::new(base) };
        let games = vec![Game::new(&config, &mut native)?, Game::new(&config, &mut mixed)?];
        Ok(Self { games, meter, ticks: (seconds * 100.0) as u32 })
    }

    /// Plays both; `look` gets both hashes after every tick.
    pub fn play(&mut self, mut look: impl FnMut(u32, [&str; 2])) -> Result<Reported, GameError> {
        let mut took = [Duration::ZERO; 2];
        let mut hashes = [String::new(), String::new()];
        for tick in 0..self.ticks {
            for ((game, took), hash) in self.games.iter_mut().zip(&mut took).zip(&mut hashes) {
                let begin = Instant::now();
                game.step(&mut NoWatcher)?;
                *took += begin.elapsed();
                *hash = game.trace().digits();
            }
            look(tick, [&hashes[0], &hashes[1]]);
        }
        let (_, worst_instructions) = self.meter.median_and_worst();
        let worst_stack = self.meter.stack();
        Ok(Reported { ticks: self.ticks, hashes, took, worst_instructions, worst_stack })
    }
}
