//! `explanations`: answers to the page's questions about cases, by the same code as `onetwo cases explain`.

use casebase::RetrievalSettings;

use crate::args::Chosen;
use crate::cases;
use crate::library::LibraryHandle;

/// A library, with settings of retrieval.
pub(crate) struct CaseExplanations {
    library_handle: Option<LibraryHandle>,
    chosen: Chosen,
}

impl CaseExplanations {
    /// Over a library, where there is one.
    pub(crate) fn new(library_handle: Option<LibraryHandle>, settings: RetrievalSettings) -> Self {
        Self { library_handle, chosen: Chosen { settings, changed: Vec::new() } }
    }
}

impl page::ExplanationService for CaseExplanations {
    fn explain(&self, problem: &str) -> Result<String, String> {
        let library_handle = self.library_handle.as_ref().ok_or("no cases are played here")?;
        cases::explained(library_handle, &self.chosen, problem)
    }

    fn situations(&self) -> Vec<String> {
        self.library_handle.as_ref().map_or_else(Vec::new, LibraryHandle::names)
    }
}
