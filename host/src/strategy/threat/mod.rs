//! `threat`: threat-based defence. Threats from the ball and from opponents that could receive it next
//! (Biswas et al. 2014 §5).
//!
//! [`defend`] is the entry point: [`receiving`] finds the *first-level threat* (the ball, or the receiver of
//! a pass), [`cover`] places keeper and primary defenders against it ([`angle`] computes the angle that a
//! body covers, [`edge`] where primaries may stand), [`danger`] finds and ranks the *second-level threats*,
//! and the remaining places are assigned to defenders greedily, with tasks held: a defender keeps its task
//! until another would be clearly nearer, and a defender that blocks the shot of the pass receiver continues
//! blocking it until the primaries are there.
//!
//! Attack frame (we defend −x), SI. All results carry their numbers. [`Memory`] gives hysteresis; an empty
//! one is valid.

pub mod angle;
mod assign;
pub mod cover;
pub mod danger;
pub mod edge;
mod legal;
pub mod receiving;

use core::fmt;

use geometry::{Attack, Point};
use protocol::RobotId;
use rules::RobotSpec;

use super::view::{ROBOTS_MAX, RobotSet, View};
use cover::{Case, Cover};
use danger::{Blocks, Danger};
use receiving::FirstLevel;

pub use legal::{legal, legal_for};

/// Fastest shot, m/s: the rules' 6.5 less a kicker's error.
const SHOT_SPEED_M_S: f32 = 6.2;

/// Settings that the paper leaves open.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThreatSettings {
    /// c of equation 6: between the 5 and 20 of the paper's Figure 6.
    pub c: f32,
    /// A slower ball is no pass, m/s.
    pub pass_speed: f32,
    /// A risk above this makes an opponent the receiver of a pass, s: it has the ball within a second.
    pub risk_threshold: f32,
    /// A pass once detected is kept until speed falls, or risk grows, by this factor beyond its threshold.
    pub hold: f32,
    /// Difference by which another opponent's risk must be greater to replace it, s.
    pub risk_worth: f32,
    /// Keeper and primaries cover the place of a carried ball after this time, s.
    pub carried_for: f32,
    /// Primary defenders' centres are this far outside our area, m: a body (0.09) and the error of tracking
    /// and control.
    pub off_area: f32,
    /// Primary defenders stand this far, each, from the middle between them, m: bodies side by side and a
    /// margin between.
    pub shoulder: f32,
    /// The keeper is no nearer to its goal line than this, m: a body, so that the posts do not stop it, and
    /// less than a ball, so that none rolls along the line behind it.
    pub keeper_back: f32,
    /// Largest distance of the keeper from the goal, m: "staying near the goal"; half of division B's area.
    pub keeper_out: f32,
    /// While primaries are on their way the keeper moves by a metre for a widest gap that is this much
    /// narrower, rad/m. 600 tries each of the drills carrier and cross (seed 9401; the next weight at 0.02):
    /// 158 and 163 goals of the carrier with 0.07 and 0.15, of the cross 75 and 59; before 223 and 85.
    pub keeper_moves: f32,
    /// It stands a metre off its planned place for a gap that is this much narrower, rad/m: with 0.02, 0.05
    /// and 0.1 (the weight before at 0.15) 163, 170 and 174 goals of the carrier, 59, 52 and 59 of the cross.
    pub keeper_differs: f32,
    /// A placement of fewer bodies than now must cover this many times the angle that it needs.
    pub to_spare: f32,
    /// This near to the axis the choice of the nearer post is kept, m.
    pub axis: f32,
    /// Opponents with x below this are near to our goal, m: in our half.
    pub near: f32,
    /// Hysteresis: one that was near stays so until it is this much farther, m.
    pub near_hold: f32,
    /// Greater open angles count as equal, rad: 10°, above it shots do not improve.
    pub open_enough: f32,
    /// Bonus on the open angle of a defended opponent, rad, so that noise does not change ranks: about 1°.
    pub open_worth: f32,
    /// Bonus on the time to shoot of a defended opponent, s.
    pub time_worth: f32,
    /// Acceleration of opponents and our defenders, m/s².
    pub acceleration: f32,
    /// Delay from an opponent's start to our robot's, s: camera to wheels are 0.05–0.07 s in the league, a
    /// tick of ours and theirs more.
    pub latency: f32,
    /// A defender is no nearer to its opponent's centre than this, m: two bodies and room to brake.
    pub clear: f32,
    /// The primaries are in place within this, m: a body's radius.
    pub in_place: f32,
    /// Where the first-level threat is nearer to our goal than this, m, a spare primary stays beside the
    /// other one: a carrier turns or steps aside before it would be back. The champions' carriers shot from
    /// up to 2.6 m; no other value was tried.
    pub spare_stays: f32,
    /// A defender changes its task, or two swap, for a path shorter by this, m: 0.4 s at 2 m/s.
    pub worth: f32,
}

impl Default for ThreatSettings {
    fn default() -> Self {
        Self {
            c: 10.0,
            pass_speed: 0.5,
            risk_threshold: -1.0,
            hold: 1.3,
            risk_worth: 0.2,
            carried_for: 0.35,
            off_area: 0.13,
            shoulder: 0.105,
            keeper_back: 0.125,
            keeper_out: 0.5,
            keeper_moves: 0.15,
            keeper_differs: 0.05,
            to_spare: 1.1,
            axis: 0.15,
            near: 0.0,
            near_hold: 0.3,
            open_enough: 0.174_532_93,
            open_worth: 0.02,
            time_worth: 0.2,
            acceleration: RobotSpec::OURS.assumed.defence_acceleration,
            latency: 0.1,
            clear: 0.25,
            in_place: RobotSpec::OURS.hull.radius,
            spare_stays: 3.5,
            worth: 0.8,
        }
    }
}

/// The threat that one robot guards against.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Guards {
    /// Keeper or primary defender: the first-level threat.
    FirstLevel {
        /// The placement that it belongs to.
        case: Case,
        /// The open angle, rad.
        open: f32,
        /// The part of it that the bodies of this placement leave open, rad.
        uncovered: f32,
    },
    /// A primary defender that is not needed, at the edge beside the one that is.
    Spare,
    /// An opponent as a second-level threat.
    SecondLevel {
        /// Number of the opponent.
        opponent: RobotId,
        /// Whether the shot is blocked, or the pass.
        blocks: Blocks,
        /// Rank among all positions, from 0.
        rank: usize,
        /// Open angle of the opponent on our goal, rad.
        open: f32,
        /// Time until it could shoot: pass and shot, s.
        time_to_shoot: f32,
    },
    /// The shot of the pass receiver, until the primaries are there.
    Held {
        /// The opponent that is to receive.
        opponent: RobotId,
        /// Distance that the primaries have yet to go, m.
        primaries_off: f32,
    },
}

impl fmt::Display for Guards {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::FirstLevel { open, uncovered, .. } => {
                let [open, uncovered] = [open, uncovered].map(f32::to_degrees);
                write!(f, "shot angle {open:.0}°, {uncovered:.0}° not covered")
            }
            Self::Spare => f.write_str("one primary defender suffices; beside it"),
            Self::SecondLevel { opponent, blocks, rank, open, time_to_shoot } => {
                let what = match blocks {
                    Blocks::Shot => "the shot of",
                    Blocks::Pass => "the pass to",
                };
                let (n, open) = (rank + 1, open.to_degrees());
                write!(
                    f,
                    "threat {n}: {what} opponent {opponent}, {open:.0}° open, {time_to_shoot:.1} s away"
                )
            }
            Self::Held { opponent, primaries_off } => {
                write!(
                    f,
                    "the shot of opponent {opponent} until the primaries, {primaries_off:.2} m off, are there"
                )
            }
        }
    }
}

/// One robot's part in the defence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Assignment {
    /// Our robot, by its number.
    pub robot: RobotId,
    /// Place for its centre, m.
    pub at: Point<Attack>,
    /// The threat it guards against.
    pub guards: Guards,
}

/// The whole defence of one moment.
#[derive(Clone, Debug, PartialEq)]
pub struct Defence {
    /// Place from which a shot is most imminent.
    pub threat: FirstLevel,
    /// Keeper and primaries against it.
    pub cover: Cover,
    /// Opponents that could receive the ball and shoot.
    pub dangers: heapless::Vec<Danger, ROBOTS_MAX>,
    /// The robots' assignments, the keeper first; robots without a task are not in it.
    pub assignments: heapless::Vec<Assignment, ROBOTS_MAX>,
}

/// State of the defence between ticks.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Memory {
    threat: Option<FirstLevel>,
    cover: Option<cover::Before>,
    /// The one that is needed (or the one at −y, of two) first.
    primaries: [Option<RobotId>; 2],
    tasks: heapless::Vec<Kept, ROBOTS_MAX>,
    held: Option<Kept>,
    near: RobotSet,
}

impl Memory {
    /// Primary defenders of the last decision; `None` where there are fewer.
    pub fn primaries(&self) -> [Option<RobotId>; 2] {
        self.primaries
    }
}

/// A task that a robot has.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Kept {
    robot: RobotId,
    opponent: RobotId,
    blocks: Blocks,
}

/// The defence by our keeper and those of our robots that are in `team`; `memory` is changed only by this
/// function.
pub fn defend(view: &View, team: RobotSet, memory: &mut Memory, settings: &ThreatSettings) -> Defence {
    let threat = receiving::first_level(view, memory.threat, settings);
    let players = view.ours.iter().filter(|robot| robot.id != view.keeper && team.has(robot.id)).count();
    let cover = cover::cover(view, threat.at, players.min(2), memory.cover, settings);
    let dangers = danger::dangers(view, &threat, &cover, memory, settings);
    let assessment = assign::Assessment { threat: &threat, cover: &cover, dangers: &dangers };
    let assignments = assign::assign(view, team, assessment, memory, settings);
    memory.threat = Some(threat);
    memory.cover = Some(cover.remember());
    Defence { threat, cover, dangers, assignments }
}

#[cfg(test)]
mod tests;
