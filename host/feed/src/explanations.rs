//! `explanations`: answers to the page's questions about cases, by the same code as `onetwo cases explain`,
//! and its case workbench.

use arena::cases::{Chosen, LibraryHandle, explained_by};
use casebase::RetrievalSettings;
use page::WorkbenchRequest;

use crate::MomentSource;
use crate::workbench::{CaseWorkbench, SharedLibrary};

/// A library, with settings of retrieval.
pub struct CaseExplanations {
    library: SharedLibrary,
    chosen: Chosen,
    workbench: CaseWorkbench,
}

impl CaseExplanations {
    /// Over a library, where there is one.
    pub fn new(library_handle: Option<LibraryHandle>, settings: RetrievalSettings) -> Self {
        Self::sharing(SharedLibrary::new(library_handle), settings)
    }

    /// Over the library of one match after the other.
    pub fn sharing(library: SharedLibrary, settings: RetrievalSettings) -> Self {
        let workbench = CaseWorkbench::new(library.clone(), settings.clone());
        Self { library, chosen: Chosen { settings, changed: Vec::new() }, workbench }
    }

    /// The same, and the page plays on from moments of this source.
    #[must_use]
    pub fn playing_on(mut self, moments: MomentSource) -> Self {
        self.workbench.moments = Some(moments);
        self
    }
}

impl page::ExplanationService for CaseExplanations {
    fn explain(&self, problem: &str) -> Result<String, String> {
        let library_handle = self.library.now().ok_or("no cases are played here")?;
        explained(&library_handle, &self.chosen, problem)
    }

    fn workbench(&self, request: &WorkbenchRequest) -> Result<String, String> {
        self.workbench.answer(request)
    }

    fn situations(&self) -> Vec<String> {
        self.library.now().map_or_else(Vec::new, |library_handle| library_handle.names())
    }
}

/// The explanation of a problem in the form of `onetwo cases explain --json`; or the error in the problem.
pub fn explained(library_handle: &LibraryHandle, chosen: &Chosen, line: &str) -> Result<String, String> {
    explained_by(&library_handle.base(), &|id| library_handle.name(id), chosen, line)
}
