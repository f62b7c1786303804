//! `action_scene`: inputs of one step of a robot's part of a case, and what follows from them. Field frame,
//! SI.

use casebase::{Case, CaseBase, CaseRobot, Leg, PointMm};
use geometry::{Angle, Field, Point};
use protocol::team::{Play, Progress};
use protocol::{CycleId, Instant, RobotId};

use crate::abilities::Abilities;
use crate::belief::Belief;
use crate::teammates::Teammates;

/// Inputs of an execution in one step.
#[derive(Clone, Copy)]
pub struct ActionScene<'s> {
    /// Time of this step, the robot's own clock.
    pub now: Instant,
    /// This robot's world model in this step.
    pub belief: &'s Belief,
    /// Newest beacon of each teammate, with its lease.
    pub teammates: &'s Teammates,
    /// Id of the cycle to which the gameplay belongs.
    pub cycle: CycleId,
    /// The gameplay of the cycle.
    pub play: &'s Play,
    /// The case being played.
    pub case: Case<'s>,
    /// The case base it is from.
    pub base: &'s CaseBase<'s>,
    /// The body that plays it.
    pub body: &'s dyn Abilities,
}

impl ActionScene<'_> {
    /// A point of the case, adapted, on the field.
    pub fn adapt(&self, point: PointMm) -> Point<Field> {
        point.plus(self.case.shift(self.ball_used())).into()
    }

    /// Adapted position of case robot `part`.
    pub fn place_of(&self, part: CaseRobot) -> Point<Field> {
        self.case.adapted(part, self.ball_used()).into()
    }

    /// The ball that all adapted positions of this cycle are relative to, mm.
    pub fn ball_used(&self) -> PointMm {
        self.play.ball.into()
    }

    /// The robot that plays case robot `part`.
    pub fn player(&self, part: CaseRobot) -> Option<RobotId> {
        self.play.robots.get(part.index()).copied()
    }

    /// How far the teammate that plays `part` has come; `None` if nothing is known of it in this cycle.
    pub fn progress_of(&self, part: CaseRobot) -> Option<Progress> {
        self.teammates.get(self.now, self.player(part)?)?.progress_in(self.cycle)
    }

    /// The leg of the ball's path that this action makes.
    pub(crate) fn leg(&self, part: CaseRobot, action: usize) -> Option<Leg> {
        self.case.legs(self.ball_used()).into_iter().find(|leg| leg.robot == part && leg.action == action)
    }

    /// End of that leg on the field, and its direction.
    pub(crate) fn leg_of(&self, part: CaseRobot, action: usize) -> Option<(Point<Field>, Angle)> {
        let leg = self.leg(part, action)?;
        Some((leg.end(), leg.start().direction_to(leg.end())))
    }
}
