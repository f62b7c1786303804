//! `wheeled`: how the wheeled robot carries out the case language's actions. SI.

use casebase::{CaseKick, KickAim};
use geometry::{Angle, Field, GoalEnd, Point};
use motion::ball::BallModel;
use motion::trajectory::Motion;
use protocol::quantized::from_mm;
use protocol::robot_io::OmniKick;
use rules::League;

use super::Abilities;
use crate::belief::Belief;
use crate::body::omni::{SHOT, SPEC};
use crate::body::{BodySpec, Intent};
use crate::skills::wheels as skills;
use crate::skills::{Reception, Step};

/// Robots on omnidirectional wheels.
#[derive(Clone, Copy, Debug)]
pub struct Wheeled;

impl Abilities for Wheeled {
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

/// How fast a ball kicked into free space still is where the case wants it, m/s: nearly lying.
const ROLLS_ON: f32 = 0.3;
