//! `player`: units of play, and who plays them. Learning asks for units; how many threads, processes and
//! interrupted runs it took to play them has no effect on what it learns.

use arena::game::GameError;
use foreign::printable;
use hil_sim::SimulationError;
use serde::Serialize;
use serde::de::DeserializeOwned;

/// A unit of play: trials or a match with one library.
pub trait Playable: Sync {
    /// Record of one of its trials or matches.
    type Played: Clone + Send + Serialize + DeserializeOwned;
    /// The unit's name in journals: equal for units that are played equally.
    fn key(&self) -> u64;
    /// Plays the unit, in a run with this seed.
    fn play(&self, seed: u64) -> Result<Vec<Self::Played>, PlayError>;
    /// Part of a budget that it took.
    fn counts(&self, played: &[Self::Played]) -> u64;
}

/// Plays units, or knows what became of them.
pub trait Player<U: Playable> {
    /// Returns what became of every unit, in order.
    fn play(&mut self, units: &[U]) -> Result<Vec<Vec<U::Played>>, PlayError>;
}

/// Error that kept units from being played.
#[derive(Debug, thiserror::Error)]
pub enum PlayError {
    /// The simulator cannot go on.
    #[error("a trial cannot be played: {0}")]
    Simulation(SimulationError),
    /// A match cannot go on.
    #[error("a match cannot be played: {0}")]
    Match(GameError),
    /// The journal cannot be read or written.
    #[error("the journal of trials cannot be kept: {0}; make the output directory writable")]
    Journal(std::io::Error),
    /// Another process writes to the journal.
    #[error("{}: another process writes to it; wait for it, or stop it", printable(.0))]
    InUse(String),
    /// This journal is of another run; the differences have the journal's value first.
    #[error("{} is of another run: {}; take another --out", printable(.0), printable(.1))]
    OtherRun(String, String),
    /// A line of a journal is no unit.
    #[error(
        "{}: the line at byte {at} is no unit of trials: {}; remove the file, its units are played again",
        printable(.file),
        printable(.what)
    )]
    Damaged {
        /// The journal.
        file: String,
        /// Start of the line, bytes.
        at: u64,
        /// The error in it.
        what: String,
    },
    /// Stopped by hand; what is finished is kept.
    #[error("stopped; the same command goes on from here")]
    Stopped,
}
