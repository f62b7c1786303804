//! `columns`: columns of the paper's tables. The one list that page, plots and Markdown share.

use study::evaluation::{Measure, TableRow};
use study::statistics::{Interval, newcombe, student, wilson};

#[derive(Clone, Copy, Debug)]
pub(crate) struct MeasureColumn {
    pub(crate) head: &'static str,
    pub(crate) unit: &'static str,
    pub(crate) decimals: usize,
    pub(crate) value: ColumnValue,
}

/// Source of a column's values.
#[derive(Clone, Copy, Debug)]
pub(crate) enum ColumnValue {
    /// A measure that is tested.
    Measured(Measure),
    /// A number without a test.
    Described(fn(&TableRow) -> Option<f64>),
}

impl MeasureColumn {
    const fn share(head: &'static str, measure: Measure) -> Self {
        Self { head, unit: "%", decimals: 1, value: ColumnValue::Measured(measure) }
    }

    const fn mean(head: &'static str, unit: &'static str, measure: Measure) -> Self {
        Self { head, unit, decimals: 2, value: ColumnValue::Measured(measure) }
    }

    const fn described(
        head: &'static str,
        unit: &'static str,
        decimals: usize,
        of: fn(&TableRow) -> Option<f64>,
    ) -> Self {
        Self { head, unit, decimals, value: ColumnValue::Described(of) }
    }

    pub(crate) fn value(&self, row: &TableRow) -> Option<f64> {
        match self.value {
            ColumnValue::Measured(measure) => measure.value(row),
            ColumnValue::Described(of) => of(row),
        }
    }

    /// The 95 % interval of a row's value, in the column's unit.
    pub(crate) fn interval(&self, row: &TableRow) -> Option<Interval> {
        let ColumnValue::Measured(measure) = self.value else { return None };
        interval(measure, row)
    }

    /// The standard deviation of a row's value, where that is known.
    pub(crate) fn spread(&self, row: &TableRow) -> Option<f64> {
        let ColumnValue::Measured(measure) = self.value else { return None };
        measure.sample(row)?.sd
    }

    pub(crate) fn is_count(&self) -> bool {
        self.unit == "trials"
    }

    pub(crate) fn is_share(&self) -> bool {
        self.unit == "%"
    }
}

/// The 95 % interval of a measure: Wilson's of a share, in percent, Student's of a mean.
pub(crate) fn interval(measure: Measure, row: &TableRow) -> Option<Interval> {
    match measure.count(row) {
        Some(count) => percent(wilson(count, CONFIDENCE)?),
        None => student(measure.sample(row)?, CONFIDENCE),
    }
}

/// The 95 % interval of the difference of two shares, in points.
pub(crate) fn difference(measure: Measure, first: &TableRow, second: &TableRow) -> Option<Interval> {
    percent(newcombe(measure.count(first)?, measure.count(second)?, CONFIDENCE)?)
}

#[allow(clippy::unnecessary_wraps, reason = "both callers are of options")]
fn percent(Interval { low, high }: Interval) -> Option<Interval> {
    Some(Interval { low: 100.0 * low, high: 100.0 * high })
}

/// The columns of a table; one without any value is left out, and timeouts where there are none.
pub(crate) fn columns(table: u8, rows: &[&TableRow]) -> Vec<MeasureColumn> {
    let all = match table {
        1 => &TABLE_1[..],
        2 => &TABLE_2,
        3 => &TABLE_3,
        4 => &TABLE_4,
        5 => &TABLE_5,
        _ => &TABLE_6,
    };
    let described = |column: &&MeasureColumn| {
        let least = if column.head == "timeout" && table != 4 { 0.0 } else { -1.0 };
        rows.iter().any(|row| column.value(row).is_some_and(|value| value > least))
    };
    all.iter().filter(described).copied().collect()
}

/// B's share of all backing up, percent.
fn share_b(row: &TableRow) -> Option<f64> {
    let (a, b) = (row.backups_a?, row.backups_b?);
    (a + b > 0.0).then(|| 100.0 * b / (a + b))
}

/// Cooperative cases among those used, percent.
fn cooperative(row: &TableRow) -> Option<f64> {
    let used = used(row)?;
    (used > 0.0).then(|| 100.0 * row.cooperative.unwrap_or_default() / used)
}

fn used(row: &TableRow) -> Option<f64> {
    Some(row.individual? + row.cooperative?)
}

/// Confidence level of the whole report.
pub(crate) const CONFIDENCE: f64 = 0.95;

const GOAL: MeasureColumn = MeasureColumn::share("goal", Measure::Goal);
const CLOSE: MeasureColumn = MeasureColumn::share("close", Measure::Close);
const BLOCK: MeasureColumn = MeasureColumn::share("block", Measure::Block);
const OUT: MeasureColumn = MeasureColumn::share("out", Measure::Out);
const TIMEOUT: MeasureColumn = MeasureColumn::share("timeout", Measure::Timeout);
const TO_GOAL: MeasureColumn = MeasureColumn::share("to goal", Measure::ToGoal);
const POSSESSION: MeasureColumn = MeasureColumn::mean("possession", "a trial", Measure::Possession);
const MIDFIELD: MeasureColumn =
    MeasureColumn::mean("midfield's possession", "a trial", Measure::MidfieldPossession);
const DEFENDER: MeasureColumn = MeasureColumn::mean("defender's possession", "a trial", Measure::Possession);
const TIME: MeasureColumn = MeasureColumn::mean("time", "s", Measure::Time);

const DUELS: MeasureColumn = MeasureColumn::described("duels", "%", 0, |row| row.duel_time);

const TABLE_1: [MeasureColumn; 9] = [GOAL, CLOSE, BLOCK, OUT, TIMEOUT, TO_GOAL, POSSESSION, TIME, DUELS];
const TABLE_2: [MeasureColumn; 3] = [
    MeasureColumn::described("A backs up", "a trial", 1, |row| row.backups_a),
    MeasureColumn::described("B backs up", "a trial", 1, |row| row.backups_b),
    MeasureColumn::described("B's share", "%", 0, share_b),
];
const TABLE_3: [MeasureColumn; 6] = [
    MeasureColumn::described("individual", "a trial", 1, |row| row.individual),
    MeasureColumn::described("cooperative", "a trial", 1, |row| row.cooperative),
    MeasureColumn::described("all", "a trial", 1, used),
    MeasureColumn::described("cooperative's share", "%", 0, cooperative),
    MeasureColumn::described("no case found", "a trial", 1, |row| row.none),
    MeasureColumn::described("time without a case", "%", 1, |row| row.default_time),
];
const TABLE_4: [MeasureColumn; 4] = [TO_GOAL, OUT, TIMEOUT, DUELS];
const TABLE_5: [MeasureColumn; 3] = [MIDFIELD, DEFENDER, TIME];
const TABLE_6: [MeasureColumn; 10] = [
    GOAL,
    CLOSE,
    BLOCK,
    OUT,
    TIMEOUT,
    TO_GOAL,
    MeasureColumn::described("out by opponents", "trials", 0, |row| row.out_by_opponents.map(f64::from)),
    MeasureColumn::described("out by attackers", "trials", 0, |row| row.out_by_attackers.map(f64::from)),
    POSSESSION,
    DUELS,
];
