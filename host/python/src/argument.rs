//! `argument`: values of Python's callers, of whatever type: `NumPy`'s numbers count as Python's own, and
//! what does not fit raises `ValueError` with the argument's name.

use std::borrow::Cow;

use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyString, PyTuple};

use crate::refused;

/// Functions that read an argument of that name, for `from_py_with`.
macro_rules! arguments {
    ($($name:ident: $read:ident -> $type:ty;)*) => {$(
        pub fn $name(value: &Bound<'_, PyAny>) -> PyResult<$type> {
            $read(stringify!($name), value)
        }
    )*};
}

arguments! {
    own: optional_whole -> Option<usize>;
    agents: optional_whole -> Option<usize>;
    count: whole -> usize;
    k: whole -> usize;
    samples: whole -> usize;
    budget: whole -> u64;
    unknown: text -> Text;
    threads: whole -> usize;
    index: whole -> usize;
    robots: whole -> usize;
    width: whole -> u32;
    period_ms: optional_whole -> Option<u32>;
    seed: whole -> u64;
    time_limit_s: optional_real -> Option<f64>;
    loss: share -> f32;
    x: short_real -> f32;
    y: short_real -> f32;
    vx: short_real -> f32;
    vy: short_real -> f32;
    heading: short_real -> f32;
    opponent: flag -> bool;
    symmetry: flag -> bool;
    case_opponents: flag -> bool;
    opponents_play_on: flag -> bool;
    task: text -> Text;
    teammates_by: text -> Text;
    opponents_by: optional_text -> Option<Text>;
    world: text -> Text;
    league: text -> Text;
    observation: text -> Text;
    scenario: text -> Text;
    opponents: text -> Text;
    approach: text -> Text;
    profile: text -> Text;
    positioning: text -> Text;
}

/// A text, Python's or a default.
pub struct Text(Cow<'static, str>);

impl Text {
    /// The default of an argument.
    pub const fn of(text: &'static str) -> Self {
        Self(Cow::Borrowed(text))
    }
}

impl From<String> for Text {
    fn from(text: String) -> Self {
        Self(Cow::Owned(text))
    }
}

impl std::ops::Deref for Text {
    type Target = str;

    fn deref(&self) -> &str {
        &self.0
    }
}

/// A number of opponents, or `None`.
pub fn opponents_count(value: &Bound<'_, PyAny>) -> PyResult<Option<usize>> {
    optional_whole("opponents", value)
}

/// A league, or `None`.
pub fn league_if_any(value: &Bound<'_, PyAny>) -> PyResult<Option<Text>> {
    optional_text("league", value)
}

/// A number of robots, or `None`.
pub fn retrievers(value: &Bound<'_, PyAny>) -> PyResult<Option<usize>> {
    optional_whole("retrievers", value)
}

/// A whole number of that type.
fn whole<T: TryFrom<i128>>(name: &str, value: &Bound<'_, PyAny>) -> PyResult<T> {
    let number = value.extract::<i128>().ok().and_then(|number| T::try_from(number).ok());
    number.ok_or_else(|| {
        refused(format!(
            "{name} {}: take a whole number of at most {} bits, from 0",
            shown(value),
            8 * size_of::<T>()
        ))
    })
}

fn optional_whole<T: TryFrom<i128>>(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Option<T>> {
    if value.is_none() { Ok(None) } else { whole(name, value).map(Some) }
}

fn optional_real(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Option<f64>> {
    if value.is_none() { Ok(None) } else { real(name, value).map(Some) }
}

fn optional_text(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Option<Text>> {
    if value.is_none() { Ok(None) } else { text(name, value).map(Some) }
}

fn real(name: &str, value: &Bound<'_, PyAny>) -> PyResult<f64> {
    value.extract().map_err(|_| refused(format!("{name} {}: take a number", shown(value))))
}

fn short_real(name: &str, value: &Bound<'_, PyAny>) -> PyResult<f32> {
    let number = real(name, value)? as f32;
    if number.is_finite() {
        return Ok(number);
    }
    Err(refused(format!("{name} {}: take a finite number of 32 bits", shown(value))))
}

/// A number that the callee holds against its range.
fn share(name: &str, value: &Bound<'_, PyAny>) -> PyResult<f32> {
    Ok(real(name, value)? as f32)
}

fn flag(name: &str, value: &Bound<'_, PyAny>) -> PyResult<bool> {
    value.extract().map_err(|_| refused(format!("{name} {}: take True or False", shown(value))))
}

fn text(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Text> {
    let text = value.extract::<String>().map(|text| Text(Cow::Owned(text)));
    text.map_err(|_| refused(format!("{name} {}: take a text", shown(value))))
}

/// The dict of an argument, if one is given.
pub fn dict<'py>(name: &str, value: Option<&Bound<'py, PyAny>>) -> PyResult<Option<Bound<'py, PyDict>>> {
    let Some(value) = value.filter(|value| !value.is_none()) else { return Ok(None) };
    let dict = value.cast::<PyDict>().cloned();
    dict.map(Some).map_err(|_| refused(format!("{name} {}: take a dict", shown(value))))
}

/// JSON of a value as `json.dumps` writes it; arrays and numbers of `NumPy` are lists and numbers. `name` is
/// the value's place, for errors.
pub fn json(name: &str, value: &Bound<'_, PyAny>, out: &mut String) -> PyResult<()> {
    // Nested deeper than any problem: a list that holds itself has no end.
    if name.matches(['.', '[']).count() > DEPTH_MAX {
        return Err(refused(format!("{}: nested too deep", short(name))));
    }
    if value.is_none() {
        out.push_str("null");
    } else if let Ok(value) = value.cast::<PyBool>() {
        out.push_str(if value.is_true() { "true" } else { "false" });
    } else if let Ok(text) = value.cast::<PyString>() {
        push_text(name, text, out)?;
    } else if value.is_exact_instance_of::<PyInt>() {
        out.push_str(&value.str()?.to_string());
    } else if let Ok(number) = value.cast::<PyFloat>() {
        if !number.value().is_finite() {
            return Err(refused(format!("{name} is {}: take finite numbers", shown(value))));
        }
        // A subclass may print itself otherwise.
        out.push_str(&PyFloat::new(value.py(), number.value()).repr()?.to_string());
    } else if let Ok(dict) = value.cast::<PyDict>() {
        out.push('{');
        for (n, (key, value)) in dict.iter().enumerate() {
            out.push_str(if n > 0 { ", " } else { "" });
            let key = key_of(name, &key)?;
            push_text(name, &key, out)?;
            out.push_str(": ");
            json(&format!("{name}.{}", short(&key.to_string())), &value, out)?;
        }
        out.push('}');
    } else if value.is_instance_of::<PyList>() || value.is_instance_of::<PyTuple>() {
        out.push('[');
        for (n, value) in value.try_iter()?.enumerate() {
            out.push_str(if n > 0 { ", " } else { "" });
            json(&format!("{name}[{n}]"), &value?, out)?;
        }
        out.push(']');
    } else if let Ok(number) = value.call_method0("__index__") {
        // A whole number of another type; Python's own has come above.
        out.push_str(&number.str()?.to_string());
    } else if let Ok(plain) = value.call_method0("tolist") {
        json(name, &plain, out)?;
    } else if let Ok(number) = value.extract::<f64>() {
        json(name, PyFloat::new(value.py(), number).as_any(), out)?;
    } else {
        let kind = value.get_type().name()?;
        return Err(refused(format!("{name} is of type {kind}: take numbers, texts, lists and dicts")));
    }
    Ok(())
}

/// A dict's key as JSON has it: a text, or the digits of a whole number of any type.
fn key_of<'py>(name: &str, key: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyString>> {
    if let Ok(text) = key.cast::<PyString>() {
        return Ok(text.clone());
    }
    let number = key.call_method0("__index__").and_then(|number| number.str());
    number.map_err(|_| refused(format!("{name} has the key {}: take texts and whole numbers", shown(key))))
}

fn push_text(name: &str, text: &Bound<'_, PyString>, out: &mut String) -> PyResult<()> {
    // Halves of a pair of surrogates are no text.
    let text = text.to_str().map_err(|_| refused(format!("{name}: a text that is not Unicode")))?;
    out.push_str(&serde_json::to_string(text).map_err(refused)?);
    Ok(())
}

/// The value as Python prints it, shortened.
fn shown(value: &Bound<'_, PyAny>) -> String {
    let text = value.repr().map_or_else(|_| "?".to_owned(), |text| text.to_string());
    short(&text)
}

fn short(text: &str) -> String {
    let mut short: String = text.chars().take(SHOWN_MAX).collect();
    if short.len() < text.len() {
        short.push('…');
    }
    short
}

/// Most characters of a value that are shown.
const SHOWN_MAX: usize = 60;
/// Deepest nesting of a problem that is read.
const DEPTH_MAX: usize = 40;
