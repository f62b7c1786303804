//! `coerce`: Coerce and Attack Planner: free kicks against a defence that follows us (Biswas et al. 2014 §4).
//!
//! | step | action | module |
//! |---|---|---|
//! | 1 | find which opponents follow the ball, and which follow our robots | [`tactics`], [`detect`] |
//! | 2 | find the best attack against the former only: the *optimistic attack* | [`attack`] |
//! | 3 | find places that draw the latter off its path: the *coerce plan* | [`coercing`] |
//! | 4, 5 | send robots there; check whether they are followed | [`Planner::watch`] |
//! | 6, 7 | play that attack, or a new one against all opponents as they are | [`Planner::watch`] |
//!
//! [`Planner`] is a value: snapshots go in ([`Planner::observe`], [`Planner::plan`], [`Planner::watch`]), a
//! plan with its reasons comes out, and [`Planner::postings`] lists the robots' places. Attack frame, SI.
//! Passes are valued by section 3.1, through [`attack::PassValue`], which [`ByPassLocation`] implements with
//! [`super::pass`]. The same snapshots and the same seed give the same plan.

pub mod attack;
mod by_pass;
pub mod coercing;
pub mod detect;
pub mod grid;
mod planner;
pub mod tactics;

use motion::trajectory::FreeLimits;
use rules::League;

pub use by_pass::ByPassLocation;
pub use planner::{CapPlan, CoerceEnd, CoercePart, CoerceProgress, FinalAttack, Followed, Planner, Posting};

/// P(receive) is a tenth above the least one for a kick (`coach::ahead`), as it falls slightly while passer
/// and receiver get ready. Planned passes worth less than 0.005 led to 0.23 shots of ours within 12 s, the
/// others to 0.75 (86 and 55 passes, seed 100, against the zone and against ours); free kicks taken at once
/// against the zone to 0.82 (134).
const ATTACK_MIN: attack::Least = attack::Least { receive: 0.7, value: 0.005 };
/// Share of a free kick's time for coercing: 4 s of 10 (D16); the remaining time is for the pass-ahead.
const COERCE_SHARE: f32 = 0.4;
/// s (paper §4; division B).
const FREE_KICK_TIME_S: f32 = 10.0;

/// Settings that the paper leaves open.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoerceSettings {
    /// Limits of our robots, for the times at which they reach a cell.
    pub robot: FreeLimits,
    /// Longest time for coercing, s: part of the time that a free kick may take.
    pub coerce_time: f32,
    /// A coercer within this of its place has arrived, m: a body's diameter.
    pub arrived: f32,
    /// Time in which opponents may follow them, s.
    pub follow_time: f32,
    /// An opponent farther than this from where it is expected was not coerced, m (docs/papers.md D16).
    pub expected_within: f32,
    /// A robot with an opponent nearer than this is marked, m: the same.
    pub marked_within: f32,
    /// Least values of the attack: else the free kick is played as usual.
    pub least: attack::Least,
    /// Coercers stay this far from pass and shot, m (D19).
    pub off_ways: f32,
    /// Least distance of a coercer from the ball, m: the distance that robots keep from a ball that is not in
    /// play.
    pub off_ball: f32,
    /// Least distance of a coercer from both areas, m: the rules' 0.2 m at free kicks, a body, a margin.
    pub off_areas: f32,
}

impl CoerceSettings {
    /// The settings for a league's rules.
    pub fn of(league: League) -> Self {
        let free_kick = league.limits().map_or(FREE_KICK_TIME_S, |limits| limits.free_kick_time);
        Self { coerce_time: COERCE_SHARE * free_kick, ..Self::default() }
    }
}

impl Default for CoerceSettings {
    fn default() -> Self {
        Self {
            robot: FreeLimits::default(),
            coerce_time: COERCE_SHARE * FREE_KICK_TIME_S,
            arrived: 0.18,
            follow_time: 0.5,
            expected_within: 0.5,
            marked_within: 0.5,
            least: ATTACK_MIN,
            off_ways: 0.5,
            off_ball: 0.7,
            off_areas: 0.32,
        }
    }
}

#[cfg(test)]
mod tests;
