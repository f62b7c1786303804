//! `vector`: many episodes of the same settings, stepped by one call on several threads.

use std::sync::Mutex;
use std::sync::mpsc::{Receiver, Sender, channel};

use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::argument;
use crate::episode::{Episode, Saved};
use crate::refused;
use crate::saved::{restored, saved};
use crate::settings::{End, Settings, View};
use crate::simulator::{Simulator, bytes_of, failed, pixels_of, read_actions, write};
use rules::Colour;

/// What `pickle` calls to make a vector again: the function, the saved state, the number of threads.
type Pickle<'py> = (Bound<'py, PyAny>, (Bound<'py, PyBytes>, usize));

/// Episodes side by side.
#[pyclass(module = "onetwo")]
pub struct VectorSimulator {
    settings: Settings,
    shares: Vec<Share>,
    /// One for each share but the first, which the caller's thread steps.
    workers: Vec<Worker>,
    actions: Vec<f32>,
    observations: Vec<f32>,
}

/// One episode and what the next call does with it.
struct Slot {
    episode: Episode,
    /// It is started again from this seed, and not stepped.
    restart: Option<u64>,
}

/// The episodes that one thread steps, with their actions and what came of them. The caller's thread reads
/// these lists only, because the episodes are in the cache of another processor.
#[derive(Default)]
struct Share {
    slots: Vec<Slot>,
    actions: Vec<f32>,
    observations: Vec<f32>,
    rewards: Vec<f32>,
    /// Numbers of the ends in `ENDS`.
    ends: Vec<u8>,
    /// The first that could not be stepped.
    error: Option<String>,
}

/// A thread that steps the shares that it is sent, and sends them back; it ends with this value.
struct Worker {
    to: Sender<Share>,
    back: Mutex<Receiver<Share>>,
}

#[pymethods]
impl VectorSimulator {
    /// `count` episodes with the settings of that simulator, from seeds 0 up.
    #[new]
    fn new(
        py: Python<'_>,
        simulator: &Bound<'_, Simulator>,
        #[pyo3(from_py_with = argument::count)] count: usize,
        #[pyo3(from_py_with = argument::threads)] threads: usize,
    ) -> PyResult<Self> {
        if !(1..=COUNT_MAX).contains(&count) {
            return Err(refused(format!("count {count}: take 1 to {COUNT_MAX} episodes")));
        }
        let settings = simulator.borrow().settings().clone();
        let episodes = py.detach(|| {
            (0..count as u64)
                .map(|seed| Episode::start(settings.clone(), seed))
                .collect::<Result<Vec<_>, _>>()
        });
        Self::of(episodes.map_err(failed)?, settings.clone(), threads)
    }

    /// Starts the listed episodes again, each from its seed, and steps all others. Writes observation,
    /// reward and number of the end of each episode; 0 while it goes on.
    fn step(
        &mut self,
        py: Python<'_>,
        actions: &Bound<'_, PyAny>,
        restarts: Vec<(usize, u64)>,
        observations: &Bound<'_, PyAny>,
        rewards: &Bound<'_, PyAny>,
        ends: &Bound<'_, PyAny>,
    ) -> PyResult<()> {
        read_actions("actions", actions, &mut self.actions)?;
        let share_len = self.shares.first().map_or(1, |share| share.slots.len().max(1));
        let count = self.count();
        for (index, seed) in restarts {
            let share = self.shares.get_mut(index / share_len);
            let slot = share.and_then(|share| share.slots.get_mut(index % share_len));
            slot.ok_or_else(|| refused(format!("restarts: index {index} of {count} episodes")))?.restart =
                Some(seed);
        }
        py.detach(|| self.step_all()).map_err(failed)?;
        write("observations", observations, &self.observations)?;
        write(
            "rewards",
            rewards,
            &self.shares.iter().flat_map(|share| &share.rewards).copied().collect::<Vec<f32>>(),
        )?;
        write("ends", ends, &self.shares.iter().flat_map(|share| &share.ends).copied().collect::<Vec<u8>>())
    }

    /// The simulated time of each episode, s.
    fn times_s(&self) -> Vec<f64> {
        self.slots().map(|slot| slot.episode.state.time_s()).collect()
    }

    /// Whether each episode has ended.
    fn ended(&self) -> Vec<bool> {
        self.slots().map(|slot| slot.episode.state.end.is_some()).collect()
    }

    /// The drawn field of an episode, as `Simulator.pixels`.
    fn pixels<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = argument::index)] index: usize,
        #[pyo3(from_py_with = argument::width)] width: u32,
    ) -> PyResult<(Bound<'py, PyBytes>, u32, u32)> {
        let count = self.count();
        let slot = self.slots().nth(index);
        let slot = slot.ok_or_else(|| refused(format!("index {index}: there are {count} episodes")))?;
        pixels_of(py, &slot.episode, width)
    }

    /// The whole state of all episodes as bytes.
    fn save<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let episodes: Vec<Saved> = self.slots().map(|slot| slot.episode.saved()).collect();
        Ok(PyBytes::new(py, &saved(&(&self.settings, episodes))?))
    }

    /// Goes on from a saved state with the same settings and number of episodes.
    fn restore(&mut self, py: Python<'_>, state: &Bound<'_, PyAny>) -> PyResult<()> {
        let other = vector_of(py, bytes_of(state)?, self.shares.len())?;
        if other.settings != self.settings || other.count() != self.count() {
            return Err(refused(format!(
                "state: {} episodes with {:?}; these are {} with {:?}",
                other.count(),
                other.settings,
                self.count(),
                self.settings
            )));
        }
        *self = other;
        Ok(())
    }

    fn __deepcopy__(&self, py: Python<'_>, _memo: &Bound<'_, PyAny>) -> PyResult<Self> {
        let copies = py.detach(|| self.slots().map(|slot| slot.episode.copy()).collect::<Result<_, _>>());
        Self::of(copies.map_err(failed)?, self.settings.clone(), self.shares.len())
    }

    /// A pickle holds the saved state.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Pickle<'py>> {
        Ok((py.import("onetwo._native")?.getattr("_vector")?, (self.save(py)?, self.shares.len())))
    }

    /// Names of the ends, by their numbers; None while an episode goes on.
    #[classattr]
    const ENDS: [Option<&'static str>; 1 + End::ALL.len()] = {
        let mut ends = [None; 1 + End::ALL.len()];
        let mut at = 0;
        while at < End::ALL.len() {
            ends[1 + End::ALL[at] as usize] = Some(End::ALL[at].label());
            at += 1;
        }
        ends
    };
}

impl VectorSimulator {
    fn of(episodes: Vec<Episode>, settings: Settings, threads: usize) -> PyResult<Self> {
        if !(1..=THREADS_MAX).contains(&threads) {
            return Err(refused(format!("threads {threads}: take 1 to {THREADS_MAX} threads")));
        }
        let (count, action_len) = (episodes.len(), settings.action_len(Colour::Blue));
        let observation_len = settings.observation_len();
        let mut shares: Vec<Share> = Vec::new();
        for (n, episode) in episodes.into_iter().enumerate() {
            if n % count.div_ceil(threads) == 0 {
                shares.push(Share::default());
            }
            let Some(share) = shares.last_mut() else { continue };
            share.slots.push(Slot { episode, restart: None });
            share.actions.resize(action_len * share.slots.len(), 0.0);
            share.observations.resize(observation_len * share.slots.len(), 0.0);
            share.rewards.push(0.0);
            share.ends.push(0);
        }
        let workers = shares.iter().skip(1).map(|_| Worker::start()).collect::<Result<_, _>>();
        Ok(Self {
            workers: workers.map_err(failed)?,
            actions: vec![0.0; count * action_len],
            observations: vec![0.0; count * observation_len],
            shares,
            settings,
        })
    }

    fn slots(&self) -> impl Iterator<Item = &Slot> {
        self.shares.iter().flat_map(|share| &share.slots)
    }

    fn count(&self) -> usize {
        self.slots().count()
    }

    /// Steps the first share on this thread, the others on one each; the first error, if there is any.
    fn step_all(&mut self) -> Result<(), String> {
        let (mut actions, mut observations) = (&self.actions[..], &mut self.observations[..]);
        for share in &mut self.shares {
            let len = share.actions.len();
            share.actions.copy_from_slice(&actions[..len]);
            actions = &actions[len..];
        }
        let (first, others) = self.shares.split_at_mut(1);
        for (share, worker) in others.iter_mut().zip(&self.workers) {
            worker.to.send(std::mem::take(share)).map_err(|_| ENDED)?;
        }
        first.iter_mut().for_each(Share::step);
        for (share, worker) in others.iter_mut().zip(&self.workers) {
            *share = worker.back.lock().map_err(|_| ENDED)?.recv().map_err(|_| ENDED)?;
        }
        for share in &self.shares {
            let (into, rest) = observations.split_at_mut(share.observations.len());
            into.copy_from_slice(&share.observations);
            observations = rest;
        }
        self.shares.iter_mut().find_map(|share| share.error.take()).map_or(Ok(()), Err)
    }
}

impl Worker {
    fn start() -> Result<Self, String> {
        let (to, inbox) = channel::<Share>();
        let (outbox, back) = channel();
        let thread = std::thread::Builder::new().name("onetwo vector".to_owned()).spawn(move || {
            for mut share in inbox {
                share.step();
                if outbox.send(share).is_err() {
                    break;
                }
            }
        });
        thread.map_err(|error| format!("no thread for episodes: {error}"))?;
        Ok(Self { to, back: Mutex::new(back) })
    }
}

impl Share {
    fn step(&mut self) {
        let count = self.slots.len().max(1);
        let (action_len, observation_len) = (self.actions.len() / count, self.observations.len() / count);
        let actions = self.actions.chunks_exact(action_len);
        let observations = self.observations.chunks_exact_mut(observation_len);
        let results = self.rewards.iter_mut().zip(&mut self.ends);
        for (((slot, action), observation), (reward, end)) in
            self.slots.iter_mut().zip(actions).zip(observations).zip(results)
        {
            if let Err(error) = slot.step(action) {
                self.error.get_or_insert(error);
            }
            slot.episode.observe(View { side: Colour::Blue, first: 0 }, observation);
            (*reward, *end) = (slot.episode.state.reward, slot.end_number());
        }
    }
}

impl Slot {
    /// Number of its end in `ENDS`.
    fn end_number(&self) -> u8 {
        self.episode.state.end.map_or(0, |end| 1 + end as u8)
    }

    fn step(&mut self, action: &[f32]) -> Result<(), String> {
        let Some(seed) = self.restart.take() else { return self.episode.step(action, &[]) };
        self.episode = Episode::start(self.episode.state.settings.clone(), seed)?;
        Ok(())
    }
}

/// A vector read from its pickle.
#[pyfunction]
pub fn _vector(py: Python<'_>, state: &[u8], threads: usize) -> PyResult<VectorSimulator> {
    vector_of(py, state, threads)
}

fn vector_of(py: Python<'_>, state: &[u8], threads: usize) -> PyResult<VectorSimulator> {
    let (settings, episodes): (Settings, Vec<Saved>) = restored(state)?;
    let episodes = py.detach(|| episodes.into_iter().map(Episode::restored).collect::<Result<Vec<_>, _>>());
    let episodes = episodes.map_err(|error| refused(format!("state: {error}")))?;
    if episodes.is_empty() || episodes.iter().any(|episode| episode.state.settings != settings) {
        return Err(refused("state: damaged: its episodes do not fit its settings"));
    }
    VectorSimulator::of(episodes, settings, threads)
}

const ENDED: &str = "a thread of the vector has ended; make another vector";
/// Most threads of a vector: more than processors of one machine help nothing.
const THREADS_MAX: usize = 256;
/// Most episodes of a vector: 100 MB of worlds, an estimate.
const COUNT_MAX: usize = 10_000;
