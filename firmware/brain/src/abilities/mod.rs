//! `abilities`: actions of the case language, carried out by the skills of each body, behind one trait
//! ([`Abilities`]).

pub mod legged;
pub mod wheeled;

use casebase::CaseKick;
use geometry::{Angle, Field, GoalEnd, Point};
use protocol::team::ShotRule;
use rules::League;

use crate::belief::Belief;
use crate::body::{BodyKind, BodySpec, Intent};
use crate::skills::{Reception, Step};

/// A kind of body: its numbers and its skills in the case language.
pub trait Abilities: Sync {
    /// Properties of this body.
    fn spec(&self) -> &'static BodySpec;

    /// Moves to the ball and takes it; faces `exit_heading` afterwards unless that loses a race.
    fn get_ball(&self, belief: &Belief, exit_heading: Option<Angle>) -> Step;

    /// Receives a ball that has been passed to this robot.
    fn receive(&self, belief: &Belief, exit_heading: Option<Angle>) -> Reception;

    /// Brings the ball held to a place.
    fn carry_to(&self, belief: &Belief, to: Point<Field>) -> Step;

    /// Passes the ball held to a place.
    fn pass(&self, belief: &Belief, place: Point<Field>) -> Intent;

    /// Kicks the held ball with the library's kick `kind`, to `end`.
    fn kick(&self, belief: &Belief, kind: &CaseKick, along: Angle, end: Point<Field>) -> Intent;

    /// Shoots the ball held at the goal, where it is open, or brings it to where that is easier.
    fn shoot(&self, belief: &Belief, attacked: GoalEnd, patient: bool) -> Intent;

    /// A case's shot at goal along the leg that ends at `leg.1`, with its kick `leg.0`, and the rule that
    /// chose it, which only legged robots report; `patient` while there is time left. `None` where there is
    /// none, and no shot worth making.
    fn shoot_leg(
        &self,
        belief: &Belief,
        attacked: GoalEnd,
        leg: (&CaseKick, Point<Field>),
        patient: bool,
    ) -> Option<(Intent, ShotRule)> {
        let _ = leg;
        Some((self.shoot(belief, attacked, patient), ShotRule::NoShot))
    }

    /// With the ball held and an opponent about to be at it: the shot that is worth more than to go on with
    /// the case, which takes `time` s.
    fn pressed_shot(&self, belief: &Belief, attacked: GoalEnd, time: f32) -> Option<Intent> {
        let _ = (belief, attacked, time);
        None
    }

    /// The heading from which a kick of that kind sends the ball in that direction.
    fn heading_for(&self, kind: &CaseKick, along: Angle) -> Angle;

    /// Seconds a passed ball takes for a distance, m.
    fn roll(&self, league: League, distance: f32) -> f32;
}

/// Abilities of that league's robots.
pub fn of(league: League) -> &'static dyn Abilities {
    match BodyKind::of(league) {
        BodyKind::Legged(_) => &legged::Legged,
        BodyKind::Wheeled(_) => &wheeled::Wheeled,
    }
}
