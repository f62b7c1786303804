//! `refusals`: answers of a strategy that were refused, in a file beside the file of the matches, so that
//! they outlive an interrupt: a line of JSON a match and team.

use std::collections::BTreeMap;
use std::fs::OpenOptions;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use arena::game::StrategyReport;
use serde::{Deserialize, Serialize};

use crate::store::{EvaluationError, LineFile, OpenError, whole_len};

/// Longest file that is read, bytes: a hundred thousand matches.
const LEN_MAX: u64 = 1 << 26;

/// A match in which answers of a strategy were refused.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Refusal {
    /// Number of the match in the plan, from 0.
    pub number: usize,
    /// Whether the strategy's team was blue.
    pub is_blue: bool,
    /// Its answers.
    #[serde(flatten)]
    pub answers: StrategyReport,
}

/// Refused answers of all matches.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct RefusedAnswers {
    /// Number of matches with such answers.
    pub matches: usize,
    /// Number of answers that were refused in them.
    pub refused: u64,
    /// Why, in the first of these matches.
    pub refusal: Option<String>,
}

impl RefusedAnswers {
    /// Sums them up.
    pub fn of(refusals: &[Refusal]) -> Self {
        Self {
            matches: refusals.len(),
            refused: refusals.iter().map(|refusal| refusal.answers.refused).sum(),
            refusal: refusals.first().and_then(|refusal| refusal.answers.refusal.clone()),
        }
    }
}

/// The file of a shard's refused answers.
#[derive(Clone, Debug)]
pub struct RefusalFile(PathBuf);

impl RefusalFile {
    /// The one beside a file of matches: `refusals-1-of-3.jsonl` beside `trials-1-of-3.csv`.
    pub fn beside(matches: &Path) -> Self {
        let name = matches.file_stem().unwrap_or_default().to_string_lossy();
        Self(matches.with_file_name(format!("{}.jsonl", name.replacen("trials", "refusals", 1))))
    }

    /// Opens the file for a run: drops an incomplete last line, and everything where the matches restart.
    pub fn open(self, matches: &Path) -> Result<Self, EvaluationError> {
        let failed = EvaluationError::file(&self.0);
        match LineFile::open(&self.0, LEN_MAX) {
            Ok((mut file, bytes)) => {
                let kept = if matches.exists() { whole_len(&bytes) } else { 0 };
                file.cut(kept as u64).map_err(failed)?;
                Ok(self)
            }
            Err(OpenError::InUse) => Err(EvaluationError::InUse(self.0.clone())),
            Err(OpenError::File(error)) => Err(failed(error)),
        }
    }

    pub(super) fn append(&self, refusal: &Refusal) -> Result<(), EvaluationError> {
        let written = serde_json::to_vec(refusal).map_err(io::Error::from).and_then(|mut line| {
            line.push(b'\n');
            // One write for a line: threads append to the file side by side.
            OpenOptions::new().append(true).create(true).open(&self.0)?.write_all(&line)
        });
        written.map_err(EvaluationError::file(&self.0))
    }

    /// All refusals, by match; of a match that was played again the last.
    pub fn read(&self) -> Result<Vec<Refusal>, EvaluationError> {
        if !self.0.exists() {
            return Ok(Vec::new());
        }
        let text = foreign::read_text(&self.0, LEN_MAX).map_err(EvaluationError::file(&self.0))?;
        let lines = text.lines().map(|line| {
            let refusal: Refusal = serde_json::from_str(line)?;
            Ok(((refusal.number, refusal.is_blue), refusal))
        });
        let by_match = lines.collect::<io::Result<BTreeMap<_, _>>>();
        Ok(by_match.map_err(EvaluationError::file(&self.0))?.into_values().collect())
    }
}
