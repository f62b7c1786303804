//! `library`: case libraries in Python, and what they answer. mm, field frame.

use std::path::PathBuf;

use arena::cases::{Answer, Chosen, LibraryHandle, explained_by, problem};
use pyo3::prelude::*;
use pyo3::types::{PyAnyMethods, PyDictMethods, PyString};

use crate::argument::{self, Text};
use crate::{from_json, refused};

/// What `pickle` calls to open a library again: the function and its league and directory.
type Pickle<'py> = (Bound<'py, PyAny>, (String, Option<PathBuf>));

/// A case library, opened once and asked many times.
#[pyclass(frozen, module = "onetwo")]
pub struct Library {
    handle: LibraryHandle,
}

#[pymethods]
impl Library {
    /// Opens a built-in league's library, or one league's directory of case files.
    #[new]
    #[pyo3(signature = (league = Text::of("four-legged"), *, directory = None))]
    fn new(
        py: Python<'_>,
        #[pyo3(from_py_with = argument::league)] league: Text,
        directory: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let directory = directory.filter(|directory| !directory.is_none());
        let directory = directory.map(PyAnyMethods::extract::<PathBuf>).transpose();
        let directory = directory.map_err(|_| refused("directory: take a path"))?;
        let handle = py.detach(|| match &directory {
            Some(directory) => LibraryHandle::read(directory, |_, _| ()),
            None => LibraryHandle::named(&league),
        });
        Ok(Self { handle: handle.map_err(refused)? })
    }

    /// The league's name.
    #[getter]
    fn league(&self) -> &str {
        self.handle.league()
    }

    /// `region/name` of every authored case, in order.
    #[getter]
    fn names(&self) -> Vec<String> {
        self.handle.names()
    }

    /// The number of stored cases: four for each authored one.
    fn __len__(&self) -> usize {
        self.handle.base().len()
    }

    /// The case that fits a problem, as a dict; its "case" is None where none fits.
    #[pyo3(signature = (problem, *, settings = None))]
    fn retrieve<'py>(
        &self,
        problem: &Bound<'py, PyAny>,
        settings: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let chosen = chosen(settings)?;
        let line = line_of(problem)?;
        let problem_read = problem::parse(&line).map_err(refused)?;
        let base = self.handle.base();
        let retrieval = casebase::retrieve(&base, &problem_read, &chosen.settings);
        let answer = Answer::new(&self.handle, &base, &problem_read, &chosen, &retrieval);
        from_json(problem.py(), &serde_json::to_string(&answer).map_err(refused)?)
    }

    /// Every case's verdict on a problem, as a dict.
    #[pyo3(signature = (problem, *, settings = None))]
    fn explain<'py>(
        &self,
        problem: &Bound<'py, PyAny>,
        settings: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let chosen = chosen(settings)?;
        let line = line_of(problem)?;
        let name_of = |id| self.handle.name(id);
        let answer = explained_by(&self.handle.base(), &name_of, &chosen, &line).map_err(refused)?;
        from_json(problem.py(), &answer)
    }

    fn __copy__(&self) -> Self {
        Self { handle: self.handle }
    }

    fn __deepcopy__(&self, _memo: &Bound<'_, PyAny>) -> Self {
        self.__copy__()
    }

    /// A pickle names the league or the directory, whose files are read again.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Pickle<'py>> {
        let directory = self.handle.directory().map(std::path::absolute).transpose()?;
        let function = py.import("onetwo._native")?.getattr("_library")?;
        Ok((function, (self.handle.league().to_owned(), directory)))
    }

    fn __repr__(&self) -> String {
        format!("Library({:?}, {} stored cases)", self.handle.league(), self.handle.base().len())
    }
}

impl Library {
    /// Case base and library, to share with other objects.
    pub fn handle(&self) -> LibraryHandle {
        self.handle
    }
}

/// `Library.retrieve` of a library, or of the built-in four-legged league's.
#[pyfunction]
#[pyo3(signature = (problem, *, library = None, settings = None))]
pub fn retrieve<'py>(
    problem: &Bound<'py, PyAny>,
    library: Option<&Bound<'py, PyAny>>,
    settings: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    Library { handle: handle_or_default(library)? }.retrieve(problem, settings)
}

/// `Library.explain` of a library, or of the built-in four-legged league's.
#[pyfunction]
#[pyo3(signature = (problem, *, library = None, settings = None))]
pub fn explain<'py>(
    problem: &Bound<'py, PyAny>,
    library: Option<&Bound<'py, PyAny>>,
    settings: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    Library { handle: handle_or_default(library)? }.explain(problem, settings)
}

/// The library's handle, or that of the league that the program takes by default.
pub fn handle_or_default(library: Option<&Bound<'_, PyAny>>) -> PyResult<LibraryHandle> {
    let Some(library) = library.filter(|library| !library.is_none()) else {
        return LibraryHandle::named("four-legged").map_err(refused);
    };
    let library = library.cast::<Library>().map_err(|_| refused("library: take a Library"))?;
    Ok(library.get().handle())
}

/// A library read from its pickle.
#[pyfunction]
pub fn _library(league: &str, directory: Option<PathBuf>) -> PyResult<Library> {
    let handle = match &directory {
        Some(directory) => LibraryHandle::read(directory, |_, _| ()),
        None => LibraryHandle::named(league),
    };
    Ok(Library { handle: handle.map_err(refused)? })
}

/// Retrieval's settings from names and values.
pub fn chosen(settings: Option<&Bound<'_, PyAny>>) -> PyResult<Chosen> {
    let mut given = Vec::new();
    let settings = argument::dict("settings", settings)?;
    for (name, value) in settings.iter().flat_map(PyDictMethods::iter) {
        given.push((name.str()?.to_string(), value.str()?.to_string()));
    }
    Chosen::of(given.iter().map(|(name, value)| (name.as_str(), value.as_str()))).map_err(refused)
}

/// The line of JSON in which the program takes a problem: a string as it is, anything else as JSON.
pub fn line_of(problem: &Bound<'_, PyAny>) -> PyResult<String> {
    if let Ok(text) = problem.cast::<PyString>() {
        return Ok(text.to_string());
    }
    let mut line = String::new();
    argument::json("problem", problem, &mut line)?;
    Ok(line)
}
