//! `vector`: many episodes of the same settings, stepped by one call on several threads.

use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::argument;
use crate::episode::{Episode, Saved};
use crate::refused;
use crate::saved::{restored, saved};
use crate::settings::{End, Settings, View};
use crate::simulator::{Simulator, bytes_of, failed, read_actions, write};
use rules::Colour;

/// What `pickle` calls to make a vector again: the function, the saved state, the number of threads.
type Pickle<'py> = (Bound<'py, PyAny>, (Bound<'py, PyBytes>, usize));

/// Episodes side by side.
#[pyclass(module = "onetwo")]
pub struct VectorSimulator {
    settings: Settings,
    threads: usize,
    slots: Vec<Slot>,
    actions: Vec<f32>,
    observations: Vec<f32>,
}

/// One episode and what the next call does with it.
struct Slot {
    episode: Episode,
    /// It is started again from this seed, and not stepped.
    restart: Option<u64>,
    error: Option<String>,
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
        let start = |seed| Episode::start(settings.clone(), seed);
        let episodes = py.detach(|| (0..count as u64).map(start).collect::<Result<Vec<_>, _>>());
        Ok(Self::of(episodes.map_err(failed)?, settings.clone(), threads))
    }

    /// Starts the listed episodes again, each from its seed, and steps all others. Writes the observations, the
    /// rewards and the number of the end of each episode; 0 while it goes on.
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
        for (index, seed) in restarts {
            let count = self.slots.len();
            let slot = self.slots.get_mut(index);
            slot.ok_or_else(|| refused(format!("restarts: index {index} of {count} episodes")))?.restart =
                Some(seed);
        }
        py.detach(|| self.step_all());
        if let Some(error) = self.slots.iter_mut().find_map(|slot| slot.error.take()) {
            return Err(failed(error));
        }
        write("observations", observations, &self.observations)?;
        let of = |slot: &Slot| slot.episode.state.reward;
        write("rewards", rewards, &self.slots.iter().map(of).collect::<Vec<f32>>())?;
        let of = |slot: &Slot| slot.episode.state.end.map_or(0, |end| 1 + end as u8);
        write("ends", ends, &self.slots.iter().map(of).collect::<Vec<u8>>())
    }

    /// The simulated time of each episode, s.
    fn times_s(&self) -> Vec<f64> {
        self.slots.iter().map(|slot| slot.episode.state.time_s()).collect()
    }

    /// Whether each episode has ended.
    fn ended(&self) -> Vec<bool> {
        self.slots.iter().map(|slot| slot.episode.state.end.is_some()).collect()
    }

    /// The whole state of all episodes as bytes.
    fn save<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let episodes: Vec<Saved> = self.slots.iter().map(|slot| slot.episode.saved()).collect();
        Ok(PyBytes::new(py, &saved(&(&self.settings, episodes))?))
    }

    /// Goes on from a saved state with the same settings and number of episodes.
    fn restore(&mut self, py: Python<'_>, state: &Bound<'_, PyAny>) -> PyResult<()> {
        let other = vector_of(py, bytes_of(state)?, self.threads)?;
        if other.settings != self.settings || other.slots.len() != self.slots.len() {
            return Err(refused(format!(
                "state: {} episodes with {:?}; these are {} with {:?}",
                other.slots.len(),
                other.settings,
                self.slots.len(),
                self.settings
            )));
        }
        *self = other;
        Ok(())
    }

    fn __deepcopy__(&self, py: Python<'_>, _memo: &Bound<'_, PyAny>) -> PyResult<Self> {
        let copies =
            py.detach(|| self.slots.iter().map(|slot| slot.episode.copy()).collect::<Result<_, _>>());
        Ok(Self::of(copies.map_err(failed)?, self.settings.clone(), self.threads))
    }

    /// A pickle holds the saved state.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Pickle<'py>> {
        Ok((py.import("onetwo._native")?.getattr("_vector")?, (self.save(py)?, self.threads)))
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
    fn of(episodes: Vec<Episode>, settings: Settings, threads: usize) -> Self {
        let slot = |episode| Slot { episode, restart: None, error: None };
        Self {
            actions: vec![0.0; episodes.len() * settings.action_len(Colour::Blue)],
            observations: vec![0.0; episodes.len() * settings.observation_len()],
            slots: episodes.into_iter().map(slot).collect(),
            threads: threads.max(1),
            settings,
        }
    }

    /// One share of the episodes on this thread, the others on one each.
    fn step_all(&mut self) {
        let (action_len, observation_len) =
            (self.settings.action_len(Colour::Blue), self.settings.observation_len());
        let share = self.slots.len().div_ceil(self.threads);
        let shares = self.slots.chunks_mut(share).zip(self.actions.chunks(share * action_len));
        let mut shares = shares.zip(self.observations.chunks_mut(share * observation_len));
        std::thread::scope(|scope| {
            let first = shares.next();
            for ((slots, actions), observations) in shares {
                scope.spawn(move || step_share(slots, actions, observations));
            }
            if let Some(((slots, actions), observations)) = first {
                step_share(slots, actions, observations);
            }
        });
    }
}

fn step_share(slots: &mut [Slot], actions: &[f32], observations: &mut [f32]) {
    let count = slots.len();
    let actions = actions.chunks_exact(actions.len() / count);
    let observations = observations.chunks_exact_mut(observations.len() / count);
    for ((slot, action), observation) in slots.iter_mut().zip(actions).zip(observations) {
        let done = match slot.restart.take() {
            Some(seed) => Episode::start(slot.episode.state.settings.clone(), seed)
                .map(|episode| slot.episode = episode),
            None => slot.episode.step(action, &[]),
        };
        slot.error = done.err();
        slot.episode.state.observe(View { side: Colour::Blue, first: 0 }, observation);
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
    Ok(VectorSimulator::of(episodes, settings, threads))
}

/// Most episodes of a vector: 100 MB of worlds, an estimate.
const COUNT_MAX: usize = 10_000;
