//! `workspace`: the repository's files and their lines, for tests that read the project itself.

mod manifest;
mod product;

use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};

pub use manifest::{Manifest, members};
pub use product::{Product, product, product_lines};

/// Path of the workspace.
pub fn root() -> PathBuf {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    here.parent().unwrap_or(here).to_path_buf()
}

/// Every Rust file of the repository.
pub fn rust_sources() -> Vec<Source> {
    files(&|path| path.extension().is_some_and(|extension| extension == "rs"))
}

/// Every file that is written by hand.
pub fn text_sources() -> Vec<Source> {
    files(&|path| {
        let extension = path.extension().and_then(|extension| extension.to_str());
        extension.is_some_and(|extension| TEXT.contains(&extension)) || path.ends_with(".ci/run")
    })
}

/// A file of the repository.
pub struct Source {
    /// From the workspace's root, with `/`.
    pub path: String,
    /// Whole text of the file.
    pub text: String,
}

/// A fault in a file, with its fix.
#[derive(Debug)]
pub struct Finding {
    /// The file, from the workspace's root.
    pub path: String,
    /// Number of the line, from 1.
    pub line: usize,
    what: String,
    hint: String,
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { path, line, what, hint } = self;
        write!(f, "{path}:{line}: {what}; {hint}")
    }
}

impl Source {
    /// Reads a file; panics where it does not exist.
    pub fn read(path: &Path) -> Self {
        let bytes = fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let relative = path.strip_prefix(root()).unwrap_or(path);
        let parts: Vec<_> = relative.iter().map(|part| part.to_string_lossy()).collect();
        Self { path: parts.join("/"), text: String::from_utf8_lossy(&bytes).into_owned() }
    }

    /// Whether it is code of one of the crates in these directories, and not a file of tests.
    pub fn is_under(&self, folders: &[String]) -> bool {
        // A crate nested in another one's directory is excluded: only files in `src` count.
        folders.iter().any(|directory| self.path.starts_with(&format!("{directory}/src/")))
            && !self.path.ends_with("/tests.rs")
    }

    /// Lines with their numbers, without comments and without a test module at the end.
    pub fn code(&self) -> impl Iterator<Item = (usize, &str)> {
        let lines: Vec<_> = self.text.lines().collect();
        let opens_tests = |at: usize| {
            let mut after = lines[at..].iter().skip_while(|line| line.starts_with("#["));
            let opens = after.next().is_some_and(|line| line.starts_with("mod ") && line.ends_with('{'));
            lines[at] == "#[cfg(test)]" && opens
        };
        let end = (0..lines.len()).find(|at| opens_tests(*at)).unwrap_or(lines.len());
        (1..)
            .zip(lines.into_iter().take(end))
            .map(|(number, line)| (number, line.split("//").next().unwrap_or("")))
    }

    /// Lines whose code has one of the patterns.
    pub fn code_with(&self, patterns: &[&str], hint: &str) -> Vec<Finding> {
        self.code().filter_map(|(number, line)| self.first_of(patterns, number, line, hint)).collect()
    }

    /// Lines that have one of the patterns, comments included.
    pub fn text_with(&self, patterns: &[&str], hint: &str) -> Vec<Finding> {
        (1..)
            .zip(self.text.lines())
            .filter_map(|(number, line)| self.first_of(patterns, number, line, hint))
            .collect()
    }

    fn first_of(&self, patterns: &[&str], number: usize, line: &str, hint: &str) -> Option<Finding> {
        let pattern = patterns.iter().find(|pattern| names(line, pattern))?;
        Some(self.at(number, &format!("`{pattern}`"), hint))
    }

    /// A finding in this file.
    pub fn at(&self, line: usize, what: &str, hint: &str) -> Finding {
        Finding { path: self.path.clone(), line, what: what.into(), hint: hint.into() }
    }
}

/// Whether the pattern occurs in the line as a name of its own, not as the tail of a longer name.
fn names(line: &str, pattern: &str) -> bool {
    let starts_label = pattern.starts_with(|first: char| first.is_alphanumeric());
    let is_tail = |at: usize| line[..at].ends_with(|before: char| before.is_alphanumeric() || before == '_');
    line.match_indices(pattern).any(|(at, _)| !(starts_label && is_tail(at)))
}

fn files(wanted: &dyn Fn(&Path) -> bool) -> Vec<Source> {
    let mut paths = Vec::new();
    walk(&root(), wanted, &mut paths);
    // The order of a directory's entries differs from machine to machine.
    paths.sort();
    paths.iter().map(|path| Source::read(path)).collect()
}

fn walk(directory: &Path, wanted: &dyn Fn(&Path) -> bool, paths: &mut Vec<PathBuf>) {
    for entry in
        fs::read_dir(directory).unwrap_or_else(|error| panic!("{}: {error}", directory.display())).flatten()
    {
        let path = entry.path();
        if path.is_dir() {
            // Cargo marks what it builds; git's own directory and results are no sources either.
            let built = path.join("CACHEDIR.TAG").exists() || path.ends_with(".git");
            if !built && !NO_SOURCES.iter().any(|name| root().join(name) == path) {
                walk(&path, wanted, paths);
            }
        } else if wanted(&path) {
            paths.push(path);
        }
    }
}

/// Extensions of files that are written by hand; everything else is data or generated.
const TEXT: [&str; 7] = ["rs", "js", "toml", "md", "sh", "svg", "txt"];
/// Directories that git ignores.
const NO_SOURCES: [&str; 2] = ["target", "out"];
