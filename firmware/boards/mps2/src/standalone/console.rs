//! `console`: diagnostic output: a line on stderr over semihosting, without the formatting of `core::fmt`.

use cortex_m_semihosting::hio;

/// Writes the text and a line's end.
pub(crate) fn say(words: &[&[u8]]) {
    // Without a console the text is dropped.
    if let Ok(mut stderr) = hio::hstderr() {
        for word in [&b"robot: "[..]].iter().chain(words).chain([&&b"\n"[..]]) {
            let _ = stderr.write_all(word);
        }
    }
}
