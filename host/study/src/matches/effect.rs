//! `effect`: effect of one part of the second paper. Our team with it against our team without, in the same
//! matches (docs/papers.md D24).
//!
//! Goals by their difference a match; the paper's two ratios (Biswas et al. 2014 §6) by the mean of their
//! logarithms, for 2 and 1/2 are as far from 1, half a shot added to each side so that a match without shots
//! has a ratio too. Student's 95 % intervals, paired t.

use serde::Serialize;

use super::match_team::MatchTeam;
use super::passes::CONFIDENCE;
use super::plan::{MatchPlan, Pairing};
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
    /// Name of the part; several with a `+` between.
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
    plan.pairings.iter().filter_map(|pairing| effect(*pairing, rows)).collect()
}

fn effect(Pairing { own, opponent }: Pairing, rows: &[MatchRow]) -> Option<Effect> {
    let (part, own_has) = own.part_beside(opponent)?;
    let (with, without) = if own_has { (own, opponent) } else { (opponent, own) };
    let rows = rows.iter().filter(|row| (row.own, row.opponent) == (own, opponent));
    let sign = if own_has { 1.0 } else { -1.0 };
    let offences = rows.clone().filter_map(MatchRow::offence_ratio).filter(|ratio| *ratio > 0.0);
    Some(Effect {
        part,
        with,
        without,
        matches: rows.clone().count() as u32,
        goals: Change::of(rows.clone().map(|row| sign * row.ahead(|side| side.goals)), |x| x),
        shots: Change::of(rows.clone().map(|row| sign * row.ahead(|side| side.shots)), |x| x),
        offence_ratio: Change::of(offences.map(|ratio| sign * ratio.ln()), f64::exp),
        attack_ratio: Change::of(rows.map(|row| sign * log_attack_ratio(row)), f64::exp),
    })
}

/// Logarithm of the attack ratio, with a part of a shot added to both sides.
fn log_attack_ratio(row: &MatchRow) -> f64 {
    let [own, theirs] = row.sides.each_ref().map(|side| f64::from(side.shots) + ADDED_SHOTS);
    (own / theirs).ln()
}

/// Half a shot, added to both sides (Haldane 1956).
const ADDED_SHOTS: f64 = 0.5;
