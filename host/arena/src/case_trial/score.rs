//! `score`: score of many attempts. Shares in percent, seconds, metres; and the table that is stored beside
//! the cases.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use serde::Serialize;

use super::{Attempt, Retrieved};

/// The sum of a case's attempts against one kind of opposition.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Score {
    /// Name of the case, `region/name`.
    pub case: String,
    /// Kind of opposition: `standing` or `playing`.
    pub opponents: &'static str,
    /// Number of attempts played.
    pub trials: usize,
    /// Attempts in which the robots retrieved the tested case first.
    pub retrieved: usize,
    /// Gameplays played to their end.
    pub completed: usize,
    /// Cases that were retrieved instead, by name; `none` where no case fitted, `nothing` where no decision
    /// was made.
    pub instead: BTreeMap<String, usize>,
    /// Ends of the gameplays that were not completed.
    pub aborted: BTreeMap<&'static str, usize>,
    /// Mean seconds of the completed gameplays; null without any.
    pub duration_s: Option<f64>,
    /// Outcomes of the completed gameplays: `goal`, `close`, `block`, `out`, or `play` where the ball stayed
    /// in play.
    pub outcomes: BTreeMap<&'static str, usize>,
    /// Mean metres that completed gameplays brought the ball towards the attacked goal; null without any.
    pub progress_m: Option<f64>,
}

impl Score {
    /// The score of these attempts.
    pub fn of(case: String, opponents: &'static str, attempts: &[Attempt]) -> Self {
        let completed: Vec<_> = attempts.iter().filter(|attempt| attempt.completed()).collect();
        let mean = |value: fn(&Attempt) -> f32| {
            let sum: f64 = completed.iter().map(|attempt| f64::from(value(attempt))).sum();
            (!completed.is_empty()).then(|| (sum / completed.len() as f64 * 1000.0).round() / 1000.0)
        };
        let mut score = Self {
            case,
            opponents,
            trials: attempts.len(),
            retrieved: 0,
            completed: completed.len(),
            instead: BTreeMap::new(),
            aborted: BTreeMap::new(),
            duration_s: mean(|attempt| attempt.duration),
            outcomes: BTreeMap::new(),
            progress_m: mean(|attempt| attempt.progress),
        };
        for attempt in attempts {
            let instead = match &attempt.retrieved {
                Retrieved::Own => {
                    score.retrieved += 1;
                    None
                }
                Retrieved::Other(name) => Some(name.as_str()),
                Retrieved::None => Some("none"),
                Retrieved::Nothing => Some("nothing"),
            };
            if let Some(name) = instead {
                *score.instead.entry(name.to_owned()).or_default() += 1;
            }
            if let Some(end) = attempt.end.filter(|_| !attempt.completed()) {
                *score.aborted.entry(end.label()).or_default() += 1;
            }
            if attempt.completed() {
                let label = attempt.outcome.map_or("play", hil_sim::TrialOutcome::label);
                *score.outcomes.entry(label).or_default() += 1;
            }
        }
        score
    }

    /// Share of attempts that were completed, percent.
    pub fn completed_percent(&self) -> f64 {
        percent(self.completed, self.trials)
    }
}

/// One row a score, as a table in Markdown.
pub fn markdown(scores: &[Score]) -> String {
    let mut table = String::from(
        "| case | opponents | retrieved % | completed % | why not | mean s | progress m | ball after completed |\n\
         |---|---|---:|---:|---|---:|---:|---|\n",
    );
    for score in scores {
        let instead = score.instead.iter().map(|(name, count)| (name.as_str(), *count));
        let aborted = score.aborted.iter().map(|(label, count)| (*label, *count));
        let outcomes = score.outcomes.iter().map(|(label, count)| (*label, *count));
        let number = |value: Option<f64>| value.map_or_else(|| "–".to_owned(), |value| format!("{value:.1}"));
        writeln!(
            table,
            "| {} | {} | {:.0} | {:.0} | {} | {} | {} | {} |",
            score.case,
            score.opponents,
            percent(score.retrieved, score.trials),
            score.completed_percent(),
            counts(instead.chain(aborted)),
            number(score.duration_s),
            number(score.progress_m),
            counts(outcomes)
        )
        .expect("a string takes everything");
    }
    table
}

/// The most frequent first.
fn counts<'a>(entries: impl Iterator<Item = (&'a str, usize)>) -> String {
    let mut entries: Vec<_> = entries.collect();
    entries.sort_by(|a, b| b.1.cmp(&a.1).then(a.0.cmp(b.0)));
    entries.iter().map(|(label, count)| format!("{label} {count}")).collect::<Vec<_>>().join(", ")
}

fn percent(part: usize, whole: usize) -> f64 {
    if whole == 0 { 0.0 } else { 100.0 * part as f64 / whole as f64 }
}
