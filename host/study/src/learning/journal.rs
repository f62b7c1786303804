//! `journal`: the file of finished units. A line each, written when the unit is over: a run that was killed
//! goes on from there, and shards in one directory read each other's.
//!
//! A shard plays its own units first and then waits for those of the others. Where another shard has not
//! finished a unit for [`ABSENT_AFTER`] it counts as absent (not started yet, killed or never scheduled) and
//! the present ones play its units too, until its journal grows again. A unit that two shards play has equal
//! trials in both journals, so that only time is lost.

use std::collections::{BTreeMap, BTreeSet};
use std::io::{Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use rayon::prelude::*;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::learning::player::{PlayError, Playable, Player};
use crate::learning::trial::LearningTrial;
use crate::store::{FileKind, LineFile, OpenError, Shard, whole_len};

/// Longest journal that is read, bytes.
const JOURNAL_LEN_MAX: u64 = 1 << 32;
/// Time between two looks at the journals of other shards.
const LOOK_PERIOD: Duration = Duration::from_millis(500);
/// Time without a unit of a shard that is waited for, after which it counts as absent: many times what a unit
/// takes (16 trials, some 0.2 s of a core), so that shards which share a core are rarely played twice.
const ABSENT_AFTER: Duration = Duration::from_secs(10);

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
    file: LineFile,
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
        let path = directory.join(shard.name_of(JOURNALS));
        let (mut file, bytes) = LineFile::open(&path, JOURNAL_LEN_MAX).map_err(|error| match error {
            OpenError::InUse => PlayError::InUse(path.display().to_string()),
            OpenError::File(error) => PlayError::Journal(error),
        })?;
        let mut known = BTreeMap::new();
        let whole = absorb(&bytes, 0, identity, &path, &mut known)?;
        file.cut(whole).map_err(PlayError::Journal)?;
        if whole == 0 {
            file.append(format!("{identity}\n").as_bytes()).map_err(PlayError::Journal)?;
        }
        Ok(Self {
            directory: directory.to_owned(),
            identity: identity.to_owned(),
            shard,
            seed,
            file,
            known,
            read: BTreeMap::new(),
            patience: ABSENT_AFTER,
            absent: BTreeSet::new(),
            stopped,
            progress,
        })
    }

    /// Sets the time after which a silent shard counts as absent; 10 s by default.
    #[must_use]
    pub fn with_patience(self, patience: Duration) -> Self {
        Self { patience, ..self }
    }

    /// Reads what other shards have finished since the last call; returns the shards that have finished
    /// something, by index from 0. Shards of another partition count as none.
    fn look(&mut self) -> Result<BTreeSet<usize>, PlayError> {
        let mut grown = BTreeSet::new();
        let entries = std::fs::read_dir(&self.directory).map_err(PlayError::Journal)?;
        for entry in entries {
            let path = entry.map_err(PlayError::Journal)?.path();
            let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
            if !name.starts_with(JOURNALS.0) || name == self.shard.name_of(JOURNALS) {
                continue;
            }
            let other = Shard::from_name_of(JOURNALS, name);
            let from = self.read.get(&path).copied().unwrap_or(0);
            let mut file = foreign::open(&path).map_err(PlayError::Journal)?;
            file.seek(SeekFrom::Start(from)).map_err(PlayError::Journal)?;
            let bytes = foreign::read_from(&file, JOURNAL_LEN_MAX).map_err(PlayError::Journal)?;
            let whole = absorb(&bytes, from, &self.identity, &path, &mut self.known)?;
            if let Some(other) = other.filter(|other| whole > from && other.parts() == self.shard.parts()) {
                grown.insert(other.index());
            }
            self.read.insert(path, whole);
        }
        self.absent.retain(|index| !grown.contains(index));
        Ok(grown)
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
            keeper.0.append(&text).map_err(PlayError::Journal)?;
            progress(unit.counts(&line.trials));
            keeper.1.insert(line.unit, line.trials);
            Ok(())
        })
    }
}

impl<U: Playable> Player<U> for JournalPlayer<'_, U::Played> {
    /// Returns what became of every unit, in order; plays those that no journal has.
    fn play(&mut self, units: &[U]) -> Result<Vec<Vec<U::Played>>, PlayError> {
        let keyed: Vec<_> = units.iter().map(|unit| (unit.key(), unit)).collect();
        let missing = |known: &BTreeMap<u64, Vec<U::Played>>| {
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
            self.file.sync().map_err(PlayError::Journal)?;
        }
        let parts = self.shard.parts();
        let mut silent_since: BTreeMap<usize, Instant> = BTreeMap::new();
        loop {
            let grown = self.look()?;
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
                if grown.contains(&index) {
                    *since = now;
                } else if now.duration_since(*since) >= self.patience {
                    self.absent.insert(index);
                }
            }
            if open.iter().any(|(key, _)| self.absent.contains(&part_of(*key, parts))) {
                self.play_for_absent(&open)?;
            } else {
                std::thread::sleep(LOOK_PERIOD.min(self.patience));
            }
        }
        Ok(keyed.iter().filter_map(|(key, _)| self.known.get(key).cloned()).collect())
    }
}

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
    let whole = whole_len(bytes);
    let mut at = from;
    for line in bytes.get(..whole).unwrap_or_default().split_inclusive(|byte| *byte == b'\n') {
        if at == 0 {
            let head = String::from_utf8_lossy(line.strip_suffix(b"\n").unwrap_or(line));
            if head != identity {
                let differences = differences(&head, identity);
                return Err(PlayError::OtherRun(path.display().to_string(), differences));
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

/// Differences of two identities, with both values: `world "0fa5e409", not "12345678"`.
fn differences(own: &str, other: &str) -> String {
    let parsed = [own, other].map(serde_json::from_str::<BTreeMap<String, Value>>);
    let [Ok(own), Ok(other)] = parsed else { return "its first line does not identify a run".to_owned() };
    let mut differing = Vec::new();
    for name in own.keys().chain(other.keys()).collect::<BTreeSet<_>>() {
        let [own, other] = [&own, &other].map(|values| values.get(name).unwrap_or(&Value::Null));
        if own != other {
            differing.push(format!("{name} {own}, not {other}"));
        }
    }
    differing.join("; ")
}

const JOURNALS: FileKind = ("journal-", ".jsonl");
