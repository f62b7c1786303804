//! `text`: text of untrusted sources, escaped for a terminal, a report or a log line.

use std::borrow::Cow;
use std::fmt::Write as _;
use std::io::{self, Write};
use std::path::Path;

/// The text with every character escaped that a terminal would execute: `\n`, `\r`, `\t`, and the others as
/// `\u001b`. So one value stays within its line, and cannot colour, move or hide the text around it.
///
/// The escapes are JSON's: text in a JSON document stays the same text.
pub fn printable(text: &str) -> Cow<'_, str> {
    if !text.contains(is_obeyed) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len() + 8);
    text.chars().for_each(|character| push(&mut out, character));
    Cow::Owned(out)
}

/// The text's first `most` characters, made [`printable`]; where it is longer, `…` and the number of its
/// bytes.
pub fn excerpt(text: &str, most: usize) -> String {
    match text.char_indices().nth(most) {
        None => printable(text).into_owned(),
        Some((cut, _)) => {
            let begin = text.get(..cut).unwrap_or_default();
            format!("{}… ({} bytes)", printable(begin), text.len())
        }
    }
}

fn push(out: &mut String, character: char) {
    match character {
        '\n' => out.push_str("\\n"),
        '\r' => out.push_str("\\r"),
        '\t' => out.push_str("\\t"),
        // All of them are in the first 65,536, as JSON's escapes are.
        _ if is_obeyed(character) => {
            let _ = write!(out, "\\u{:04x}", u32::from(character));
        }
        _ => out.push(character),
    }
}

/// Returns whether a terminal or a text view would execute the character instead of displaying it.
fn is_obeyed(character: char) -> bool {
    character.is_control()
        || matches!(
            character,
            // Arabic letter mark, left-to-right and right-to-left marks, embeddings, overrides and isolates:
            // "Trojan source".
            '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}'
            // Line and paragraph separator, byte order mark.
            | '\u{2028}' | '\u{2029}' | '\u{feff}'
        )
}

/// A writer for text: its input is escaped as by [`printable`], except line ends and tabs, which are the
/// program's own. Bytes that are no UTF-8 become `\u{fffd}`.
#[derive(Debug)]
pub struct Printable<W: Write> {
    into: W,
    /// The first bytes of a character whose others have not arrived: at most 3.
    begun: Vec<u8>,
}

impl<W: Write> Printable<W> {
    /// A writer that passes escaped text to `into`.
    pub const fn new(into: W) -> Self {
        Self { into, begun: Vec::new() }
    }

    fn put(&mut self, text: &str) -> io::Result<()> {
        let own = |character: char| matches!(character, '\n' | '\t');
        if !text.contains(|character| is_obeyed(character) && !own(character)) {
            return self.into.write_all(text.as_bytes());
        }
        let mut out = String::with_capacity(text.len() + 8);
        for character in text.chars() {
            if own(character) { out.push(character) } else { push(&mut out, character) }
        }
        self.into.write_all(out.as_bytes())
    }
}

impl<W: Write> Write for Printable<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let joined;
        let mut left = if self.begun.is_empty() {
            bytes
        } else {
            joined = [&std::mem::take(&mut self.begun)[..], bytes].concat();
            &joined[..]
        };
        loop {
            match str::from_utf8(left) {
                Ok(text) => {
                    self.put(text)?;
                    return Ok(bytes.len());
                }
                Err(error) => {
                    let (whole, rest) = left.split_at(error.valid_up_to());
                    self.put(str::from_utf8(whole).unwrap_or_default())?;
                    let Some(wrong) = error.error_len() else {
                        self.begun = rest.to_vec();
                        return Ok(bytes.len());
                    };
                    self.put("\u{fffd}")?;
                    left = rest.get(wrong..).unwrap_or_default();
                }
            }
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        self.into.flush()
    }
}

/// A file's name as it can stand in a line.
pub fn printable_path(path: &Path) -> String {
    printable(&path.to_string_lossy()).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn control_characters_are_escaped_and_the_rest_stays() {
        for plain in ["", "TIGERs Mannheim", "größe ✓ 日本 🤖", "a\\b"] {
            assert!(matches!(printable(plain), Cow::Borrowed(same) if same == plain), "{plain}");
        }
        let hostile = "gc\u{1b}]0;pwn\u{7}\u{1b}[31mRED\n0.00 s GOAL\r\u{9b}2J\u{202e}txt\u{7f}\t\u{0}";
        let printed = printable(hostile);
        assert_eq!(
            printed,
            "gc\\u001b]0;pwn\\u0007\\u001b[31mRED\\n0.00 s GOAL\\r\\u009b2J\\u202etxt\\u007f\\t\\u0000"
        );
        assert!(!printed.chars().any(is_obeyed));
    }

    #[test]
    fn every_character_of_the_first_65536_is_either_displayed_or_escaped() {
        for character in (0..=0xffff).filter_map(char::from_u32) {
            let text = character.to_string();
            let printed = printable(&text);
            assert!(!printed.contains(char::is_control), "{:04x}", u32::from(character));
            assert!(printed == text || printed.starts_with('\\'), "{:04x}", u32::from(character));
        }
    }

    #[test]
    fn a_long_text_is_shortened() {
        assert_eq!(excerpt("short", 10), "short");
        assert_eq!(excerpt("größer\u{1b}", 4), "größ… (9 bytes)");
        assert_eq!(excerpt(&"x".repeat(50_000_000), 3), "xxx… (50000000 bytes)");
    }

    #[test]
    fn a_writer_escapes_all_but_line_ends_however_the_bytes_are_cut() {
        let text = "one\ttwo\n\u{1b}[2Jthree \u{9b}31m größe 🤖\u{202e}\r\nend";
        let expected = "one\ttwo\n\\u001b[2Jthree \\u009b31m größe 🤖\\u202e\\r\nend";
        for piece in 1..text.len() {
            let mut writer = Printable::new(Vec::new());
            for bytes in text.as_bytes().chunks(piece) {
                writer.write_all(bytes).unwrap();
            }
            assert_eq!(str::from_utf8(&writer.into).unwrap(), expected, "pieces of {piece}");
        }
    }

    #[test]
    fn a_writer_lets_no_raw_byte_through_that_is_no_text() {
        let mut writer = Printable::new(Vec::new());
        writer.write_all(b"a\x9b31m\xff\xc3(\n").unwrap();
        assert_eq!(str::from_utf8(&writer.into).unwrap(), "a\u{fffd}31m\u{fffd}\u{fffd}(\n");
    }
}
