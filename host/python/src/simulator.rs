//! `simulator`: the Small Size simulator in Python, step by step. Numbers come and go through buffers, such
//! as NumPy's arrays, without NumPy being needed.

use geometry::{Angle, Point, Pose, Vector};
use hil_sim::small_size::Ball;
use protocol::{RobotId, Who};
use pyo3::buffer::PyBuffer;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rules::{Colour, League};

use crate::argument::{self, Text};
use crate::episode::{ACTION_LEN, Episode, Settings, observation_len};
use crate::refused;

/// Episodes of the Small Size simulator.
#[derive(Clone)]
#[pyclass(module = "onetwo")]
pub struct Simulator {
    settings: Settings,
    episode: Episode,
    /// Seed of the episode, and what has happened in it since: they are what a pickle holds.
    seed: u64,
    events: Vec<Event>,
    own: Vec<f32>,
    opponents: Vec<f32>,
    observation: Vec<f32>,
}

#[pymethods]
impl Simulator {
    /// A simulator, with its first episode begun from `seed`.
    #[new]
    #[pyo3(signature = (own = 1, opponents = 0, *, league = Text::of("division-b"), period_ms = 25, time_limit_s = 30.0, seed = 0))]
    fn new(
        #[pyo3(from_py_with = argument::own)] own: usize,
        #[pyo3(from_py_with = argument::opponents_count)] opponents: usize,
        #[pyo3(from_py_with = argument::league)] league: Text,
        #[pyo3(from_py_with = argument::period_ms)] period_ms: u32,
        #[pyo3(from_py_with = argument::time_limit_s)] time_limit_s: f64,
        #[pyo3(from_py_with = argument::seed)] seed: u64,
    ) -> PyResult<Self> {
        let found = LEAGUES.into_iter().find(|known| known.name() == &*league);
        let league = found.ok_or_else(|| {
            refused(format!("league {:?}: take {}", &*league, LEAGUES.map(League::name).join(" or ")))
        })?;
        if !(1..=ROBOTS_MAX).contains(&own) || opponents > ROBOTS_MAX {
            return Err(refused(format!(
                "own {own}, opponents {opponents}: take 1 to {ROBOTS_MAX} own robots and at most {ROBOTS_MAX} opponents"
            )));
        }
        if !(1..=PERIOD_MAX_MS).contains(&period_ms) {
            return Err(refused(format!("period_ms {period_ms}: take 1 to {PERIOD_MAX_MS} ms")));
        }
        if time_limit_s.is_nan() || time_limit_s <= 0.0 {
            return Err(refused(format!("time_limit_s {time_limit_s}: take more than 0 s")));
        }
        let settings = Settings { league, own, opponents, period_ms, time_limit_s };
        let episode = start(&settings, seed)?;
        Ok(Self {
            own: vec![0.0; ACTION_LEN * own],
            opponents: vec![0.0; ACTION_LEN * opponents],
            observation: vec![0.0; observation_len(&settings)],
            settings,
            episode,
            seed,
            events: Vec::new(),
        })
    }

    /// Begins another episode, from the start positions of that seed.
    fn reset(&mut self, #[pyo3(from_py_with = argument::seed)] seed: u64) -> PyResult<()> {
        self.episode = start(&self.settings, seed)?;
        self.seed = seed;
        self.events.clear();
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
        read("actions", actions, &mut self.own)?;
        if let Some(actions) = opponent_actions {
            read("opponent_actions", actions, &mut self.opponents)?;
        }
        let against = opponent_actions.map_or_else(Vec::new, |_| self.opponents.clone());
        let event = Event::Step { own: self.own.clone(), opponents: against };
        py.detach(|| self.play(event));
        if let Some(into) = into {
            self.observe(into)?;
        }
        Ok((self.episode.reward, self.episode.end.map(crate::episode::End::label)))
    }

    /// Writes the observation into a writable buffer of `observation_size` float32.
    fn observe(&mut self, into: &Bound<'_, PyAny>) -> PyResult<()> {
        let size = observation_len(&self.settings);
        let wrong = || refused(format!("into: expected a writable, contiguous buffer of {size} float32"));
        let buffer = PyBuffer::<f32>::get(into).map_err(|_| wrong())?;
        if !has_native_byte_order(&buffer)
            || buffer.readonly()
            || !buffer.is_c_contiguous()
            || buffer.item_count() != size
        {
            return Err(wrong());
        }
        let values = &mut self.observation[..];
        self.episode.observe(|at, value| values[at] = value);
        buffer.copy_from_slice(into.py(), values)
    }

    /// The true state as a dict: SI units, field frame, own robots attack +x.
    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let world = &self.episode.world;
        let ball = PyDict::new(py);
        let (at, velocity) = (world.ball.position, world.ball.velocity);
        ball.set_item("position", (at.x(), at.y(), world.ball.height))?;
        ball.set_item("velocity", (velocity.x(), velocity.y(), world.ball.climb))?;
        let state = PyDict::new(py);
        state.set_item("time_s", world.time())?;
        state.set_item("ball", ball)?;
        for (name, colour, count) in
            [("own", Colour::Blue, self.settings.own), ("opponents", Colour::Yellow, self.settings.opponents)]
        {
            let mut robots = Vec::new();
            for robot in RobotId::all().take(count).filter_map(|id| world.robot(Who { colour, id })) {
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
        Ok(state)
    }

    /// Places the ball on the ground, rolling with that velocity.
    #[pyo3(signature = (x, y, vx = 0.0, vy = 0.0))]
    fn place_ball(
        &mut self,
        #[pyo3(from_py_with = argument::x)] x: f32,
        #[pyo3(from_py_with = argument::y)] y: f32,
        #[pyo3(from_py_with = argument::vx)] vx: f32,
        #[pyo3(from_py_with = argument::vy)] vy: f32,
    ) {
        self.play(Event::Ball([x, y, vx, vy]));
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
        let count = if opponent { self.settings.opponents } else { self.settings.own };
        if index >= count {
            return Err(refused(format!("index {index}: that team has {count} robots")));
        }
        self.play(Event::Robot { opponent, index: index as u8, pose: [x, y, heading] });
        Ok(())
    }

    fn __copy__(&self) -> Self {
        self.clone()
    }

    /// The episode goes on in the copy as it would here, bit for bit.
    fn __deepcopy__(&self, _memo: &Bound<'_, PyAny>) -> Self {
        self.clone()
    }

    /// A pickle holds the seed and all that happened since; it is played again.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, Pickled)> {
        let function = py.import("onetwo._native")?.getattr("_simulator")?;
        let Settings { league, own, opponents, period_ms, time_limit_s } = self.settings;
        let events = self.events.iter().map(Event::numbers).collect();
        Ok((function, (own, opponents, league.name().to_owned(), period_ms, time_limit_s, self.seed, events)))
    }

    /// Simulated time since the episode's start, s.
    #[getter]
    fn time_s(&self) -> f64 {
        self.episode.world.time()
    }

    /// Number of values in `actions`.
    #[getter]
    fn action_size(&self) -> usize {
        self.own.len()
    }

    /// Number of values in an observation.
    #[getter]
    fn observation_size(&self) -> usize {
        observation_len(&self.settings)
    }

    /// Hash of every step's state so far: equal for equal episodes.
    #[getter]
    fn trace_hash(&self) -> String {
        self.episode.trace_hash()
    }
}

/// Arguments of [`_simulator`].
type Pickled = (usize, usize, String, u32, f64, u64, Vec<Vec<f32>>);

/// What was done to an episode.
#[derive(Clone)]
enum Event {
    /// A control period with these orders.
    Step { own: Vec<f32>, opponents: Vec<f32> },
    /// The ball was placed: place and velocity.
    Ball([f32; 4]),
    /// A robot was placed: place and heading.
    Robot { opponent: bool, index: u8, pose: [f32; 3] },
}

impl Event {
    /// As numbers: the kind, then what it has.
    fn numbers(&self) -> Vec<f32> {
        match self {
            Self::Step { own, opponents } => [&[0.0], &own[..], opponents].concat(),
            Self::Ball(ball) => [&[1.0], &ball[..]].concat(),
            Self::Robot { opponent, index, pose } => {
                [&[2.0, f32::from(u8::from(*opponent)), f32::from(*index)], &pose[..]].concat()
            }
        }
    }

    /// An event of its numbers, in an episode with that many numbers of own orders.
    fn of(numbers: &[f32], own_len: usize) -> Option<Self> {
        match numbers.split_first()? {
            (0.0, orders) => {
                let (own, opponents) = orders.split_at_checked(own_len)?;
                Some(Self::Step { own: own.to_vec(), opponents: opponents.to_vec() })
            }
            (1.0, ball) => Some(Self::Ball(ball.try_into().ok()?)),
            (2.0, [opponent, index, pose @ ..]) => {
                let pose = pose.try_into().ok()?;
                Some(Self::Robot { opponent: *opponent != 0.0, index: *index as u8, pose })
            }
            _ => None,
        }
    }
}

impl Simulator {
    /// Does something to the episode, and keeps it for a pickle.
    fn play(&mut self, event: Event) {
        let world = &mut self.episode.world;
        match &event {
            Event::Step { own, opponents } => self.episode.step(own, opponents),
            Event::Ball([x, y, vx, vy]) => {
                world.put_ball(Ball::rolling(Point::new(*x, *y), Vector::new(*vx, *vy)));
            }
            Event::Robot { opponent, index, pose: [x, y, heading] } => {
                let colour = if *opponent { Colour::Yellow } else { Colour::Blue };
                let pose = Pose { position: Point::new(*x, *y), heading: Angle::new(*heading) };
                if let Some(id) = RobotId::new(*index) {
                    world.put(Who { colour, id }, pose);
                }
            }
        }
        self.events.push(event);
    }
}

/// A simulator read from its pickle.
#[pyfunction]
pub fn _simulator(
    own: usize,
    opponents: usize,
    league: &str,
    period_ms: u32,
    time_limit_s: f64,
    seed: u64,
    events: Vec<Vec<f32>>,
) -> PyResult<Simulator> {
    let league = Text::from(league.to_owned());
    let mut simulator = Simulator::new(own, opponents, league, period_ms, time_limit_s, seed)?;
    for numbers in events {
        let event = Event::of(&numbers, ACTION_LEN * own);
        simulator.play(event.ok_or_else(|| refused("a pickle of another version of onetwo"))?);
    }
    Ok(simulator)
}

fn start(settings: &Settings, seed: u64) -> PyResult<Episode> {
    Episode::start(settings.clone(), seed)
        .ok_or_else(|| PyRuntimeError::new_err("that league has no simulator of wheeled robots"))
}

/// Whether a buffer's numbers are in this machine's byte order: `PyBuffer` takes both orders.
fn has_native_byte_order(buffer: &PyBuffer<f32>) -> bool {
    let foreign: &[u8] = if cfg!(target_endian = "little") { b">!" } else { b"<" };
    !buffer.format().to_bytes().first().is_some_and(|order| foreign.contains(order))
}

/// Reads numbers from a buffer of float32, or from a sequence of numbers.
fn read(name: &str, from: &Bound<'_, PyAny>, into: &mut [f32]) -> PyResult<()> {
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

/// Leagues with wheeled robots.
const LEAGUES: [League; 3] = [League::DivisionB, League::DivisionA, League::Ssl2013];
/// Robots of a team, as division A has them.
const ROBOTS_MAX: usize = 11;
/// Longest control period, ms: robots brake where an order is older (`order_lasts`).
const PERIOD_MAX_MS: u32 = 100;
