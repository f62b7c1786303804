//! `oracle`: answers to the page's questions about cases, by the same code as `onetwo cases explain`.

use casebase::Settings;

use crate::args::Chosen;
use crate::cases;
use crate::library::Shelf;

/// A library, with settings of retrieval.
pub(crate) struct CaseOracle {
    shelf: Option<Shelf>,
    chosen: Chosen,
}

impl CaseOracle {
    /// Over a library, where there is one.
    pub(crate) fn new(shelf: Option<Shelf>, settings: Settings) -> Self {
        Self { shelf, chosen: Chosen { settings, changed: Vec::new() } }
    }
}

impl page::Oracle for CaseOracle {
    fn explain(&self, problem: &str) -> Result<String, String> {
        let shelf = self.shelf.as_ref().ok_or("no cases are played here")?;
        cases::explained(shelf, &self.chosen, problem)
    }

    fn situations(&self) -> Vec<String> {
        self.shelf.as_ref().map_or_else(Vec::new, Shelf::names)
    }
}
