//! `trial`: one trial of Ros et al. 2009, as `onetwo trial --json` plays it.

use arena::TrialConfig;
use arena::{Profile, Setup};
use brain::Positioning;
use case_tools::Reduction;
use hil_sim::{Configuration, NativeBackend, Scenario};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

use crate::argument::{self, Text};
use crate::library::{chosen, handle_or_default};
use crate::{from_json, refused};

/// Plays one trial and returns its report as a dict; flags, defaults and keys are those of `onetwo trial
/// --json`.
#[pyfunction]
#[pyo3(signature = (
    *,
    scenario = Text::of("3"),
    opponents = Text::of("dg"),
    approach = Text::of("cbr"),
    seed = 1,
    profile = Text::of("simulated"),
    robots = 2,
    library = None,
    settings = None,
    positioning = Text::of("dependent"),
    retrievers = None,
    loss = 0.0,
    symmetry = true,
    case_opponents = true,
    opponents_play_on = false,
))]
pub fn trial<'py>(
    py: Python<'py>,
    #[pyo3(from_py_with = argument::scenario)] scenario: Text,
    #[pyo3(from_py_with = argument::opponents)] opponents: Text,
    #[pyo3(from_py_with = argument::approach)] approach: Text,
    #[pyo3(from_py_with = argument::seed)] seed: u64,
    #[pyo3(from_py_with = argument::profile)] profile: Text,
    #[pyo3(from_py_with = argument::robots)] robots: usize,
    library: Option<&Bound<'py, PyAny>>,
    settings: Option<&Bound<'py, PyAny>>,
    #[pyo3(from_py_with = argument::positioning)] positioning: Text,
    #[pyo3(from_py_with = argument::retrievers)] retrievers: Option<usize>,
    #[pyo3(from_py_with = argument::loss)] loss: f32,
    #[pyo3(from_py_with = argument::symmetry)] symmetry: bool,
    #[pyo3(from_py_with = argument::case_opponents)] case_opponents: bool,
    #[pyo3(from_py_with = argument::opponents_play_on)] opponents_play_on: bool,
) -> PyResult<Bound<'py, PyAny>> {
    let scenario = Scenario::from_label(&scenario)
        .ok_or_else(|| unknown("scenario", &scenario, "1, 2, 3, 4 or random"))?;
    let opponents =
        Configuration::from_label(&opponents).ok_or_else(|| unknown("opponents", &opponents, "dg or 2d"))?;
    let approach = arena::approach_from_label(&approach).ok_or_else(|| {
        unknown("approach", &approach, &arena::APPROACHES.map(arena::approach_label).join(" or "))
    })?;
    let profile =
        Profile::from_label(&profile).ok_or_else(|| unknown("profile", &profile, "simulated or robots"))?;
    let positioning = [Positioning::Dependent, Positioning::Independent]
        .into_iter()
        .find(|known| arena::positioning_label(*known) == &*positioning)
        .ok_or_else(|| unknown("positioning", &positioning, "dependent or independent"))?;
    let retrievers = retrievers.unwrap_or(robots);
    if !ROBOTS.contains(&robots) || !ROBOTS.contains(&retrievers) {
        return Err(refused("robots and retrievers: take a number from 1 to 4"));
    }
    if !(0.0..=1.0).contains(&loss) {
        return Err(refused(format!("loss {loss}: take a share from 0 to 1")));
    }
    let setup = Setup {
        settings: chosen(settings)?.settings,
        positioning,
        retrievers: retrievers.min(robots),
        loss,
        symmetry,
        opponents: case_opponents,
        opponents_pause: !opponents_play_on,
    };
    let handle = handle_or_default(library)?;
    let json = py.detach(|| {
        let reduced = handle.reduced(Reduction { symmetry, opponents: case_opponents }).map_err(refused)?;
        reduced.check_field_of_trials().map_err(refused)?;
        let base = reduced.base();
        let config = TrialConfig { robots, ..TrialConfig::new(scenario, opponents, approach, seed) };
        let names = arena::CaseNames::new(reduced.names());
        let config = profile.apply(setup.apply(config)).with_library(base, names);
        let report = arena::run(&config, Box::new(NativeBackend::new(base)), &mut [])
            .map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
        serde_json::to_string(&report).map_err(refused)
    })?;
    from_json(py, &json)
}

fn unknown(what: &str, given: &str, known: &str) -> PyErr {
    refused(format!("{what} {given:?}: take {known}"))
}

/// Attackers, and those among them that retrieve: as the program's flags take them.
const ROBOTS: std::ops::RangeInclusive<usize> = 1..=4;
