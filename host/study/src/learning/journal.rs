//! `journal`: the file of finished units. A line each, written when the unit is over: a run that was killed
//! goes on from there, and shards in one directory read each other's.
//!
//! A shard plays its own units first and then waits for those of the others. Where another shard has not
//! finished a unit for [`PATIENCE`] it counts as absent (not started yet, killed or never scheduled) and the
//! present ones play its units too, until its journal grows again. A unit that two shards play has equal
//! trials in both journals, so that only time is lost.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use crate::evaluation::Shard;
use rayon::prelude::*;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::learning::trial::LearningTrial;
use crate::learning::work::{PlayError, Player, Unit};

/// Longest journal that is read, bytes.
const JOURNAL_LEN_MAX: u64 = 1 << 32;
/// Time between two looks at the journals of other shards.
const LOOK: Duration = Duration::from_millis(500);
/// Time without a unit of a shard that is waited for, after which it counts as absent: many times what a unit
/// takes (16 trials, some 0.2 s of a core), so that shards which share a core are rarely played twice.
const PATIENCE: Duration = Duration::from_secs(10);

/// A unit that a journal can keep.
pub trait Playable: Sync {
    /// What is kept of each of its trials.
    type Played: Clone + Send + Serialize + DeserializeOwned;
    /// Its name in journals: equal for units that are played equally.
    fn key(&self) -> u64;
    /// Plays it, in a run with this seed.
    fn play(&self, seed: u64) -> Result<Vec<Self::Played>, PlayError>;
    /// What it took of a budget.
    fn counts(&self, played: &[Self::Played]) -> u64;
}

impl Playable for Unit<'_> {
    type Played = LearningTrial;

    fn key(&self) -> u64 {
        Unit::key(self)
    }

    fn play(&self, seed: u64) -> Result<Vec<LearningTrial>, PlayError> {
        Unit::play(self, seed).map_err(PlayError::Simulation)
    }

    fn counts(&self, played: &[LearningTrial]) -> u64 {
        played.len() as u64
    }
}

/// A finished unit.
#[derive(Debug, Serialize, Deserialize)]
struct Line<T> {
    unit: u64,
    trials: Vec<T>,
}

/// Plays units on all threads of the current rayon pool and keeps them in a directory.
pub struct JournalPlayer<'s, T = LearningTrial> {
    directory: PathBuf,
    identity: String,
    shard: Shard,
    seed: u64,
    file: File,
    known: BTreeMap<u64, Vec<T>>,
    /// Bytes of each other shard's file that were read.
    read: BTreeMap<PathBuf, u64>,
    patience: Duration,
    /// Shards that are not waited for, by index from 0.
    absent: BTreeSet<usize>,
    stopped: &'s AtomicBool,
    progress: &'s (dyn Fn(u64) + Sync),
}

impl<T> std::fmt::Debug for JournalPlayer<'_, T> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("JournalPlayer").field("directory", &self.directory).finish_non_exhaustive()
    }
}

impl<'s, T: Clone + Send + Serialize + DeserializeOwned> JournalPlayer<'s, T> {
    /// Opens or creates the journal of a shard of the run that `identity` names; only an equal one goes on.
    pub fn open(
        directory: &Path,
        identity: &str,
        shard: Shard,
        seed: u64,
        stopped: &'s AtomicBool,
        progress: &'s (dyn Fn(u64) + Sync),
    ) -> Result<Self, PlayError> {
        let path = directory.join(file_name(shard));
        let file = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(&path);
        let mut file = file.map_err(PlayError::Journal)?;
        if let Err(TryLockError::WouldBlock) = file.try_lock() {
            let what = format!("{} is in use by another process", path.display());
            return Err(PlayError::Journal(io::Error::other(what)));
        }
        let bytes = foreign::read_from(&file, JOURNAL_LEN_MAX).map_err(PlayError::Journal)?;
        let mut known = BTreeMap::new();
        let whole = absorb(&bytes, 0, identity, &path, &mut known)?;
        file.set_len(whole).and_then(|()| file.seek(SeekFrom::End(0))).map_err(PlayError::Journal)?;
        if whole == 0 {
            file.write_all(format!("{identity}\n").as_bytes()).map_err(PlayError::Journal)?;
        }
        Ok(Self {
            directory: directory.to_owned(),
            identity: identity.to_owned(),
            shard,
            seed,
            file,
            known,
            read: BTreeMap::new(),
            patience: PATIENCE,
            absent: BTreeSet::new(),
            stopped,
            progress,
        })
    }

    /// With another time after which a silent shard counts as absent; 10 s by default.
    #[must_use]
    pub fn with_patience(self, patience: Duration) -> Self {
        Self { patience, ..self }
    }

    /// Reads what other shards have finished since the last call; returns the shards that have finished
    /// something, by index from 0. Shards of another partition count as none.
    fn look(&mut self) -> Result<BTreeSet<usize>, PlayError> {
        let mut heard = BTreeSet::new();
        let entries = std::fs::read_dir(&self.directory).map_err(PlayError::Journal)?;
        for entry in entries {
            let path = entry.map_err(PlayError::Journal)?.path();
            let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
            if !name.starts_with(PREFIX) || name == file_name(self.shard) {
                continue;
            }
            let own_partition = (1..=self.shard.parts())
                .find(|index| Shard::new(*index, self.shard.parts()).is_some_and(|s| name == file_name(s)));
            let from = self.read.get(&path).copied().unwrap_or(0);
            let mut file = foreign::open(&path).map_err(PlayError::Journal)?;
            file.seek(SeekFrom::Start(from)).map_err(PlayError::Journal)?;
            let bytes = foreign::read_from(&file, JOURNAL_LEN_MAX).map_err(PlayError::Journal)?;
            let whole = absorb(&bytes, from, &self.identity, &path, &mut self.known)?;
            if whole > from
                && let Some(index) = own_partition
            {
                heard.insert(index - 1);
            }
            self.read.insert(path, whole);
        }
        self.absent.retain(|index| !heard.contains(index));
        Ok(heard)
    }

    /// Plays some units of absent shards, beginning at another place than other shards do.
    fn play_for_absent<U: Playable<Played = T>>(&mut self, missing: &[(u64, &U)]) -> Result<(), PlayError> {
        let parts = self.shard.parts();
        let mut theirs: Vec<_> =
            missing.iter().filter(|(key, _)| self.absent.contains(&part_of(*key, parts))).copied().collect();
        let begin = theirs.len() * self.shard.index() / parts;
        theirs.rotate_left(begin);
        theirs.truncate(rayon::current_num_threads());
        self.play_own(&theirs)
    }

    fn play_own<U: Playable<Played = T>>(&mut self, own: &[(u64, &U)]) -> Result<(), PlayError> {
        let keeper = Mutex::new((&mut self.file, &mut self.known));
        let (stopped, seed, progress) = (self.stopped, self.seed, self.progress);
        own.par_iter().try_for_each(|(key, unit)| {
            if stopped.load(Ordering::Relaxed) {
                return Err(PlayError::Stopped);
            }
            let line = Line { unit: *key, trials: unit.play(seed)? };
            let mut text = serde_json::to_vec(&line).map_err(|error| PlayError::Journal(error.into()))?;
            text.push(b'\n');
            let mut keeper = keeper.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
            keeper.0.write_all(&text).map_err(PlayError::Journal)?;
            progress(unit.counts(&line.trials));
            keeper.1.insert(line.unit, line.trials);
            Ok(())
        })
    }

    /// What became of every unit, in order; those that no journal has are played.
    pub(crate) fn play_all<U: Playable<Played = T>>(
        &mut self,
        units: &[U],
    ) -> Result<Vec<Vec<T>>, PlayError> {
        let keyed: Vec<_> = units.iter().map(|unit| (unit.key(), unit)).collect();
        let missing = |known: &BTreeMap<u64, Vec<T>>| {
            let mut asked = BTreeSet::new();
            let open = keyed.iter().filter(|(key, _)| !known.contains_key(key) && asked.insert(*key));
            open.copied().collect::<Vec<_>>()
        };
        let mut open = missing(&self.known);
        if !open.is_empty() {
            // Others may have played them, this shard's own too while it was not there.
            self.look()?;
            open = missing(&self.known);
        }
        open.retain(|(key, _)| self.shard.has(unit_number(*key)));
        self.play_own(&open)?;
        if !open.is_empty() && self.shard != Shard::WHOLE {
            // Computers that share the directory over a network see what was handed to the disk.
            self.file.sync_data().map_err(PlayError::Journal)?;
        }
        let parts = self.shard.parts();
        let mut silent_since: BTreeMap<usize, Instant> = BTreeMap::new();
        loop {
            let heard = self.look()?;
            let open = missing(&self.known);
            if open.is_empty() {
                break;
            }
            if self.stopped.load(Ordering::Relaxed) {
                return Err(PlayError::Stopped);
            }
            let now = Instant::now();
            for index in open.iter().map(|(key, _)| part_of(*key, parts)) {
                let since = silent_since.entry(index).or_insert(now);
                if heard.contains(&index) {
                    *since = now;
                } else if now.duration_since(*since) >= self.patience {
                    self.absent.insert(index);
                }
            }
            if open.iter().any(|(key, _)| self.absent.contains(&part_of(*key, parts))) {
                self.play_for_absent(&open)?;
            } else {
                std::thread::sleep(LOOK.min(self.patience));
            }
        }
        Ok(keyed.iter().filter_map(|(key, _)| self.known.get(key).cloned()).collect())
    }
}

impl Player for JournalPlayer<'_> {
    fn play(&mut self, units: &[Unit<'_>]) -> Result<Vec<Vec<LearningTrial>>, PlayError> {
        self.play_all(units)
    }
}

/// The number by which a unit belongs to a shard.
fn unit_number(key: u64) -> usize {
    (key >> 1) as usize
}

/// The shard of a unit, by index from 0.
fn part_of(key: u64, parts: usize) -> usize {
    unit_number(key) % parts
}

/// Adds the whole lines of a journal's `bytes`, which begin at byte `from`; returns where they end.
fn absorb<T: DeserializeOwned>(
    bytes: &[u8],
    from: u64,
    identity: &str,
    path: &Path,
    known: &mut BTreeMap<u64, Vec<T>>,
) -> Result<u64, PlayError> {
    let whole = bytes.iter().rposition(|byte| *byte == b'\n').map_or(0, |end| end + 1);
    let mut at = from;
    for line in bytes.get(..whole).unwrap_or_default().split_inclusive(|byte| *byte == b'\n') {
        if at == 0 {
            let head = String::from_utf8_lossy(line.strip_suffix(b"\n").unwrap_or(line));
            if head != identity {
                let differences = differences(&head, identity);
                return Err(PlayError::OtherRun { file: path.display().to_string(), differences });
            }
        } else {
            let line: Line<T> = serde_json::from_slice(line).map_err(|error| PlayError::Damaged {
                file: path.display().to_string(),
                at,
                what: error.to_string(),
            })?;
            known.insert(line.unit, line.trials);
        }
        at += line.len() as u64;
    }
    Ok(at)
}

/// What two identities differ in, with both values: `world "0fa5e409", not "12345678"`.
fn differences(own: &str, other: &str) -> String {
    let parsed = [own, other].map(serde_json::from_str::<BTreeMap<String, Value>>);
    let [Ok(own), Ok(other)] = parsed else { return "its first line does not identify a run".to_owned() };
    let names: BTreeSet<_> = own.keys().chain(other.keys()).collect();
    let value = |values: &BTreeMap<String, Value>, name: &str| values.get(name).cloned().unwrap_or_default();
    let pairs = names.into_iter().map(|name| (name, value(&own, name), value(&other, name)));
    let differing = pairs.filter(|(_, own, other)| own != other);
    let words: Vec<_> = differing.map(|(name, own, other)| format!("{name} {own}, not {other}")).collect();
    words.join("; ")
}

const PREFIX: &str = "journal-";

fn file_name(shard: Shard) -> String {
    format!("{PREFIX}{}l", shard.file_name().trim_start_matches("trials-").replace(".csv", ".json"))
}
