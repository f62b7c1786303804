//! `variant`: a case library in memory, changed or not, ready to be played.

use std::collections::BTreeSet;
use std::sync::Arc;

use arena::CaseNames;
use case_tools::{Files, Finding, Library, build, build_without_warnings};
use casebase::{CaseBase, Problem, RetrievalSettings, SettingError, retrieve_best};
use hil_sim::Fnv;

use crate::learning::edit::{Change, Edit, EditError};

/// A library and the files that it was built from.
#[derive(Clone, Debug)]
pub struct Variant {
    /// Files of the library.
    pub files: Files,
    library: Arc<Library>,
    /// The settings that robots retrieve with.
    pub settings: RetrievalSettings,
    /// Hash of its files' names and texts, and of settings that are not at their defaults.
    pub hash: u64,
}

/// Refusal of a library.
#[derive(Debug, thiserror::Error)]
pub enum VariantError {
    /// An edit does not fit the files.
    #[error(transparent)]
    Edit(EditError),
    /// The files are refused, with findings.
    #[error("the library is refused; correct it:{}", lines(.0))]
    Refused(Vec<Finding>),
}

fn lines(findings: &[Finding]) -> String {
    findings.iter().fold(String::new(), |text, finding| text + "\n  " + &finding.to_string())
}

/// Answer of retrieval: the case's name and symmetry, and the robots that play it.
pub type Answer = Option<(String, u16, Vec<u8>)>;

impl Variant {
    /// The library of these files; warnings are not computed.
    pub fn new(files: Files) -> Result<Self, VariantError> {
        Self::with_settings(files, RetrievalSettings::default())
    }

    fn with_settings(files: Files, settings: RetrievalSettings) -> Result<Self, VariantError> {
        let library = build_without_warnings(&files).map_err(VariantError::Refused)?;
        let mut hash = Fnv::default();
        for file in std::iter::once(&files.rules).chain(&files.cases) {
            for text in [&file.name, &file.text] {
                hash.add(&(text.len() as u64).to_le_bytes());
                hash.add(text.as_bytes());
            }
        }
        for line in changed(&settings) {
            hash.add(line.as_bytes());
        }
        Ok(Self { library: Arc::new(library), settings, hash: hash.value(), files })
    }

    /// The library after an edit.
    pub fn edited(&self, edit: &Edit) -> Result<Self, VariantError> {
        let files = edit.apply(&self.files).map_err(VariantError::Edit)?;
        let mut settings = self.settings.clone();
        if let Change::Setting(name, value) = &edit.change {
            let refused =
                |error: SettingError| EditError { case: edit.case.clone(), what: error.to_string() };
            settings.set(name, value).map_err(refused).map_err(VariantError::Edit)?;
        }
        Self::with_settings(files, settings)
    }

    /// Settings of retrieval that are not at their defaults, as `name=value`.
    pub fn changed_settings(&self) -> Vec<String> {
        changed(&self.settings)
    }

    /// Case base of the library.
    pub fn base(&self) -> CaseBase<'_> {
        self.library.base()
    }

    /// The same for the rest of the program, as hosts need it: the library is kept until its end.
    pub(crate) fn lasting_base(&self) -> CaseBase<'static> {
        let library: &'static Arc<Library> = Box::leak(Box::new(Arc::clone(&self.library)));
        library.base()
    }

    /// `region/name` of its cases, in the order of ids.
    pub fn names(&self) -> &[String] {
        &self.library.names
    }

    /// The same, for reports.
    pub fn case_names(&self) -> CaseNames {
        CaseNames::new(self.names().iter().cloned())
    }

    /// Retrieves as a robot would. Ids change with the number of files, names do not.
    pub fn answer(&self, base: &CaseBase<'_>, problem: &Problem) -> Answer {
        let found = retrieve_best(base, problem, &self.settings)?;
        let name = self.names().get(usize::from(found.case.0 / 4)).cloned().unwrap_or_default();
        let robots = found.correspondence.iter().map(|robot| robot.number()).collect();
        Some((name, found.case.0 % 4, robots))
    }

    /// Codes and files of the warnings of `cases check`.
    pub fn warnings(&self) -> Result<BTreeSet<(String, &'static str)>, VariantError> {
        let checked = build(&self.files).map_err(VariantError::Refused)?;
        let warning = |finding: &Finding| (finding.file.display().to_string(), finding.code);
        Ok(checked.findings.iter().map(warning).collect())
    }
}

fn changed(settings: &RetrievalSettings) -> Vec<String> {
    let defaults = RetrievalSettings::default();
    let both = settings.describe().zip(defaults.describe());
    both.filter(|(own, default)| own != default).map(|((name, value), _)| format!("{name}={value}")).collect()
}
