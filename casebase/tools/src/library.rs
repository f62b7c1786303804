//! `library`: loading and checking of a league's library. From its files to a checked table
//! (docs/case-format.md §1–§3).

use std::path::Path;

use casebase::CaseBase;
use casebase::table::TableError;

use crate::authored::Authored;
use crate::check::errors;
use crate::codes::code;
use crate::encode::{Table, encode};
use crate::files::{Files, SourcePlace};
use crate::league::CaseLeague;
use crate::lineup::Lineup;
use crate::sample::Sampler;
use foreign::{Finding, Severity};

/// One league's cases, checked, mirrored and encoded. Lists have one entry per authored case, in the order of
/// ids.
#[derive(Clone, Debug)]
pub struct Library {
    /// The league's name: that of its directory.
    pub league: String,
    /// The table for robots.
    pub table: Table,
    /// `region/name` of every authored case.
    pub names: Vec<String>,
    /// The intent of each case, in its author's text.
    pub intents: Vec<String>,
    /// The text of each case file.
    pub sources: Vec<String>,
    /// File and line of each case's ball position.
    pub balls: Vec<SourcePlace>,
    /// The names of the kick kinds, by [`casebase::KickId`].
    pub kicks: Vec<String>,
    /// Areas of the robots in the problems drawn for it.
    pub lineup: Lineup,
    /// Warnings of a library that is accepted; no errors among them.
    pub findings: Vec<Finding>,
}

/// Reads one league's directory; returns the findings, with at least one error among them, where it is
/// refused.
pub fn load(directory: &Path) -> Result<Library, Vec<Finding>> {
    load_with_progress(directory, |_, _| {})
}

/// The same; `on_progress` is called with the number of completed steps and the total: two a case file.
pub fn load_with_progress(
    directory: &Path,
    on_progress: impl FnMut(usize, usize),
) -> Result<Library, Vec<Finding>> {
    build_with(&Files::read(directory)?, BuildOptions::FULL, on_progress)
}

#[derive(Clone, Copy)]
struct BuildOptions {
    /// Parts of the cases that are kept.
    reduction: Reduction,
    /// Search for warnings, which takes most of the time.
    warnings: bool,
}

impl BuildOptions {
    /// Whole cases, with warnings.
    const FULL: Self = Self { reduction: Reduction::NONE, warnings: true };
}

/// Parts of its cases that a library keeps: for measuring the value of each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reduction {
    /// Mirrored copies (paper §2.4); without them only authored cases are ever found, under their own ids.
    pub symmetry: bool,
    /// Opponents and their scopes (paper §2.1).
    pub opponents: bool,
}

impl Reduction {
    /// No reduction: every case whole, with its symmetric copies.
    pub const NONE: Self = Self { symmetry: true, opponents: true };
}

/// The library of files that were read, with these parts of its cases alone; without warnings about the
/// reduced cases.
pub fn build_reduced(files: &Files, reduction: Reduction) -> Result<Library, Vec<Finding>> {
    build_with(files, BuildOptions { reduction, warnings: false }, |_, _| {})
}

/// The library of files that were read; without warnings, which take most of the time.
pub fn build_without_warnings(files: &Files) -> Result<Library, Vec<Finding>> {
    build_with(files, BuildOptions { reduction: Reduction::NONE, warnings: false }, |_, _| {})
}

/// The library of files that were read.
pub fn build(files: &Files) -> Result<Library, Vec<Finding>> {
    build_with(files, BuildOptions::FULL, |_, _| {})
}

fn build_with(
    files: &Files,
    BuildOptions { reduction, warnings }: BuildOptions,
    mut on_progress: impl FnMut(usize, usize),
) -> Result<Library, Vec<Finding>> {
    let steps = 2 * files.cases.len();
    let (league, mut findings) = CaseLeague::read(&files.rules);
    let mut cases = Vec::new();
    for (done, file) in files.cases.iter().enumerate() {
        on_progress(done, steps);
        let (case, read) = Authored::read(file, league.as_ref());
        findings.extend(read);
        if let (Some(case), Some(league)) = (case, &league) {
            findings.extend(errors(file, &case, league));
            cases.push(case);
        }
    }
    if files.cases.len() > CASES_MAX {
        let message = format!("{} cases, at most {CASES_MAX} can be numbered", files.cases.len());
        let hint = "split the league, or take cases out";
        findings.push(files.rules.finding(Severity::Error, code::TOO_MANY_CASES, 1, message, hint));
    }
    let Some(league) = league.filter(|_| findings.iter().all(|finding| finding.severity != Severity::Error))
    else {
        return Err(in_order(findings));
    };
    if !reduction.opponents {
        for case in &mut cases {
            case.opponents.clear();
        }
    }
    let largest = cases.iter().map(|case| case.teammates.len()).max().unwrap_or(0);
    let table = encode(&league, &cases, reduction.symmetry);
    let mut library = Library {
        league: files.league.clone(),
        table,
        names: files.cases.iter().map(|file| file.name.clone()).collect(),
        intents: cases.iter().map(|case| case.intent.clone()).collect(),
        sources: files.cases.iter().map(|file| file.text.clone()).collect(),
        balls: files.cases.iter().zip(&cases).map(|(file, case)| file.place(case.ball_span.start)).collect(),
        kicks: league.kicks.iter().map(|(name, _)| name.clone()).collect(),
        lineup: league.lineup.clone().unwrap_or_else(|| Lineup::guess(league.field, largest)),
        findings,
    };
    if warnings {
        let found = crate::warnings::warnings(files, &cases, &library.base(), &league, |done| {
            on_progress(files.cases.len() + done, steps);
        });
        library.note(found);
    }
    Ok(library)
}

impl Library {
    /// The case base over the table.
    pub fn base(&self) -> CaseBase<'_> {
        // The table was encoded by this crate; a refusal by its reader is a defect here, and every test would
        // detect it.
        self.read()
            .unwrap_or_else(|error| panic!("the table built from {} cannot be read: {error}", self.league))
    }

    /// The problems of `seed` that are drawn for this library.
    pub fn sampler(&self, seed: u64) -> Sampler {
        Sampler::new(self.lineup.clone(), self.base().field(), seed)
    }

    /// Adds findings, in the order of files and lines.
    pub fn note(&mut self, more: Vec<Finding>) {
        self.findings = in_order([std::mem::take(&mut self.findings), more].concat());
    }

    fn read(&self) -> Result<CaseBase<'_>, TableError> {
        CaseBase::from_bytes(self.table.bytes())
    }
}

fn in_order(mut findings: Vec<Finding>) -> Vec<Finding> {
    findings.sort_by(|a, b| (&a.file, a.line, a.severity).cmp(&(&b.file, b.line, b.severity)));
    findings
}

/// Maximum number of authored cases of a league: the ids of their copies have 16 bits.
const CASES_MAX: usize = (u16::MAX as usize + 1) / 4;
