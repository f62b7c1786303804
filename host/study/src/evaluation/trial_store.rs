//! `trial_store`: crash-safe file of finished trials. Every trial is a line, appended to its shard's file
//! when it is over.
//!
//! The first line identifies the evaluation, the second names the columns. A last line without its end was
//! torn by the interrupt: it is cut off, and its trial played again. Lines stand in the order in which trials
//! ended; the reader sorts.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use serde::Serialize;
use serde::de::DeserializeOwned;

use super::difference::Difference;
use super::error::EvaluationError;
use super::identity::Identity;
use super::row::{TrialRow, to_csv, to_line};

/// A row of such a file: one of a plan's trials, when it is over.
pub trait Entry: Clone + PartialEq + Serialize + DeserializeOwned + Send {
    /// The identity of the evaluation of its file.
    type Identity: Clone + Serialize + DeserializeOwned;
    /// Mark at the start of its file.
    const MARK: &'static str;
    /// Its number in the plan, from 0.
    fn number(&self) -> usize;
    /// Whether the row is what that evaluation plans under its number.
    fn is_planned(&self, identity: &Self::Identity) -> bool;
    /// Number of planned rows.
    fn planned(identity: &Self::Identity) -> usize;
    /// The settings in which two evaluations differ; empty between equals.
    fn differences(own: &Self::Identity, other: &Self::Identity) -> Vec<Difference>;
}

impl Entry for TrialRow {
    type Identity = Identity;
    const MARK: &'static str = "# onetwo trials 1 ";
    fn number(&self) -> usize {
        self.trial
    }
    fn is_planned(&self, identity: &Identity) -> bool {
        identity.plan.get(self.trial).is_some_and(|planned| self.is_of(&planned))
    }
    fn planned(identity: &Identity) -> usize {
        identity.plan.len()
    }
    fn differences(own: &Identity, other: &Identity) -> Vec<Difference> {
        own.differences(other)
    }
}

/// Contents of a file of trials.
#[derive(Clone, Debug, PartialEq)]
pub struct Kept<R: Entry = TrialRow> {
    /// Path of the file.
    pub file: PathBuf,
    /// The identity of its evaluation.
    pub identity: R::Identity,
    /// Its trials, in the order of the file.
    pub rows: Vec<R>,
    /// Bytes up to the end of the last complete line.
    whole: usize,
}

/// Reads a file of trials; `None` where it was torn before its first trial.
pub fn read<R: Entry>(path: &Path) -> Result<Option<Kept<R>>, EvaluationError> {
    let bytes = foreign::read(path, LEDGER_LEN_MAX).map_err(EvaluationError::file(path))?;
    parse(path, &bytes)
}

/// Longest file that is read, bytes: a million trials have 300 MB.
const LEDGER_LEN_MAX: u64 = 1 << 30;

fn parse<R: Entry>(path: &Path, bytes: &[u8]) -> Result<Option<Kept<R>>, EvaluationError> {
    let whole = bytes.iter().rposition(|&byte| byte == b'\n').map_or(0, |end| end + 1);
    let mut lines = bytes[..whole].split_inclusive(|&byte| byte == b'\n');
    let (Some(head), Some(_columns)) = (lines.next(), lines.next()) else { return Ok(None) };
    let fault = |line, what: String| EvaluationError::Row { file: path.to_owned(), line, what };
    let json = head.strip_prefix(R::MARK.as_bytes()).ok_or_else(|| fault(1, format!("no `{}`", R::MARK)))?;
    let identity: R::Identity = serde_json::from_slice(json).map_err(|error| fault(1, error.to_string()))?;
    let mut reader = csv::Reader::from_reader(&bytes[head.len()..whole]);
    let columns = reader.headers().map_err(|error| fault(2, error.to_string()))?.clone();
    let rows = (3..).zip(reader.deserialize()).map(|(line, row)| {
        let row: R = row.map_err(|error| fault(line, error.to_string()))?;
        if let Some(what) = not_finite(&columns, &row) {
            return Err(fault(line, what));
        }
        if row.is_planned(&identity) {
            Ok(row)
        } else {
            Err(fault(line, format!("trial {} of the plan is another", row.number())))
        }
    });
    let rows = rows.collect::<Result<_, _>>()?;
    Ok(Some(Kept { file: path.to_owned(), identity, rows, whole }))
}

/// The column of a row that holds a NaN or an infinity, if any. No trial has such a measure, and a single one
/// makes every mean that contains it invalid.
fn not_finite<R: Entry>(columns: &csv::StringRecord, row: &R) -> Option<String> {
    // Written again, such a number has one spelling, for any spelling in the file: `nan`, `+inf`, `1e999`.
    let line = to_line(row).ok()?;
    let mut again = csv::ReaderBuilder::new().has_headers(false).from_reader(&line[..]);
    let cells = again.records().next()?.ok()?;
    let at = cells.iter().position(|cell| matches!(cell, "NaN" | "inf" | "-inf"))?;
    let column = columns.get(at).unwrap_or("a column");
    Some(format!("{column} is {}, not a finite number", cells.get(at).unwrap_or_default()))
}

/// A file of trials that is appended to.
#[derive(Debug)]
pub(super) struct TrialStore {
    file: File,
    path: PathBuf,
    /// Whether the line with the columns' names is written; it comes with the first trial.
    headed: bool,
}

impl TrialStore {
    /// Opens or creates a file of `identity`; returns it with the trials that it already holds.
    pub(super) fn open<R: Entry>(
        path: &Path,
        identity: &R::Identity,
    ) -> Result<(Self, Vec<R>), EvaluationError> {
        let failed = EvaluationError::file(path);
        let file = OpenOptions::new()
            .read(true)
            .write(true)
            .create(true)
            .truncate(false)
            .open(path)
            .map_err(failed)?;
        // If the file system has no locks, the user must not run two processes on one shard.
        if let Err(TryLockError::WouldBlock) = file.try_lock() {
            return Err(EvaluationError::InUse(path.to_owned()));
        }
        let bytes = foreign::read_from(&file, LEDGER_LEN_MAX).map_err(EvaluationError::file(path))?;
        let kept = parse::<R>(path, &bytes)?;
        let mut trial_store = Self { file, path: path.to_owned(), headed: kept.is_some() };
        let Some(kept) = kept else {
            trial_store.cut(0)?;
            let json = serde_json::to_string(identity).map_err(|error| trial_store.unwritten(error))?;
            trial_store.write(format!("{}{json}\n", R::MARK).as_bytes())?;
            return Ok((trial_store, Vec::new()));
        };
        let differences = R::differences(&kept.identity, identity);
        if !differences.is_empty() {
            return Err(EvaluationError::Another { file: path.to_owned(), merged: None, differences });
        }
        trial_store.cut(kept.whole)?;
        Ok((trial_store, kept.rows))
    }

    /// Stores a trial: once this returns, killing the process does not lose it.
    pub(super) fn keep<R: Entry>(&mut self, row: &R) -> Result<(), EvaluationError> {
        let line = if self.headed { to_line(row) } else { to_csv(std::slice::from_ref(row)) };
        let line = line.map_err(|error| self.unwritten(error))?;
        self.headed = true;
        self.write(&line)
    }

    fn cut(&mut self, whole: usize) -> Result<(), EvaluationError> {
        let cut = self.file.set_len(whole as u64).and_then(|()| self.file.seek(SeekFrom::End(0)));
        cut.map(|_| ()).map_err(EvaluationError::file(&self.path))
    }

    fn write(&mut self, bytes: &[u8]) -> Result<(), EvaluationError> {
        self.file.write_all(bytes).map_err(EvaluationError::file(&self.path))
    }

    fn unwritten(&self, error: impl Into<std::io::Error>) -> EvaluationError {
        EvaluationError::File { file: self.path.clone(), error: error.into() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluation::EvaluationPlan;
    use crate::evaluation::identity::tests::identity;

    fn text(identity: &Identity) -> String {
        format!("{}{}\n", TrialRow::MARK, serde_json::to_string(identity).unwrap())
    }

    fn refused(text: &str) -> String {
        parse::<TrialRow>(Path::new("x.csv"), text.as_bytes()).unwrap_err().to_string()
    }

    #[test]
    fn a_file_torn_before_its_first_trial_holds_nothing() {
        let head = text(&identity());
        for torn in ["", "# one", head.trim_end(), &head, &format!("{head}trial,pro")] {
            assert_eq!(parse::<TrialRow>(Path::new("x.csv"), torn.as_bytes()).unwrap(), None, "{torn}");
        }
    }

    #[test]
    fn a_number_that_is_none_is_refused_with_file_line_and_column() {
        let identity = Identity { plan: EvaluationPlan::paper(1).with_trials(2), ..identity() };
        let planned = identity.plan.get(0).unwrap();
        let row = TrialRow {
            profile: planned.cell.profile,
            configuration: planned.cell.configuration,
            scenario: planned.cell.scenario,
            approach: planned.cell.approach,
            seed: planned.seed,
            time_s: 10.125,
            // A hash that parses as an infinite number is still a hash.
            trace_hash: "1234567890e99999".to_owned(),
            ..super::super::row::tests::row()
        };
        let csv = String::from_utf8(to_csv(&[row]).unwrap()).unwrap();
        let file = |csv: &str| format!("{}{csv}", text(&identity));
        let kept = parse::<TrialRow>(Path::new("x.csv"), file(&csv).as_bytes()).unwrap().unwrap();
        assert_eq!(kept.rows.len(), 1);
        for wrong in ["NaN", "nan", "inf", "-inf", "infinity", "1e999"] {
            let error = refused(&file(&csv.replace("10.125", wrong)));
            assert!(error.starts_with("x.csv:3: time_s is "), "{wrong}: {error}");
            assert!(error.contains("not a finite number"), "{wrong}: {error}");
        }
    }

    #[cfg(unix)]
    #[test]
    fn a_device_is_no_ledger() {
        let error = read::<TrialRow>(Path::new("/dev/zero")).unwrap_err().to_string();
        assert!(error.contains("a device, not a regular file"), "{error}");
    }

    #[test]
    fn what_is_no_file_of_trials_is_refused_with_its_line() {
        assert!(refused("a,b\n1,2\n").starts_with("x.csv:1: "));
        assert!(
            refused(&format!("{}{{}}\ntrial\n", TrialRow::MARK))
                .starts_with("x.csv:1: missing field `program`")
        );
        let wrong = format!("{}trial,profile\n1,simulated\n", text(&identity()));
        assert!(refused(&wrong).starts_with("x.csv:3: "), "{}", refused(&wrong));
    }
}
