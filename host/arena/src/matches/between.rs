//! `between`: the same matches played by two programs, case bases or settings, and how much better the second
//! ones were, match by match.

use serde::Serialize;

use super::MatchIdentity;
use super::effect::Change;
use super::match_team::MatchTeam;
use super::plan::MatchPlan;
use super::row::MatchRow;
use crate::evaluation::Difference;
use crate::evaluation::statistics::{Sample, detectable};

/// Matches against one opponent, or all of them.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Between {
    /// The opponent; none: all of them together.
    pub opponent: Option<MatchTeam>,
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
pub fn same_matches(before: &MatchIdentity, after: &MatchIdentity) -> Result<(), Vec<Difference>> {
    let compared = ["program", "cases", "settings", "strategy's command"];
    let mut differences = before.differences(after);
    differences.retain(|difference| !compared.contains(&difference.what));
    if differences.is_empty() { Ok(()) } else { Err(differences) }
}

/// Compares [the same matches](same_matches), each list in the order of the plan: one for each opponent, and
/// one for all where there are several.
pub fn between(plan: &MatchPlan, before: &[MatchRow], after: &[MatchRow]) -> Vec<Between> {
    let pairs: Vec<_> = before.iter().zip(after).collect();
    let mut opponents: Vec<_> = plan.pairings.iter().map(|pairing| Some(pairing.opponent)).collect();
    opponents.dedup();
    if opponents.len() > 1 {
        opponents.push(None);
    }
    opponents.into_iter().filter_map(|opponent| of(opponent, &pairs)).collect()
}

fn of(opponent: Option<MatchTeam>, pairs: &[(&MatchRow, &MatchRow)]) -> Option<Between> {
    let pairs = || pairs.iter().filter(|(_, row)| opponent.is_none_or(|opponent| row.opponent == opponent));
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
    Some(Between {
        opponent,
        goals_before: sum(&mut pairs().map(|(before, _)| *before)),
        goals_after: sum(&mut pairs().map(|(_, after)| *after)),
        detectable_goals: Sample::of(goals.clone()).and_then(detectable),
        goals: Change::of(goals, |x| x)?,
        shots: Change::of(shots, |x| x)?,
    })
}
