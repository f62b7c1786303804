//! `legged`: abilities of the walking robot. SI.

mod walk;

use casebase::{CaseKick, KickAim, Primitive};
use geometry::{Angle, Field, GoalEnd, Point};
use motion::legged::{CARRY_SPEED, WALK_FORWARD};
use motion::rolling::RollingBall;
use protocol::Duration;
use protocol::quantized::from_mm;
use protocol::robot_io::LeggedKick;
use protocol::team::ShotRule;
use rules::League;

use crate::belief::Belief;
use crate::body::{Body, BodySpec, Intent};
use crate::skills::legged as skills;
use crate::skills::{Reception, Step};

pub use walk::{actuate, nominal};

/// Robots on four legs.
#[derive(Clone, Copy, Debug)]
pub struct Legged;

impl Body for Legged {
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

const SPEC: BodySpec = BodySpec {
    speed: WALK_FORWARD,
    carry_speed: CARRY_SPEED,
    // A quarter turn at 1 rad/s.
    turn: 1.5,
    // Grabs of 0.5 s each, of which three in four succeed.
    grab: 1.5,
    kick: 0.5,
    // Half the adaptation limit of 1.5 m at walking speed.
    longest_fetch: 2.5,
    arrived_within: 0.15,
    // A step away from touching it.
    next_to_ball: 0.35,
    // The robot turns first, and the ball arrives fast.
    receiver_haste: 0.6,
    receiver_near: 0.3,
    // The league's 3 s of holding a ball.
    shot_patience: Duration::millis(3000),
    // Radii of body (0.12) and ball (0.0425) and a centimetre.
    opponent_holds_within: 0.1725,
    // An arm's length more than touching.
    disputed_within: 0.25,
    doubt_steps: 5,
};
