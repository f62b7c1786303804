//! `comparison`: the same matches played by two programs, case bases or settings: the difference match by
//! match.

use serde::Serialize;

use super::MatchIdentity;
use super::effect::Change;
use super::plan::{MatchPlan, Pairing};
use super::row::MatchRow;
use crate::statistics::{Sample, detectable};
use crate::store::Difference;

/// Matches of one pair of teams, or of all.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MatchComparison {
    /// The pair of teams; none: all of them together.
    pub pairing: Option<Pairing>,
    /// Goals of the first program's matches, for and against.
    pub goals_before: [u32; 2],
    /// Goals of the second program's matches, for and against.
    pub goals_after: [u32; 2],
    /// Difference of goals a match, second less first.
    pub goals: Change,
    /// The smallest difference of goals a match that so many matches find in 80 of 100 repetitions.
    pub detectable_goals: Option<f64>,
    /// Difference of shots a match, likewise.
    pub shots: Change,
}

/// Checks that the matches of both are the same ones.
///
/// # Errors
/// The differences other than program, cases and settings.
pub fn check_same_matches(before: &MatchIdentity, after: &MatchIdentity) -> Result<(), Vec<Difference>> {
    let compared = ["program", "cases", "settings", "strategy's command"];
    let mut differences = before.differences(after);
    differences.retain(|difference| !compared.contains(&difference.what));
    if differences.is_empty() { Ok(()) } else { Err(differences) }
}

/// Compares [the same matches](check_same_matches), each list in the order of the plan: one result for each
/// pair of teams, and one for all where there are several.
pub fn compare_matches(plan: &MatchPlan, before: &[MatchRow], after: &[MatchRow]) -> Vec<MatchComparison> {
    let pairs: Vec<_> = before.iter().zip(after).collect();
    let mut pairings: Vec<_> = plan.pairings.iter().copied().map(Some).collect();
    if pairings.len() > 1 {
        pairings.push(None);
    }
    pairings.into_iter().filter_map(|pairing| of(pairing, &pairs)).collect()
}

fn of(pairing: Option<Pairing>, pairs: &[(&MatchRow, &MatchRow)]) -> Option<MatchComparison> {
    let pairs = pairs.iter().filter(|(_, row)| {
        pairing.is_none_or(|Pairing { own, opponent }| (row.own, row.opponent) == (own, opponent))
    });
    let goals =
        pairs.clone().map(|(before, after)| after.ahead(|side| side.goals) - before.ahead(|side| side.goals));
    let shots =
        pairs.clone().map(|(before, after)| after.ahead(|side| side.shots) - before.ahead(|side| side.shots));
    Some(MatchComparison {
        pairing,
        goals_before: goals_of(pairs.clone().map(|(before, _)| *before)),
        goals_after: goals_of(pairs.map(|(_, after)| *after)),
        detectable_goals: Sample::of(goals.clone()).and_then(detectable),
        goals: Change::of(goals, |x| x)?,
        shots: Change::of(shots, |x| x)?,
    })
}

/// Goals of all these matches, for and against.
fn goals_of<'r>(rows: impl Iterator<Item = &'r MatchRow>) -> [u32; 2] {
    rows.fold([0, 0], |[own, theirs], row| [own + row.sides[0].goals, theirs + row.sides[1].goals])
}
