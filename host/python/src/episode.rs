//! `episode`: one attempt at a task in the Small Size simulator, in steps of one control period, and how it
//! is saved.

use geometry::{Field, Pose};
use hil_sim::TraceHash;
use hil_sim::small_size::Ball;
use protocol::Who;
use serde::{Deserialize, Serialize};

use crate::computers::{self, Computers};
use crate::sensed::SensedWorld;
use crate::settings::{Observation, Settings, View};
use crate::state::State;

/// What the caller did to an episode.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub enum Event {
    /// A control period with these orders of each side.
    Step(Vec<f32>, Vec<f32>),
    /// The ball was placed.
    Ball(Ball),
    /// A robot was placed.
    Robot(Who, Pose<Field>),
}

/// An episode as it is saved.
#[derive(Serialize, Deserialize)]
pub enum Saved {
    /// All of its state.
    Whole(Box<State>),
    /// Where computers play or cameras watch, what happened since the start, to be played again; with the
    /// hash at the end.
    Played(Settings, u64, Vec<Event>, TraceHash),
}

/// Episode with its world, advanced action by action.
#[derive(Debug)]
pub struct Episode {
    /// Its state, but for computers'.
    pub state: State,
    computers: Option<Computers>,
    sensed: Option<SensedWorld>,
    /// Where computers play or cameras watch, what happened since the start.
    events: Vec<Event>,
}

impl Episode {
    /// From start positions that follow from the seed; an error where that cannot be played.
    pub fn start(settings: Settings, seed: u64) -> Result<Self, String> {
        settings.check()?;
        let mut state = State::start(settings, seed)?;
        let computers = if computers::are_needed(&state.settings) {
            let computers = Computers::start(&state.settings, seed, &mut state.world)?;
            state.started = state.world.now();
            Some(computers)
        } else {
            None
        };
        state.trace.small_size_tick(0, &state.world);
        let sensed =
            (state.settings.observation == Observation::Sensed).then(|| state.sensed()).transpose()?;
        Ok(Self { state, computers, sensed, events: Vec::new() })
    }

    /// Writes the observation, [`Settings::observation_len`] numbers within ±1.
    pub fn observe(&self, view: View, into: &mut [f32]) {
        self.state.observe(view, self.sensed.as_ref().map(|sensed| &sensed.estimated), into);
    }

    /// Plays one control period with these orders, [`ACTION_LEN`] numbers for each robot; an empty slice
    /// for the opponents lets them stand, or their driver drive. A finished episode stays as it is.
    pub fn step(&mut self, own: &[f32], opponents: &[f32]) -> Result<(), String> {
        self.state.reward = 0.0;
        if self.state.end.is_some() {
            return Ok(());
        }
        self.keep(|| Event::Step(own.to_vec(), opponents.to_vec()));
        let state = &mut self.state;
        state.order(own, opponents);
        let (before, was_in_play) = (state.potential(), state.in_play);
        let Some(computers) = &self.computers else {
            for _ in 0..state.settings.period_ms {
                state.world.step();
                if let Some(sensed) = &mut self.sensed {
                    sensed.look(&state.world);
                }
                state.end = state.judge();
                if state.end.is_some() {
                    break;
                }
            }
            state.finish_step(before, was_in_play, [0; 2], &mut self.sensed);
            return Ok(());
        };
        let score = state.score;
        for _ in 0..state.settings.period_ms / state.settings.tick_ms() {
            let judgement = computers.tick(&mut state.world)?;
            if let Some(sensed) = &mut self.sensed {
                sensed.look(&state.world);
            }
            if state.settings.task.spec().referee {
                state.take(judgement);
            }
            state.end = judgement.end.or_else(|| state.judge());
            if state.end.is_some() {
                break;
            }
        }
        state.finish_step(before, was_in_play, score, &mut self.sensed);
        Ok(())
    }

    /// Places the ball.
    pub fn put_ball(&mut self, ball: Ball) {
        self.keep(|| Event::Ball(ball));
        self.state.world.put_ball(ball);
    }

    /// Places a robot, resting.
    pub fn put_robot(&mut self, who: Who, pose: Pose<Field>) {
        self.keep(|| Event::Robot(who, pose));
        self.state.world.put(who, pose);
    }

    /// Keeps an event where a copy must play it again.
    fn keep(&mut self, event: impl FnOnce() -> Event) {
        if self.is_played_again() {
            self.events.push(event());
        }
    }

    /// Whether a saved state is the seed and what happened since.
    fn is_played_again(&self) -> bool {
        self.computers.is_some() || self.sensed.is_some()
    }

    /// Another that goes on as this one would.
    pub fn copy(&self) -> Result<Self, String> {
        if self.computers.is_some() {
            return Self::restored(self.saved());
        }
        let (state, sensed) = (self.state.clone(), self.sensed.clone());
        Ok(Self { state, computers: None, sensed, events: self.events.clone() })
    }

    /// The episode as it is saved.
    pub fn saved(&self) -> Saved {
        let state = &self.state;
        if self.is_played_again() {
            let settings = state.settings.clone();
            return Saved::Played(settings, state.seed, self.events.clone(), state.trace);
        }
        Saved::Whole(Box::new(state.clone()))
    }

    /// The episode that was saved; an error where it is none.
    pub fn restored(saved: Saved) -> Result<Self, String> {
        match saved {
            Saved::Whole(state) => {
                state.settings.check()?;
                let is_played_again = computers::are_needed(&state.settings)
                    || state.settings.observation == Observation::Sensed;
                if !state.is_consistent() || is_played_again {
                    return Err("its robots do not fit its settings".to_owned());
                }
                Ok(Self { state: *state, computers: None, sensed: None, events: Vec::new() })
            }
            Saved::Played(settings, seed, events, trace) => {
                let mut episode = Self::start(settings, seed)?;
                for event in events {
                    match event {
                        Event::Step(own, opponents) => episode.step(&own, &opponents)?,
                        Event::Ball(ball) => episode.put_ball(ball),
                        Event::Robot(who, pose) => episode.put_robot(who, pose),
                    }
                }
                if episode.state.trace != trace {
                    return Err("another build of onetwo, or another machine, plays otherwise".to_owned());
                }
                Ok(episode)
            }
        }
    }
}
