//! `research`: functions of `onetwo.cases` over many problems and whole libraries: similarity, coverage,
//! drafts and learning. Other threads run meanwhile. mm, field frame.

use arena::cases::{LibraryHandle, problem};
use case_tools::competence::{roles, shared};
use case_tools::coverage::{Cells, Counters, Survey};
use case_tools::{Files, Finding, build_without_warnings, skeleton};
use casebase::{Problem, Symmetry};
use pyo3::buffer::PyBuffer;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rayon::prelude::*;
use serde_json::json;
use study::learning::{
    Collected, Kind, LearnSettings, PlayError, Playable, Player, Worlds, learn, learn_matches,
};

use crate::argument::{self, Text};
use crate::library::{Library, chosen, handle_or_default, line_of};
use crate::ranking::{Arrays, Local, Ranked, SAMPLES, SAMPLES_PER_UNIT, Similarity, TERMS, Unknown};
use crate::simulator::write;
use crate::{from_json, refused};

/// Arrays of problems as Python has them: ball, defending, teammates, opponents, left out.
type Columns<'py> = (
    Bound<'py, PyAny>,
    Bound<'py, PyAny>,
    Option<Bound<'py, PyAny>>,
    Option<Bound<'py, PyAny>>,
    Option<Bound<'py, PyAny>>,
);
/// Where answers go: case ids, similarities, terms, players.
type Into4<'py> = [Bound<'py, PyAny>; 4];
/// Learned: the report, the files of the library.
type Report<'py> = (Bound<'py, PyAny>, Bound<'py, PyDict>);

/// Names of the symmetries, by the number of a stored case modulo their number.
pub const SYMMETRIES: [&str; Symmetry::ALL.len()] = {
    let mut labels = [""; Symmetry::ALL.len()];
    let mut at = 0;
    while at < labels.len() {
        labels[at] = Symmetry::ALL[at].label();
        at += 1;
    }
    labels
};

/// Writes the k most similar cases of each problem; ids of -1 where a library has fewer.
#[pyfunction]
pub fn _rank<'py>(
    library: &Bound<'py, Library>,
    columns: Columns<'py>,
    #[pyo3(from_py_with = argument::k)] k: usize,
    weights: &Bound<'py, PyAny>,
    local: &Bound<'py, PyAny>,
    #[pyo3(from_py_with = argument::unknown)] unknown: Text,
    settings: Option<&Bound<'py, PyAny>>,
    #[pyo3(from_py_with = argument::threads)] threads: usize,
    into: Into4<'py>,
) -> PyResult<()> {
    let (py, base) = (library.py(), library.get().handle().lasting_base());
    if !(1..=base.len()).contains(&k) {
        return Err(refused(format!("k {k}: take 1 to {}, the number of stored cases", base.len())));
    }
    let arrays = arrays_of(&columns)?;
    let similarity = similarity_of(weights, local, &unknown)?;
    let settings = chosen(settings)?.settings;
    let ranked: Vec<Vec<Ranked>> = py.detach(|| {
        let numbers = (0..arrays.len()).into_par_iter();
        let ranked = numbers.map(|number| arrays.problem(number).rank(&base, &similarity, &settings, k));
        Ok::<_, PyErr>(pool(threads)?.install(|| ranked.collect()))
    })?;
    let rows: Vec<_> = ranked.iter().flat_map(|row| (0..k).map(move |n| row.get(n))).collect();
    let nan = [f32::NAN; TERMS.len()];
    let ids: Vec<i32> = rows.iter().map(|row| row.map_or(-1, |row| i32::from(row.id))).collect();
    let similarities: Vec<f32> = rows.iter().map(|row| row.map_or(f32::NAN, |row| row.similarity)).collect();
    let terms: Vec<f32> = rows.iter().flat_map(|row| row.map_or(nan, |row| row.terms)).collect();
    let players: Vec<i8> =
        rows.iter().flat_map(|row| row.map_or([-1; casebase::TEAMMATES_MAX], |row| row.players)).collect();
    write("ids", &into[0], &ids)?;
    write("similarities", &into[1], &similarities)?;
    write("terms", &into[2], &terms)?;
    write("players", &into[3], &players)
}

/// Writes retrieval's answer to each problem, the id of the stored case or -1.
#[pyfunction]
pub fn _retrieve<'py>(
    library: &Bound<'py, Library>,
    columns: Columns<'py>,
    settings: Option<&Bound<'py, PyAny>>,
    #[pyo3(from_py_with = argument::threads)] threads: usize,
    into: &Bound<'py, PyAny>,
) -> PyResult<()> {
    let (py, base) = (library.py(), library.get().handle().lasting_base());
    let arrays = arrays_of(&columns)?;
    let settings = chosen(settings)?.settings;
    let problems = whole(&arrays)?;
    let ids: Vec<i32> = py.detach(|| {
        let answers = problems.par_iter().map(|problem| {
            casebase::retrieve_best(&base, problem, &settings).map_or(-1, |found| i32::from(found.case.0))
        });
        Ok::<_, PyErr>(pool(threads)?.install(|| answers.collect()))
    })?;
    write("ids", into, &ids)
}

/// How a library covers problems: the caller's, or `samples` drawn ones.
#[pyfunction]
pub fn _coverage<'py>(
    library: &Bound<'py, Library>,
    columns: Option<Columns<'py>>,
    #[pyo3(from_py_with = argument::samples)] samples: usize,
    #[pyo3(from_py_with = argument::seed)] seed: u64,
    settings: Option<&Bound<'py, PyAny>>,
    #[pyo3(from_py_with = argument::threads)] threads: usize,
) -> PyResult<Bound<'py, PyAny>> {
    let (py, handle) = (library.py(), library.get().handle());
    let settings = chosen(settings)?.settings;
    let given = columns.as_ref().map(|columns| whole(&arrays_of(columns)?)).transpose()?;
    let report = py.detach(|| {
        let base = handle.lasting_base();
        let cells = Cells::new(base.field(), Cells::suitable_edge_mm(base.field()));
        let survey = Survey::new(base, &settings, cells.map_err(refused)?).map_err(refused)?;
        let source = build_without_warnings(&files_of(handle)?).map_err(findings)?.sampler(seed);
        let number_of = given.as_ref().map_or(samples, Vec::len);
        let blocks = (0..number_of.div_ceil(BLOCK)).into_par_iter().map(|first| {
            let numbers = first * BLOCK..number_of.min((first + 1) * BLOCK);
            survey.over(numbers.map(|n| {
                let problem = given.as_ref().and_then(|problems| problems.get(n)).cloned();
                (n as u64, problem.unwrap_or_else(|| source.problem(n as u64)))
            }))
        });
        let counters = pool(threads)?.install(|| blocks.reduce(|| survey.empty(), Counters::merge));
        Ok::<_, PyErr>(report(handle, &counters))
    })?;
    from_json(py, &report)
}

/// Coverage as JSON.
fn report(handle: LibraryHandle, counters: &Counters) -> String {
    let roles = roles(counters, &shared(counters));
    let cases = handle.names().into_iter().zip(&counters.cases).zip(roles).map(|((name, case), role)| {
        json!({"case": name, "role": role.label(), "candidate": case.candidate(), "wins": case.wins, "sole": case.sole})
    });
    let cases: Vec<_> = cases.collect();
    json!({"problems": counters.problems, "none": counters.none, "candidates": counters.candidates, "cases": cases})
        .to_string()
}

/// A case file for a situation: its text, notes, and whether retrieval finds it.
#[pyfunction]
pub fn _draft<'py>(
    library: &Bound<'py, Library>,
    problem: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyAny>> {
    let asked = problem::parse(&line_of(problem)?).map_err(refused)?;
    let files = files_of(library.get().handle())?;
    let draft = skeleton(&files.rules, &asked);
    let draft = draft.map_err(|_| refused("problem: a case needs one teammate at least"))?;
    from_json(
        problem.py(),
        &json!({"text": draft.text, "notes": draft.notes, "retrieved": draft.retrieved}).to_string(),
    )
}

/// Texts of a library's files by their names, `league` and `region/name`.
#[pyfunction]
pub fn _files<'py>(library: &Bound<'py, Library>) -> PyResult<Bound<'py, PyDict>> {
    texts(library.py(), &files_of(library.get().handle())?)
}

/// Learns as `onetwo cases learn` does, in memory: the report, and the files of the learned library.
#[pyfunction]
pub fn _learn<'py>(
    library: &Bound<'py, Library>,
    #[pyo3(from_py_with = argument::budget)] budget: u64,
    #[pyo3(from_py_with = argument::seed)] seed: u64,
    kinds: Vec<String>,
    #[pyo3(from_py_with = argument::profile)] profile: Text,
    error_rate: f64,
    dry_run: bool,
    #[pyo3(from_py_with = argument::threads)] threads: usize,
) -> PyResult<Report<'py>> {
    let (py, handle) = (library.py(), handle_or_default(Some(library.as_any()))?);
    if !(LEAST_ERROR_RATE..=0.5).contains(&error_rate) {
        return Err(refused(format!("error_rate {error_rate}: take {LEAST_ERROR_RATE} to 0.5")));
    }
    let worlds = Worlds::from_label(&profile);
    let settings = LearnSettings {
        seed,
        budget,
        kinds: kinds.iter().map(|label| kind_of(label)).collect::<PyResult<_>>()?,
        worlds: worlds.ok_or_else(|| refused("profile: take simulated, robots or both"))?,
        error_rate,
        tries: TRIES,
        refused: [].into(),
        shuffle: false,
        dry_run,
    };
    let league = handle.simulated_league().map_err(refused)?;
    let learned = py.detach(|| {
        let (files, mut player) = (files_of(handle)?, Threads { pool: pool(threads)?, seed });
        let none = Collected::default();
        let learned = match league.limits() {
            Some(_) => learn_matches(files, none, &settings, &mut player),
            None => learn(files, none, &settings, &mut player),
        };
        learned.map_err(refused)
    })?;
    let report = from_json(py, &study::learning::json(&learned).to_string())?;
    Ok((report, texts(py, &learned.end.files)?))
}

/// Plays units on its threads and keeps nothing.
struct Threads {
    pool: rayon::ThreadPool,
    seed: u64,
}

impl<U: Playable> Player<U> for Threads {
    fn play(&mut self, units: &[U]) -> Result<Vec<Vec<U::Played>>, PlayError> {
        let seed = self.seed;
        self.pool.install(|| units.par_iter().map(|unit| unit.play(seed)).collect())
    }
}

fn pool(threads: usize) -> PyResult<rayon::ThreadPool> {
    if !(1..=THREADS_MAX).contains(&threads) {
        return Err(refused(format!("threads {threads}: take 1 to {THREADS_MAX} threads")));
    }
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().map_err(refused)
}

fn files_of(handle: LibraryHandle) -> PyResult<Files> {
    handle.files().map_err(findings)
}

fn findings(findings: Vec<Finding>) -> PyErr {
    let lines: Vec<String> = findings.iter().map(ToString::to_string).collect();
    refused(format!("library: {}", lines.join("; ")))
}

fn texts<'py>(py: Python<'py>, files: &Files) -> PyResult<Bound<'py, PyDict>> {
    let found = PyDict::new(py);
    for file in std::iter::once(&files.rules).chain(&files.cases) {
        found.set_item(&file.name, &file.text)?;
    }
    Ok(found)
}

/// An array's numbers.
fn numbers(name: &str, from: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
    let buffer = PyBuffer::<f64>::get(from);
    buffer.map_err(|_| refused(format!("{name}: take an array of float64")))?.to_vec(from.py())
}

/// A kind of changes by its label.
fn kind_of(label: &str) -> PyResult<Kind> {
    let known = Kind::ALL.map(Kind::label).join(", ");
    Kind::from_label(label).ok_or_else(|| refused(format!("only {label:?}: take some of {known}")))
}

/// Arrays of problems, checked.
fn arrays_of(columns: &Columns<'_>) -> PyResult<Arrays> {
    let (ball, defending, teammates, opponents, left_out) = columns;
    let arrays = Arrays {
        ball: numbers("ball", ball)?,
        defending: numbers("defending", defending)?,
        teammates: teammates.as_ref().map(|from| numbers("teammates", from)).transpose()?,
        opponents: opponents.as_ref().map(|from| numbers("opponents", from)).transpose()?,
        left_out: left_out.as_ref().map(|from| numbers("left_out", from)).transpose()?,
    };
    arrays.check().map_err(refused)?;
    Ok(arrays)
}

/// The problems, if every part of each is known.
fn whole(arrays: &Arrays) -> PyResult<Vec<Problem>> {
    let problems = (0..arrays.len()).map(|number| {
        arrays.problem(number).whole().ok_or_else(|| {
            refused(format!(
                "problems: number {number} is not known in all parts, as retrieval needs it; ask rank"
            ))
        })
    });
    problems.collect()
}

fn similarity_of(
    weights: &Bound<'_, PyAny>,
    local: &Bound<'_, PyAny>,
    unknown: &str,
) -> PyResult<Similarity> {
    let mut similarity = Similarity::usual();
    for (at, value) in terms("weights", weights)? {
        let weight = value.extract::<f32>().ok().filter(|weight| weight.is_finite() && *weight >= 0.0);
        similarity.weights[at] =
            weight.ok_or_else(|| refused(format!("weights: {} is {value}; take 0 or more", TERMS[at])))?;
    }
    for (at, function) in terms("local", local)? {
        similarity.local[at] =
            Local::Table((0..SAMPLES).map(|n| sample(TERMS[at], &function, n)).collect::<PyResult<_>>()?);
    }
    let labels = Unknown::ALL.map(Unknown::label).join(" or ");
    similarity.unknown =
        Unknown::from_label(unknown).ok_or_else(|| refused(format!("unknown {unknown:?}: take {labels}")))?;
    Ok(similarity)
}

/// A dict of terms: the number of each, and its value.
fn terms<'py>(what: &str, given: &Bound<'py, PyAny>) -> PyResult<Vec<(usize, Bound<'py, PyAny>)>> {
    let given = argument::dict(what, Some(given))?;
    let places = given.iter().flatten().map(|(name, value)| {
        let (name, known) = (name.str()?.to_string(), TERMS.join(", "));
        let at = TERMS.iter().position(|term| *term == name);
        Ok((at.ok_or_else(|| refused(format!("{what}: no term {name:?}; there are {known}")))?, value))
    });
    places.collect()
}

/// Value of a caller's local similarity at a sampled distance.
fn sample(term: &str, function: &Bound<'_, PyAny>, number: usize) -> PyResult<f32> {
    let distance = number as f32 / SAMPLES_PER_UNIT;
    if !function.is_callable() {
        return Err(refused(format!("local: {term} is {function}; take a function of a distance")));
    }
    let value = function.call1((distance,))?;
    let share = value.extract::<f32>().ok().filter(|share| (0.0..=1.0).contains(share));
    share.ok_or_else(|| refused(format!("local: {term} gives {value} at {distance}; take 0 to 1")))
}

/// Problems that are counted in one go, as `onetwo cases coverage` does.
const BLOCK: usize = 2048;
/// Most threads of a call.
const THREADS_MAX: usize = 256;
/// Sequential tests that the error rate of learning is shared among, as the program has it.
const TRIES: u32 = 40;
/// As the program has it.
const LEAST_ERROR_RATE: f64 = 0.0001;
