//! `drills`: our team against scripted opponents, from starts drawn around recorded situations: what a
//! carrier at our area, a marker at our free kick, a cross, a rebound or a shielded ball cost us.
//!
//! ```text
//! situations.csv ─► moments ─► DrillStart ─► our host and robots against a Script ─► DrillRow ─► DrillResult
//! ```
//! Ours is blue and defends −x. SI units, field frame. The scripts see the truth and drive bodies without
//! brains, so they stay the same while our play changes.

mod play;
mod result;
mod script;
pub mod situations;
mod start;

use arena::game::GameError;
use hil_sim::Stream;
use hil_sim::small_size::worlds::WorldChoice;
use serde::Serialize;

pub use play::NextTouch;
pub use result::{DrillResult, Proportion, drill_results, drill_table};
pub use situations::{Situation, SituationError};

use crate::matches::MatchTeam;
use crate::store::{Experiment, job_seed};

geometry::labels! {
    /// What the opponents do.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum DrillKind {
        /// One of theirs has the ball at our area, goes along it and shoots when the goal is open. Succeeds
        /// without a goal within 5 s.
        Carrier = "carrier",
        /// Our free kick in our half; one of theirs 0.6 to 0.8 m from the ball steps into its line, the
        /// others follow ours. Succeeds where a mate has the ball next and no goal falls within 8 s.
        Marker = "marker",
        /// Their free kick from 2.5 m off our corner to 2.4 m before our goal, and a first-touch shot of 5
        /// m/s. Succeeds without a goal within 4 s.
        Cross = "cross",
        /// A slow ball before our keeper, one of theirs a metre off. Succeeds where ours touch it within
        /// 0.4 s.
        Rebound = "rebound",
        /// One of theirs shields the ball in our half. Succeeds where ours touch it within 3 s.
        Shielder = "shielder",
        /// A ball at our goal line, between the posts, beside one, or at the area's edge. Succeeds where it
        /// is half a metre away within 5 s, and no goal.
        GoalLine = "goal-line",
        /// A ball at rest, one of ours 0.3 m from it, one of theirs 0.3 to 1 m from it that goes for it, our
        /// two nearest mates marked. Succeeds where ours still have it after 3 s: no kick of theirs, and the
        /// last touch or the restart ours, or our goal.
        Contested = "contested",
    }
}

impl DrillKind {
    /// Time for which play is watched, s.
    fn watched_s(self) -> f64 {
        match self {
            Self::Carrier | Self::GoalLine => 5.0,
            Self::Marker => 8.0,
            Self::Cross | Self::Rebound | Self::Shielder => 4.0,
            Self::Contested => 3.0,
        }
    }
}

/// Outcome of one try.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DrillRow {
    /// The drill.
    pub drill: DrillKind,
    /// Number of the try, from 0.
    pub number: u32,
    /// Seed of its match.
    pub seed: u64,
    /// The ball came into play.
    pub played: bool,
    /// A goal of ours.
    pub goal: bool,
    /// A shot of theirs: a kick of more than 3 m/s that would cross our goal line between the posts, or near.
    pub shot_against: bool,
    /// A goal of theirs.
    pub goal_against: bool,
    /// Who touched the ball after ours had kicked it.
    pub next_touch: NextTouch,
    /// Time until ours touched the ball, s.
    pub touched_s: Option<f64>,
    /// Time until the ball was half a metre from where it lay, s.
    pub cleared_s: Option<f64>,
    /// Ours scored, or theirs did not kick the ball and the last touch or the restart is ours.
    pub kept: bool,
}

impl DrillRow {
    fn new(drill: DrillKind, number: u32, seed: u64) -> Self {
        Self {
            drill,
            number,
            seed,
            played: false,
            goal: false,
            shot_against: false,
            goal_against: false,
            next_touch: NextTouch::None,
            touched_s: None,
            cleared_s: None,
            kept: false,
        }
    }

    /// Whether ours did what the drill asks.
    pub fn succeeded(&self) -> bool {
        self.played
            && match self.drill {
                DrillKind::Carrier | DrillKind::Cross => !self.goal_against,
                DrillKind::Marker => self.next_touch == NextTouch::Mate && !self.goal_against,
                DrillKind::Rebound => self.touched_s.is_some_and(|time| time <= REBOUND_WITHIN_S),
                DrillKind::Shielder => self.touched_s.is_some_and(|time| time <= SHIELDED_WITHIN_S),
                DrillKind::GoalLine => self.cleared_s.is_some() && !self.goal_against,
                DrillKind::Contested => self.kept,
            }
    }
}

/// Tries of drills. Equal plans give equal rows on any number of threads.
#[derive(Clone, Debug)]
pub struct DrillPlan {
    /// The drills, in the order of results.
    pub drills: Vec<DrillKind>,
    /// Situations from which starts are drawn.
    pub situations: Vec<Situation>,
    /// Tries of each.
    pub tries: u32,
    /// Seed of starts and matches.
    pub seed: u64,
    /// Physics.
    pub world: WorldChoice,
    /// Our team.
    pub team: MatchTeam,
}

/// A try of a plan.
#[derive(Clone, Copy, Debug)]
pub struct DrillJob {
    drill: DrillKind,
    number: u32,
}

impl Experiment for DrillPlan {
    type Job = DrillJob;
    type Row = DrillRow;
    type Error = GameError;

    fn jobs(&self) -> Result<Vec<DrillJob>, GameError> {
        let drills = self.drills.iter().copied();
        Ok(drills.flat_map(|drill| (0..self.tries).map(move |number| DrillJob { drill, number })).collect())
    }

    fn play(&self, job: &DrillJob) -> Result<DrillRow, GameError> {
        let DrillJob { drill, number } = *job;
        let seed = self.seed_of(drill, number);
        let moments = start::moments(drill, &self.situations);
        let mut chance = Stream::new(seed, "drill");
        match start::draw(drill, &self.situations, &moments, &mut chance) {
            Some(start) => play::play(drill, &start, (number, seed), (self.team, self.world)),
            None => Ok(DrillRow::new(drill, number, seed)),
        }
    }
}

impl DrillPlan {
    /// The seed of a try: the same for every team and world.
    fn seed_of(&self, drill: DrillKind, number: u32) -> u64 {
        job_seed(self.seed, drill.label(), number)
    }
}

/// A rebound is played at once: within this time, s.
const REBOUND_WITHIN_S: f64 = 0.4;
/// A shielded ball is touched within this time, s.
const SHIELDED_WITHIN_S: f64 = 3.0;

#[cfg(test)]
mod tests {
    use super::*;

    fn plan(drills: &[DrillKind], tries: u32) -> DrillPlan {
        DrillPlan {
            drills: drills.to_vec(),
            situations: situations::built_in().unwrap(),
            tries,
            seed: 5,
            world: WorldChoice::Nominal,
            team: MatchTeam::ours(),
        }
    }

    #[test]
    fn every_drill_has_moments_and_legal_starts() {
        let plan = plan(&DrillKind::ALL, 40);
        for job in plan.jobs().unwrap() {
            let moments = start::moments(job.drill, &plan.situations);
            let mut chance = Stream::new(plan.seed_of(job.drill, job.number), "drill");
            let start = start::draw(job.drill, &plan.situations, &moments, &mut chance).unwrap();
            let field = start.league.field();
            for pose in &start.theirs {
                let off = field.distance_to_area(start::OUR_END, pose.position);
                assert!(off > 0.05, "{:?} {}: {pose:?}", job.drill, job.number);
            }
            let all: Vec<_> = start.ours.iter().chain(&start.theirs).map(|pose| pose.position).collect();
            for (number, a) in all.iter().enumerate() {
                let clear = all[..number].iter().all(|b| a.distance(*b) > 0.15);
                assert!(clear, "{:?} {}: {all:?}", job.drill, job.number);
            }
        }
    }

    #[test]
    fn every_drill_is_played_alike_on_any_number_of_threads() {
        let plan = plan(&DrillKind::ALL, 2);
        let play = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| plan.play_all(&|| ())).unwrap()
        };
        let rows = play(1);
        assert_eq!(rows, play(2));
        assert!(rows.iter().all(|row| row.played), "{rows:#?}");
    }
}
