//! `simulator`: the Small Size simulator in Python, step by step. Numbers come and go through buffers, such
//! as NumPy's arrays, without NumPy being needed.

use geometry::{Angle, Point, Pose, Vector};
use hil_sim::small_size::Ball;
use protocol::{RobotId, Who};
use pyo3::buffer::{Element, PyBuffer};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use rules::{Colour, League};

use crate::argument::{self, Text};
use crate::driver::Driver;
use crate::episode::Episode;
use crate::picture::{self, Pixels};
use crate::refused;
use crate::saved::{restored, saved};
use crate::settings::{ACTION_LEN, End, Observation, Settings, View};
use crate::task::Task;

/// Episodes of the Small Size simulator.
#[pyclass(module = "onetwo")]
pub struct Simulator {
    episode: Episode,
    own: Vec<f32>,
    opponents: Vec<f32>,
    observation: Vec<f32>,
}

#[pymethods]
impl Simulator {
    /// A simulator, with its first episode started from `seed`.
    #[new]
    #[pyo3(signature = (own = None, opponents = None, *, task = Text::of("score"), agents = None,
        teammates_by = Text::of("none"), opponents_by = None, world = Text::of("nominal"),
        observation = Text::of("truth"), league = None, period_ms = None, time_limit_s = None, seed = 0))]
    fn new(
        py: Python<'_>,
        #[pyo3(from_py_with = argument::own)] own: Option<usize>,
        #[pyo3(from_py_with = argument::opponents_count)] opponents: Option<usize>,
        #[pyo3(from_py_with = argument::task)] task: Text,
        #[pyo3(from_py_with = argument::agents)] agents: Option<usize>,
        #[pyo3(from_py_with = argument::teammates_by)] teammates_by: Text,
        #[pyo3(from_py_with = argument::opponents_by)] opponents_by: Option<Text>,
        #[pyo3(from_py_with = argument::world)] world: Text,
        #[pyo3(from_py_with = argument::observation)] observation: Text,
        #[pyo3(from_py_with = argument::league_if_any)] league: Option<Text>,
        #[pyo3(from_py_with = argument::period_ms)] period_ms: Option<u32>,
        #[pyo3(from_py_with = argument::time_limit_s)] time_limit_s: Option<f64>,
        #[pyo3(from_py_with = argument::seed)] seed: u64,
    ) -> PyResult<Self> {
        let task = known("task", &task, Task::from_label, &Task::ALL.map(Task::label))?;
        let driver =
            |name: &str, label: &str| known(name, label, Driver::from_label, &Driver::ALL.map(Driver::label));
        let spec = task.spec();
        let own = own.unwrap_or(spec.own);
        let opponents_by = opponents_by.map_or(Ok(spec.opponents_by), |label| driver("opponents_by", &label));
        let league = match league {
            Some(league) => known("league", &league, league_of, &Settings::LEAGUES.map(League::name))?,
            None if spec.scenario.is_some() => League::FourLegged,
            None => League::DivisionB,
        };
        let mut settings = Settings {
            task,
            league,
            observation: known(
                "observation",
                &observation,
                Observation::from_label,
                &Observation::ALL.map(Observation::label),
            )?,
            own,
            opponents: opponents.unwrap_or(spec.opponents),
            agents: agents.unwrap_or(own),
            teammates_by: driver("teammates_by", &teammates_by)?,
            opponents_by: opponents_by?,
            world: world.parse().map_err(|error| refused(format!("world: {error}")))?,
            period_ms: 0,
            time_limit_s: time_limit_s.unwrap_or(spec.time_limit_s),
        };
        settings.period_ms = period_ms.unwrap_or_else(|| settings.default_period_ms());
        Ok(Self::of(start(py, &settings, seed)?))
    }

    /// Starts another episode, from the start positions of that seed.
    fn reset(&mut self, py: Python<'_>, #[pyo3(from_py_with = argument::seed)] seed: u64) -> PyResult<()> {
        self.episode = start(py, &self.episode.state.settings, seed)?;
        Ok(())
    }

    /// Plays one control period; returns the reward and how the episode ended, or None while it goes on.
    #[pyo3(signature = (actions, opponent_actions = None, into = None))]
    fn step(
        &mut self,
        py: Python<'_>,
        actions: &Bound<'_, PyAny>,
        opponent_actions: Option<&Bound<'_, PyAny>>,
        into: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<(f32, Option<&'static str>)> {
        read_actions("actions", actions, &mut self.own)?;
        let mut against = &[][..];
        if let Some(actions) = opponent_actions {
            let settings = &self.episode.state.settings;
            let (driver, task) = (settings.opponents_by, settings.task);
            if task.spec().scenario.is_some() {
                let label = task.label();
                return Err(refused(format!("opponent_actions: opponents of {label:?} take no orders")));
            }
            if driver != Driver::None {
                let label = driver.label();
                return Err(refused(format!(
                    "opponent_actions: {label:?} moves the opponents; take opponents_by=\"none\" to order them"
                )));
            }
            read_actions("opponent_actions", actions, &mut self.opponents)?;
            against = &self.opponents[..];
        }
        py.detach(|| self.episode.step(&self.own, against)).map_err(failed)?;
        if let Some(into) = into {
            self.observe(into, 0, false)?;
        }
        Ok((self.episode.state.reward, self.episode.state.end.map(End::label)))
    }

    /// Writes the observation into a writable buffer of `observation_size` float32.
    #[pyo3(signature = (into, index = 0, opponent = false))]
    fn observe(
        &mut self,
        into: &Bound<'_, PyAny>,
        #[pyo3(from_py_with = argument::index)] index: usize,
        #[pyo3(from_py_with = argument::opponent)] opponent: bool,
    ) -> PyResult<()> {
        let side = side_of(opponent);
        // An empty side may still be looked at, as its first robot would.
        if index > 0 {
            self.robot(index, opponent)?;
        }
        self.episode.observe(View { side, first: index }, &mut self.observation);
        write("into", into, &self.observation)
    }

    /// The true state as a dict: SI units, field frame, own robots attack +x.
    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let of = &self.episode.state;
        let world = &of.world;
        let ball = PyDict::new(py);
        let (at, velocity) = (world.ball.position, world.ball.velocity);
        ball.set_item("position", (at.x(), at.y(), world.ball.height))?;
        ball.set_item("velocity", (velocity.x(), velocity.y(), world.ball.climb))?;
        let state = PyDict::new(py);
        state.set_item("time_s", of.time_s())?;
        state.set_item("ball", ball)?;
        for (name, colour) in [("own", Colour::Blue), ("opponents", Colour::Yellow)] {
            let mut robots = Vec::new();
            let ids = RobotId::all().take(of.settings.count(colour));
            for robot in ids.filter_map(|id| world.robot(Who { colour, id })) {
                let one = PyDict::new(py);
                one.set_item("position", (robot.pose.position.x(), robot.pose.position.y()))?;
                one.set_item("heading", robot.pose.heading.radians())?;
                one.set_item("velocity", (robot.velocity.x(), robot.velocity.y()))?;
                one.set_item("turning", robot.turning)?;
                one.set_item("ball_contact", robot.ball_contact)?;
                robots.push(one);
            }
            state.set_item(name, robots)?;
        }
        state.set_item("score", (of.score[0], of.score[1]))?;
        state.set_item("in_play", of.in_play)?;
        Ok(state)
    }

    /// The drawn field `width` pixels wide: red, green and blue of each pixel, width, height.
    fn pixels<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = argument::width)] width: u32,
    ) -> PyResult<(Bound<'py, PyBytes>, u32, u32)> {
        pixels_of(py, &self.episode, width)
    }

    /// The drawn field as SVG.
    #[pyo3(signature = (width = 960))]
    fn svg(&self, #[pyo3(from_py_with = argument::width)] width: u32) -> PyResult<String> {
        Ok(picture::svg(&self.episode.state, width_of(width)?))
    }

    /// The picture of a notebook's cell.
    fn _repr_svg_(&self) -> String {
        picture::svg(&self.episode.state, NOTEBOOK_WIDTH)
    }

    /// Places the ball on the ground, rolling with that velocity.
    #[pyo3(signature = (x, y, vx = 0.0, vy = 0.0))]
    fn place_ball(
        &mut self,
        #[pyo3(from_py_with = argument::x)] x: f32,
        #[pyo3(from_py_with = argument::y)] y: f32,
        #[pyo3(from_py_with = argument::vx)] vx: f32,
        #[pyo3(from_py_with = argument::vy)] vy: f32,
    ) -> PyResult<()> {
        self.may_place("ball")?;
        self.episode.put_ball(Ball::rolling(Point::new(x, y), Vector::new(vx, vy)));
        Ok(())
    }

    /// Places a robot, resting: an own one by its index, or an opponent.
    #[pyo3(signature = (index, x, y, heading = 0.0, *, opponent = false))]
    fn place_robot(
        &mut self,
        #[pyo3(from_py_with = argument::index)] index: usize,
        #[pyo3(from_py_with = argument::x)] x: f32,
        #[pyo3(from_py_with = argument::y)] y: f32,
        #[pyo3(from_py_with = argument::heading)] heading: f32,
        #[pyo3(from_py_with = argument::opponent)] opponent: bool,
    ) -> PyResult<()> {
        self.may_place("robot")?;
        let who = self.robot(index, opponent)?;
        self.episode.put_robot(who, Pose { position: Point::new(x, y), heading: Angle::new(heading) });
        Ok(())
    }

    fn __copy__(&self, py: Python<'_>) -> PyResult<Self> {
        Ok(Self::of(py.detach(|| self.episode.copy()).map_err(failed)?))
    }

    /// The episode goes on in the copy as it would here, bit for bit.
    fn __deepcopy__(&self, py: Python<'_>, _memo: &Bound<'_, PyAny>) -> PyResult<Self> {
        self.__copy__(py)
    }

    /// A pickle holds the saved state.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (Bound<'py, PyBytes>,))> {
        Ok((py.import("onetwo._native")?.getattr("_simulator")?, (self.save(py)?,)))
    }

    /// The whole state of the episode as bytes.
    fn save<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        Ok(PyBytes::new(py, &saved(&self.episode.saved())?))
    }

    /// Goes on from a saved state of a simulator with the same settings.
    fn restore(&mut self, py: Python<'_>, state: &Bound<'_, PyAny>) -> PyResult<()> {
        let episode = episode_of(py, bytes_of(state)?)?;
        let (theirs, ours) = (&episode.state.settings, &self.episode.state.settings);
        if theirs != ours {
            return Err(refused(format!("state: of a simulator with {theirs:?}; this one has {ours:?}")));
        }
        self.episode = episode;
        Ok(())
    }

    /// Simulated time since the episode's start, s.
    #[getter]
    fn time_s(&self) -> f64 {
        self.episode.state.time_s()
    }

    /// Number of values in `actions`.
    #[getter]
    fn action_size(&self) -> usize {
        self.own.len()
    }

    /// Number of values in an observation.
    #[getter]
    fn observation_size(&self) -> usize {
        self.observation.len()
    }

    /// How the episode ended, or None while it goes on.
    #[getter]
    fn end(&self) -> Option<&'static str> {
        self.episode.state.end.map(End::label)
    }

    /// Goals of the own team and of the opponents under the referee.
    #[getter]
    fn score(&self) -> (u32, u32) {
        self.episode.state.score.into()
    }

    /// Numbers of robots: own, those of them that the caller moves, opponents.
    #[getter]
    fn robots(&self) -> (usize, usize, usize) {
        let Settings { own, agents, opponents, .. } = self.episode.state.settings;
        (own, agents, opponents)
    }

    /// Name of the task.
    #[getter]
    fn task(&self) -> &'static str {
        self.episode.state.settings.task.label()
    }

    /// Who moves the opponents.
    #[getter]
    fn opponents_by(&self) -> &'static str {
        self.episode.state.settings.opponents_by.label()
    }

    /// Control period, ms.
    #[getter]
    fn period_ms(&self) -> u32 {
        self.episode.state.settings.period_ms
    }

    /// Hash of every step's state so far: equal for equal episodes.
    #[getter]
    fn trace_hash(&self) -> String {
        self.episode.state.trace.digits()
    }
}

impl Simulator {
    /// Around an episode.
    fn of(episode: Episode) -> Self {
        let settings = &episode.state.settings;
        Self {
            own: vec![0.0; settings.action_len(Colour::Blue)],
            opponents: vec![0.0; settings.action_len(Colour::Yellow)],
            observation: vec![0.0; settings.observation_len()],
            episode,
        }
    }

    /// Settings of its episodes.
    pub fn settings(&self) -> &Settings {
        &self.episode.state.settings
    }

    /// An error where a task's places are those of its scenario.
    fn may_place(&self, what: &str) -> PyResult<()> {
        let task = self.settings().task;
        if task.spec().scenario.is_none() {
            return Ok(());
        }
        Err(refused(format!("place_{what}: places of the task {:?} are the scenario's", task.label())))
    }

    fn robot(&self, index: usize, opponent: bool) -> PyResult<Who> {
        let colour = side_of(opponent);
        let count = self.settings().count(colour);
        let id = RobotId::new(index.min(usize::from(u8::MAX)) as u8).filter(|_| index < count);
        let id = id.ok_or_else(|| refused(format!("index {index}: that team has {count} robots")))?;
        Ok(Who { colour, id })
    }
}

/// Bytes of the drawn field, width, height.
pub fn pixels_of<'py>(
    py: Python<'py>,
    episode: &Episode,
    width: u32,
) -> PyResult<(Bound<'py, PyBytes>, u32, u32)> {
    let svg = picture::svg(&episode.state, width_of(width)?);
    let Pixels { rgb, size } = py.detach(|| picture::pixels(&svg)).map_err(failed)?;
    Ok((PyBytes::new(py, &rgb), size[0], size[1]))
}

fn width_of(width: u32) -> PyResult<u32> {
    let (least, most) = (picture::WIDTHS.start(), picture::WIDTHS.end());
    picture::WIDTHS
        .contains(&width)
        .then_some(width)
        .ok_or_else(|| refused(format!("width {width}: take {least} to {most} pixels")))
}

/// A simulator read from its pickle.
#[pyfunction]
pub fn _simulator(py: Python<'_>, state: &[u8]) -> PyResult<Simulator> {
    Ok(Simulator::of(episode_of(py, state)?))
}

/// The episode of a saved state.
fn episode_of(py: Python<'_>, state: &[u8]) -> PyResult<Episode> {
    let saved = restored(state)?;
    py.detach(|| Episode::restored(saved)).map_err(|error| refused(format!("state: {error}")))
}

/// The bytes of an argument `state`.
pub fn bytes_of<'a>(state: &'a Bound<'_, PyAny>) -> PyResult<&'a [u8]> {
    let bytes = state.cast::<PyBytes>().map_err(|_| refused("state: take the bytes that save() returned"))?;
    Ok(bytes.as_bytes())
}

fn start(py: Python<'_>, settings: &Settings, seed: u64) -> PyResult<Episode> {
    settings.check().map_err(refused)?;
    py.detach(|| Episode::start(settings.clone(), seed)).map_err(failed)
}

/// An error of the simulator itself.
pub fn failed(error: String) -> PyErr {
    PyRuntimeError::new_err(error)
}

fn side_of(opponent: bool) -> Colour {
    if opponent { Colour::Yellow } else { Colour::Blue }
}

fn league_of(name: &str) -> Option<League> {
    Settings::LEAGUES.into_iter().chain([League::FourLegged]).find(|known| known.name() == name)
}

/// The value of that label, or an error with the known ones.
fn known<T>(name: &str, label: &str, find: fn(&str) -> Option<T>, labels: &[&str]) -> PyResult<T> {
    find(label).ok_or_else(|| refused(format!("{name} {label:?}: take {}", labels.join(" or "))))
}

/// Whether a buffer's numbers are in this machine's byte order: `PyBuffer` takes both orders.
fn has_native_byte_order<T: Element>(buffer: &PyBuffer<T>) -> bool {
    let foreign: &[u8] = if cfg!(target_endian = "little") { b">!" } else { b"<" };
    !buffer.format().to_bytes().first().is_some_and(|order| foreign.contains(order))
}

/// Writes numbers into a writable buffer of their type and number.
pub fn write<T: Element>(name: &str, into: &Bound<'_, PyAny>, values: &[T]) -> PyResult<()> {
    let kind = std::any::type_name::<T>().replace('f', "float").replace('u', "uint");
    let size = values.len();
    let wrong = || refused(format!("{name}: expected a writable, contiguous buffer of {size} {kind}"));
    let buffer = PyBuffer::<T>::get(into).map_err(|_| wrong())?;
    if !has_native_byte_order(&buffer)
        || buffer.readonly()
        || !buffer.is_c_contiguous()
        || buffer.item_count() != size
    {
        return Err(wrong());
    }
    buffer.copy_from_slice(into.py(), values)
}

/// Reads orders from a buffer of float32, or from a sequence of numbers.
pub fn read_actions(name: &str, from: &Bound<'_, PyAny>, into: &mut [f32]) -> PyResult<()> {
    let size = into.len();
    let wrong = || {
        refused(format!(
            "{name}: expected {size} numbers, {ACTION_LEN} a robot: forward, left, turn, kick, dribbler"
        ))
    };
    if let Ok(buffer) = PyBuffer::<f32>::get(from)
        && has_native_byte_order(&buffer)
    {
        if buffer.item_count() != size {
            return Err(wrong());
        }
        buffer.copy_to_slice(from.py(), into)?;
    } else {
        let values: Vec<f32> = from.extract().map_err(|_| wrong())?;
        if values.len() != size {
            return Err(wrong());
        }
        into.copy_from_slice(&values);
    }
    finite(name, into)
}

fn finite(name: &str, values: &[f32]) -> PyResult<()> {
    match values.iter().position(|value| !value.is_finite()) {
        Some(at) => Err(refused(format!("{name}: number {at} is {}; take finite numbers", values[at]))),
        None => Ok(()),
    }
}

/// Width of a picture in a notebook, px.
const NOTEBOOK_WIDTH: u32 = 720;
