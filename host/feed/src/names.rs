//! `names`: names and intents of a library's cases, for the page.

use arena::cases::LibraryHandle;
use protocol::CaseId;

#[derive(Debug, Default)]
pub(crate) struct Names {
    names: Vec<String>,
    meant: Vec<String>,
}

impl Names {
    /// Of this library; none without one.
    pub(crate) fn new(library_handle: Option<&LibraryHandle>) -> Self {
        let Some(library_handle) = library_handle else { return Self::default() };
        let names = library_handle.names();
        let meant = (0..names.len())
            .map(|i| library_handle.intent(CaseId(i as u16 * 4)).unwrap_or_default())
            .collect();
        Self { names, meant }
    }

    /// `region/name` of a stored case.
    pub(super) fn of(&self, case: CaseId) -> String {
        let name = self.names.get(usize::from(case.0 / 4));
        name.cloned().unwrap_or_else(|| format!("case {}", case.0))
    }

    pub(super) fn meant(&self, case: CaseId) -> String {
        self.meant.get(usize::from(case.0 / 4)).cloned().unwrap_or_default()
    }
}
