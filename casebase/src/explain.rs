//! `explain`: reason why each case is a candidate or not (docs/case-format.md §3.3: the first failure with
//! its margin).
//!
//! Every case listed under the problem's goal is tested, lowest id first, in the fixed order ball, robot
//! count, field (where the settings require it), travel, free path, demands on opponents. No index and no
//! short cut: tests compare retrieval with it.

use geometry::math;
use protocol::{CaseId, RobotId};

use crate::action::CaseRobot;
use crate::case::Case;
use crate::correspondence::{assign, assign_within};
use crate::leg::Leg;
use crate::path::blocked_leg;
use crate::presence::Presence;
use crate::problem::Problem;
use crate::query::{Query, UnmetDemand};
use crate::rank::Match;
use crate::settings::RetrievalSettings;
use crate::stored::Stored;
use crate::table::CaseBase;

geometry::labels! {
    /// Result of a case.
    #[derive(Clone, Debug, PartialEq)]
    pub enum CaseVerdict {
        /// The ball lies outside the ball's scope.
        Ball {
            /// sim_B, at most the threshold.
            similarity: f32,
            /// Difference to the threshold.
            margin: f32,
        } = "ball",
        /// The problem has fewer robots than the case needs.
        Robots {
            /// Robots of the case.
            needed: usize,
            /// Robots of the problem.
            present: usize,
        } = "robots",
        /// An adapted position lies outside the field, and the settings reject such cases.
        OutOfField {
            /// The robot whose adapted position lies outside.
            robot: CaseRobot,
        } = "out_of_field",
        /// A robot of the cheapest correspondence exceeds the travel limit; the one with the longest distance
        /// is reported.
        TooFar {
            /// The case robot at whose adapted position the player would start.
            robot: CaseRobot,
            /// The player of that part.
            player: RobotId,
            /// The player's distance from the adapted position, mm.
            distance: f32,
            /// Distance above the limit, mm.
            margin: f32,
        } = "thr_c",
        /// An opponent stands in the ball's path.
        Path {
            /// Number of the leg, from 0.
            index: usize,
            /// The leg, mm, field frame.
            leg: Leg,
            /// Number of the opponent in the problem, from 0.
            opponent: usize,
            /// Depth of the opponent inside the leg, mm.
            inside_mm: f32,
        } = "path",
        /// An opponent scope demands what the problem does not have.
        Opponents {
            /// Number of the case's opponent, from 0.
            scope: usize,
            /// Demand of the scope.
            presence: Presence,
            /// Number of the problem's opponent that stands in an excluding scope, from 0.
            opponent: Option<usize>,
        } = "opponents",
        /// The case is a candidate.
        Candidate(Match) = "candidate",
    }
}

/// Passes the verdict on every case listed under the problem's goal to a callback, lowest id first.
pub fn explain(
    base: &CaseBase<'_>,
    problem: &Problem,
    settings: &RetrievalSettings,
    mut sink: impl FnMut(CaseId, CaseVerdict),
) {
    Query::with(problem, settings, |query| {
        for case in base.cases().filter(|case| case.defending() == problem.defending) {
            let Some(stored) = case.stored() else { continue };
            sink(case.id(), judge(base, query, &case, &stored));
        }
    });
}

fn judge(base: &CaseBase<'_>, query: &Query<'_>, case: &Case<'_>, stored: &Stored<'_, '_>) -> CaseVerdict {
    let (problem, settings) = (query.problem, query.settings);
    let exponent = case.ball_exponent(problem.ball);
    if exponent >= query.key.limit {
        let similarity = math::exp(-exponent);
        return CaseVerdict::Ball { similarity, margin: (settings.threshold - similarity).max(0.0) };
    }
    if case.teammates() > problem.teammates.len() {
        return CaseVerdict::Robots { needed: case.teammates(), present: problem.teammates.len() };
    }
    if let Some(robot) = query.robot_outside(stored) {
        return CaseVerdict::OutOfField { robot };
    }
    let distances = query.distances(stored);
    let assigned = assign(&distances, settings).filter(|found| found.distance <= settings.travel_max_mm);
    let Some(assignment) = assigned else {
        // A constrained search without a result reports the cheapest correspondence without the constraint.
        let cheapest = assign_within(&distances, settings.cost, f32::INFINITY);
        let too_far = cheapest.and_then(|cheapest| {
            Some(CaseVerdict::TooFar {
                robot: CaseRobot::new(cheapest.farthest)?,
                player: *cheapest.players.ids.get(cheapest.farthest)?,
                distance: cheapest.distance,
                margin: cheapest.distance - settings.travel_max_mm,
            })
        });
        let robots = CaseVerdict::Robots { needed: case.teammates(), present: problem.teammates.len() };
        return too_far.unwrap_or(robots);
    };
    if let Some(blocked) = blocked_leg(case, base, problem.ball, &problem.opponents, settings) {
        return CaseVerdict::Path {
            index: blocked.index,
            leg: blocked.leg,
            opponent: blocked.opponent,
            inside_mm: blocked.inside_mm,
        };
    }
    if let Some(UnmetDemand { scope, opponent }) = query.unmet_demand(stored) {
        return CaseVerdict::Opponents { scope, presence: case.presence(scope), opponent };
    }
    let free = query.freedom(stored).unwrap_or(0.0);
    CaseVerdict::Candidate(query.found(stored, exponent, free, assignment.players).into_match())
}
