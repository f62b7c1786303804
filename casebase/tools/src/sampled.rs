//! `sampled`: cases that no drawn problem retrieves, and what is retrieved instead. Warnings
//! (docs/case-format.md §1.2), from counters over problems; the build of the built-in libraries draws none.

use casebase::{RetrievalSettings, SettingError};

use crate::codes::code;
use crate::coverage::{CaseCounters, Cells, Counters, Survey, VERDICTS};
use crate::library::Library;
use foreign::{Finding, Severity};

impl Library {
    /// Counts problems over the library, with retrieval's defaults and the field as one cell: the input of
    /// [`never_retrieved`].
    pub fn survey(&self) -> Result<Survey<'_>, SettingError> {
        let base = self.base();
        let field = base.field();
        let cells = Cells { columns: 1, rows: 1, edge_mm: field.length.max(field.width) };
        Survey::new(base, &RetrievalSettings::default(), cells)
    }
}

/// Warns of every authored case that none of the counted problems retrieved. Twins are skipped: their own
/// warning gives the reason.
pub fn never_retrieved(library: &Library, counters: &Counters) -> Vec<Finding> {
    if counters.problems == 0 {
        return Vec::new();
    }
    let is_twin = |file| library.findings.iter().any(|other| other.code == code::TWIN && other.file == file);
    let never = library.balls.iter().zip(&counters.cases).filter(|(_, case)| case.wins == 0);
    let never = never.filter(|(ball, _)| !is_twin(ball.file.as_path()));
    never
        .map(|(ball, case)| {
            let drawn = counters.problems;
            let (why, hint) = reason(library, case, drawn);
            Finding {
                code: code::NEVER_RETRIEVED,
                severity: Severity::Warning,
                file: ball.file.clone(),
                line: ball.line,
                message: format!("never retrieved in {drawn} drawn problems: {why}"),
                hint: hint.to_owned(),
            }
        })
        .collect()
}

/// The obstacle in most of the `drawn` problems, and its fix.
fn reason(library: &Library, case: &CaseCounters, drawn: u64) -> (String, &'static str) {
    // The lowest id of those that beat it equally often.
    let beaten_by = case.beaten_by.iter().max_by_key(|(winner, count)| (**count, u16::MAX - **winner));
    if let Some((winner, count)) = beaten_by {
        let name = &library.names[usize::from(*winner)];
        let candidate = case.candidate();
        return (
            format!("a candidate in {candidate} of them, beaten most often by {name} ({count} times)"),
            "tell them apart by opponents, robots or scopes, or take it out",
        );
    }
    let at_ball = drawn - case.verdicts[BALL_INDEX];
    if at_ball == 0 {
        return (
            "a candidate in none of them, no ball lay in its scope".to_owned(),
            "enlarge the scope of the ball, or draw more problems (--problems)",
        );
    }
    let (label, count) = VERDICTS
        .iter()
        .zip(&case.verdicts)
        .skip(BALL_INDEX + 1)
        .fold(("", 0), |most, (label, count)| if *count > most.1 { (*label, *count) } else { most });
    let (failed, hint) = match label {
        "robots" => (
            "fewer robots are drawn than it needs",
            "draw more with [problems] in league.toml, or leave robots out of the case",
        ),
        "path" => {
            ("an opponent blocks the ball's path", "lead the ball along another path, or keep legs short")
        }
        _ => (
            "its robots are too far away",
            "place them nearer to the ball, or say in [problems] of league.toml where robots stand",
        ),
    };
    let why = format!(
        "a candidate in none of them; the ball lay in its scope in {at_ball}, and in {count} {failed}"
    );
    (why, hint)
}

/// The index of "ball" in [`VERDICTS`].
const BALL_INDEX: usize = 0;
