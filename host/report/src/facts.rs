//! `facts`: provenance of an evaluation, by name and value, all that its files record.

use serde_json::Value;
use study::evaluation::Identity;

/// Settings that the trials depend on, under one heading.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Facts {
    /// The heading above the entries.
    pub title: String,
    /// Name and value of each setting.
    pub entries: Vec<(String, String)>,
}

impl Facts {
    /// All of an evaluation whose trials have this hash.
    pub fn of(identity: &Identity, csv_hash: &str) -> Vec<Self> {
        let mut first = Self { title: "Program, cases and trials".to_owned(), entries: Vec::new() };
        let mut rest = Vec::new();
        let whole = serde_json::to_value(identity).unwrap_or_default();
        for (name, value) in whole.as_object().into_iter().flatten() {
            match (heading(name), value) {
                (Some(title), value) => {
                    let mut facts = Self { title: title.to_owned(), entries: Vec::new() };
                    flatten("", value, &mut facts.entries);
                    rest.push(facts);
                }
                (None, Value::Array(names)) => {
                    first.entries.push((name.clone(), format!("{}: {}", names.len(), joined(names))));
                }
                (None, value) => flatten(name, value, &mut first.entries),
            }
        }
        first.entries.push((HASH.to_owned(), csv_hash.to_owned()));
        let mut facts = vec![first];
        facts.extend(rest);
        facts
    }
}

/// Name of the number that distinguishes two evaluations.
pub(crate) const HASH: &str = "csv hash of the trials";

/// The parts that are long enough for a heading of their own.
fn heading(name: &str) -> Option<&'static str> {
    match name {
        "settings" => Some("Settings of retrieval"),
        "parameters" => Some("The world"),
        "plan" => Some("The plan"),
        _ => None,
    }
}

fn joined(values: &[Value]) -> String {
    values.iter().map(label).collect::<Vec<_>>().join(", ")
}

fn label(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

/// Numbers and texts below each other, named by their path.
fn flatten(name: &str, value: &Value, entries: &mut Vec<(String, String)>) {
    let below = |key: &str| if name.is_empty() { key.to_owned() } else { format!("{name}.{key}") };
    match value {
        Value::Object(parts) => parts.iter().for_each(|(key, part)| flatten(&below(key), part, entries)),
        Value::Array(parts) if parts.iter().any(Value::is_object) => {
            for (i, part) in parts.iter().enumerate() {
                match part {
                    // One line for each element: its members belong together.
                    Value::Object(part) => {
                        let members: Vec<_> =
                            part.iter().map(|(key, value)| format!("{key} {}", label(value))).collect();
                        entries.push((below(&(i + 1).to_string()), members.join(", ")));
                    }
                    part => flatten(&below(&(i + 1).to_string()), part, entries),
                }
            }
        }
        Value::Array(parts) => entries.push((name.to_owned(), joined(parts))),
        value => entries.push((name.to_owned(), label(value))),
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn nested_values_are_listed_down_to_the_leaves() {
        let mut entries = Vec::new();
        let value = json!({"a": 1.5, "b": {"c": "x", "d": [1, 2]}, "e": [{"f": "1", "g": 2}], "h": null});
        flatten("", &value, &mut entries);
        let texts: Vec<_> = entries.iter().map(|(name, value)| (name.as_str(), value.as_str())).collect();
        assert_eq!(texts, [("a", "1.5"), ("b.c", "x"), ("b.d", "1, 2"), ("e.1", "f 1, g 2"), ("h", "null")]);
    }
}
