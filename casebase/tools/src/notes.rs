//! `notes`: the warnings about one file, as the checks of cases collect them.

use std::ops::Range;

use crate::files::SourceFile;
use foreign::{Finding, Severity};

/// Collects the warnings about one file.
pub(crate) struct Notes<'n> {
    pub(crate) file: &'n SourceFile,
    pub(crate) findings: &'n mut Vec<Finding>,
}

impl Notes<'_> {
    pub(crate) fn add(
        &mut self,
        code: &'static str,
        at: &Range<usize>,
        message: impl Into<String>,
        hint: &str,
    ) {
        let line = self.file.line(at.start);
        self.findings.push(self.file.finding(Severity::Warning, code, line, message, hint));
    }
}
