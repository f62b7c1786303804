//! `skills`: success rate and time of single skills, through the whole loop, in worlds of any physics.
//!
//! ```text
//! SkillPlan ─► tries (skill × world × number) ─► drill: start, orders, judge ─► TryResult ─► SkillRow
//! ```
//! A try plays world, cameras, host, radio and brains as a match does. Its start comes from seed, skill and
//! number alone, so that one number starts equally in every named world; the true world decides whether it
//! succeeded. Times in simulated seconds.

mod catches;
mod drill;
mod kicks;
mod placement;
mod places;
mod rows;
mod save;
mod story;
#[cfg(test)]
mod tests;

use casebase::CaseBase;
use hil_sim::NativeBackend;
use hil_sim::small_size::worlds::WorldChoice;
use rules::League;

use crate::store::Experiment;
use arena::game::GameError;
pub use rows::{SkillRow, rows};

geometry::labels! {
    /// A skill that is measured.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
    pub enum Skill {
        /// The referee's ball placement, by a whole team under its coach.
        Placement = "placement",
        /// Having the ball: resting, rolling, at a board, beside an opponent.
        GetBall = "get-ball",
        /// Having a ball that was passed.
        Receive = "receive",
        /// Carrying the ball a metre, within the rules.
        Dribble = "dribble",
        /// Half a turn with the ball.
        TurnWithBall = "turn-with-ball",
        /// A flat kick past a point three metres away.
        Kick = "kick",
        /// A chip over a robot.
        Chip = "chip",
        /// The keeper stops a shot.
        Save = "save",
    }
}

/// Tries to be played.
#[derive(Clone, Debug)]
pub struct SkillPlan {
    /// Field, robots, ball and rules.
    pub league: League,
    /// Name of the worlds as the user gave it: a name, or `random`.
    pub world: String,
    /// The physics of each world.
    pub worlds: Vec<WorldChoice>,
    /// Tries of each skill in each world.
    pub tries: u32,
    /// Number of the first try: a single one is repeated by its number.
    pub first: u32,
    /// Seed of all random numbers.
    pub seed: u64,
    /// Skills to try, in the order of the table.
    pub skills: Vec<Skill>,
}

/// One try of a plan.
#[derive(Clone, Debug)]
pub struct Try {
    /// The skill that is tried.
    pub skill: Skill,
    /// Field, robots, ball and rules.
    pub league: League,
    /// The physics that it is tried in.
    pub world: WorldChoice,
    /// Number of the start: the same start in every named world.
    pub number: u32,
    /// Seed of the plan, from which the start is drawn.
    pub seed: u64,
}

/// Result of a try.
#[derive(Clone, Debug)]
pub struct TryResult {
    /// The try that was made.
    pub tried: Try,
    /// Description of its start.
    pub start: String,
    /// Simulated seconds until it succeeded, or what was wrong at the end.
    pub end: Result<f32, String>,
}

impl SkillPlan {
    /// All tries, skill by skill and world by world.
    pub fn tries(&self) -> Vec<Try> {
        let mut all = Vec::new();
        for &skill in &self.skills {
            for (i, world) in self.worlds.iter().enumerate() {
                // Another start in every random world, or tries of one kind alone would be met.
                let first = self.first + i as u32 * self.tries;
                all.extend((first..first + self.tries).map(|number| Try {
                    skill,
                    league: self.league,
                    world: *world,
                    number,
                    seed: self.seed,
                }));
            }
        }
        all
    }
}

impl Experiment for SkillPlan {
    type Job = Try;
    type Row = TryResult;
    type Error = GameError;

    fn jobs(&self) -> Result<Vec<Try>, GameError> {
        Ok(self.tries())
    }

    fn play(&self, tried: &Try) -> Result<TryResult, GameError> {
        tried.clone().play(&mut Vec::new())
    }
}

impl Try {
    /// Plays it; `story` gets a line for every tenth of a second.
    pub fn play(self, story: &mut Vec<String>) -> Result<TryResult, GameError> {
        drill::play(self, &mut NativeBackend::new(CaseBase::default()), story)
    }

    /// The command that plays it again.
    pub fn command(&self) -> String {
        format!(
            "onetwo evaluate skills --league {} --world {} --skill {} --first {} --tries 1 --seed {} --story",
            self.league.name(),
            self.world,
            self.skill.label(),
            self.number,
            self.seed
        )
    }
}
