//! `effect`: effect of one part of the second paper. Our team with it against our team without, in the same
//! matches (docs/papers.md D24).
//!
//! Goals by their difference a match; the paper's two ratios (Biswas et al. 2014 §6) by the mean of their
//! logarithms, for 2 and 1/2 are as far from 1, half a shot added to each side so that a match without shots
//! has a ratio too. Student's 95 % intervals, paired t.

use serde::Serialize;

use super::match_team::MatchTeam;
use super::passes::CONFIDENCE;
use super::plan::MatchPlan;
use super::row::MatchRow;
use crate::statistics::{Sample, paired, student};

/// Advantage of the side with the part.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Change {
    /// A difference, 0 without effect; or a ratio, 1 without effect.
    pub mean: f64,
    /// Lower end of its 95 % interval; `None` of a single match.
    pub low: Option<f64>,
    /// Upper end of the 95 % interval.
    pub high: Option<f64>,
    /// p: probability of an equal or larger difference between equals.
    pub p: Option<f64>,
    /// Number of matches that have the value.
    pub matches: u32,
}

impl Change {
    pub(super) fn of(values: impl Iterator<Item = f64> + Clone, transform: fn(f64) -> f64) -> Option<Self> {
        let sample = Sample::of(values)?;
        let interval = student(sample, CONFIDENCE);
        Some(Self {
            mean: transform(sample.mean),
            low: interval.map(|interval| transform(interval.low)),
            high: interval.map(|interval| transform(interval.high)),
            p: paired(sample).map(|test| test.p),
            matches: sample.n,
        })
    }
}

/// Effect of a part.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Effect {
    /// Its name; several with a `+` between.
    pub part: String,
    /// The team that played with it.
    pub with: MatchTeam,
    /// The team that played without it.
    pub without: MatchTeam,
    /// Number of matches between the two.
    pub matches: u32,
    /// Goals a match with it, less those without.
    pub goals: Option<Change>,
    /// Shots a match, likewise.
    pub shots: Option<Change>,
    /// Offence ratio of the side with it.
    pub offence_ratio: Option<Change>,
    /// Attack ratio of the side with it.
    pub attack_ratio: Option<Change>,
}

/// One for each pair of the plan whose teams differ by parts that one of them has and the other lacks.
pub fn effects(plan: &MatchPlan, rows: &[MatchRow]) -> Vec<Effect> {
    let of = |own: MatchTeam, opponent: MatchTeam| {
        let (part, own_has) = own.part_beside(opponent)?;
        let rows = rows.iter().filter(|row| (row.own, row.opponent) == (own, opponent));
        let sign = if own_has { 1.0 } else { -1.0 };
        let goals = |row: &MatchRow| f64::from(row.goals) - f64::from(row.goals_against);
        let shots = |row: &MatchRow| f64::from(row.shots) - f64::from(row.shots_against);
        let attack =
            |row: &MatchRow| ((f64::from(row.shots) + HALF) / (f64::from(row.shots_against) + HALF)).ln();
        let offence = |row: &MatchRow| row.offence_ratio().filter(|ratio| *ratio > 0.0).map(f64::ln);
        Some(Effect {
            part,
            with: if own_has { own } else { opponent },
            without: if own_has { opponent } else { own },
            matches: rows.clone().count() as u32,
            goals: Change::of(rows.clone().map(|row| sign * goals(row)), |x| x),
            shots: Change::of(rows.clone().map(|row| sign * shots(row)), |x| x),
            offence_ratio: Change::of(rows.clone().filter_map(offence).map(|x| sign * x), f64::exp),
            attack_ratio: Change::of(rows.map(|row| sign * attack(row)), f64::exp),
        })
    };
    plan.pairings.iter().filter_map(|pairing| of(pairing.own, pairing.opponent)).collect()
}

/// Half a shot, added to both sides (Haldane 1956).
const HALF: f64 = 0.5;
