//! `results`: results of an evaluation. Everything that is written into its directory, computed from the rows
//! of its trials alone.
//!
//! | file | what |
//! |---|---|
//! | `trials.csv` | every trial, in the plan's order |
//! | `tables.json`, `tables.csv` | the paper's tables (docs/case-format.md §5.2) |
//! | `comparisons.json`, `comparisons.csv` | ours against the paper's, and approach against approach |
//! | `claims.json` | the paper's claims in prose, and whether our numbers and its own support them |
//! | `judge.json` | whether the pattern of its results is reproduced |
//! | `cases.csv` | uses and outcomes of each case |
//! | `run.json` | identity of the evaluation: program, seed, numbers, cases, settings, world |

use std::io;
use std::path::Path;

use serde::Serialize;

use super::ablation::Effect;
use super::claims::{Claim, claims};
use super::comparison::{Comparison, compare, with_paper};
use super::identity::Identity;
use super::judge::{JudgementLine, judge};
use super::paper::paper;
use super::row::TrialRow;
use super::tables::{TableRow, tables};
use super::uses::{CaseUse, uses, uses_to_csv};
use crate::store::{EvaluationError, csv_hash, to_csv};
use arena::APPROACHES;

/// An evaluation that was played to its end.
#[derive(Clone, Debug, PartialEq)]
pub struct Results {
    /// Identity of the evaluation: everything that its trials depend on.
    pub identity: Identity,
    /// Trials, in the plan's order.
    pub rows: Vec<TrialRow>,
    /// Rows of the paper's tables, computed from our trials.
    pub tables: Vec<TableRow>,
    /// Every row compared with the paper's.
    pub with_paper: Vec<Comparison>,
    /// Every approach compared with every later one.
    pub between_approaches: Vec<Comparison>,
    /// The paper's claims, and the verdicts of the numbers.
    pub claims: Vec<Claim>,
    /// Whether the pattern of the paper's results is reproduced.
    pub lines: Vec<JudgementLine>,
    /// Uses and outcomes of each case.
    pub uses: Vec<CaseUse>,
    /// [`csv_hash`] of its trials.
    pub hash: String,
}

/// `run.json`.
#[derive(Serialize)]
struct Run<'a> {
    #[serde(flatten)]
    identity: &'a Identity,
    trials: usize,
    csv_hash: &'a str,
}

impl Results {
    /// Results of an evaluation's trials in the plan's order, as [`merge`](crate::store::merge) returns them.
    pub fn new(identity: Identity, rows: Vec<TrialRow>) -> Result<Self, EvaluationError> {
        let hash = csv_hash(&to_csv(&rows)?);
        let tables = tables(&rows);
        let pairs = (1..).zip(APPROACHES);
        let pairs =
            pairs.flat_map(|(next, first)| APPROACHES[next..].iter().map(move |second| (first, *second)));
        let between = pairs.flat_map(|(first, second)| compare(&tables, first, second)).collect();
        Ok(Self {
            with_paper: with_paper(&tables, paper()),
            between_approaches: between,
            claims: claims(&tables, paper()),
            lines: judge(&tables),
            uses: uses(&rows, &identity.cases),
            identity,
            rows,
            tables,
            hash,
        })
    }

    /// Every file of the results: name and content.
    pub fn files(&self) -> Result<Vec<(&'static str, Vec<u8>)>, EvaluationError> {
        let all: Vec<_> = self.with_paper.iter().chain(&self.between_approaches).collect();
        let paper = self.with_paper.len();
        let flat: Vec<_> = all.iter().enumerate().map(|(i, comparison)| comparison.flat(i < paper)).collect();
        let run = Run { identity: &self.identity, trials: self.rows.len(), csv_hash: &self.hash };
        contents([
            ("trials.csv", as_csv(&self.rows)),
            ("tables.json", json(&self.tables)),
            ("tables.csv", as_csv(&self.tables)),
            ("comparisons.json", json(&flat)),
            ("comparisons.csv", as_csv(&flat)),
            ("claims.json", json(&self.claims)),
            ("judge.json", json(&self.lines)),
            ("cases.csv", uses_to_csv(&self.uses).map_err(Into::into)),
            ("run.json", json(&run)),
        ])
    }
}

/// The files of an ablation's effects: name and content.
pub fn effect_files(effects: &[Effect]) -> Result<Vec<(&'static str, Vec<u8>)>, EvaluationError> {
    contents([("ablations.json", json(&effects)), ("ablations.csv", as_csv(effects))])
}

fn contents<const N: usize>(
    files: [(&'static str, io::Result<Vec<u8>>); N],
) -> Result<Vec<(&'static str, Vec<u8>)>, EvaluationError> {
    let files = files.into_iter().map(|(name, bytes)| {
        let bytes = bytes.map_err(EvaluationError::file(Path::new(name)))?;
        Ok((name, bytes))
    });
    files.collect()
}

/// Indented JSON: one line for each element of a list would be too long to read.
fn json(value: &impl Serialize) -> io::Result<Vec<u8>> {
    let mut bytes = serde_json::to_vec_pretty(value)?;
    bytes.push(b'\n');
    Ok(bytes)
}

fn as_csv<T: Serialize>(rows: &[T]) -> io::Result<Vec<u8>> {
    to_csv(rows).map_err(Into::into)
}
