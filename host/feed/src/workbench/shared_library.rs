//! `shared_library`: the library of a page's matches. Each match keeps the one it began with; the next one
//! begins with what is on disk then.

use std::path::Path;
use std::sync::{Arc, PoisonError, RwLock};

use arena::cases::{LibraryError, LibraryHandle};
use case_tools::Files;

/// A library that is read again for every match.
#[derive(Clone, Debug)]
pub struct SharedLibrary(Arc<RwLock<Option<LibraryHandle>>>);

impl SharedLibrary {
    /// A library that the next match plays; none where no cases are played.
    pub fn new(library_handle: Option<LibraryHandle>) -> Self {
        Self(Arc::new(RwLock::new(library_handle)))
    }

    /// Library of the match that is played now; none where no cases are played.
    pub fn now(&self) -> Option<LibraryHandle> {
        *self.0.read().unwrap_or_else(PoisonError::into_inner)
    }

    /// Reads its directory again, if it has one; as it was where that is refused.
    pub fn read_again(&self) -> Result<(), LibraryError> {
        if let Some(directory) = self.directory() {
            let read = LibraryHandle::read(directory, |_, _| {})?;
            *self.0.write().unwrap_or_else(PoisonError::into_inner) = Some(read);
        }
        Ok(())
    }

    /// The directory that it was read from.
    pub fn directory(&self) -> Option<&'static Path> {
        self.now()?.directory()
    }

    /// The files as they are now.
    pub(super) fn files(&self) -> Result<Files, String> {
        let library_handle = self.now().ok_or("no cases are played here")?;
        library_handle.files().map_err(|findings| super::refused(&findings))
    }
}
