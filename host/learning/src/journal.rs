//! `journal`: the file of finished units. A line each, written when the unit is over: a run that was killed
//! goes on from there, and shards in one directory read each other's.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use arena::evaluation::Shard;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::trial::LearningTrial;
use crate::work::{PlayError, Player, Unit};

/// Longest journal that is read, bytes.
const JOURNAL_LEN_MAX: u64 = 1 << 32;
/// Time between two looks at the journals of other shards.
const LOOK: Duration = Duration::from_millis(500);

/// A finished unit.
#[derive(Debug, Serialize, Deserialize)]
struct Line {
    unit: u64,
    trials: Vec<LearningTrial>,
}

/// Plays units on all threads of the current rayon pool and keeps them in a directory.
pub struct JournalPlayer<'s> {
    directory: PathBuf,
    identity: String,
    shard: Shard,
    seed: u64,
    file: File,
    known: BTreeMap<u64, Vec<LearningTrial>>,
    /// Bytes of each other shard's file that were read.
    read: BTreeMap<PathBuf, usize>,
    stopped: &'s AtomicBool,
    progress: &'s (dyn Fn(u64) + Sync),
}

impl std::fmt::Debug for JournalPlayer<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("JournalPlayer").field("directory", &self.directory).finish_non_exhaustive()
    }
}

impl<'s> JournalPlayer<'s> {
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
        file.set_len(whole as u64).and_then(|()| file.seek(SeekFrom::End(0))).map_err(PlayError::Journal)?;
        if whole == 0 {
            file.write_all(format!("{identity}\n").as_bytes()).map_err(PlayError::Journal)?;
        }
        let (directory, identity) = (directory.to_owned(), identity.to_owned());
        Ok(Self { directory, identity, shard, seed, file, known, read: BTreeMap::new(), stopped, progress })
    }

    /// Reads what other shards have finished since the last call.
    fn look(&mut self) -> Result<(), PlayError> {
        let entries = std::fs::read_dir(&self.directory).map_err(PlayError::Journal)?;
        for entry in entries {
            let path = entry.map_err(PlayError::Journal)?.path();
            let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
            if !name.starts_with(PREFIX) || name == file_name(self.shard) {
                continue;
            }
            let bytes = foreign::read(&path, JOURNAL_LEN_MAX).map_err(PlayError::Journal)?;
            let from = self.read.get(&path).copied().unwrap_or(0);
            let whole = absorb(&bytes, from, &self.identity, &path, &mut self.known)?;
            self.read.insert(path, whole);
        }
        Ok(())
    }

    fn play_own(&mut self, own: &[(u64, &Unit<'_>)]) -> Result<(), PlayError> {
        let keeper = Mutex::new((&mut self.file, &mut self.known));
        let (stopped, seed, progress) = (self.stopped, self.seed, self.progress);
        own.par_iter().try_for_each(|(key, unit)| {
            if stopped.load(Ordering::Relaxed) {
                return Err(PlayError::Stopped);
            }
            let line = Line { unit: *key, trials: unit.play(seed).map_err(PlayError::Simulation)? };
            let mut text = serde_json::to_vec(&line).map_err(|error| PlayError::Journal(error.into()))?;
            text.push(b'\n');
            let mut keeper = keeper.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
            keeper.0.write_all(&text).map_err(PlayError::Journal)?;
            progress(line.trials.len() as u64);
            keeper.1.insert(line.unit, line.trials);
            Ok(())
        })
    }
}

impl Player for JournalPlayer<'_> {
    fn play(&mut self, units: &[Unit<'_>]) -> Result<Vec<Vec<LearningTrial>>, PlayError> {
        let keyed: Vec<_> = units.iter().map(|unit| (unit.key(), unit)).collect();
        let mut asked = BTreeSet::new();
        let open: Vec<_> = (keyed.iter())
            .filter(|(key, _)| !self.known.contains_key(key) && asked.insert(*key))
            .copied()
            .collect();
        let own: Vec<_> =
            open.iter().filter(|(key, _)| self.shard.has((*key >> 1) as usize)).copied().collect();
        self.play_own(&own)?;
        while keyed.iter().any(|(key, _)| !self.known.contains_key(key)) {
            if self.stopped.load(Ordering::Relaxed) {
                return Err(PlayError::Stopped);
            }
            self.look()?;
            if keyed.iter().any(|(key, _)| !self.known.contains_key(key)) {
                std::thread::sleep(LOOK);
            }
        }
        Ok(keyed.iter().filter_map(|(key, _)| self.known.get(key).cloned()).collect())
    }
}

/// Adds the whole lines of a journal from byte `from` on; returns where they end.
fn absorb(
    bytes: &[u8],
    from: usize,
    identity: &str,
    path: &Path,
    known: &mut BTreeMap<u64, Vec<LearningTrial>>,
) -> Result<usize, PlayError> {
    let whole = bytes.iter().rposition(|byte| *byte == b'\n').map_or(0, |end| end + 1);
    let mut at = from;
    for line in bytes.get(from..whole).unwrap_or_default().split_inclusive(|byte| *byte == b'\n') {
        if at == 0 {
            if line.strip_suffix(b"\n") != Some(identity.as_bytes()) {
                return Err(PlayError::OtherRun(path.display().to_string()));
            }
        } else {
            let line: Line =
                serde_json::from_slice(line).map_err(|error| PlayError::Journal(error.into()))?;
            known.insert(line.unit, line.trials);
        }
        at += line.len();
    }
    Ok(at)
}

const PREFIX: &str = "journal-";

fn file_name(shard: Shard) -> String {
    format!("{PREFIX}{}l", shard.file_name().trim_start_matches("trials-").replace(".csv", ".json"))
}
