//! `comparison`: the same matches played by two programs, case bases or settings: the difference match by
//! match.

use serde::Serialize;

use super::MatchIdentity;
use super::effect::Change;
use super::plan::{MatchPlan, Pairing};
use super::row::MatchRow;
use crate::evaluation::Difference;
use crate::statistics::{Sample, detectable};

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
    let is_of = |row: &MatchRow, Pairing { own, opponent }| (row.own, row.opponent) == (own, opponent);
    let pairs = || pairs.iter().filter(|(_, row)| pairing.is_none_or(|pairing| is_of(row, pairing)));
    let ahead = |goals: u32, against: u32| f64::from(goals) - f64::from(against);
    let goals = pairs().map(|(before, after)| {
        ahead(after.goals, after.goals_against) - ahead(before.goals, before.goals_against)
    });
    let shots = pairs().map(|(before, after)| {
        ahead(after.shots, after.shots_against) - ahead(before.shots, before.shots_against)
    });
    let sum = |rows: &mut dyn Iterator<Item = &MatchRow>| {
        rows.fold([0, 0], |[own, theirs], row| [own + row.goals, theirs + row.goals_against])
    };
    Some(MatchComparison {
        pairing,
        goals_before: sum(&mut pairs().map(|(before, _)| *before)),
        goals_after: sum(&mut pairs().map(|(_, after)| *after)),
        detectable_goals: Sample::of(goals.clone()).and_then(detectable),
        goals: Change::of(goals, |x| x)?,
        shots: Change::of(shots, |x| x)?,
    })
}
