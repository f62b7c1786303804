//! `row_file`: crash-safe file of the rows of a shard: every job is a line, appended when it is over.
//!
//! The first line identifies the evaluation, the second names the columns. A last line without its end was
//! torn by the interrupt: it is cut off, and its job played again. Lines stand in the order in which jobs
//! ended; the reader sorts.

use std::io;
use std::path::{Path, PathBuf};

use serde::Serialize;
use serde::de::DeserializeOwned;

use super::csv_rows::{to_csv, to_line};
use super::difference::Difference;
use super::error::EvaluationError;
use super::line_file::{LineFile, OpenError, whole_len};

/// A row of a stored experiment: one of its jobs, when it is over.
pub trait Row: Clone + PartialEq + Serialize + DeserializeOwned + Send {
    /// The identity of the evaluation of its file.
    type Identity: Clone + Serialize + DeserializeOwned;
    /// Mark at the start of its file.
    const MARK: &'static str;
    /// Number in the plan, from 0.
    fn number(&self) -> usize;
    /// Whether the row is what that evaluation plans under its number.
    fn is_planned(&self, identity: &Self::Identity) -> bool;
    /// Number of planned rows.
    fn planned(identity: &Self::Identity) -> usize;
    /// The settings in which two evaluations differ; empty between equals.
    fn differences(own: &Self::Identity, other: &Self::Identity) -> Vec<Difference>;
}

/// Contents of a file of trials.
#[derive(Clone, Debug, PartialEq)]
pub struct Kept<R: Row> {
    /// Path of the file.
    pub file: PathBuf,
    /// The identity of its evaluation.
    pub identity: R::Identity,
    /// Rows, in the order of the file.
    pub rows: Vec<R>,
    /// Bytes up to the end of the last complete line.
    whole: usize,
}

/// Reads a file of trials; `None` where it was torn before its first trial.
pub fn read<R: Row>(path: &Path) -> Result<Option<Kept<R>>, EvaluationError> {
    let bytes = foreign::read(path, LEN_MAX).map_err(EvaluationError::file(path))?;
    parse(path, &bytes)
}

/// Longest file that is read, bytes: a million trials have 300 MB.
const LEN_MAX: u64 = 1 << 30;

fn parse<R: Row>(path: &Path, bytes: &[u8]) -> Result<Option<Kept<R>>, EvaluationError> {
    let whole = whole_len(bytes);
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
fn not_finite<R: Row>(columns: &csv::StringRecord, row: &R) -> Option<String> {
    // Written again, such a number has one spelling, for any spelling in the file: `nan`, `+inf`, `1e999`.
    let line = to_line(row).ok()?;
    let mut again = csv::ReaderBuilder::new().has_headers(false).from_reader(&line[..]);
    let cells = again.records().next()?.ok()?;
    let at = cells.iter().position(|cell| matches!(cell, "NaN" | "inf" | "-inf"))?;
    let column = columns.get(at).unwrap_or("a column");
    Some(format!("{column} is {}, not a finite number", cells.get(at).unwrap_or_default()))
}

#[derive(Debug)]
pub(super) struct RowFile {
    lines: LineFile,
    /// Whether the line with the columns' names is written; it comes with the first row.
    headed: bool,
}

impl RowFile {
    /// Opens or creates a file of `identity`; returns it with the rows that it already holds.
    pub(super) fn open<R: Row>(
        path: &Path,
        identity: &R::Identity,
    ) -> Result<(Self, Vec<R>), EvaluationError> {
        let (mut lines, bytes) = LineFile::open(path, LEN_MAX).map_err(|error| match error {
            OpenError::InUse => EvaluationError::InUse(path.to_owned()),
            OpenError::File(error) => EvaluationError::file(path)(error),
        })?;
        let Some(kept) = parse::<R>(path, &bytes)? else {
            let json = serde_json::to_string(identity).map_err(io::Error::from);
            let head = json.map(|json| format!("{}{json}\n", R::MARK));
            let begun = head.and_then(|head| lines.cut(0).and_then(|()| lines.append(head.as_bytes())));
            begun.map_err(EvaluationError::file(path))?;
            return Ok((Self { lines, headed: false }, Vec::new()));
        };
        let differences = R::differences(&kept.identity, identity);
        if !differences.is_empty() {
            return Err(EvaluationError::Another { file: path.to_owned(), merged: None, differences });
        }
        lines.cut(kept.whole as u64).map_err(EvaluationError::file(path))?;
        Ok((Self { lines, headed: true }, kept.rows))
    }

    /// Stores a row: once this returns, killing the process does not lose it.
    pub(super) fn keep<R: Row>(&mut self, row: &R) -> Result<(), EvaluationError> {
        let line = if self.headed { to_line(row) } else { to_csv(std::slice::from_ref(row)) };
        self.headed = true;
        let kept = line.map_err(io::Error::from).and_then(|line| self.lines.append(&line));
        kept.map_err(EvaluationError::file(self.lines.path()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluation::{
        EvaluationPlan, Identity, TrialRow, identity_for_tests as identity, row_for_tests as row,
    };

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
        let first = TrialRow {
            profile: planned.cell.profile,
            configuration: planned.cell.configuration,
            scenario: planned.cell.scenario,
            approach: planned.cell.approach,
            seed: planned.seed,
            time_s: 10.125,
            // A hash that parses as an infinite number is still a hash.
            trace_hash: "1234567890e99999".to_owned(),
            ..row()
        };
        let csv = String::from_utf8(to_csv(&[first]).unwrap()).unwrap();
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
    fn a_device_is_no_file_of_rows() {
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
