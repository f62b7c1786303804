//! `state`: what a soak keeps in its directory: per target the next number, counts and corpus; findings.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{fs, io};

use super::{Labels, Target};

/// A target's progress, in the file `NAME.txt`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Progress {
    /// Number of the next recipe.
    pub next: u64,
    /// Executions so far.
    pub executions: u64,
    /// Thread seconds so far.
    pub seconds: f64,
    /// Findings so far.
    pub findings: u64,
    /// Every label, with the recipe that showed it first.
    pub corpus: BTreeMap<String, Vec<u64>>,
}

impl Progress {
    /// The recipe of a number: its own seed, or every other time a recipe of the corpus continued by it.
    pub fn recipe(&self, number: u64) -> Vec<u64> {
        let kept = self.corpus.values().nth((number / 2) as usize % self.corpus.len().max(1));
        let mut recipe =
            kept.filter(|kept| number % 2 == 1 && kept.len() < RECIPE_LEN_MAX).cloned().unwrap_or_default();
        recipe.push(number);
        recipe
    }

    /// Adds what a recipe showed.
    pub fn add(&mut self, recipe: &[u64], labels: Labels) {
        for label in labels {
            if self.corpus.len() < LABELS_MAX {
                self.corpus.entry(label).or_insert_with(|| recipe.to_vec());
            }
        }
    }

    /// Reads a target's progress; the start where there is no file.
    ///
    /// # Errors
    /// A file that cannot be read, or a line that is none of it.
    pub fn read(directory: &Path, target: &Target) -> io::Result<Self> {
        let file = file(directory, target);
        let text = match fs::read_to_string(&file) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Self::default()),
            read => read?,
        };
        let damaged = || io::Error::other(format!("{}: a line is damaged; remove the file", file.display()));
        Self::parse(&text).ok_or_else(damaged)
    }

    fn parse(text: &str) -> Option<Self> {
        let mut lines = text.lines();
        let mut counts = lines.next()?.split(' ');
        let mut count = || counts.next()?.parse::<u64>().ok();
        let (next, executions, findings) = (count()?, count()?, count()?);
        let seconds = counts.next()?.parse().ok()?;
        let entry =
            |line: &str| Some((line.split_once('\t')?.1.to_owned(), recipe(line.split_once('\t')?.0)?));
        Some(Self { next, executions, seconds, findings, corpus: lines.map(entry).collect::<Option<_>>()? })
    }

    /// Writes it, whole or not at all.
    pub fn write(&self, directory: &Path, target: &Target) -> io::Result<()> {
        let mut text = format!("{} {} {} {:.1}\n", self.next, self.executions, self.findings, self.seconds);
        for (label, recipe) in &self.corpus {
            // Writing to a String cannot fail.
            let _ = writeln!(text, "{}\t{label}", written(recipe));
        }
        let (file, new) = (file(directory, target), directory.join("new"));
        fs::create_dir_all(directory)?;
        fs::write(&new, text)?;
        fs::rename(new, file)
    }
}

fn file(directory: &Path, target: &Target) -> PathBuf {
    directory.join(target.name).with_extension("txt")
}

/// A recipe as it is written: seeds with commas between.
pub fn written(recipe: &[u64]) -> String {
    recipe.iter().map(u64::to_string).collect::<Vec<_>>().join(",")
}

/// A recipe of a text.
pub fn recipe(text: &str) -> Option<Vec<u64>> {
    text.split(',').map(|seed| seed.parse().ok()).collect()
}

/// Keeps a finding: what was violated, and the line that repeats it.
pub fn keep(directory: &Path, target: &Target, recipe: &[u64], what: &str) -> io::Result<PathBuf> {
    let findings = directory.join("findings");
    fs::create_dir_all(&findings)?;
    let (name, recipe) = (target.name, written(recipe));
    let file = findings.join(format!("{name}-{}.txt", recipe.rsplit(',').next().unwrap_or_default()));
    fs::write(&file, format!("{what}\nrepeat: cargo xtask soak --repeat {name}:{recipe}\n"))?;
    Ok(file)
}

/// Longest recipe, seeds: later ones would play the same disorder.
const RECIPE_LEN_MAX: usize = 12;
/// Most labels of a target; beyond they are noise.
const LABELS_MAX: usize = 20_000;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::soak::TARGETS;

    #[test]
    fn progress_goes_on_where_it_was_written() {
        let directory = std::env::temp_dir().join(format!("onetwo-soak-{}", std::process::id()));
        let mut progress =
            Progress { next: 7, executions: 9, seconds: 1.5, findings: 1, ..Progress::default() };
        progress.add(&[4, 5], Labels::from(["phase Stop ".to_owned(), "b\u{e9}".to_owned()]));
        progress.add(&[6], Labels::from(["phase Stop ".to_owned()]));
        assert_eq!(Progress::read(&directory, &TARGETS[0]).unwrap(), Progress::default());
        progress.write(&directory, &TARGETS[0]).unwrap();
        assert_eq!(Progress::read(&directory, &TARGETS[0]).unwrap(), progress);
        assert_eq!((progress.recipe(8), progress.recipe(9)), (vec![8], vec![4, 5, 9]));
        let kept = keep(&directory, &TARGETS[0], &[4, 9], "a panic").unwrap();
        assert!(fs::read_to_string(kept).unwrap().ends_with("--repeat host:4,9\n"));
        fs::remove_dir_all(directory).unwrap();
    }
}
