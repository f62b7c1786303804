//! `comparison`: what was found when two traces were played in step: the first difference of each kind, and
//! how many there are. Times in s on the hosts' clock.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use arena::game::TICK_US;
use foreign::{excerpt, printable};
use host::record::header::RecordingHeader;
use host::record::trace::Record;
use rules::Colour;
use serde::Serialize;
use serde_json::Value;

use super::decisions::Decision;
use super::unlike::{self, Unlike, What};

/// Settings whose values differ that are listed; beyond it they are only counted.
const SETTINGS_LISTED: usize = 20;
/// Longest value of a setting that is printed, characters.
const SETTING_LEN: usize = 80;

#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct Setting {
    name: String,
    a: Value,
    b: Value,
}

/// One of the two files, after it was played.
#[derive(Debug, Serialize)]
pub(super) struct Ended {
    pub(super) file: String,
    pub(super) span_s: (f64, f64),
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) damage: Option<String>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
struct Records {
    same: u64,
    /// In the same place of a tick, with another content.
    different: u64,
    only_a: u64,
    only_b: u64,
}

/// Numbers of one host's orders.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
struct OrderCounts {
    /// Orders of one robot at one tick.
    compared: u64,
    different: u64,
    /// Ticks at which at least one robot's order differs.
    ticks_different: u64,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
struct DecisionCounts {
    a: usize,
    b: usize,
    /// Decisions of one trace without the same one in the other.
    different: usize,
}

/// Gathers what is found.
#[derive(Debug)]
pub(super) struct Comparison {
    settings: Vec<Setting>,
    ticks: u64,
    firsts: BTreeMap<What, Unlike>,
    records: Records,
    positions: u64,
    colours: Vec<Colour>,
    orders: Vec<OrderCounts>,
    decisions: DecisionCounts,
}

/// The result, as text and as JSON.
#[derive(Debug, Serialize)]
pub struct Report {
    kind: &'static str,
    files: [Ended; 2],
    same: bool,
    /// The earliest difference.
    first: Option<Unlike>,
    /// The first difference of each kind.
    firsts: Vec<Unlike>,
    ticks: u64,
    records: Records,
    orders: BTreeMap<&'static str, OrderCounts>,
    positions_different: u64,
    decisions: DecisionCounts,
    settings: Vec<Setting>,
}

/// Differences between two headers; programs and seeds are settings too.
pub(super) fn settings(a: &RecordingHeader, b: &RecordingHeader) -> Vec<Setting> {
    let value = |header| serde_json::to_value(header).unwrap_or_default();
    let mut found = Vec::new();
    walk("", &value(a), &value(b), &mut found);
    found
}

fn walk(name: &str, a: &Value, b: &Value, found: &mut Vec<Setting>) {
    let under = |key: &str| if name.is_empty() { key.to_owned() } else { format!("{name}.{key}") };
    match (a, b) {
        _ if a == b => {}
        (Value::Object(left), Value::Object(right)) => {
            let more = right.keys().filter(|key| !left.contains_key(*key));
            for key in left.keys().chain(more) {
                walk(&under(key), &a[key.as_str()], &b[key.as_str()], found);
            }
        }
        (Value::Array(left), Value::Array(right)) if left.len() == right.len() => {
            for (i, (a, b)) in left.iter().zip(right).enumerate() {
                walk(&under(&i.to_string()), a, b, found);
            }
        }
        _ => found.push(Setting { name: name.to_owned(), a: a.clone(), b: b.clone() }),
    }
}

impl Comparison {
    pub(super) fn new(settings: Vec<Setting>, colours: &[Colour]) -> Self {
        Self {
            settings,
            ticks: 0,
            firsts: BTreeMap::new(),
            records: Records::default(),
            positions: 0,
            colours: colours.to_vec(),
            orders: vec![OrderCounts::default(); colours.len()],
            decisions: DecisionCounts::default(),
        }
    }

    /// Keeps a difference if it is the first of its kind; its text is only made then.
    pub(super) fn find(&mut self, at_s: f64, what: What, values: impl FnOnce() -> (String, String, String)) {
        self.firsts.entry(what).or_insert_with(|| {
            let (of, a, b) = values();
            Unlike { at_s, tick: (at_s * 1e6 / TICK_US as f64 + 1e-6) as u64, what, of, a, b }
        });
    }

    /// The records of one tick, in the order of both files.
    pub(super) fn records(&mut self, tick: u64, a: &[Record], b: &[Record], colours: &[Colour]) {
        self.ticks += 1;
        let start_s = (tick * TICK_US) as f64 * 1e-6;
        for (one, two) in a.iter().zip(b) {
            if one == two {
                self.records.same += 1;
                continue;
            }
            self.records.different += 1;
            let at_s = one.at.min(two.at).0 as f64 * 1e-6;
            self.find(at_s, What::Record, || unlike::records(one, two, colours));
        }
        let both = a.len().min(b.len());
        self.records.only_a += (a.len() - both) as u64;
        self.records.only_b += (b.len() - both) as u64;
        let extra = |list: &[Record]| {
            list.get(both)
                .map_or_else(|| "no such record".to_owned(), |record| unlike::whole(record, colours))
        };
        if a.len() != b.len() {
            let at = a.get(both).or(b.get(both)).map_or(start_s, |record| record.at.0 as f64 * 1e-6);
            let values = ("number of records in the tick".to_owned(), extra(a), extra(b));
            self.find(at, What::Record, || values);
        }
    }

    /// Records of the trace `which` after the other has ended.
    pub(super) fn goes_on(&mut self, which: usize, records: u64) {
        *(if which == 0 { &mut self.records.only_a } else { &mut self.records.only_b }) += records;
    }

    pub(super) fn positions(&mut self, differ: bool) {
        self.positions += u64::from(differ);
    }

    pub(super) fn order(&mut self, host: usize, differs: bool) {
        if let Some(counts) = self.orders.get_mut(host) {
            counts.compared += 1;
            counts.different += u64::from(differs);
        }
    }

    pub(super) fn orders_of_tick(&mut self, host: usize, differ: bool) {
        if let Some(counts) = self.orders.get_mut(host) {
            counts.ticks_different += u64::from(differ);
        }
    }

    /// Decisions on cases, in the order of time: two are the same where all that is known of them is.
    pub(super) fn decisions(&mut self, a: &[Decision], b: &[Decision]) {
        if let Some(i) = (0..a.len().max(b.len())).find(|i| a.get(*i) != b.get(*i)) {
            let (one, two) = (a.get(i), b.get(i));
            let at_s =
                [one, two].into_iter().flatten().map(|decision| decision.at_s).fold(f64::MAX, f64::min);
            let team = one.or(two).map_or("", |decision| decision.team).to_owned();
            let (mut left, mut right) = (decision_text(one), decision_text(two));
            if left == right {
                // Same robot, time and case: the problem or the grounds differ.
                (left, right) = (json(one), json(two));
            }
            self.find(at_s, What::Decision, || (team, left, right));
        }
        let different = missing(a, b).max(missing(b, a));
        self.decisions = DecisionCounts { a: a.len(), b: b.len(), different };
    }

    pub(super) fn report(self, files: [Ended; 2]) -> Report {
        let mut firsts: Vec<Unlike> = self.firsts.into_values().collect();
        // Of one moment a record comes before what follows from it.
        firsts.sort_by(|a, b| a.at_s.total_cmp(&b.at_s).then(a.what.cmp(&b.what)));
        Report {
            kind: "comparison",
            files,
            same: firsts.is_empty(),
            first: firsts.first().cloned(),
            firsts,
            ticks: self.ticks,
            records: self.records,
            orders: self.colours.iter().map(|colour| colour.label()).zip(self.orders).collect(),
            positions_different: self.positions,
            decisions: self.decisions,
            settings: self.settings,
        }
    }
}

fn decision_text(decision: Option<&Decision>) -> String {
    let Some(Decision { at_s, case, note, .. }) = decision else { return "no decision".to_owned() };
    let case = case.as_deref().map_or_else(|| "no case".to_owned(), |case| excerpt(case, SETTING_LEN));
    format!("robot {} at {} s: {case}", note.by, Value::from(*at_s))
}

fn json(decision: Option<&Decision>) -> String {
    decision
        .map_or_else(String::new, |decision| serde_json::to_value(decision).unwrap_or_default().to_string())
}

/// Decisions of `list` without the same one in `other`, each counted as often as it is missing.
fn missing(list: &[Decision], other: &[Decision]) -> usize {
    let mut left: Vec<&Decision> = other.iter().collect();
    let mut missing = 0;
    for decision in list {
        match left.iter().position(|found| *found == decision) {
            Some(found) => drop(left.remove(found)),
            None => missing += 1,
        }
    }
    missing
}

impl Report {
    /// True if nothing differs.
    pub fn same(&self) -> bool {
        self.same
    }

    /// Index of the damaged file, of the first one if both are.
    pub fn damaged(&self) -> Option<usize> {
        self.files.iter().position(|file| file.damage.is_some())
    }

    /// Place where that file is cut or damaged; empty where it is whole.
    pub fn damage(&self, which: usize) -> String {
        self.files.get(which).and_then(|file| file.damage.clone()).unwrap_or_default()
    }

    pub(super) fn first(&self) -> Option<&Unlike> {
        self.first.as_ref()
    }

    /// Lines for the operator.
    pub fn text(&self) -> String {
        let mut out = String::new();
        for (name, Ended { file, span_s: (first, last), damage }) in ["A", "B"].into_iter().zip(&self.files) {
            let _ = writeln!(out, "{name}: {}, from {first:.3} to {last:.3} s", printable(file));
            if let Some(damage) = damage {
                let _ = writeln!(out, "   damaged: {}", printable(damage));
            }
        }
        for Setting { name, a, b } in self.settings.iter().take(SETTINGS_LISTED) {
            let value = |value: &Value| excerpt(&value.to_string(), SETTING_LEN);
            let _ = writeln!(out, "setting {}: A {}, B {}", printable(name), value(a), value(b));
        }
        if self.settings.len() > SETTINGS_LISTED {
            let _ = writeln!(out, "and {} settings more", self.settings.len() - SETTINGS_LISTED);
        }
        let Some(first) = &self.first else {
            let _ = writeln!(
                out,
                "equal: {} records, {} ticks, {} decisions on cases",
                self.records.same, self.ticks, self.decisions.a
            );
            return out;
        };
        let _ = write!(out, "first difference: {}", first.text());
        for unlike in &self.firsts[1..] {
            let _ = write!(out, "first {}", unlike.text());
        }
        let Records { same, different, only_a, only_b } = self.records;
        let _ = writeln!(
            out,
            "records: {same} the same, {different} different, {only_a} only in A, {only_b} only in B"
        );
        for (team, OrderCounts { compared, different, ticks_different }) in &self.orders {
            let ticks = self.ticks;
            let _ = writeln!(
                out,
                "orders of {team}: {different} of {compared} differ, at {ticks_different} of {ticks} ticks"
            );
        }
        let _ = writeln!(out, "positions: differ at {} of {} ticks", self.positions_different, self.ticks);
        let DecisionCounts { a, b, different } = self.decisions;
        let _ = writeln!(out, "decisions on cases: {a} in A, {b} in B, {different} differ");
        out
    }
}

#[cfg(test)]
mod tests {
    use host::HostSettings;
    use host::record::trace::RecordKind;
    use host::referee::SenderAddress;
    use protocol::Instant;
    use rules::League;

    use super::*;

    fn record(at: u64, last: u8) -> Record {
        let from = SenderAddress::INTERNAL;
        Record { at: Instant(at), host: 0, kind: RecordKind::Sent, from, bytes: vec![255, last] }
    }

    fn ended() -> [Ended; 2] {
        ["a", "b"].map(|file| Ended { file: file.to_owned(), span_s: (0.0, 1.0), damage: None })
    }

    #[test]
    fn equal_records_are_equal_and_one_that_differs_is_the_first_difference() {
        let same = [record(10_000, 1), record(12_000, 2)];
        let mut comparison = Comparison::new(Vec::new(), &[Colour::Blue]);
        comparison.records(1, &same, &same, &[Colour::Blue]);
        let other = [record(20_000, 1), record(21_000, 3)];
        comparison.records(2, &[record(20_000, 1), record(21_000, 2)], &other, &[Colour::Blue]);
        comparison.records(3, &same, &same[..1], &[Colour::Blue]);
        let report = comparison.report(ended());
        assert_eq!(report.records, Records { same: 4, different: 1, only_a: 1, only_b: 0 });
        let first = report.first.as_ref().expect("a difference");
        assert_eq!((first.what, first.tick, (first.at_s * 1e6).round()), (What::Record, 2, 21_000.0));
        assert!(!report.same() && report.text().contains("first difference: record: sent of blue"));
        let whole = Comparison::new(Vec::new(), &[]).report(ended());
        assert!(whole.same() && whole.text().contains("equal: "));
    }

    #[test]
    fn of_one_moment_the_record_comes_first() {
        let mut comparison = Comparison::new(Vec::new(), &[]);
        let values = || ("x".to_owned(), "1".to_owned(), "2".to_owned());
        comparison.find(0.5, What::Order, values);
        comparison.find(0.5, What::Record, values);
        comparison.find(0.7, What::Record, values);
        let report = comparison.report(ended());
        assert_eq!(report.first.map(|first| (first.what, first.at_s)), Some((What::Record, 0.5)));
        assert_eq!(report.firsts.len(), 2);
    }

    #[test]
    fn settings_that_differ_are_named_with_both_values() {
        let header = RecordingHeader::of(&HostSettings::new(Colour::Blue, League::DivisionB, 7));
        let mut other = header.clone();
        other.seed = Some(3);
        other.hosts[0].kick[2] = 1.5;
        let found = settings(&header, &other);
        let names: Vec<&str> = found.iter().map(|setting| &*setting.name).collect();
        assert_eq!(names, ["hosts.0.kick.2", "seed"]);
        assert_eq!(found[1].b, 3);
        assert!(settings(&header, &header).is_empty());
    }
}
