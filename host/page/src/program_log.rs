//! `program_log`: what the program reports while it runs: errors, warnings, alarms and notes, the newest of
//! them kept in a ring. Times in s since the program's start.

use std::collections::VecDeque;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use serde::Serialize;

/// Entries that are kept: some 200 kB, hours of a match that goes well.
const ENTRIES_MAX: usize = 2_000;
/// Longest text of an entry, characters: the rest is cut.
const TEXT_MAX: usize = 1_000;

/// Urgency of an entry.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum LogLevel {
    /// A part of the program failed.
    Error,
    /// A fault that an operator should act on now.
    Alarm,
    /// Something is not as it should be.
    Warning,
    /// Information that needs no action.
    Note,
}

/// Report of the program, with its time and source.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LogEntry {
    /// Number of the entry, from 0, rising by one.
    pub n: u64,
    /// Time of the report, s since the program's start.
    pub at: f64,
    /// The time in the match, s, where the reporter knows one.
    pub t: Option<f64>,
    /// Urgency of the entry.
    pub level: LogLevel,
    /// Reporter: "program", "blue host".
    pub source: String,
    /// Text of the report, at most 1000 characters.
    pub text: String,
}

/// The newest entries, shared between the threads that add and read them.
#[derive(Debug)]
pub struct ProgramLog {
    began: Instant,
    entries: Mutex<(u64, VecDeque<LogEntry>)>,
}

impl Default for ProgramLog {
    fn default() -> Self {
        Self { began: Instant::now(), entries: Mutex::default() }
    }
}

impl ProgramLog {
    /// Adds an entry; the oldest goes where there are more than 2000.
    pub fn add(&self, level: LogLevel, source: &str, t: Option<f64>, text: &str) {
        let at = (self.began.elapsed().as_secs_f64() * 1e3).round() * 1e-3;
        let text = text.chars().take(TEXT_MAX).collect();
        let mut entries = self.entries.lock().unwrap_or_else(PoisonError::into_inner);
        let (next, ring) = &mut *entries;
        if ring.len() >= ENTRIES_MAX {
            ring.pop_front();
        }
        ring.push_back(LogEntry { n: *next, at, t, level, source: source.to_owned(), text });
        *next += 1;
    }

    /// The kept entries with a number of at least `n`, oldest first.
    pub fn from(&self, n: u64) -> Vec<LogEntry> {
        let entries = self.entries.lock().unwrap_or_else(PoisonError::into_inner);
        entries.1.iter().filter(|entry| entry.n >= n).cloned().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_newest_entries_are_kept_and_numbers_go_on() {
        let log = ProgramLog::default();
        for number in 0..ENTRIES_MAX + 3 {
            log.add(LogLevel::Note, "program", None, &number.to_string());
        }
        let kept = log.from(0);
        assert_eq!((kept.len(), kept[0].n, &*kept[0].text), (ENTRIES_MAX, 3, "3"));
        assert_eq!(log.from(ENTRIES_MAX as u64 + 2).len(), 1);
        assert!(log.from(ENTRIES_MAX as u64 + 3).is_empty());
        assert!(kept.windows(2).all(|pair| pair[0].at <= pair[1].at));
    }

    #[test]
    fn a_long_text_is_cut() {
        let log = ProgramLog::default();
        log.add(LogLevel::Error, "program", Some(1.0), &"ä".repeat(TEXT_MAX + 5));
        assert_eq!(log.from(0)[0].text.chars().count(), TEXT_MAX);
    }
}
