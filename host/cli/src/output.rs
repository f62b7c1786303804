//! `output`: everything that is printed, on stdout and stderr. Control characters of a terminal are escaped,
//! from any source: a referee's program, a log file, a file's name.
//!
//! Line ends and tabs pass, because they are the program's own; a foreign value that is put into a line goes
//! through [`foreign::printable`] first, so that it cannot end the line. Nothing else in this crate prints (a
//! test checks this).

use std::borrow::Cow;
use std::env;
use std::fmt::{Arguments, Display};
use std::io::{self, BufWriter, IsTerminal as _, StdoutLock, Write};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};

use clap::ValueEnum;

use foreign::Printable;
use page::{LogLevel, ProgramLog};
use serde::Serialize;

use crate::Failure;

/// Whether messages on stderr are coloured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ColorChoice {
    /// On a terminal, unless `NO_COLOR` is set or `TERM` is `dumb`.
    Auto,
    /// Into files and pipes, too.
    Always,
    /// Nowhere.
    Never,
}

/// Set once, before anything is printed.
static COLOURED: AtomicBool = AtomicBool::new(false);

impl ColorChoice {
    /// Colours messages from now on, or does not.
    pub(crate) fn apply(self) {
        let set = |name: &str| env::var_os(name).filter(|value| !value.is_empty());
        let coloured = self.colours(
            io::stderr().is_terminal(),
            set("NO_COLOR").is_some(),
            set("TERM").is_some_and(|value| value == "dumb"),
        );
        COLOURED.store(coloured, Ordering::Relaxed);
    }

    fn colours(self, terminal: bool, no_color: bool, dumb: bool) -> bool {
        match self {
            Self::Auto => terminal && !no_color && !dumb,
            Self::Always => true,
            Self::Never => false,
        }
    }
}

/// Prints what failed, on stderr, after the word `error:`, which is red and bold where messages are coloured.
pub(crate) fn print_error(error: &dyn Display) {
    let (on, off) = if COLOURED.load(Ordering::Relaxed) { ("\u{1b}[1;31m", "\u{1b}[0m") } else { ("", "") };
    program_log().add(LogLevel::Error, "program", None, &format!("error: {error}"));
    let mut raw = io::stderr().lock();
    let _ = write!(raw, "{on}error:{off} ");
    let _ = writeln!(Printable::new(raw), "{error}");
}

/// Stdout for many lines; it has to be flushed.
pub(crate) fn lines() -> BufWriter<Printable<StdoutLock<'static>>> {
    BufWriter::new(Printable::new(io::stdout().lock()))
}

/// Prints on stdout, whole or not at all; a reader that closed it has read enough.
pub(crate) fn print_text(text: &str) -> Result<(), Failure> {
    let mut out = Printable::new(io::stdout().lock());
    out.write_all(text.as_bytes()).and_then(|()| out.flush()).map_err(Failure::Output)
}

pub(crate) fn json_line(value: &impl Serialize) -> Result<String, Failure> {
    serde_json::to_string(value).map(|text| text + "\n").map_err(|error| Failure::Output(error.into()))
}

/// Log of everything printed on stderr, for the page: there is one stderr, and one log of it.
pub(crate) fn program_log() -> Arc<ProgramLog> {
    static LOG: OnceLock<Arc<ProgramLog>> = OnceLock::new();
    LOG.get_or_init(Arc::default).clone()
}

/// The level that a line on stderr tells by its first word.
fn level(line: &str) -> LogLevel {
    let first = line.split([':', ' ']).next().unwrap_or_default();
    match first {
        "error" => LogLevel::Error,
        "warning" => LogLevel::Warning,
        _ => LogLevel::Note,
    }
}

/// Prints a line on stderr, and keeps it in the program's log. If stderr is closed the line is only kept.
pub(crate) fn print_aside(text: Arguments<'_>) {
    let line = text.to_string();
    program_log().add(level(&line), "program", None, &line);
    print_secret(text);
}

/// Prints a line on stderr that no viewer of the page may read: it has the page's token.
pub(crate) fn print_secret(line: Arguments<'_>) {
    let mut out = Printable::new(io::stderr().lock());
    let _ = writeln!(out, "{line}");
}

/// Prints a line on stderr, as `eprintln!` would.
macro_rules! note {
    ($($text:tt)*) => { $crate::output::print_aside(format_args!($($text)*)) };
}
pub(crate) use note;

/// A word of a command line as a shell takes it.
pub(crate) fn quoted(word: &str) -> Cow<'_, str> {
    if !word.is_empty() && word.chars().all(|c| c.is_alphanumeric() || "_-./:=,+@%".contains(c)) {
        return Cow::Borrowed(word);
    }
    Cow::Owned(format!("'{}'", word.replace('\'', r"'\''")))
}

pub(crate) use foreign::printable_path;

#[cfg(test)]
mod tests {
    use std::fs;
    use std::path::{Path, PathBuf};

    use super::*;

    #[test]
    fn colours_are_for_terminals_that_want_them() {
        assert!(ColorChoice::Auto.colours(true, false, false));
        assert!(!ColorChoice::Auto.colours(false, false, false), "a pipe");
        assert!(!ColorChoice::Auto.colours(true, true, false), "NO_COLOR");
        assert!(!ColorChoice::Auto.colours(true, false, true), "TERM=dumb");
        assert!(ColorChoice::Always.colours(false, true, true));
        assert!(!ColorChoice::Never.colours(true, false, false));
    }

    #[test]
    fn a_word_is_quoted_where_a_shell_would_read_it_otherwise() {
        for (word, expected) in [
            ("out/my-lib", "out/my-lib"),
            ("thr_c=1200", "thr_c=1200"),
            ("my lib", "'my lib'"),
            ("it's", r"'it'\''s'"),
            ("$HOME", "'$HOME'"),
            ("", "''"),
        ] {
            assert_eq!(quoted(word), expected);
        }
    }

    #[test]
    fn a_file_s_name_stays_within_its_line() {
        let name = printable_path(Path::new("a\u{1b}]0;pwn\u{7}\n0.00 s  GOAL"));
        assert_eq!(name, "a\\u001b]0;pwn\\u0007\\n0.00 s  GOAL");
    }

    #[test]
    fn a_secret_is_not_kept_for_viewers_and_a_warning_is_one() {
        super::print_secret(format_args!("page     http://host/?token=0123"));
        super::note!("warning: the disk is slow");
        let kept = super::program_log().from(0);
        assert!(kept.iter().all(|entry| !entry.text.contains("token=")));
        let warning = kept.iter().find(|entry| entry.text == "warning: the disk is slow");
        assert_eq!(warning.map(|entry| entry.level), Some(page::LogLevel::Warning));
    }

    fn sources(directory: &Path, into: &mut Vec<PathBuf>) {
        for entry in fs::read_dir(directory).unwrap().map(|entry| entry.unwrap().path()) {
            if entry.is_dir() {
                sources(&entry, into);
            } else if entry.extension().is_some_and(|extension| extension == "rs") {
                into.push(entry);
            }
        }
    }

    #[test]
    fn nothing_else_prints() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
        let mut files = Vec::new();
        sources(&root, &mut files);
        assert!(files.len() > 50, "{}", root.display());
        let prints = ["println!(", "print!(", "io::stdout()", " stdout()", "io::stderr()", "&mut stdout()"];
        for file in
            files.iter().filter(|file| !["output.rs", "progress.rs"].iter().any(|own| file.ends_with(own)))
        {
            for (number, line) in (1..).zip(fs::read_to_string(file).unwrap().lines()) {
                let found =
                    prints.iter().find(|print| line.contains(*print) && !line.contains("is_terminal"));
                assert_eq!(
                    found,
                    None,
                    "{}:{number}: use `note!`, `say` or `lines` of output.rs",
                    file.display()
                );
            }
        }
    }
}
