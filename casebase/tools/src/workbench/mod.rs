//! `workbench`: a case file that a person edits step by step: changes of its text, and what is to be shown of
//! it after each. No input or output: text in, text and data out.
//!
//! The text is the one truth: an [`Edit`] changes it and nothing else of it, a [`Sheet`] is worked out from
//! it again, and undo is an earlier text.

mod action_text;
mod aim;
mod case_text;
mod edit;
mod edit_error;
mod follow;
mod part;
mod sheet;

use std::path::Path;

use casebase::Symmetry;

use crate::authored::Authored;
use crate::files::Files;
use crate::league::CaseLeague;
use crate::library::{Library, build};
use foreign::Finding;

pub use action_text::{ActionText, TurnText};
pub use case_text::CaseText;
pub use edit::Edit;
pub use edit_error::EditError;
pub use part::Part;
pub use sheet::{CopySheet, FindingNote, LegSheet, PlacedOpponent, PlacedRobot, RobotSheet, Scoped, Sheet};

/// Longest name of a case, bytes.
const NAME_MAX: usize = 80;

/// A league's case files, of which one is edited.
#[derive(Clone, Debug)]
pub struct Workbench {
    files: Files,
    league: CaseLeague,
    /// Findings before anything was edited.
    findings: Vec<Finding>,
}

impl Workbench {
    /// On these files; the findings where they are refused.
    pub fn new(files: Files) -> Result<Self, Vec<Finding>> {
        let findings = build(&files)?.findings;
        let (league, refused) = CaseLeague::read(&files.rules);
        Ok(Self { files, league: league.ok_or(refused)?, findings })
    }

    /// Files of the library as they were read.
    pub fn files(&self) -> &Files {
        &self.files
    }

    /// Rules of the library's league.
    pub fn league(&self) -> &CaseLeague {
        &self.league
    }

    /// The library with this text as that of the case `name`; the findings where it is refused.
    pub fn library(&self, name: &str, text: &str) -> Result<Library, Vec<Finding>> {
        build(&self.files.with(name, text))
    }

    /// The text after a change that was made in a symmetric copy.
    pub fn edited(
        &self,
        name: &str,
        text: &str,
        edit: Edit,
        symmetry: Symmetry,
    ) -> Result<String, EditError> {
        let edit = edit.under(symmetry);
        let edit =
            self.case(name, text).and_then(|case| aim::aimed(&case, &self.league, &edit)).unwrap_or(edit);
        edit.apply(text)
    }

    /// Returns whether a finding stands in the library's files as they are, on whatever line.
    fn is_known(&self, finding: &Finding) -> bool {
        let Finding { file, code, message, .. } = finding;
        self.findings.iter().any(|old| (&old.file, &old.code, &old.message) == (file, code, message))
    }

    /// The sheet of a case's text: findings, robots with their actions, and copies.
    pub fn sheet(&self, name: &str, text: &str) -> Sheet {
        let files = self.files.with(name, text);
        let found = match build(&files) {
            Ok(library) => library.findings,
            Err(findings) => findings,
        };
        let own = |finding: &&Finding| case_name(&finding.file) == name;
        let case = self.case(name, text);
        Sheet {
            name: name.to_owned(),
            text: text.to_owned(),
            intent: case.as_ref().map(|case| case.intent.clone()).unwrap_or_default(),
            findings: found.iter().filter(own).map(FindingNote::of).collect(),
            elsewhere: found.iter().filter(|f| !own(f) && !self.is_known(f)).map(FindingNote::of).collect(),
            robots: case.as_ref().map_or_else(Vec::new, |case| sheet::robots(case, &self.league)),
            copies: case.as_ref().map_or_else(Vec::new, |case| sheet::copies(case, &self.league)),
        }
    }

    fn case(&self, name: &str, text: &str) -> Option<Authored> {
        let files = Files::from_texts("", "", &[(name, text)]);
        Authored::read(files.cases.first()?, Some(&self.league)).0
    }
}

/// `region/name` of a case file's path.
pub fn case_name(file: &Path) -> String {
    let stem = file.with_extension("");
    let parts: Vec<_> = stem.iter().map(|part| part.to_string_lossy()).collect();
    parts[parts.len().saturating_sub(2)..].join("/")
}

/// Returns whether a case may have this name: `region/name` of letters, digits, `-` and `_`.
pub fn is_case_name(name: &str) -> bool {
    let plain =
        |part: &str| !part.is_empty() && part.chars().all(|c| c.is_ascii_alphanumeric() || "-_".contains(c));
    name.len() <= NAME_MAX && name.split_once('/').is_some_and(|(region, name)| plain(region) && plain(name))
}

#[cfg(test)]
mod tests;
