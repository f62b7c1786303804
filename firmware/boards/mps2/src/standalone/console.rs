//! `console`: diagnostic output: a line on stderr over semihosting, without the formatting of `core::fmt`.

use cortex_m_semihosting::hio;

/// Writes the text and a line's end.
pub(crate) fn print(pieces: &[&[u8]]) {
    // Without a console the text is dropped.
    if let Ok(mut stderr) = hio::hstderr() {
        for label in [&b"robot: "[..]].iter().chain(pieces).chain([&&b"\n"[..]]) {
            let _ = stderr.write_all(label);
        }
    }
}
