//! `debug_tree`: comparison of messages by their `Debug` text, read back as a tree and compared with JSON.
//!
//! `Debug` names the Rust fields and the enums' variants, so this sees a field under a wrong name or with a
//! wrong enum, which a round trip of bytes does not.

use serde_json::Value;

/// A value as `Debug` prints it.
#[derive(Debug, PartialEq)]
enum DebugTree {
    Number(String),
    Text(String),
    /// A unit variant, `true`, `false` or `None`.
    Name(String),
    Fields(Vec<(String, DebugTree)>),
    /// `Some(…)` or a variant with a value.
    Holds(String, Box<DebugTree>),
    List(Vec<DebugTree>),
}

/// Whether the message's `Debug` text equals the JSON; otherwise where they differ.
pub(crate) fn agree(debug: &str, expected: &Value) -> Result<(), String> {
    let mut reader = Reader { text: debug.as_bytes(), at: 0 };
    let debug_tree = reader.value();
    assert_eq!(reader.at, debug.len(), "not read to the end: {debug}");
    compare(expected, &debug_tree, "")
}

fn compare(expected: &Value, debug_tree: &DebugTree, path: &str) -> Result<(), String> {
    let differs = || Err(format!("{path}: expected {expected}, is {debug_tree:?}"));
    let same = match (expected, debug_tree) {
        (_, DebugTree::Holds(name, inner)) if name == "Some" => return compare(expected, inner, path),
        (Value::Object(fields), DebugTree::Fields(debug_tree)) => {
            return compare_fields(fields, debug_tree, path);
        }
        (Value::Array(values), DebugTree::List(debug_tree)) if values.len() == debug_tree.len() => {
            return values.iter().zip(debug_tree).enumerate().try_for_each(
                |(index, (expected, debug_tree))| compare(expected, debug_tree, &format!("{path}[{index}]")),
            );
        }
        (Value::Bool(value), DebugTree::Name(name)) => value.to_string() == *name,
        (Value::String(value), DebugTree::Text(text)) => value == text,
        (Value::String(value), DebugTree::Name(name)) => same_variant(value, name),
        // JSON gives 64-bit integers as strings.
        (Value::String(value), DebugTree::Number(number)) => value == number,
        (Value::Number(value), DebugTree::Number(number)) => same_number(value, number),
        _ => false,
    };
    if same { Ok(()) } else { differs() }
}

fn compare_fields(
    expected: &serde_json::Map<String, Value>,
    debug_tree: &[(String, DebugTree)],
    path: &str,
) -> Result<(), String> {
    let mut debug_tree: Vec<(String, &DebugTree)> =
        debug_tree.iter().filter_map(|(name, value)| set(name, value)).collect();
    for (name, value) in expected {
        // Required bytes that are empty look like a list that is: here both are nothing, the encoded bytes
        // differ.
        if value.as_array().is_some_and(Vec::is_empty) {
            continue;
        }
        let Some(at) = debug_tree.iter().position(|(own, _)| own == name) else {
            return Err(format!("{path}.{name}: expected {value}, is not there"));
        };
        let (_, own) = debug_tree.remove(at);
        compare(value, own, &format!("{path}.{name}"))?;
    }
    match debug_tree.first() {
        Some((name, value)) => Err(format!("{path}.{name}: is {value:?}, expected nothing")),
        None => Ok(()),
    }
}

/// A field that is there, under the league's name: a oneof under its member's.
fn set<'a>(name: &str, value: &'a DebugTree) -> Option<(String, &'a DebugTree)> {
    match value {
        DebugTree::Name(none) if none == "None" => None,
        DebugTree::List(values) if values.is_empty() => None,
        DebugTree::Holds(some, inner) if some == "Some" => match &**inner {
            DebugTree::Holds(variant, inner) => Some((snake(variant), inner)),
            DebugTree::List(values) if values.is_empty() => None,
            inner => Some((name.to_owned(), inner)),
        },
        value => Some((name.to_owned(), value)),
    }
}

fn snake(camel: &str) -> String {
    let mut out = String::new();
    for letter in camel.chars() {
        if letter.is_uppercase() && !out.is_empty() {
            out.push('_');
        }
        out.extend(letter.to_lowercase());
    }
    out
}

/// Whether the variant is the league's value. Ours go without the enum's name in front, and `UNKNOWN_…` is
/// `Unknown`.
pub(crate) fn same_variant(league: &str, variant: &str) -> bool {
    let prefixes = ["SSL_SOURCE_", "DIV_", "HULL_COLOR_", "TEAM_COLOR_", "CAPABILITY_"];
    let bare = prefixes.iter().find_map(|prefix| league.strip_prefix(prefix)).unwrap_or(league);
    if bare.starts_with("UNKNOWN") {
        return variant == "Unknown";
    }
    bare.replace('_', "").eq_ignore_ascii_case(variant)
}

fn same_number(value: &serde_json::Number, debug_tree: &str) -> bool {
    if value.to_string() == debug_tree {
        return true;
    }
    // An f32 is printed with its shortest digits, the same in both.
    !value.is_i64() && !value.is_u64() && value.as_f64() == debug_tree.parse().ok()
}

struct Reader<'a> {
    text: &'a [u8],
    at: usize,
}

impl Reader<'_> {
    fn value(&mut self) -> DebugTree {
        match self.text[self.at] {
            b'"' => self.string(),
            b'[' => DebugTree::List(self.list(b']', Self::value)),
            b'-' | b'0'..=b'9' => DebugTree::Number(self.label()),
            _ => {
                let name = self.label();
                match self.text.get(self.at..self.at + 2) {
                    Some(b" {") => {
                        self.at += 1;
                        DebugTree::Fields(self.list(b'}', Self::field))
                    }
                    Some([b'(', _]) => {
                        self.at += 1;
                        let inner = self.value();
                        self.eat(b')');
                        DebugTree::Holds(name, Box::new(inner))
                    }
                    _ => DebugTree::Name(name),
                }
            }
        }
    }

    fn field(&mut self) -> (String, DebugTree) {
        let name = self.label();
        self.eat(b':');
        self.eat(b' ');
        (name.trim_start_matches("r#").to_owned(), self.value())
    }

    /// The items between the bracket here and `close`, separated by commas.
    fn list<T>(&mut self, close: u8, mut item: impl FnMut(&mut Self) -> T) -> Vec<T> {
        self.at += 1;
        let mut items = Vec::new();
        loop {
            while matches!(self.text[self.at], b' ' | b',') {
                self.at += 1;
            }
            if self.text[self.at] == close {
                self.at += 1;
                return items;
            }
            items.push(item(self));
        }
    }

    fn label(&mut self) -> String {
        let rest = &self.text[self.at..];
        let in_label = |byte: &u8| byte.is_ascii_alphanumeric() || b"_#.-+".contains(byte);
        let length = rest.iter().position(|byte| !in_label(byte)).unwrap_or(rest.len());
        assert!(length > 0, "no word at {}: {}", self.at, String::from_utf8_lossy(rest));
        self.at += length;
        String::from_utf8_lossy(&rest[..length]).into_owned()
    }

    fn string(&mut self) -> DebugTree {
        let start = self.at;
        self.at += 1;
        while self.text[self.at] != b'"' {
            self.at += if self.text[self.at] == b'\\' { 2 } else { 1 };
        }
        self.at += 1;
        let quoted = std::str::from_utf8(&self.text[start..self.at]).expect("whole letters");
        // Rust's escapes in these texts are JSON's.
        DebugTree::Text(serde_json::from_str(quoted).expect("a string with simple escapes"))
    }

    fn eat(&mut self, byte: u8) {
        assert_eq!(self.text[self.at], byte, "at {}", self.at);
        self.at += 1;
    }
}
