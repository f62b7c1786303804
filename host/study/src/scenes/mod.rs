//! `scenes`: short scenes of play, each played by several variants of our team from the same start and with
//! the same random numbers. What a part of the play is worth is read off the pairs.
//!
//! Whole matches see little of a part that acts a few times in each: of 40 matches a difference of less than
//! 0.8 goals a match is lost in chance. A scene is a free kick of ours, or a moment of open play with a robot
//! of ours nearest to the ball, and lasts [`SCENE_S`] from the moment at which the ball is in play.
//!
//! ```text
//! matches of other seeds ─► SceneStart ─► play(start, team) for each team ─► SceneRow ─► scene_effects
//! ```
//! Ours is blue. SI units, field frame.

mod effect;
mod play;
mod row;
mod start;
mod table;

use hil_sim::small_size::worlds::WorldChoice;
use host::strategy::Team;
use rules::{Colour, League};
use serde::Serialize;

pub use effect::{SceneEffect, SceneMeasure, scene_effects};
pub use play::SceneOutcome;
pub use row::SceneRow;
pub use start::SceneStart;
pub use table::scene_table;

use crate::matches::MatchTeam;
use crate::store::{Experiment, job_seed};
use arena::game::{GameConfig, GameError};

/// Time in which a scene is watched, from the moment at which the ball is in play, s: the issue's measure of
/// an attack, in which a team can pass twice and shoot.
pub const SCENE_S: f64 = 12.0;

const US: Colour = Colour::Blue;

geometry::labels! {
    /// Kind of start of a scene.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum SceneKind {
        /// Our free kick in the other half.
        FreeKick = "free-kick",
        /// The ball in play, with a robot of ours nearest to it.
        OpenPlay = "open-play",
    }
}

/// The scenes of a measurement. Equal plans give equal rows on any number of threads.
#[derive(Clone, Debug)]
pub struct ScenePlan {
    /// Field, robots and rules.
    pub league: League,
    /// Physics of all scenes.
    pub world: WorldChoice,
    /// Seed of starts and scenes.
    pub seed: u64,
    /// Number of free kicks against each opponent.
    pub free_kicks: u32,
    /// Number of moments of open play against each opponent.
    pub open_play: u32,
    /// The team that the others are compared with.
    pub team: MatchTeam,
    /// The same with one part more or less.
    pub variants: Vec<MatchTeam>,
    /// The teams that they play against.
    pub opponents: Vec<MatchTeam>,
}

/// A scene of a plan, ready to be played.
#[derive(Clone, Debug)]
pub struct Scene {
    kind: SceneKind,
    opponent: MatchTeam,
    /// Number among those of its kind and opponent, from 0.
    number: u32,
    start: SceneStart,
    team: MatchTeam,
}

impl Experiment for ScenePlan {
    type Job = Scene;
    type Row = SceneRow;
    type Error = GameError;

    /// Draws the starts; every scene stands once for each team.
    fn jobs(&self) -> Result<Vec<Scene>, GameError> {
        let mut jobs = Vec::new();
        for opponent in self.opponents.iter().copied() {
            for (kind, number, start) in start::draw(self, opponent)? {
                let teams = [self.team].into_iter().chain(self.variants.iter().copied());
                jobs.extend(teams.map(|team| Scene { kind, opponent, number, start: start.clone(), team }));
            }
        }
        Ok(jobs)
    }

    fn play(&self, scene: &Scene) -> Result<SceneRow, GameError> {
        let Scene { kind, opponent, number, ref start, team } = *scene;
        let seed = self.seed_of(kind, number);
        let outcome = play::play(&self.config(team, opponent, seed, SCENE_S_MAX), kind, start)?;
        Ok(SceneRow { kind, opponent, number, seed, team, outcome })
    }
}

impl ScenePlan {
    /// Number of scenes, each team's counted.
    pub fn len(&self) -> usize {
        (self.free_kicks + self.open_play) as usize * self.opponents.len() * (1 + self.variants.len())
    }

    /// Whether it has no scenes.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    fn config(&self, team: MatchTeam, opponent: MatchTeam, seed: u64, duration_s: f64) -> GameConfig {
        let mut config = GameConfig::new(self.league, seed, duration_s).between(Team::Ours, opponent.team);
        config.world = self.world;
        for setup in &mut config.teams {
            let plays = if setup.colour == US { team } else { opponent };
            (setup.tactics, setup.approach) = (plays.host_tactics(), plays.approach());
        }
        config
    }

    /// The seed of a scene is the same for all teams and opponents.
    fn seed_of(&self, kind: SceneKind, number: u32) -> u64 {
        job_seed(self.seed, kind.label(), number)
    }
}

/// Longest scene, with the stop and the free kick before it, s.
const SCENE_S_MAX: f64 = 60.0;

#[cfg(test)]
mod tests;
