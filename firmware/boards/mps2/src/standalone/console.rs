//! `console`: diagnostic output: a line on stderr over semihosting, without the formatting of `core::fmt`.

use cortex_m_semihosting::hio;

/// Writes the words and a line's end.
pub(crate) fn say(words: &[&[u8]]) {
    // Where nobody listens there is nothing to be done about it.
    if let Ok(mut stderr) = hio::hstderr() {
        for word in [&b"robot: "[..]].iter().chain(words).chain([&&b"\n"[..]]) {
            let _ = stderr.write_all(word);
        }
    }
}
