//! `description`: reads a description. Every key once, each value of its kind and within its range, with its
//! line for findings.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::keys::{KEYS, Key, Kind};
use crate::wheels::Wheel;
use foreign::{Finding, Severity};

/// A value of a description.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A number in the key's unit.
    Number(f32),
    /// A whole number, 0 or more.
    Whole(u32),
    /// A number for each wheel, in the key's unit.
    Wheels(Vec<f32>),
    /// Ball speed, m/s, and pulse, µs.
    Pulses(Vec<(f32, u64)>),
    /// A word or a name.
    Text(String),
}

/// A description that was read and checked.
#[derive(Clone, Debug, PartialEq)]
pub struct Description {
    file: String,
    /// Values in the order of [`KEYS`], each with its line.
    values: Vec<(Value, u32)>,
    warnings: Vec<Finding>,
}

impl Description {
    /// Reads `text`, without holding values against each other; the error is every fault that was found, in
    /// the file's order.
    pub(crate) fn parse(file: &str, text: &str) -> Result<Self, Vec<Finding>> {
        let mut reader = Reader { file, text, findings: Vec::new() };
        let values: Option<Vec<_>> = reader.values().into_iter().collect();
        let Some(values) = values.filter(|_| reader.findings.is_empty()) else {
            reader.findings.sort_by_key(|finding| finding.line);
            return Err(reader.findings);
        };
        Ok(Self { file: file.to_owned(), values, warnings: Vec::new() })
    }

    /// The same with doubts about it.
    pub(crate) fn doubted(self, warnings: Vec<Finding>) -> Self {
        Self { warnings, ..self }
    }

    /// Value of the key `name`.
    pub fn name(&self) -> &str {
        self.text("name")
    }

    /// Findings that do not refuse it.
    pub fn warnings(&self) -> &[Finding] {
        &self.warnings
    }

    /// Every key with its value, in the order of [`KEYS`].
    pub fn entries(&self) -> impl Iterator<Item = (&'static Key, &Value)> {
        KEYS.iter().zip(self.values.iter().map(|(value, _)| value))
    }

    /// The keys whose values differ from another description's, their names aside.
    pub fn differences(&self, other: &Self) -> Vec<&'static str> {
        let pairs = self.entries().zip(other.entries());
        let unlike = pairs.filter(|((key, a), (_, b))| key.kind != Kind::Name && a != b);
        unlike.map(|((key, _), _)| key.path).collect()
    }

    fn place(&self, path: &str) -> &(Value, u32) {
        let index = KEYS.iter().position(|key| key.path == path);
        let value = index.and_then(|index| self.values.get(index));
        value.unwrap_or_else(|| panic!("`{path}` is no key of a description"))
    }

    /// The value of a key of [`KEYS`].
    pub fn value(&self, path: &str) -> &Value {
        &self.place(path).0
    }

    /// The number of a key of [`KEYS`] that has one; NaN for any other.
    pub fn number(&self, path: &str) -> f32 {
        match self.value(path) {
            Value::Number(number) => *number,
            Value::Whole(number) => *number as f32,
            Value::Wheels(_) | Value::Pulses(_) | Value::Text(_) => f32::NAN,
        }
    }

    /// The word or name of a key of [`KEYS`]; empty where it has none.
    pub fn text(&self, path: &str) -> &str {
        if let Value::Text(text) = self.value(path) { text } else { "" }
    }

    /// The pulses of a key of [`KEYS`]; empty where it has none.
    pub fn pulses(&self, path: &str) -> &[(f32, u64)] {
        if let Value::Pulses(pulses) = self.value(path) { pulses } else { &[] }
    }

    /// The number of a key for one wheel; NaN where the list has none.
    fn of_wheel(&self, path: &str, index: usize) -> f32 {
        match self.value(path) {
            Value::Wheels(list) => list.get(index).copied().unwrap_or(f32::NAN),
            _ => self.number(path),
        }
    }

    /// The wheels, in their order.
    pub fn wheels(&self) -> Vec<Wheel> {
        let Value::Wheels(places) = self.value("wheels.degrees") else { return Vec::new() };
        let wheels = places.iter().enumerate().map(|(index, place)| Wheel {
            place: *place,
            distance: self.of_wheel("wheels.distance", index),
            skew: self.of_wheel("wheels.skew", index),
            output: self.of_wheel("wheels.outputs", index) as u8,
        });
        wheels.collect()
    }

    pub(crate) fn finding(
        &self,
        severity: Severity,
        code: &'static str,
        path: &str,
        message: String,
        hint: String,
    ) -> Finding {
        Finding { code, severity, file: self.file.as_str().into(), line: self.place(path).1, message, hint }
    }
}

/// A file that is being read, with its findings.
struct Reader<'f> {
    file: &'f str,
    text: &'f str,
    findings: Vec<Finding>,
}

type Node<'t, 'i> = &'t Spanned<DeValue<'i>>;

impl Reader<'_> {
    fn error(&mut self, code: &'static str, span: Range<usize>, message: String, hint: String) {
        let before = self.text.get(..span.start).unwrap_or_default();
        let line = 1 + before.matches('\n').count() as u32;
        let finding =
            Finding { code, severity: Severity::Error, file: self.file.into(), line, message, hint };
        self.findings.push(finding);
    }

    /// A value for each key; `None` where it is missing or wrong.
    fn values(&mut self) -> Vec<Option<(Value, u32)>> {
        let text = self.text;
        let root = match DeTable::parse(text) {
            Ok(root) => root,
            Err(error) => {
                let words = error.message().split_whitespace().collect::<Vec<_>>().join(" ");
                let span = error.span().unwrap_or(0..0);
                self.error("syntax", span, format!("not TOML: {words}"), "correct the syntax".into());
                return KEYS.iter().map(|_| None).collect();
            }
        };
        self.refuse_unknown(root.get_ref(), "");
        KEYS.iter().map(|key| self.value(&root, key)).collect()
    }

    /// Names every key and table that no description has.
    fn refuse_unknown(&mut self, table: &DeTable<'_>, above: &str) {
        for (key, value) in table {
            let path = if above.is_empty() {
                key.get_ref().to_string()
            } else {
                format!("{above}.{}", key.get_ref())
            };
            let is_table = KEYS.iter().any(|known| is_within(known.table(), &path));
            if let Some(inner) = value.get_ref().as_table().filter(|_| is_table) {
                self.refuse_unknown(inner, &path);
            } else if !is_table && !KEYS.iter().any(|known| known.path == path) {
                let names = names_in(above);
                self.error(
                    "unknown-key",
                    key.span(),
                    format!("unknown key {path}"),
                    format!("take one of: {names}"),
                );
            }
        }
    }

    fn value(&mut self, root: &Spanned<DeTable<'_>>, key: &Key) -> Option<(Value, u32)> {
        let mut table = root.get_ref();
        let mut span = 0..0;
        for part in key.table().split('.').filter(|part| !part.is_empty()) {
            let Some(inner) = table.get(part) else { break };
            span = inner.span();
            let Some(inner) = inner.get_ref().as_table() else {
                let hint = format!("write [{}] and its keys below", key.table());
                self.error("wrong-type", span, format!("{part} is no table"), hint);
                return None;
            };
            table = inner;
        }
        let node =
            key.table().split('.').filter(|part| !part.is_empty()).try_fold(root.get_ref(), |table, part| {
                table.get(part).and_then(|inner| inner.get_ref().as_table())
            });
        let Some(node) = node.and_then(|table| table.get(key.name())) else {
            if let Some(absent) = absent(key.kind) {
                let line = 1 + self.text.get(..span.start).unwrap_or_default().matches('\n').count() as u32;
                return Some((absent, line));
            }
            let message = format!("{} is missing ({})", key.path, key.meaning);
            self.error("missing-key", span, message, format!("add it: {}", key.allowed()));
            return None;
        };
        let value = read(node, key.kind);
        let line = 1 + self.text.get(..node.span().start).unwrap_or_default().matches('\n').count() as u32;
        if value.is_none() {
            let unit = if key.unit.is_empty() { String::new() } else { format!(" {}", key.unit) };
            let said = described(node.get_ref(), &unit);
            let code = if fits(node.get_ref(), key.kind) { "bad-value" } else { "wrong-type" };
            self.error(
                code,
                node.span(),
                format!("{} is {said}", key.path),
                format!("give {}", key.allowed()),
            );
        }
        value.map(|value| (value, line))
    }
}

/// Returns whether `table` is `path`, or lies within it.
fn is_within(table: &str, path: &str) -> bool {
    table.strip_prefix(path).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}

/// The keys and tables directly below a table.
fn names_in(above: &str) -> String {
    let mut names: Vec<&str> = Vec::new();
    for key in KEYS {
        let rest = if above.is_empty() {
            Some(key.path)
        } else {
            key.path.strip_prefix(above).and_then(|r| r.strip_prefix('.'))
        };
        let Some(first) = rest.map(|rest| rest.split('.').next().unwrap_or(rest)) else { continue };
        if !names.contains(&first) {
            names.push(first);
        }
    }
    names.join(", ")
}

/// The value, if it is of the kind and within its range.
fn read(node: Node<'_, '_>, kind: Kind) -> Option<Value> {
    let value = node.get_ref();
    match kind {
        Kind::Number(low, high) => number(value).filter(|x| (low..=high).contains(x)).map(Value::Number),
        Kind::Whole(low, high) => whole(value)
            .filter(|n| (u64::from(low)..=u64::from(high)).contains(n))
            .map(|n| Value::Whole(n as u32)),
        Kind::Angles => {
            let angles: Option<Vec<f32>> =
                value.as_array()?.iter().map(|angle| number(angle.get_ref())).collect();
            let angles = angles.filter(|angles| (3..=4).contains(&angles.len()))?;
            angles.iter().all(|angle| (-180.0..=180.0).contains(angle)).then_some(Value::Wheels(angles))
        }
        Kind::PerWheel(low, high, _) => {
            let all = number(value).filter(|x| (low..=high).contains(x)).map(Value::Number);
            all.or_else(|| each(value, low, high).map(Value::Wheels))
        }
        Kind::Outputs => {
            let outputs = each(value, 1.0, 4.0)?;
            let mut seen = [false; 5];
            let new = outputs
                .iter()
                .all(|output| output.fract() == 0.0 && !std::mem::replace(&mut seen[*output as usize], true));
            new.then_some(Value::Wheels(outputs))
        }
        Kind::Pulses => pulses(value).map(Value::Pulses),
        Kind::Word(words) => {
            value.as_str().filter(|word| words.contains(word)).map(|word| Value::Text(word.to_owned()))
        }
        Kind::Name => {
            let letter = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
            let name =
                value.as_str().filter(|name| (1..=32).contains(&name.len()) && name.chars().all(letter));
            name.map(|name| Value::Text(name.to_owned()))
        }
    }
}

/// The value of a key that is not in the file, where it may be absent.
fn absent(kind: Kind) -> Option<Value> {
    match kind {
        Kind::PerWheel(.., absent) => absent.map(Value::Number),
        Kind::Outputs => Some(Value::Wheels(vec![1.0, 2.0, 3.0, 4.0])),
        _ => None,
    }
}

/// Three or four numbers within a range.
fn each(value: &DeValue<'_>, low: f32, high: f32) -> Option<Vec<f32>> {
    let numbers: Option<Vec<f32>> = value
        .as_array()?
        .iter()
        .map(|node| number(node.get_ref()).filter(|x| (low..=high).contains(x)))
        .collect();
    numbers.filter(|numbers| (3..=4).contains(&numbers.len()))
}

/// Pairs of speed and pulse that rise.
fn pulses(value: &DeValue<'_>) -> Option<Vec<(f32, u64)>> {
    let mut pairs = Vec::new();
    let mut last = (0.0, 0);
    for pair in value.as_array()? {
        let pair: Vec<_> = pair.get_ref().as_array()?.iter().collect();
        let [speed, micros] = pair[..] else { return None };
        let pair = (number(speed.get_ref())?, whole(micros.get_ref())?);
        if pair.0 <= last.0 || pair.1 <= last.1 || pair.0 > KICK_MAX || pair.1 > PULSE_MAX {
            return None;
        }
        last = pair;
        pairs.push(pair);
    }
    (2..=PAIRS_MAX).contains(&pairs.len()).then_some(pairs)
}

/// A number as the file writes it: read as `f32` at once, not by way of another precision.
fn number(value: &DeValue<'_>) -> Option<f32> {
    let text = match value {
        DeValue::Float(number) => number.as_str(),
        DeValue::Integer(number) if number.radix() == 10 => number.as_str(),
        _ => return None,
    };
    text.replace('_', "").parse().ok().filter(|number: &f32| number.is_finite())
}

fn whole(value: &DeValue<'_>) -> Option<u64> {
    let number = value.as_integer()?;
    u64::from_str_radix(&number.as_str().replace('_', ""), number.radix()).ok()
}

/// Returns whether the value has the kind's type, so that only its range is wrong.
fn fits(value: &DeValue<'_>, kind: Kind) -> bool {
    match kind {
        Kind::Number(..) => matches!(value, DeValue::Float(_) | DeValue::Integer(_)),
        Kind::Whole(..) => matches!(value, DeValue::Integer(_)),
        Kind::Angles | Kind::Outputs | Kind::Pulses => matches!(value, DeValue::Array(_)),
        Kind::PerWheel(..) => matches!(value, DeValue::Float(_) | DeValue::Integer(_) | DeValue::Array(_)),
        Kind::Word(_) | Kind::Name => matches!(value, DeValue::String(_)),
    }
}

fn described(value: &DeValue<'_>, unit: &str) -> String {
    match value {
        DeValue::String(text) => format!("the text {text:?}"),
        DeValue::Integer(number) => format!("{number}{unit}"),
        DeValue::Float(number) => format!("{number}{unit}"),
        DeValue::Boolean(truth) => format!("the truth value {truth}"),
        DeValue::Datetime(_) => "a date or time".to_owned(),
        DeValue::Array(list) => {
            let parts: Vec<_> = list.iter().map(|part| described(part.get_ref(), "")).collect();
            format!("[{}]", parts.join(", "))
        }
        DeValue::Table(_) => "a table".to_owned(),
    }
}

/// Longest pulse of a coil, µs: the boards' timers end it there.
const PULSE_MAX: u64 = 6_000;
/// No table asks for a faster ball, m/s.
const KICK_MAX: f32 = 15.0;
/// Pairs of a table: the robot searches it in order.
const PAIRS_MAX: usize = 16;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wheels::wheel_slots;

    const OURS: &str = include_str!("../ours.toml");

    fn refused(from: &str, to: &str) -> String {
        assert!(OURS.contains(from), "{from}");
        let findings = Description::read("r.toml", &OURS.replacen(from, to, 1)).unwrap_err();
        findings.iter().map(Finding::to_string).collect::<Vec<_>>().join("\n")
    }

    fn line_of(text: &str) -> usize {
        1 + OURS.lines().position(|line| line.starts_with(text)).unwrap()
    }

    #[test]
    fn numbers_are_the_file_s_own() {
        let ours = Description::read("ours.toml", OURS).unwrap();
        assert_eq!((ours.number("body.front"), ours.number("plan.speed")), (0.073, 3.0));
        let slots = wheel_slots(&ours.wheels());
        assert_eq!((slots.count, slots.degrees), (4, [-60.0, -135.0, 135.0, 60.0]));
        assert_eq!((slots.levers, slots.outputs), ([0.081; 4], [0, 1, 2, 3]));
        assert_eq!(ours.pulses("kicker.flat_pulses"), [(2.0, 1_500), (4.0, 2_600), (6.5, 4_500)]);
        assert_eq!((ours.text("motors.scheme"), ours.number("kicker.pause_ms")), ("pwm-direction", 500.0));
        assert_eq!(ours.entries().count(), KEYS.len());
    }

    #[test]
    fn a_value_out_of_range_is_named_with_file_line_key_unit_and_range() {
        let said = refused("radius = 0.09 ", "radius = 0.1 ");
        let line = line_of("radius = 0.09 ");
        let hint = "give 0.04 to 0.09 m";
        assert_eq!(said, format!("r.toml:{line}: error[bad-value]: body.radius is 0.1 m; {hint}"));
        assert!(
            refused("cells = 4 ", "cells = 40 ")
                .contains("battery.cells is 40; give a whole number, 1 to 10")
        );
        assert!(
            refused("scheme = \"pwm-direction\"", "scheme = \"steam\"")
                .contains("pwm-direction, three-pwm, smart")
        );
        assert!(refused("mass = 2.5 ", "mass = nan ").contains("body.mass is nan kg"));
    }

    #[test]
    fn an_unknown_or_missing_key_or_table_is_named_with_those_that_are_there() {
        let said = refused("height = 0.15 ", "heigth = 0.15 ");
        assert!(said.contains("unknown key body.heigth; take one of: radius, height, front"), "{said}");
        assert!(said.contains("body.height is missing"), "{said}");
        assert!(
            refused("[dribbler]", "[dribler]")
                .contains("unknown key dribler; take one of: name, body, wheels")
        );
        assert!(refused("[assumed.role]", "[assumed.rolle]").contains("unknown key assumed.rolle"));
        assert!(refused("[body]", "body = 3\n[bodi]").contains("body is no table"));
    }

    #[test]
    fn a_wrong_type_a_wrong_list_and_broken_syntax_give_different_findings() {
        assert!(
            refused("mass = 2.5 ", "mass = \"2.5\" ")
                .contains("error[wrong-type]: body.mass is the text \"2.5\"")
        );
        assert!(
            refused("[-60.0, -135.0, 135.0, 60.0]", "[-60.0, 135.0]")
                .contains("wheels.degrees is [-60.0, 135.0]")
        );
        let falling = refused("[4.0, 2600]", "[4.0, 1400]");
        assert!(falling.contains("kicker.flat_pulses") && falling.contains("both rising"), "{falling}");
        let long = refused("[6.5, 4500]", "[6.5, 6001]");
        assert!(long.contains("6000 µs"), "{long}");
        assert!(refused("[body]", "[body").contains("error[syntax]: not TOML"));
    }

    #[test]
    fn no_cut_and_no_flipped_byte_of_a_description_panics() {
        for end in (0..OURS.len()).filter(|end| OURS.is_char_boundary(*end)).step_by(7) {
            let _ = Description::read("cut", &OURS[..end]);
        }
        for at in (0..OURS.len()).step_by(11) {
            let mut bytes = OURS.as_bytes().to_vec();
            bytes[at] ^= 1 << (at % 7);
            if let Ok(text) = String::from_utf8(bytes) {
                let _ = Description::read("flipped", &text);
            }
        }
    }

    #[test]
    fn descriptions_differ_by_key() {
        let ours = Description::read("a", OURS).unwrap();
        let other = Description::read("b", &OURS.replace("mass = 2.5 ", "mass = 2.4 ")).unwrap();
        assert_eq!(ours.differences(&other), ["body.mass"]);
        assert!(ours.differences(&ours).is_empty());
    }
}
