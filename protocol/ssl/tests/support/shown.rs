//! `shown`: comparison of messages by their `Debug` text, read back as a tree and compared with JSON.
//!
//! `Debug` names the Rust fields and the enums' variants, so this sees a field under a wrong name or with a
//! wrong enum, which a round trip of bytes does not.

use serde_json::Value;

/// A value as `Debug` prints it.
#[derive(Debug, PartialEq)]
enum Shown {
    Number(String),
    Text(String),
    /// A unit variant, `true`, `false` or `None`.
    Name(String),
    Fields(Vec<(String, Shown)>),
    /// `Some(…)` or a variant with a value.
    Holds(String, Box<Shown>),
    List(Vec<Shown>),
}

/// Whether the message's `Debug` text equals the JSON; otherwise where they differ.
pub(crate) fn agree(debug: &str, expected: &Value) -> Result<(), String> {
    let mut reader = Reader { text: debug.as_bytes(), at: 0 };
    let shown = reader.value();
    assert_eq!(reader.at, debug.len(), "not read to the end: {debug}");
    compare(expected, &shown, "")
}

fn compare(expected: &Value, shown: &Shown, path: &str) -> Result<(), String> {
    let differs = || Err(format!("{path}: expected {expected}, is {shown:?}"));
    let same = match (expected, shown) {
        (_, Shown::Holds(name, inner)) if name == "Some" => return compare(expected, inner, path),
        (Value::Object(fields), Shown::Fields(shown)) => return compare_fields(fields, shown, path),
        (Value::Array(values), Shown::List(shown)) if values.len() == shown.len() => {
            return values.iter().zip(shown).enumerate().try_for_each(|(index, (expected, shown))| {
                compare(expected, shown, &format!("{path}[{index}]"))
            });
        }
        (Value::Bool(value), Shown::Name(name)) => value.to_string() == *name,
        (Value::String(value), Shown::Text(text)) => value == text,
        (Value::String(value), Shown::Name(name)) => same_variant(value, name),
        // JSON gives 64-bit integers as strings.
        (Value::String(value), Shown::Number(number)) => value == number,
        (Value::Number(value), Shown::Number(number)) => same_number(value, number),
        _ => false,
    };
    if same { Ok(()) } else { differs() }
}

fn compare_fields(
    expected: &serde_json::Map<String, Value>,
    shown: &[(String, Shown)],
    path: &str,
) -> Result<(), String> {
    let mut shown: Vec<(String, &Shown)> =
        shown.iter().filter_map(|(name, value)| set(name, value)).collect();
    for (name, value) in expected {
        // Required bytes that are empty look like a list that is: here both are nothing, the encoded bytes
        // differ.
        if value.as_array().is_some_and(Vec::is_empty) {
            continue;
        }
        let Some(at) = shown.iter().position(|(own, _)| own == name) else {
            return Err(format!("{path}.{name}: expected {value}, is not there"));
        };
        let (_, own) = shown.remove(at);
        compare(value, own, &format!("{path}.{name}"))?;
    }
    match shown.first() {
        Some((name, value)) => Err(format!("{path}.{name}: is {value:?}, expected nothing")),
        None => Ok(()),
    }
}

/// A field that is there, under the league's name: a oneof under its member's.
fn set<'a>(name: &str, value: &'a Shown) -> Option<(String, &'a Shown)> {
    match value {
        Shown::Name(none) if none == "None" => None,
        Shown::List(values) if values.is_empty() => None,
        Shown::Holds(some, inner) if some == "Some" => match &**inner {
            Shown::Holds(variant, inner) => Some((snake(variant), inner)),
            Shown::List(values) if values.is_empty() => None,
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

fn same_number(value: &serde_json::Number, shown: &str) -> bool {
    if value.to_string() == shown {
        return true;
    }
    // An f32 is printed with its shortest digits, the same in both.
    !value.is_i64() && !value.is_u64() && value.as_f64() == shown.parse().ok()
}

struct Reader<'a> {
    text: &'a [u8],
    at: usize,
}

impl Reader<'_> {
    fn value(&mut self) -> Shown {
        match self.text[self.at] {
            b'"' => self.string(),
            b'[' => Shown::List(self.list(b']', Self::value)),
            b'-' | b'0'..=b'9' => Shown::Number(self.label()),
            _ => {
                let name = self.label();
                match self.text.get(self.at..self.at + 2) {
                    Some(b" {") => {
                        self.at += 1;
                        Shown::Fields(self.list(b'}', Self::field))
                    }
                    Some([b'(', _]) => {
                        self.at += 1;
                        let inner = self.value();
                        self.eat(b')');
                        Shown::Holds(name, Box::new(inner))
                    }
                    _ => Shown::Name(name),
                }
            }
        }
    }

    fn field(&mut self) -> (String, Shown) {
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

    fn string(&mut self) -> Shown {
        let start = self.at;
        self.at += 1;
        while self.text[self.at] != b'"' {
            self.at += if self.text[self.at] == b'\\' { 2 } else { 1 };
        }
        self.at += 1;
        let quoted = std::str::from_utf8(&self.text[start..self.at]).expect("whole letters");
        // Rust's escapes in these texts are JSON's.
        Shown::Text(serde_json::from_str(quoted).expect("a string with simple escapes"))
    }

    fn eat(&mut self, byte: u8) {
        assert_eq!(self.text[self.at], byte, "at {}", self.at);
        self.at += 1;
    }
}
