//! `onetwo_native`: the Rust side of the Python package `onetwo`. Case retrieval and its explanation,
//! trials of the first paper, and the Small Size simulator step by step (README.md).
//!
//! Answers are those of the command line: the same functions of crate `arena`, as JSON, read by Python's own
//! `json`. Bad input raises `ValueError` with the program's message; nothing is printed.
#![forbid(unsafe_code)]

mod argument;
mod computers;
mod driver;
mod episode;
mod legged;
mod library;
mod picture;
mod ranking;
mod research;
mod saved;
mod sensed;
mod settings;
mod simulator;
mod start;
mod state;
mod task;
mod trial;
mod vector;

use pyo3::prelude::*;

/// The extension module.
#[pymodule]
#[pyo3(name = "_native")]
mod onetwo_native {
    #[pymodule_export]
    use super::library::{_library, Library, explain, retrieve};
    #[pymodule_export]
    use super::research::{_coverage, _draft, _files, _learn, _rank, _retrieve};
    #[pymodule_export]
    use super::simulator::{_simulator, Simulator};
    #[pymodule_export]
    use super::trial::trial;
    #[pymodule_export]
    use super::vector::{_vector, VectorSimulator};

    /// Names of the symmetries, by a stored case's id modulo 4.
    #[pymodule_export]
    const SYMMETRIES: [&str; 4] = super::research::SYMMETRIES;

    /// The package's version.
    #[pymodule_export]
    const VERSION: &str = env!("CARGO_PKG_VERSION");
}

/// Python's value of a JSON text.
fn from_json<'py>(py: Python<'py>, text: &str) -> PyResult<Bound<'py, PyAny>> {
    py.import("json")?.call_method1("loads", (text,))
}

/// A `ValueError` with that message.
fn refused(message: impl std::fmt::Display) -> PyErr {
    pyo3::exceptions::PyValueError::new_err(message.to_string())
}
