//! `onetwo robot show`: a description's values with their units, and what follows from them.

use std::fmt::Write as _;

use clap::Args;
use robots::{Description, Value};
use rules::RobotSpec;
use serde_json::{Map, Value as Json, json};

use super::derived;
use crate::Failure;
use crate::output::print_text;
use crate::robot_description::{own, read};

/// Arguments of `robot show`.
#[derive(Debug, Args)]
pub(crate) struct ShowArgs {
    /// The description, a file or a built-in name; by default what this program is built for.
    #[arg(value_name = "FILE")]
    file: Option<String>,
    /// One JSON object: values and derived numbers, each with its unit.
    #[arg(long, conflicts_with = "text")]
    json: bool,
    /// The description's own text, to keep a copy of a built-in one.
    #[arg(long)]
    text: bool,
}

pub(super) fn run(args: &ShowArgs) -> Result<(), Failure> {
    let (source, text, description) = match &args.file {
        None => (RobotSpec::SOURCE.to_owned(), RobotSpec::TEXT.to_owned(), own()?),
        Some(file) => {
            let (chosen, description) = read(file)?;
            (chosen.source, chosen.text, description)
        }
    };
    if args.text {
        return print_text(&text);
    }
    if args.json {
        return print_text(&format!("{}\n", as_json(&source, &description)));
    }
    print_text(&as_text(&source, &description))
}

fn as_text(source: &str, of: &Description) -> String {
    let mut text = format!("robot {} ({source})\n\n", of.name());
    let mut table = "";
    for (key, value) in of.entries().filter(|(key, _)| key.path != "name") {
        if key.table() != table {
            table = key.table();
            let _ = writeln!(text, "[{table}]");
        }
        let _ = writeln!(text, "  {:<22} {} {}", key.name(), written(value), key.unit);
    }
    text.push_str("\nWhat follows:\n");
    for (name, value, unit) in derived::rows(of) {
        let _ = writeln!(text, "  {name:<50} {value:.2} {unit}");
    }
    text
}

fn written(value: &Value) -> String {
    match value {
        Value::Number(number) => number.to_string(),
        Value::Whole(number) => number.to_string(),
        Value::Wheels(list) => format!("{list:?}"),
        Value::Pulses(pulses) => {
            let pairs: Vec<_> = pulses.iter().map(|(speed, micros)| format!("{speed} at {micros}")).collect();
            pairs.join(", ")
        }
        Value::Text(text) => text.clone(),
    }
}

fn as_json(source: &str, of: &Description) -> Json {
    let value = |value: &Value| match value {
        // By the shortest text that reads as the same number.
        Value::Number(number) => json!(number.to_string().parse::<f64>().unwrap_or(f64::NAN)),
        Value::Whole(number) => json!(number),
        Value::Wheels(list) => json!(list),
        Value::Pulses(pulses) => json!(pulses),
        Value::Text(text) => json!(text),
    };
    let entries = of.entries().map(|(key, its)| {
        (key.path.to_owned(), json!({ "value": value(its), "unit": key.unit, "meaning": key.meaning }))
    });
    let entries: Map<_, _> = entries.collect();
    let derived = derived::rows(of)
        .into_iter()
        .map(|(name, value, unit)| (name.to_owned(), json!({ "value": value, "unit": unit })));
    let derived: Map<_, _> = derived.collect();
    json!({ "name": of.name(), "source": source, "values": entries, "derived": derived })
}
