//! `files`: the files of a league's library. `league.toml` and `<region>/<name>.toml`
//! (docs/case-format.md §1).

use std::fs;
use std::path::{Path, PathBuf};

use crate::codes::code;
use foreign::{Finding, Severity};

/// A file of a library, read.
#[derive(Clone, Debug)]
pub struct SourceFile {
    /// Path as in findings.
    pub path: PathBuf,
    /// Path in the library, with `/`, without `.toml`.
    pub name: String,
    /// Whole text of the file, TOML.
    pub text: String,
}

impl SourceFile {
    fn new(directory: &Path, name: &str, text: &str) -> Self {
        let path = directory.join(format!("{name}.toml"));
        Self { path, name: name.to_owned(), text: text.to_owned() }
    }

    /// The line, from 1, of a byte of the text.
    pub(crate) fn line(&self, at: usize) -> u32 {
        self.text.bytes().take(at).filter(|byte| *byte == b'\n').count() as u32 + 1
    }

    /// The line of a byte of the text.
    pub(crate) fn place(&self, at: usize) -> SourcePlace {
        SourcePlace { file: self.path.clone(), line: self.line(at) }
    }

    pub(crate) fn finding(
        &self,
        severity: Severity,
        code: &'static str,
        line: u32,
        message: impl Into<String>,
        hint: impl Into<String>,
    ) -> Finding {
        Finding { code, severity, file: self.path.clone(), line, message: message.into(), hint: hint.into() }
    }
}

/// A line of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SourcePlace {
    /// Path of the file.
    pub file: PathBuf,
    /// Line in the file, from 1.
    pub line: u32,
}

/// The files of one league.
#[derive(Clone, Debug)]
pub struct Files {
    /// The league's name: that of its directory.
    pub league: String,
    /// The file `league.toml`, with its text.
    pub rules: SourceFile,
    /// The case files, ordered by the bytes of their names: this order is their ids.
    pub cases: Vec<SourceFile>,
}

impl Files {
    /// Reads a league's directory.
    pub fn read(directory: &Path) -> Result<Self, Vec<Finding>> {
        let mut found = Found::default();
        found.enter(directory, "", 0);
        let at = found.cases.iter().position(|file| file.name == LEAGUE);
        let rules = at.map(|at| found.cases.remove(at));
        if rules.is_none() && !found.league_unreadable {
            let message = "the library has no league.toml";
            let hint = "add one with [field], [pass] and [kicks.KIND], and name one league's directory";
            found.error(code::NO_LEAGUE, directory.join("league.toml"), message, hint);
        }
        let Some(rules) = rules.filter(|_| found.findings.is_empty()) else {
            found.findings.sort_by(|a, b| a.file.cmp(&b.file));
            return Err(found.findings);
        };
        let absolute = directory.canonicalize().unwrap_or_else(|_| directory.to_owned());
        let league = absolute.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        Ok(Self { league, rules, cases: found.cases }.sorted())
    }

    /// Files from memory: `cases` as pairs of `region/name` and text.
    pub fn from_texts(league: &str, rules: &str, cases: &[(&str, &str)]) -> Self {
        let directory = Path::new(league);
        let cases = cases.iter().map(|(name, text)| SourceFile::new(directory, name, text)).collect();
        let rules = SourceFile::new(directory, LEAGUE, rules);
        Self { league: league.to_owned(), rules, cases }.sorted()
    }

    /// The same files with this text as that of the case `name`, which is added where there is none.
    pub fn with(&self, name: &str, text: &str) -> Self {
        let mut files = self.clone();
        let directory = self.rules.path.parent().unwrap_or(Path::new(""));
        let file = SourceFile::new(directory, name, text);
        files.cases.retain(|case| case.name != name);
        files.cases.push(file);
        files.sorted()
    }

    /// The same files without the case `name`.
    pub fn without(&self, name: &str) -> Self {
        let mut files = self.clone();
        files.cases.retain(|case| case.name != name);
        files
    }

    fn sorted(mut self) -> Self {
        self.cases.sort_by(|a, b| a.name.as_bytes().cmp(b.name.as_bytes()));
        self
    }
}

/// Results so far; `league.toml` among the cases.
#[derive(Default)]
struct Found {
    cases: Vec<SourceFile>,
    findings: Vec<Finding>,
    league_unreadable: bool,
}

impl Found {
    /// Reads a directory, `depth` levels below the library's; `prefix` is its path with a `/` at the end.
    fn enter(&mut self, directory: &Path, prefix: &str, depth: usize) {
        let entries = match fs::read_dir(directory).and_then(Iterator::collect::<Result<Vec<_>, _>>) {
            Ok(entries) => entries,
            Err(error) => {
                let message = format!("the directory cannot be read: {error}");
                return self.error(
                    code::UNREADABLE,
                    directory.to_owned(),
                    message,
                    "make it a readable directory",
                );
            }
        };
        for entry in entries {
            let path = entry.path();
            let file_name = entry.file_name();
            let name = file_name.to_string_lossy();
            // An editor's lock (`.#one.toml`), what other systems keep beside a file (`._one.toml`), `.git`.
            if name.starts_with('.') {
                continue;
            }
            if path.is_dir() {
                if depth < DEPTH_MAX {
                    self.enter(&path, &format!("{prefix}{name}/"), depth + 1);
                }
            } else if let Some(stem) = without_ending(&name) {
                if foreign::printable(&name) != name {
                    let message = "a file's name has characters that cannot be shown";
                    self.error(code::MISPLACED, path, message, "rename it: letters, digits and dashes");
                    continue;
                }
                let is_league = depth == 0 && stem.eq_ignore_ascii_case(LEAGUE);
                let stem = if is_league { LEAGUE } else { stem };
                let case = format!("{prefix}{stem}");
                if self.cases.iter().any(|file| file.name == case) {
                    let message = format!("{case} has two files, whose endings differ");
                    self.error(code::MISPLACED, path, message, "keep the one that ends in .toml");
                } else if is_league || depth == 1 {
                    self.read(path, case, is_league);
                } else {
                    let message = format!("{prefix}{name} is not at <region>/<name>.toml");
                    let hint = "move it into the directory of its region, right below league.toml";
                    self.error(code::MISPLACED, path, message, hint);
                }
            }
        }
    }

    fn read(&mut self, path: PathBuf, name: String, is_league: bool) {
        match foreign::read_text(&path, CASE_FILE_LEN_MAX) {
            Ok(text) => self.cases.push(SourceFile { path, name, text }),
            Err(error) => {
                self.league_unreadable |= is_league;
                let message = format!("the file cannot be read: {error}");
                self.error(code::UNREADABLE, path, message, "make it a readable text file in UTF-8");
            }
        }
    }

    fn error(&mut self, code: &'static str, file: PathBuf, message: impl Into<String>, hint: &str) {
        let (message, hint) = (message.into(), hint.to_owned());
        self.findings.push(Finding { code, severity: Severity::Error, file, line: 1, message, hint });
    }
}

/// The name without `.toml`, in upper or lower case.
fn without_ending(name: &str) -> Option<&str> {
    let (stem, ending) = name.split_at_checked(name.len().checked_sub(ENDING.len())?)?;
    (ending.eq_ignore_ascii_case(ENDING) && !stem.is_empty()).then_some(stem)
}

/// Ending of every file of a library.
const ENDING: &str = ".toml";
/// The league's own file, without `.toml`.
const LEAGUE: &str = "league";
/// Maximum length of a library file, bytes: the longest case of ours has 3 kB.
pub const CASE_FILE_LEN_MAX: u64 = 1 << 20;
/// Maximum depth at which misplaced files are searched; also ends a cycle of links.
const DEPTH_MAX: usize = 8;
