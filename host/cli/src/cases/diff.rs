//! `diff`: two cases side by side on one problem: the result of each retrieval test for both, and the
//! criterion by which one ranks first.

use std::io::{self, Write};

use arena::cases::LibraryHandle;
use casebase::{CaseVerdict, Criterion, Match, RetrievalSettings, Symmetry, rank_order};
use protocol::CaseId;
use serde::Serialize;

use super::failure::NoCase;

/// The case of two that ranks first, and the criterion that decides.
#[derive(Debug, Serialize)]
pub(super) struct Difference<'a> {
    /// The one that ranks first; the only candidate, if just one is.
    first: Option<u16>,
    /// The criterion that separates them, or `verdict`, or `neither`.
    by: &'static str,
    /// Both, in the order they were asked for.
    cases: [Side<'a>; 2],
}

#[derive(Debug, Serialize)]
struct Side<'a> {
    id: u16,
    case: &'a str,
    symmetry: &'static str,
    verdict: &'static str,
    #[serde(skip)]
    why: String,
}

/// A stored case by its id, its name (as authored) or `name/symmetry`.
pub(super) fn find(library_handle: &LibraryHandle, stored: usize, asked: &str) -> Result<CaseId, NoCase> {
    if let Some(id) = asked.parse::<u16>().ok().filter(|id| usize::from(*id) < stored) {
        return Ok(CaseId(id));
    }
    let names = library_handle.names();
    let with = |name: &str, symmetry: Symmetry| {
        let authored = names.iter().position(|known| known == name)?;
        Some(CaseId(4 * authored as u16 + symmetry.bits()))
    };
    let mirrored = asked.rsplit_once('/').and_then(|(name, label)| {
        let symmetry = Symmetry::ALL.into_iter().find(|symmetry| symmetry.label() == label)?;
        with(name, symmetry)
    });
    mirrored
        .or_else(|| with(asked, Symmetry::Identity))
        .ok_or_else(|| super::show::unknown(library_handle, asked))
}

impl<'a> Difference<'a> {
    /// `reported` are both cases with their verdicts and texts; a case for the other goal has none.
    pub(super) fn new(
        library_handle: &'a LibraryHandle,
        reported: [(CaseId, Option<&CaseVerdict>, String); 2],
        settings: &RetrievalSettings,
    ) -> Self {
        let found = reported.each_ref().map(|(_, verdict, _)| match verdict {
            Some(CaseVerdict::Candidate(found)) => Some(found),
            _ => None,
        });
        let (first, by) = match found {
            [Some(a), Some(b)] => {
                let first = if rank_order(a, b, settings).is_le() { a } else { b };
                (Some(first.case.0), separated_by(a, b, settings))
            }
            [Some(only), None] | [None, Some(only)] => (Some(only.case.0), "verdict"),
            [None, None] => (None, "neither"),
        };
        let cases = reported.map(|(id, verdict, why)| Side {
            id: id.0,
            case: library_handle.name(id),
            symmetry: Symmetry::from_bits(id.0).label(),
            verdict: verdict.map_or("other_goal", CaseVerdict::label),
            why,
        });
        Self { first, by, cases }
    }

    pub(super) fn write(&self, output: &mut impl Write, line: u64) -> io::Result<()> {
        for side in &self.cases {
            writeln!(
                output,
                "line {line}: {} ({}), id {}: {}: {}",
                side.case, side.symmetry, side.id, side.verdict, side.why
            )?;
        }
        match self.first {
            Some(id) => writeln!(output, "line {line}: id {id} ranks first, by {}\n", self.by),
            None => writeln!(output, "line {line}: neither is a candidate\n"),
        }
    }
}

/// The first criterion in which two candidates differ.
fn separated_by(a: &Match, b: &Match, settings: &RetrievalSettings) -> &'static str {
    for criterion in settings.ranking {
        match criterion {
            Criterion::Conditions if a.conditions != b.conditions => return "conditions",
            Criterion::Teammates if a.teammates != b.teammates => return "teammates",
            Criterion::IntervalCost => {
                // Only fuzzy paths are compared by their degree; crisp ones are all 1.
                if a.free != b.free {
                    return "free path";
                }
                if interval(a) != interval(b) {
                    return "similarity interval";
                }
                if a.cost != b.cost {
                    return "cost";
                }
            }
            _ => {}
        }
    }
    if a.exponent == b.exponent { "id" } else { "similarity" }
}

/// Number of the similarity interval H, h, l, L (paper §3.4).
fn interval(found: &Match) -> usize {
    [0.8_f64, 0.6, 0.4].iter().filter(|end| f64::from(found.exponent) > -end.ln()).count()
}
