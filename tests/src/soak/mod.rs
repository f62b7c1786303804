//! `soak`: what `cargo xtask soak --hours N` plays: swarm runs, matches, hostile bytes, mutated packets
//! into a whole host, mutated files into their readers.
//!
//! A target plays a *recipe*, a list of seeds that determines everything it does, and gives labels of what
//! happened (verdicts, phases, faults, codes of findings). A recipe that shows a new label is kept in the
//! target's corpus, and later recipes continue it: that leads runs to where no run was, without an
//! instrumented build.

pub mod state;

mod files;
mod packets;

use std::cell::RefCell;
use std::collections::BTreeSet;
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook};

use arena::game::NoWatcher;

use crate::hostile::{self, Corpus};
use crate::swarm::{self, matches};

pub use files::Files;
pub use packets::Packets;

/// Labels of what happened in a run.
pub type Labels = BTreeSet<String>;

/// Everything that targets start from.
#[derive(Debug)]
pub struct Material {
    corpus: Corpus,
    packets: Packets,
    files: Files,
}

impl Material {
    /// Reads the committed corpora and files, and records a match.
    ///
    /// # Errors
    /// A file that cannot be read, or a match that cannot be played; in words.
    pub fn gather() -> Result<Self, String> {
        Ok(Self {
            corpus: hostile::corpus().map_err(|error| format!("protocol/fuzz/corpus: {error}"))?,
            packets: Packets::record()?,
            files: Files::read()?,
        })
    }
}

/// Something that is played over and over.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    /// Its name, in files and on the command line.
    pub name: &'static str,
    /// Unit of its executions.
    pub unit: &'static str,
    /// Plays a recipe; returns the number of executions, and the error is a violated property.
    play: fn(&Material, &[u64], &mut Labels) -> Result<u64, String>,
}

/// All targets.
pub const TARGETS: [Target; 5] = [
    Target { name: "host", unit: "inputs", play: packets::play },
    Target { name: "files", unit: "files", play: files::play },
    Target { name: "bytes", unit: "byte strings", play: bytes },
    Target { name: "swarm", unit: "runs", play: faults },
    Target { name: "matches", unit: "matches", play: referee },
];

impl Target {
    /// The target of that name.
    pub fn named(name: &str) -> Option<&'static Self> {
        TARGETS.iter().find(|target| target.name == name)
    }

    /// Plays a recipe; a panic is an error too, with its message and place. Call [`catch_panics`] before.
    pub fn play(&self, material: &Material, recipe: &[u64]) -> (Labels, Result<u64, String>) {
        let mut labels = Labels::new();
        let played = catch_unwind(AssertUnwindSafe(|| (self.play)(material, recipe, &mut labels)));
        let result = played.unwrap_or_else(|_| Err(PANIC.with_borrow_mut(std::mem::take)));
        (labels, result)
    }
}

/// From now on panics are kept for the findings instead of printed.
pub fn catch_panics() {
    set_hook(Box::new(|panic| PANIC.with_borrow_mut(|last| *last = panic.to_string())));
}

thread_local! {
    static PANIC: RefCell<String> = const { RefCell::new(String::new()) };
}

/// The words of a text, without numbers and names: equal for equal kinds of messages.
fn label(text: &str) -> String {
    let mut words = text.split(|c: char| !c.is_ascii_alphabetic()).filter(|word| !word.is_empty());
    let mut label = String::new();
    while label.len() < LABEL_LEN
        && let Some(word) = words.next()
    {
        label.push_str(word);
        label.push(' ');
    }
    label
}

fn newest(recipe: &[u64]) -> u64 {
    recipe.last().copied().unwrap_or_default()
}

fn bytes(material: &Material, recipe: &[u64], _: &mut Labels) -> Result<u64, String> {
    hostile::run(&material.corpus, newest(recipe), STRINGS)
        .map_err(|panicked| format!("{} with {:02x?}", panicked.target, panicked.bytes))?;
    Ok(STRINGS)
}

fn faults(_: &Material, recipe: &[u64], labels: &mut Labels) -> Result<u64, String> {
    let seed = newest(recipe);
    let counters = swarm::run(seed).map_err(|found| swarm::report(seed, &found))?;
    labels.insert(format!("gameplays {}", counters.gameplays.min(10)));
    Ok(1)
}

fn referee(_: &Material, recipe: &[u64], labels: &mut Labels) -> Result<u64, String> {
    let plan = matches::Plan::drawn(newest(recipe), matches::LENGTH);
    let outcome = matches::play(&plan, &mut NoWatcher);
    labels.extend(outcome.begun.iter().enumerate().map(|(kind, n)| format!("restart {kind}: {}", n.min(&9))));
    if outcome.found.is_empty() { Ok(1) } else { Err(matches::report(&plan, &outcome)) }
}

/// Byte strings a recipe: a tenth of a second.
const STRINGS: u64 = 10_000;
/// Longest label, about, bytes.
const LABEL_LEN: usize = 30;
