//! `document`: TOML reader whose errors name the line. A table with spans, read key by key.

use std::ops::{Range, RangeInclusive};

use casebase::PointMm;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::codes::code;
use crate::files::SourceFile;
use crate::keys::COORDINATES;
use foreign::{Finding, Severity};

/// A file being read, with its findings.
pub(crate) struct Reader<'f> {
    pub(crate) file: &'f SourceFile,
    pub(crate) findings: Vec<Finding>,
}

/// A value with its span in the file.
pub(crate) type Value<'t, 'i> = &'t Spanned<DeValue<'i>>;

/// A table being read: its keys, its name in error messages, and its span.
pub(crate) struct Table<'t, 'i> {
    keys: &'t DeTable<'i>,
    name: String,
    span: Range<usize>,
}

impl<'f> Reader<'f> {
    pub(crate) fn new(file: &'f SourceFile) -> Self {
        Self { file, findings: Vec::new() }
    }

    /// The file's text as TOML; an error and `None` where it is invalid.
    pub(crate) fn parse(&mut self) -> Option<Spanned<DeTable<'f>>> {
        match DeTable::parse(&self.file.text) {
            Ok(root) => Some(root),
            Err(error) => {
                let at = error.span().unwrap_or(0..0);
                self.error(
                    code::SYNTAX,
                    at,
                    format!("not TOML: {}", one_line(error.message())),
                    "correct the syntax",
                );
                None
            }
        }
    }

    pub(crate) fn error(
        &mut self,
        code: &'static str,
        span: Range<usize>,
        message: impl Into<String>,
        hint: impl Into<String>,
    ) {
        let line = self.file.line(span.start);
        self.findings.push(self.file.finding(Severity::Error, code, line, message, hint));
    }

    pub(crate) fn warning(
        &mut self,
        code: &'static str,
        span: Range<usize>,
        message: impl Into<String>,
        hint: impl Into<String>,
    ) {
        let line = self.file.line(span.start);
        self.findings.push(self.file.finding(Severity::Warning, code, line, message, hint));
    }

    /// An error about a value's type.
    fn wrong_type(&mut self, value: Value<'_, '_>, name: &str, expected: &str) {
        let message = format!("{name} is {}", described(value.get_ref()));
        self.error(code::WRONG_TYPE, value.span(), message, format!("give {expected}"));
    }

    pub(crate) fn text<'t>(&mut self, value: Value<'t, '_>, name: &str) -> Option<&'t str> {
        let text = value.get_ref().as_str();
        if text.is_none() {
            self.wrong_type(value, name, "a string in quotes");
        }
        text
    }

    pub(crate) fn list<'t, 'i>(&mut self, value: Value<'t, 'i>, name: &str) -> Option<Vec<Value<'t, 'i>>> {
        if let Some(list) = value.get_ref().as_array() {
            return Some(list.iter().collect());
        }
        self.wrong_type(value, name, "a list");
        None
    }

    pub(crate) fn table<'t, 'i>(
        &mut self,
        value: Value<'t, 'i>,
        name: impl Into<String>,
    ) -> Option<Table<'t, 'i>> {
        let name = name.into();
        if let Some(keys) = value.get_ref().as_table() {
            return Some(Table { keys, name, span: value.span() });
        }
        self.wrong_type(value, &name, "a table");
        None
    }

    /// A whole number within `allowed`.
    pub(crate) fn whole(
        &mut self,
        value: Value<'_, '_>,
        name: &str,
        allowed: &RangeInclusive<i32>,
    ) -> Option<i32> {
        let Some(integer) = value.get_ref().as_integer() else {
            self.wrong_type(value, name, "a whole number");
            return None;
        };
        let number = i32::from_str_radix(integer.as_str(), integer.radix()).ok();
        let number = number.filter(|number| allowed.contains(number));
        if number.is_none() {
            let (low, high) = (allowed.start(), allowed.end());
            let message = format!("{name} is {integer}");
            let hint = format!("give a whole number from {low} to {high}");
            self.error(code::BAD_VALUE, value.span(), message, hint);
        }
        number
    }

    /// `[x, y]` in mm.
    pub(crate) fn point(&mut self, value: Value<'_, '_>, name: &str) -> Option<PointMm> {
        let pair = value.get_ref().as_array().filter(|list| list.iter().count() == 2);
        let Some(pair) = pair else {
            self.wrong_type(value, name, "[x, y] in whole mm");
            return None;
        };
        let mut numbers = pair.iter().map(|number| self.whole(number, name, &COORDINATES));
        let (x, y) = (numbers.next()?, numbers.next()?);
        Some(PointMm::new(x?, y?))
    }
}

impl<'t, 'i> Table<'t, 'i> {
    pub(crate) fn root(root: &'t Spanned<DeTable<'i>>) -> Self {
        Self { keys: root.get_ref(), name: String::new(), span: 0..0 }
    }

    pub(crate) fn span(&self) -> Range<usize> {
        self.span.clone()
    }

    /// The full name of a key, for error messages.
    pub(crate) fn name_of(&self, key: &str) -> String {
        if self.name.is_empty() { key.to_owned() } else { format!("{}.{key}", self.name) }
    }

    pub(crate) fn optional(&self, key: &str) -> Option<Value<'t, 'i>> {
        self.keys.get(key)
    }

    pub(crate) fn required(&self, reader: &mut Reader<'_>, key: &str) -> Option<Value<'t, 'i>> {
        let value = self.optional(key);
        if value.is_none() {
            let message = format!("{} is missing", self.name_of(key));
            reader.error(code::MISSING_KEY, self.span(), message, format!("add {key}"));
        }
        value
    }

    pub(crate) fn whole(
        &self,
        reader: &mut Reader<'_>,
        key: &str,
        allowed: &RangeInclusive<i32>,
    ) -> Option<i32> {
        let value = self.required(reader, key)?;
        reader.whole(value, &self.name_of(key), allowed)
    }

    /// A required point, with its span in the file.
    pub(crate) fn point(&self, reader: &mut Reader<'_>, key: &str) -> Option<(PointMm, Range<usize>)> {
        let value = self.required(reader, key)?;
        Some((reader.point(value, &self.name_of(key))?, value.span()))
    }

    /// Reports every key that is not among `known`.
    pub(crate) fn refuse_others(&self, reader: &mut Reader<'_>, known: &[&str]) {
        for key in self.keys.keys().filter(|key| !known.contains(&key.get_ref().as_ref())) {
            let message = format!("unknown key {}", self.name_of(key.get_ref()));
            reader.error(
                code::UNKNOWN_KEY,
                key.span(),
                message,
                format!("take one of: {}", known.join(", ")),
            );
        }
    }

    /// Every key with its span and its value, in the order of the file.
    pub(crate) fn entries(&self) -> Vec<(&'t str, Range<usize>, Value<'t, 'i>)> {
        let mut entries: Vec<_> =
            self.keys.iter().map(|(key, value)| (key.get_ref().as_ref(), key.span(), value)).collect();
        entries.sort_by_key(|(_, span, _)| span.start);
        entries
    }
}

fn described(value: &DeValue<'_>) -> String {
    match value {
        DeValue::String(text) => format!("the string {text:?}"),
        DeValue::Integer(number) => format!("the whole number {number}"),
        DeValue::Float(number) => format!("the number {number}"),
        DeValue::Boolean(truth) => format!("the truth value {truth}"),
        DeValue::Datetime(_) => "a date or time".to_owned(),
        DeValue::Array(list) => format!("a list of {}", list.iter().count()),
        DeValue::Table(_) => "a table".to_owned(),
    }
}

fn one_line(message: &str) -> String {
    message.split_whitespace().collect::<Vec<_>>().join(" ")
}
