//! `problem`: the situation that a case is retrieved for. P = (B, G, Tm, Opp) (Ros et al. 2009, §2.1), mm,
//! field frame.

use heapless::Vec;
use protocol::RobotId;
use protocol::decision::{DecisionReport, Grounds};
use serde::{Deserialize, Serialize};

use crate::{GoalEnd, PointMm};

/// Maximum number of teammates in a problem: the largest league's team.
pub const PROBLEM_TEAMMATES_MAX: usize = 11;
/// Maximum number of opponents in a problem.
pub const PROBLEM_OPPONENTS_MAX: usize = 11;

/// The present situation. Coordinates may be any `i32`, on the field or not.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Problem {
    /// B: the ball's position, mm, field frame.
    pub ball: PointMm,
    /// G, the goal we defend.
    pub defending: GoalEnd,
    /// Tm: the robots that can play, in any order, each id once.
    pub teammates: Vec<(RobotId, PointMm), PROBLEM_TEAMMATES_MAX>,
    /// Opp: the opponents' positions, mm, field frame, in any order.
    pub opponents: Vec<PointMm, PROBLEM_OPPONENTS_MAX>,
}

impl Problem {
    /// The problem on which a robot decided; `None` where it knew of no ball.
    pub fn of(report: &DecisionReport) -> Option<Self> {
        (report.grounds != Grounds::NoBall).then(|| Self {
            ball: report.ball.into(),
            defending: report.defending,
            teammates: report.teammates.iter().map(|(id, at)| (*id, (*at).into())).collect(),
            opponents: report.opponents.iter().map(|at| (*at).into()).collect(),
        })
    }
}
