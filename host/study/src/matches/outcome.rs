//! `outcome`: results of the matches of two teams. Means a match with Student's 95 % intervals, and the
//! paper's ratios (Biswas et al. 2014 §6).

use std::cmp::Ordering;
use std::collections::BTreeMap;

use host::strategy::Team;
use host::strategy::counters::PlayCounters;
use serde::Serialize;

use super::match_team::MatchTeam;
use super::passes::{self, CONFIDENCE, Passes, counted};
use super::plan::MatchPlan;
use super::row::{MatchRow, MatchSide};
use crate::statistics::{Sample, paired, student};
use arena::ledger::CaseTable;

/// Mean over matches of a number that is never below 0, or of a share, never above 1; its interval is clipped
/// there.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Estimate {
    /// Mean of the matches' values.
    pub mean: f64,
    /// Lower end of its 95 % interval; `None` of a single match.
    pub low: Option<f64>,
    /// Upper end of the 95 % interval.
    pub high: Option<f64>,
    /// Number of matches that have the value.
    pub matches: u32,
}

impl Estimate {
    /// Estimate of these numbers, each at most `most`; `None` without numbers.
    fn of(values: impl Iterator<Item = f64> + Clone, most: f64) -> Option<Self> {
        let sample = Sample::of(values)?;
        let interval = student(sample, CONFIDENCE);
        Some(Self {
            mean: sample.mean,
            low: interval.map(|interval| interval.low.max(0.0)),
            high: interval.map(|interval| interval.high.min(most)),
            matches: sample.n,
        })
    }
}

/// All matches of two teams.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Outcome {
    /// The team whose numbers come first.
    pub own: MatchTeam,
    /// The team that it played against.
    pub opponent: MatchTeam,
    /// Number of matches played.
    pub matches: u32,
    /// Number of matches won, drawn and lost.
    pub won_drawn_lost: [u32; 3],
    /// All goals, for and against.
    pub goals: [u32; 2],
    /// Goals scored in a match.
    pub goals_for: Option<Estimate>,
    /// Goals against a match.
    pub goals_against: Option<Estimate>,
    /// p of such a difference of goals between equals, by the paired t; `None` of a single match.
    pub goals_p: Option<f64>,
    /// Offence ratio, the mean of the matches' own.
    pub offence_ratio: Option<Estimate>,
    /// Attack ratio, the mean over those matches in which the opponents shot.
    pub attack_ratio: Option<Estimate>,
    /// All own shots over all of theirs: counts the matches in which they never shot too.
    pub attack_ratio_of_all: Option<f64>,
    /// Shots, a match, for and against.
    pub shots: [Option<Estimate>; 2],
    /// Shots that a keeper had to stop, that hit a post, or went in, for and against.
    pub chances: [Option<Estimate>; 2],
    /// Own share of possession.
    pub possession: Option<Estimate>,
    /// Passes that arrived, for and against.
    pub passes: [Option<Estimate>; 2],
    /// Balls lost, for and against.
    pub losses: [Option<Estimate>; 2],
    /// Share of the match with the ball in play.
    pub ball_in_play: Option<Estimate>,
    /// Ends of possessions, kicks, shots and left balls, all matches, own and theirs.
    pub attack: [BTreeMap<String, u32>; 2],
    /// Passes of restarts, planned free kicks and P(we have it) against observed shares, own and theirs.
    pub restarts: [Passes; 2],
    /// Offences by kind, all matches, own and theirs.
    pub fouls: [BTreeMap<String, u32>; 2],
    /// Plays of every case and what followed, all matches, own and theirs.
    pub cases: [CaseTable; 2],
}

/// One for each pair of the plan, in its order.
pub fn outcomes(plan: &MatchPlan, rows: &[MatchRow]) -> Vec<Outcome> {
    plan.pairings
        .iter()
        .map(|pairing| {
            let played: Vec<_> = rows
                .iter()
                .filter(|row| (row.own, row.opponent) == (pairing.own, pairing.opponent))
                .collect();
            outcome(pairing.own, pairing.opponent, &played)
        })
        .collect()
}

fn outcome(own: MatchTeam, opponent: MatchTeam, rows: &[&MatchRow]) -> Outcome {
    let differences = Sample::of(rows.iter().map(|row| row.ahead(|side| side.goals)));
    let [shots, against] = totals(rows, |side| side.shots);
    let [goals_for, goals_against] = means(rows, |side| side.goals);
    Outcome {
        own,
        opponent,
        matches: rows.len() as u32,
        won_drawn_lost: [Ordering::Greater, Ordering::Equal, Ordering::Less].map(|end| ended(rows, end)),
        goals: totals(rows, |side| side.goals),
        goals_for,
        goals_against,
        goals_p: differences.and_then(paired).map(|test| test.p),
        offence_ratio: Estimate::of(rows.iter().filter_map(|row| row.offence_ratio()), f64::INFINITY),
        attack_ratio: Estimate::of(rows.iter().filter_map(|row| row.attack_ratio()), f64::INFINITY),
        attack_ratio_of_all: (against > 0).then(|| f64::from(shots) / f64::from(against)),
        shots: means(rows, |side| side.shots),
        chances: means(rows, |side| side.chances),
        possession: Estimate::of(rows.iter().filter_map(|row| row.possession()), 1.0),
        passes: means(rows, |side| side.passes),
        losses: means(rows, |side| side.losses),
        ball_in_play: Estimate::of(rows.iter().map(|row| f64::from(row.ball_in_play)), 1.0),
        attack: summed(rows, |side| &side.attack),
        restarts: played(rows).map(|play| Passes::of(&play)),
        fouls: summed(rows, |side| &side.fouls),
        cases: [0, 1].map(|side| cases(rows, side)),
    }
}

fn means(rows: &[&MatchRow], count: fn(&MatchSide) -> u32) -> [Option<Estimate>; 2] {
    [0, 1].map(|side| Estimate::of(rows.iter().map(|row| f64::from(count(&row.sides[side]))), f64::INFINITY))
}

/// Sum of a count over all matches, of both teams.
fn totals(rows: &[&MatchRow], count: fn(&MatchSide) -> u32) -> [u32; 2] {
    [0, 1].map(|side| rows.iter().map(|row| count(&row.sides[side])).sum())
}

/// Number of matches in which the first team's goals compare so with its opponent's.
fn ended(rows: &[&MatchRow], end: Ordering) -> u32 {
    rows.iter().filter(|row| row.sides[0].goals.cmp(&row.sides[1].goals) == end).count() as u32
}

/// Sum of the counts of a column over all matches by kind, of both teams.
fn summed(rows: &[&MatchRow], column: fn(&MatchSide) -> &str) -> [BTreeMap<String, u32>; 2] {
    [0, 1].map(|side| {
        let mut all = BTreeMap::new();
        for (kind, n) in rows.iter().flat_map(|row| counted(column(&row.sides[side]))) {
            *all.entry(kind.to_owned()).or_default() += n;
        }
        all
    })
}

/// Plays of a team's cases and what followed, over all matches.
fn cases(rows: &[&MatchRow], side: usize) -> CaseTable {
    let mut all = CaseTable::default();
    for row in rows {
        all.merge(&CaseTable::read(&row.sides[side].cases));
    }
    all
}

/// Counts of both sides' hosts, over all matches.
fn played(rows: &[&MatchRow]) -> [PlayCounters; 2] {
    let mut sums = [PlayCounters::default(); 2];
    for row in rows {
        for (sum, side) in sums.iter_mut().zip(&row.sides) {
            passes::add(sum, &side.play());
        }
    }
    sums
}

/// The passes of restarts of our team in all these matches, with any tactics; of both sides where it played
/// itself.
pub fn our_passes(rows: &[MatchRow]) -> Passes {
    let mut sum = PlayCounters::default();
    for row in rows {
        for (team, side) in [row.own, row.opponent].into_iter().zip(&row.sides) {
            if team.team == Team::Ours {
                passes::add(&mut sum, &side.play());
            }
        }
    }
    Passes::of(&sum)
}
