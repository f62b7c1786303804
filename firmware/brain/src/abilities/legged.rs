//! `legged`: how the walking robot carries out the case language's actions. SI.

use casebase::{CaseKick, KickAim, Primitive};
use geometry::{Angle, Field, GoalEnd, Point};
use motion::rolling::RollingBall;
use protocol::quantized::from_mm;
use protocol::robot_io::LeggedKick;
use protocol::team::ShotRule;
use rules::League;

use super::Abilities;
use crate::belief::Belief;
use crate::body::legged::{SPEC, nominal};
use crate::body::{BodySpec, Intent};
use crate::skills::legged as skills;
use crate::skills::{Reception, Step};

/// Robots on four legs.
#[derive(Clone, Copy, Debug)]
pub struct Legged;

impl Abilities for Legged {
    fn spec(&self) -> &'static BodySpec {
        &SPEC
    }

    fn get_ball(&self, belief: &Belief, exit_heading: Option<Angle>) -> Step {
        skills::get_ball(belief, exit_heading)
    }

    fn receive(&self, belief: &Belief, exit_heading: Option<Angle>) -> Reception {
        skills::receive(belief, exit_heading)
    }

    fn carry_to(&self, belief: &Belief, to: Point<Field>) -> Step {
        skills::carry_to(belief, to, SPEC.arrived_within)
    }

    fn pass(&self, belief: &Belief, place: Point<Field>) -> Intent {
        skills::pass(belief, place)
    }

    fn kick(&self, belief: &Belief, kind: &CaseKick, along: Angle, _end: Point<Field>) -> Intent {
        skills::shoot(belief, along, legged_kick(kind))
    }

    fn shoot(&self, belief: &Belief, attacked: GoalEnd, patient: bool) -> Intent {
        skills::attempt(belief, attacked, patient).unwrap_or_else(|| skills::push_on(belief, attacked))
    }

    fn shoot_leg(
        &self,
        belief: &Belief,
        attacked: GoalEnd,
        leg: (&CaseKick, Point<Field>),
        patient: bool,
    ) -> Option<(Intent, ShotRule)> {
        skills::case_shot(belief, attacked, leg.1, legged_kick(leg.0), patient)
    }

    fn pressed_shot(&self, belief: &Belief, attacked: GoalEnd, time: f32) -> Option<Intent> {
        skills::pressed_shot(belief, attacked, time)
    }

    fn heading_for(&self, kind: &CaseKick, along: Angle) -> Angle {
        along - nominal(legged_kick(kind)).0
    }

    fn roll(&self, league: League, distance: f32) -> f32 {
        let ball = RollingBall { deceleration: league.ball().rolling_deceleration };
        ball.speed_for(distance) / ball.deceleration
    }
}

/// The body's kick for a kick kind of the library: the one it names, else by reach.
fn legged_kick(kind: &CaseKick) -> LeggedKick {
    match (kind.primitive, kind.aim) {
        (Primitive::ForwardSoft, _) => LeggedKick::ForwardSoft,
        (Primitive::ForwardHard, _) => LeggedKick::ForwardHard,
        (Primitive::Left, _) => LeggedKick::Left,
        (Primitive::Right, _) => LeggedKick::Right,
        (Primitive::Pass | Primitive::Unspecified, KickAim::Heading { length_mm, .. }) => {
            LeggedKick::Pass(from_mm(length_mm))
        }
        (Primitive::Pass | Primitive::Unspecified, KickAim::Goal { .. }) => LeggedKick::ForwardHard,
    }
}
