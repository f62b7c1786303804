//! `console`: diagnostic output: a line on stderr over semihosting, without the formatting of `core::fmt`.

use cortex_m_semihosting::hio;
use heapless::Vec;

/// Longest line, bytes; what is longer is cut.
const LINE_LEN: usize = 160;

/// Writes the text and a line's end, at once: robots that share a terminal do not mix their lines.
pub(crate) fn print(pieces: &[&[u8]]) {
    let mut line = Vec::<u8, LINE_LEN>::new();
    let text = b"robot: ".iter().chain(pieces.iter().copied().flatten());
    for byte in text.take(LINE_LEN - 1).chain(b"\n") {
        // Never full: the text is cut.
        let _ = line.push(*byte);
    }
    // Without a console the text is dropped.
    if let Ok(mut stderr) = hio::hstderr() {
        let _ = stderr.write_all(&line);
    }
}
