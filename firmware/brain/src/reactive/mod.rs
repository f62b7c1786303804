//! `reactive`: reactive behaviour of robots without a case. One behaviour per body, behind a common
//! interface.

mod legged;
mod wheels;

use geometry::GoalEnd;
use protocol::team::Role;
use protocol::{Instant, RobotId};
use rules::League;

use crate::belief::Belief;
use crate::body::Intent;
use crate::body::kind::{self, BodyKind};
use crate::teammates::Teammates;

/// Extent of the behaviour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Freedom {
    /// The whole behaviour: approach, grab, kick.
    Full,
    /// Keep near the ball, leave it to others: a robot that waits for the end of a gameplay.
    KeepNear,
    /// Approach, but neither grab nor kick: the short time between two gameplays.
    Approach,
}

/// The behaviour of a body, with its state.
#[derive(Clone, Debug)]
pub enum Reactive {
    /// The paper's behaviour, on legs.
    Legged(kind::Legs, legged::LeggedReactive),
    /// Simple and rule-compliant, on wheels.
    Wheels(kind::WheeledKind, wheels::WheeledReactive),
}

impl Reactive {
    /// The behaviour of that league's robots.
    pub fn of(league: League) -> Self {
        match BodyKind::of(league) {
            BodyKind::Legged(built) => Self::Legged(built, legged::LeggedReactive::default()),
            BodyKind::Wheeled(built) => Self::Wheels(built, wheels::WheeledReactive::default()),
        }
    }

    /// This robot's present role in its team.
    pub fn role(&self) -> Role {
        match self {
            Self::Legged(_, legs) => legs.role(),
            Self::Wheels(_, wheels) => wheels.role(),
        }
    }

    /// While a case is played: resets the state.
    pub fn rest(&mut self) {
        match self {
            Self::Legged(_, legs) => legs.rest(),
            Self::Wheels(_, wheels) => wheels.rest(),
        }
    }

    /// The intent of one step.
    pub fn step(
        &mut self,
        now: Instant,
        me: RobotId,
        belief: &Belief,
        teammates: &Teammates,
        attacked: GoalEnd,
        freedom: Freedom,
    ) -> Intent {
        match self {
            Self::Legged(_, legs) => legs.step(now, belief, teammates, attacked, freedom),
            Self::Wheels(_, wheels) => wheels.step(now, me, belief, teammates, attacked, freedom),
        }
    }
}
