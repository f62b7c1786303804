//! `lines`: reader of problem lines (docs/case-format.md §5.1).
//!
//! Blank lines are skipped but counted; a line that is malformed, is no UTF-8 or does not end within
//! [`LINE_MAX`] is reported as an error of that line, and reading goes on. Answers are flushed before reading
//! blocks, so that a program at the other end of both pipes may ask, wait for the answer and ask again.

use std::io::{self, BufRead, BufReader, Read, Write};

use arena::cases::problem::{self, Malformed};
use casebase::Problem;

use crate::Failure;

/// Passes every line that is not blank to `answer`, with its number: the problem in it, or what is wrong as
/// `line 7: place: reason`.
pub(crate) fn for_each_problem<W: Write>(
    input: impl Read,
    output: &mut W,
    mut answer: impl FnMut(&mut W, u64, Result<Problem, String>) -> io::Result<()>,
) -> Result<(), Failure> {
    let mut input = BufReader::new(input);
    let mut line = Vec::new();
    for number in 1_u64.. {
        if !input.buffer().contains(&b'\n') {
            output.flush().map_err(Failure::Output)?;
        }
        if !read_line(&mut input, &mut line).map_err(Failure::Input)? {
            break;
        }
        if line.iter().all(u8::is_ascii_whitespace) {
            continue;
        }
        let line = if number == 1 { line.strip_prefix(BYTE_ORDER_MARK).unwrap_or(&line) } else { &line[..] };
        let problem = problem_in(line).map_err(|malformed| format!("line {number}: {malformed}"));
        answer(output, number, problem).map_err(Failure::Output)?;
    }
    output.flush().map_err(Failure::Output)
}

/// The next line up to one byte more than [`LINE_MAX`], with the remainder skipped; `false` at the end of the
/// input.
fn read_line(input: &mut impl BufRead, line: &mut Vec<u8>) -> io::Result<bool> {
    line.clear();
    input.by_ref().take(LINE_MAX as u64 + 1).read_until(b'\n', line)?;
    if line.len() > LINE_MAX && !line.ends_with(b"\n") {
        input.skip_until(b'\n')?;
    }
    Ok(!line.is_empty())
}

fn problem_in(line: &[u8]) -> Result<Problem, Malformed> {
    let line = line.strip_suffix(b"\n").unwrap_or(line);
    if line.len() > LINE_MAX {
        return Err(Malformed::line(format!("longer than {LINE_MAX} bytes")));
    }
    let text = std::str::from_utf8(line)
        .map_err(|error| Malformed::at(&format!("column {}", error.valid_up_to() + 1), "not UTF-8"))?;
    problem::parse(text)
}

/// What some editors put before the first line.
const BYTE_ORDER_MARK: &[u8] = "\u{feff}".as_bytes();
/// Longest line, bytes: a problem of 11 + 11 robots needs 500; the remainder is for blanks. The bound keeps
/// an endless line from filling the memory.
pub(crate) const LINE_MAX: usize = 65_536;

#[cfg(test)]
mod tests {
    use super::*;

    const GOOD: &str = r#"{"ball":[1,2],"defending":"cyan","teammates":{},"opponents":[]}"#;

    /// "ok" or the error, one entry for each answered line.
    fn answers(input: &[u8]) -> Vec<String> {
        let mut output = Vec::new();
        for_each_problem(input, &mut output, |output, _, problem| {
            writeln!(output, "{}", problem.map_or_else(|error| error, |_| "ok".to_owned()))
        })
        .unwrap();
        String::from_utf8(output).unwrap().lines().map(str::to_owned).collect()
    }

    #[test]
    fn blank_lines_count_and_get_no_answer() {
        let input = format!("\n{GOOD}\n \t\r\n{{\n\n{GOOD}");
        assert_eq!(
            answers(input.as_bytes()),
            ["ok", "line 4: column 1: not JSON: EOF while parsing an object", "ok"]
        );
    }

    #[test]
    fn lines_may_end_as_on_windows_and_the_last_need_not_end() {
        assert_eq!(answers(format!("{GOOD}\r\n{GOOD}").as_bytes()), ["ok", "ok"]);
        assert_eq!(answers(format!("\u{feff}{GOOD}\r\n{GOOD}").as_bytes()), ["ok", "ok"]);
        assert!(answers(b"").is_empty());
    }

    #[test]
    fn bytes_that_are_no_text_spoil_only_their_line() {
        let input = [b"ab\xff\xfe\n", GOOD.as_bytes(), b"\n\x00\n"].concat();
        let answers = answers(&input);
        assert_eq!(answers[..2], ["line 1: column 3: not UTF-8", "ok"]);
        assert!(answers[2].starts_with("line 3: column 1: not JSON"), "{}", answers[2]);
    }

    #[test]
    fn an_endless_line_spoils_only_itself() {
        let fits = format!("{GOOD}{}", " ".repeat(LINE_MAX - GOOD.len()));
        let input = format!("{fits}\n{fits} \n{}\n{GOOD}\n", "x".repeat(10 * LINE_MAX));
        assert_eq!(
            answers(input.as_bytes()),
            ["ok", "line 2: longer than 65536 bytes", "line 3: longer than 65536 bytes", "ok"]
        );
    }

    #[test]
    fn an_answer_is_out_before_the_next_question_is_awaited() {
        /// Sends one line, then requires its answer before it sends the next.
        struct Dialogue<'a> {
            asked: usize,
            flushed: &'a std::cell::Cell<usize>,
        }
        impl Read for Dialogue<'_> {
            fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
                assert_eq!(self.flushed.get(), self.asked, "the answer is still held back");
                if self.asked == 3 {
                    return Ok(0);
                }
                self.asked += 1;
                buffer[..3].copy_from_slice(b"{}\n");
                Ok(3)
            }
        }
        struct Output<'a> {
            written: usize,
            flushed: &'a std::cell::Cell<usize>,
        }
        impl Write for Output<'_> {
            fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
                self.written += usize::from(bytes.ends_with(b"\n"));
                Ok(bytes.len())
            }
            fn flush(&mut self) -> io::Result<()> {
                self.flushed.set(self.written);
                Ok(())
            }
        }
        let flushed = std::cell::Cell::new(0);
        let mut output = Output { written: 0, flushed: &flushed };
        for_each_problem(Dialogue { asked: 0, flushed: &flushed }, &mut output, |output, _, _| {
            writeln!(output, "x")
        })
        .unwrap();
        assert_eq!(output.written, 3);
    }
}
