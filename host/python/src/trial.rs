//! `trial`: one trial of Ros et al. 2009, as `onetwo trial --json` plays it.

use arena::TrialConfig;
use arena::{Profile, Setup};
use brain::Positioning;
use case_tools::Reduction;
use hil_sim::{Configuration, NativeBackend, Scenario};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::library::{Library, chosen, handle_or_default};
use crate::{from_json, refused};

/// Plays one trial and returns its report as a dict; flags, defaults and keys are those of `onetwo trial
/// --json`.
#[pyfunction]
#[pyo3(signature = (
    *,
    scenario = "3",
    opponents = "dg",
    approach = "cbr",
    seed = 1,
    profile = "simulated",
    robots = 2,
    library = None,
    settings = None,
    positioning = "dependent",
    retrievers = None,
    loss = 0.0,
    symmetry = true,
    case_opponents = true,
    opponents_play_on = false,
))]
pub fn trial<'py>(
    py: Python<'py>,
    scenario: &str,
    opponents: &str,
    approach: &str,
    seed: u64,
    profile: &str,
    robots: usize,
    library: Option<&Library>,
    settings: Option<&Bound<'py, PyDict>>,
    positioning: &str,
    retrievers: Option<usize>,
    loss: f32,
    symmetry: bool,
    case_opponents: bool,
    opponents_play_on: bool,
) -> PyResult<Bound<'py, PyAny>> {
    let scenario = Scenario::from_label(scenario)
        .ok_or_else(|| unknown("scenario", scenario, "1, 2, 3, 4 or random"))?;
    let opponents =
        Configuration::from_label(opponents).ok_or_else(|| unknown("opponents", opponents, "dg or 2d"))?;
    let approach = arena::approach_from_label(approach).ok_or_else(|| {
        unknown("approach", approach, &arena::APPROACHES.map(arena::approach_label).join(" or "))
    })?;
    let profile =
        Profile::from_label(profile).ok_or_else(|| unknown("profile", profile, "simulated or robots"))?;
    let positioning = [Positioning::Dependent, Positioning::Independent]
        .into_iter()
        .find(|known| arena::positioning_label(*known) == positioning)
        .ok_or_else(|| unknown("positioning", positioning, "dependent or independent"))?;
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
