//! `omni`: abilities of the wheeled robot, and how it carries out the case language's actions. SI.
//!
//! [`Drivetrain`] turns intents into a body's motion, [`surroundings`] lists what it keeps out of, the skills
//! are in [`skills::wheels`](crate::skills::wheels).

mod bodies;
mod drivetrain;
pub mod surroundings;

use casebase::{CaseKick, KickAim};
use geometry::{Angle, Field, GoalEnd, Point};
use motion::ball::BallModel;
use motion::trajectory::Motion;
use protocol::Duration;
use protocol::quantized::from_mm;
use protocol::robot_io::OmniKick;
use rules::{League, RobotSpec, contact};

use crate::belief::Belief;
use crate::body::{Body, BodySpec, Intent};
use crate::skills::wheels as skills;
use crate::skills::{Reception, Step};

pub use drivetrain::{Drivetrain, LIMITS, limits_without_ball};

/// From the robot's centre to its flat front, m.
pub const FRONT: f32 = RobotSpec::OURS.hull.front;
/// From the robot's centre to a ball at its front, m.
pub const BALL_AT: f32 = RobotSpec::OURS.hull.ball_at();

/// A target to drive to, and what dribbler and kicker do meanwhile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drive {
    /// Target position, at which the robot stops.
    pub to: Point<Field>,
    /// Heading to turn to.
    pub face: Angle,
    /// Speed limit, m/s, of the robot's centre.
    pub speed: f32,
    /// How the ball is treated on the path.
    pub mode: DriveMode,
    /// Share of the dribbler's full speed, 0–1.
    pub dribbler: f32,
    /// Kick to fire as soon as the ball touches the kicker, once it is armed.
    pub kick: OmniKick,
    /// Whether it is armed: the robot faces the direction of the kick.
    pub armed: bool,
    /// Share of the acceleration that is planned with, with or without the ball; more than 1 for a step to
    /// the ball.
    pub acceleration_share: f32,
    /// Instructions that choosing the target took, by the search's estimate: its path has so much less.
    pub effort: u32,
}

/// How a robot treats the ball on its path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DriveMode {
    /// An obstacle to go around.
    Avoiding,
    /// It is no obstacle: it may be touched.
    Bold,
    /// It is held and must stay held: gentle accelerations.
    Holding,
}

impl Drive {
    /// Drives to a place, around the ball, at full speed.
    pub fn avoiding(to: Point<Field>, face: Angle) -> Self {
        Self {
            to,
            face,
            speed: f32::INFINITY,
            mode: DriveMode::Avoiding,
            dribbler: 0.0,
            kick: OmniKick::None,
            armed: true,
            acceleration_share: 1.0,
            effort: 0,
        }
    }

    /// Drives to a place; the ball may be touched.
    pub fn bold(to: Point<Field>, face: Angle) -> Self {
        Self { mode: DriveMode::Bold, ..Self::avoiding(to, face) }
    }

    /// Drives to a place with the ball.
    pub fn holding(to: Point<Field>, face: Angle) -> Self {
        Self { mode: DriveMode::Holding, dribbler: 1.0, ..Self::avoiding(to, face) }
    }

    /// Deceleration of a robot that touches something otherwise, m/s²: what wheels hold, without the ball.
    fn hardest_braking(&self) -> f32 {
        match self.mode {
            DriveMode::Holding => RobotSpec::OURS.plan_holding.braking,
            DriveMode::Avoiding | DriveMode::Bold => RobotSpec::OURS.governor.brake,
        }
    }
}

impl From<Drive> for Intent {
    fn from(drive: Drive) -> Self {
        Self::Drive(drive)
    }
}

/// Robots on omnidirectional wheels.
#[derive(Clone, Copy, Debug)]
pub struct Wheeled;

impl Body for Wheeled {
    fn spec(&self) -> &'static BodySpec {
        &SPEC
    }

    fn get_ball(&self, belief: &Belief, exit_heading: Option<Angle>) -> Step {
        skills::get_ball(belief, exit_heading)
    }

    fn receive(&self, belief: &Belief, exit_heading: Option<Angle>) -> Reception {
        skills::take_pass(belief, exit_heading)
    }

    fn carry_to(&self, belief: &Belief, to: Point<Field>) -> Step {
        skills::carry_to(belief, to, SPEC.arrived_within)
    }

    fn pass(&self, belief: &Belief, place: Point<Field>) -> Intent {
        let speed = skills::pass_speed(belief.dribbler_point().distance(place));
        skills::kick_held(belief, place, OmniKick::Flat(speed))
    }

    fn kick(&self, belief: &Belief, kind: &CaseKick, _along: Angle, end: Point<Field>) -> Intent {
        let speed = match kind.aim {
            KickAim::Heading { length_mm, .. } => {
                BallModel::default().kick_speed(from_mm(length_mm), ROLLS_ON).min(SHOT)
            }
            KickAim::Goal { .. } => SHOT,
        };
        skills::kick_held(belief, end, OmniKick::Flat(speed))
    }

    fn shoot(&self, belief: &Belief, attacked: GoalEnd, patient: bool) -> Intent {
        skills::shoot(belief, attacked, patient)
    }

    fn heading_for(&self, _kind: &CaseKick, along: Angle) -> Angle {
        along
    }

    fn roll(&self, _league: League, distance: f32) -> f32 {
        let speed = skills::pass_speed(distance);
        let path =
            BallModel::default().kicked(Point::<Field>::new(0.0, 0.0), geometry::Vector::new(speed, 0.0));
        path.time_to(distance).unwrap_or_else(|| path.duration())
    }
}

/// The fastest kick wanted, m/s; the governor has the last word.
pub const SHOT: f32 = RobotSpec::OURS.kicker.fastest;
/// How fast a ball kicked into free space still is where the case wants it, m/s: nearly lying.
const ROLLS_ON: f32 = 0.3;

const SPEC: BodySpec = BodySpec {
    // Two metres from standstill to standstill take 1.5 s with 3.5 m/s².
    speed: 1.3,
    carry_speed: 0.7,
    // A quarter turn at 3 rad/s, including acceleration.
    turn: 0.8,
    grab: 0.7,
    kick: 0.2,
    longest_fetch: 2.5,
    arrived_within: 0.05,
    next_to_ball: 0.25,
    receiver_haste: 0.7,
    receiver_near: 0.15,
    shot_patience: Duration::millis(1000),
    opponent_holds_within: contact::HELD_WITHIN,
    disputed_within: 0.15,
    doubt_steps: 20,
};
