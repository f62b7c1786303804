//! `point`: pairwise comparison of two measurements with a significance test. Claims and verdicts consist of
//! these.

use std::fmt;

use brain::Approach;
use hil_sim::Scenario;
use serde::Serialize;

use crate::evaluation::comparison::Measure;
use crate::evaluation::tables::{Extent, TableRow};
use crate::statistics::{Count, Sample, Test, against, normal, two_proportions, welch};
use arena::approach_label;

/// Two numbers of a claim.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ClaimPoint {
    /// The trials that it is about.
    pub of: String,
    /// Description of the first number.
    pub first_name: String,
    /// The first number, in the measure's unit.
    pub first: f64,
    /// Description of the second number.
    pub second_name: String,
    /// The second number, in the measure's unit.
    pub second: f64,
    /// p: probability of a difference at least as large between equals; null where no spread is known.
    pub p: Option<f64>,
    /// Corrected over the claim's points by Holm.
    pub p_holm: Option<f64>,
    /// Whether it supports the claim.
    pub stands: Standing,
    #[serde(skip)]
    wanted: Wanted,
    #[serde(skip)]
    decimals: usize,
}

/// Whether a point supports its claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Standing {
    /// The claim is supported.
    Holds,
    /// The opposite is supported.
    Against,
    /// The difference is not significant.
    Open,
}

/// Expected order of the numbers of a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in super::super) enum Wanted {
    /// The first above the second.
    Greater,
    /// The first not below the second: equality is enough.
    AtLeast,
    /// No significant difference.
    Alike,
}

/// Significance level (paper §5: Student's t at 5 percent).
const LEVEL: f64 = 0.05;

impl ClaimPoint {
    pub(in super::super) fn new(
        of: impl Into<String>,
        (first_name, first): (impl Into<String>, f64),
        (second_name, second): (impl Into<String>, f64),
        test: Option<Test>,
        wanted: Wanted,
    ) -> Self {
        let (of, first_name, second_name) = (of.into(), first_name.into(), second_name.into());
        let p = test.map(|test| test.p);
        let mut point = Self {
            of,
            first_name,
            first,
            second_name,
            second,
            p,
            p_holm: p,
            stands: Standing::Open,
            wanted,
            decimals: 2,
        };
        point.stand();
        point
    }

    pub(in super::super) fn with_decimals(self, decimals: usize) -> Self {
        Self { decimals, ..self }
    }

    /// Sets the trials that it is about.
    pub(in super::super) fn of(self, of: impl Into<String>) -> Self {
        Self { of: of.into(), ..self }
    }

    /// Judges it by its corrected p; equality must hold before any correction.
    pub(super) fn stand(&mut self) {
        let sure = self.p_holm.is_none_or(|p| p < LEVEL);
        let difference = self.first - self.second;
        self.stands = match self.wanted {
            Wanted::Greater if difference > 0.0 && sure => Standing::Holds,
            Wanted::Greater if difference < 0.0 && sure => Standing::Against,
            Wanted::Greater => Standing::Open,
            Wanted::AtLeast if difference >= 0.0 => Standing::Holds,
            Wanted::AtLeast if sure => Standing::Against,
            Wanted::AtLeast => Standing::Open,
            Wanted::Alike if self.p_holm.is_some_and(|p| p < LEVEL) => Standing::Against,
            Wanted::Alike if self.p.is_some_and(|p| p >= LEVEL) => Standing::Holds,
            Wanted::Alike => Standing::Open,
        };
    }
}

impl fmt::Display for ClaimPoint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { of, first_name, first, second_name, second, p_holm, decimals, .. } = self;
        let sign = if first > second {
            ">"
        } else if first < second {
            "<"
        } else {
            "="
        };
        write!(f, "{of}: {first_name} {first:.decimals$} {sign} {second_name} {second:.decimals$}")?;
        match p_holm {
            Some(p) => write!(f, " ({})", p_text(*p)),
            None => Ok(()),
        }
    }
}

/// Variance of a row's percentage or mean; `None` where no spread is known.
fn variance_of_mean(measure: Measure, row: &TableRow) -> Option<f64> {
    if let Some(count) = measure.count(row) {
        let share = count.share()?;
        return Some(1e4 * share * (1.0 - share) / f64::from(count.of));
    }
    let sample = measure.sample(row)?;
    sample.sd.map(|sd| sd * sd / f64::from(sample.n))
}

/// A p value as text: `p 0.035`, `p < 0.001`.
pub(in super::super) fn p_text(p: f64) -> String {
    if p < 0.001 { "p < 0.001".to_owned() } else { format!("p {p:.3}") }
}

/// Rows of the paper's tables, ours or its own.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct Rows<'a> {
    pub(in super::super) rows: &'a [TableRow],
    /// Sample of Table 6: all trials where there are such rows, or as many as the paper's.
    pub(in super::super) sample: Extent,
}

impl<'a> Rows<'a> {
    pub(in super::super) fn row(
        self,
        table: u8,
        scenario: Scenario,
        approach: Approach,
    ) -> Option<&'a TableRow> {
        let of = |sample| {
            let key = (table, scenario, approach, sample);
            self.rows.iter().find(|row| (row.table, row.scenario, row.approach, row.sample) == key)
        };
        of(self.sample).or_else(|| of(Extent::Paper))
    }

    /// A measure of two approaches in a scenario; the first should be the greater.
    pub(in super::super) fn pair(
        self,
        (table, scenario): (u8, Scenario),
        measure: Measure,
        [first, second]: [Approach; 2],
        wanted: Wanted,
    ) -> Option<ClaimPoint> {
        let (a, b) = (self.row(table, scenario, first)?, self.row(table, scenario, second)?);
        let values = (measure.value(a)?, measure.value(b)?);
        let (first, second) = (approach_label(first), approach_label(second));
        let of = format!("scenario {scenario}");
        let point = ClaimPoint::new(of, (first, values.0), (second, values.1), measure.test(a, b), wanted);
        Some(point.with_decimals(decimals(measure)))
    }

    /// A measure of an approach in two scenarios; in the first it should be the greater.
    pub(in super::super) fn scenarios(
        self,
        table: u8,
        approach: Approach,
        measure: Measure,
        [first, second]: [Scenario; 2],
    ) -> Option<ClaimPoint> {
        let (a, b) = (self.row(table, first, approach)?, self.row(table, second, approach)?);
        let [first, second] = [first, second].map(|scenario| format!("scenario {scenario}"));
        let values = (measure.value(a)?, measure.value(b)?);
        let of = approach_label(approach);
        let point =
            ClaimPoint::new(of, (first, values.0), (second, values.1), measure.test(a, b), Wanted::Greater);
        Some(point.with_decimals(decimals(measure)))
    }

    /// Compares by how much a measure is greater in one approach than in another, in two cells; in the first
    /// it should be more.
    pub(in super::super) fn effects(
        self,
        first: (u8, Scenario, Measure),
        second: (u8, Scenario, Measure),
        approaches: [Approach; 2],
        names: [String; 2],
    ) -> Option<ClaimPoint> {
        let (a, b) = (self.effect(first, approaches)?, self.effect(second, approaches)?);
        let test = a.1.zip(b.1).and_then(|(x, y)| normal(a.0 - b.0, x + y));
        let [x, y] = names;
        let [greater, less] = approaches.map(approach_label);
        let of = format!("{greater} - {less}");
        Some(ClaimPoint::new(of, (x, a.0), (y, b.0), test, Wanted::Greater).with_decimals(decimals(first.2)))
    }

    /// A difference, and its variance where it is known.
    fn effect(
        self,
        (table, scenario, measure): (u8, Scenario, Measure),
        [first, second]: [Approach; 2],
    ) -> Option<(f64, Option<f64>)> {
        let (a, b) = (self.row(table, scenario, first)?, self.row(table, scenario, second)?);
        let difference = measure.value(a)? - measure.value(b)?;
        let variances = variance_of_mean(measure, a).zip(variance_of_mean(measure, b));
        Some((difference, variances.map(|(x, y)| x + y)))
    }

    /// A mean of the first approach against a multiple of that of the second.
    pub(in super::super) fn times(
        self,
        (table, scenario): (u8, Scenario),
        measure: Measure,
        [first, second]: [Approach; 2],
        factor: f64,
    ) -> Option<ClaimPoint> {
        let (a, b) = (self.row(table, scenario, first)?, self.row(table, scenario, second)?);
        let (a, b) = (measure.sample(a)?, measure.sample(b)?);
        let b = Sample { mean: factor * b.mean, sd: b.sd.map(|sd| factor * sd), ..b };
        let second = format!("{factor} x {}", approach_label(second));
        let of = format!("scenario {scenario}");
        Some(ClaimPoint::new(
            of,
            (approach_label(first), a.mean),
            (second, b.mean),
            welch(a, b),
            Wanted::Greater,
        ))
    }

    /// Robot B's backing up against robot A's.
    pub(in super::super) fn backups(self, scenario: Scenario) -> Option<ClaimPoint> {
        let row = self.row(2, scenario, Approach::Reactive)?;
        let sample = |mean: Option<f64>, sd| Some(Sample { n: row.trials, mean: mean?, sd });
        let (a, b) = (sample(row.backups_a, row.backups_a_sd)?, sample(row.backups_b, row.backups_b_sd)?);
        let of = format!("scenario {scenario}");
        Some(ClaimPoint::new(of, ("B", b.mean), ("A", a.mean), welch(b, a), Wanted::Greater))
    }

    /// The cases for several robots among all used, percent. Cases of a trial count as if they were drawn
    /// independently.
    pub(in super::super) fn cooperative(self, scenario: Scenario, approach: Approach) -> Option<Count> {
        let row = self.row(3, scenario, approach)?;
        let trials = f64::from(row.trials);
        let (one, several) = (row.individual? * trials, row.cooperative? * trials);
        Some(Count { hits: several.round() as u32, of: (one + several).round() as u32 })
    }

    /// The share of cases for several robots, compared with one half.
    pub(in super::super) fn half_cooperative(self, scenario: Scenario) -> Option<ClaimPoint> {
        let count = self.cooperative(scenario, Approach::Cases)?;
        let share = 100.0 * count.share()?;
        let of = format!("scenario {scenario}");
        let point = ClaimPoint::new(
            of,
            ("several robots", share),
            ("half", 50.0),
            against(count, 0.5),
            Wanted::AtLeast,
        );
        Some(point.with_decimals(1))
    }

    /// The share of cases for several robots in two scenarios; the first should have more.
    pub(in super::super) fn more_cooperative(self, [first, second]: [Scenario; 2]) -> Option<ClaimPoint> {
        let (a, b) = (self.cooperative(first, Approach::Cases)?, self.cooperative(second, Approach::Cases)?);
        let [x, y] = [first, second].map(|scenario| format!("scenario {scenario}"));
        let (x, y) = ((x, 100.0 * a.share()?), (y, 100.0 * b.share()?));
        Some(ClaimPoint::new("several robots", x, y, two_proportions(a, b), Wanted::Greater).with_decimals(1))
    }

    /// Trials that opponents ended by putting the ball out: more with the first approach.
    pub(in super::super) fn put_out(
        self,
        scenario: Scenario,
        [first, second]: [Approach; 2],
    ) -> Option<ClaimPoint> {
        let of = |approach| {
            let row = self.row(6, scenario, approach)?;
            Some(Count { hits: row.out_by_opponents?, of: row.trials })
        };
        let (a, b) = (of(first)?, of(second)?);
        let share = |count: Count| Some(100.0 * count.share()?);
        let [x, y] = [first, second].map(approach_label);
        let (x, y) = ((x, share(a)?), (y, share(b)?));
        let name = format!("scenario {scenario}");
        Some(ClaimPoint::new(name, x, y, two_proportions(a, b), Wanted::Greater).with_decimals(1))
    }
}

pub(super) fn decimals(measure: Measure) -> usize {
    if measure.is_share() { 1 } else { 2 }
}
