//! Which case fits the situation best? (Ros et al. 2009, §3, Algorithms 1 and 2; DESIGN §4.3)
//!
//! A case is a candidate if the ball lies in its ball scope, the robots are near enough to their adapted positions
//! and the ball's path is free; candidates are ranked by [`rank_order`](crate::rank_order). Cheap checks come
//! first; the answer is the one of the plain order. Lengths in mm, relative to the ball.

use core::ops::ControlFlow;

use geometry::math;
use heapless::Vec;
use protocol::CaseId;

use crate::action::TEAMMATES_MAX;
use crate::case::Case;
use crate::correspondence::{Assignment, Distances, assign};
use crate::path::{conditions, freedom, is_blocking, least_exponent};
use crate::point::gauss_exponent;
use crate::problem::{PROBLEM_OPPONENTS_MAX, PROBLEM_TEAMMATES_MAX, Problem};
use crate::rank::{Key, Match, key_order};
use crate::settings::{Criterion, FreePathRule, OutOfField, ScopeRule, Settings};
use crate::table::{CaseBase, Gate};
use crate::{CaseRobot, PointMm};

/// What a retrieval found.
#[derive(Clone, Debug, PartialEq)]
pub struct Retrieval {
    /// The case that ranks first.
    pub best: Option<Match>,
    /// Number of candidates.
    pub candidates: u16,
}

/// The best case and the number of candidates.
pub fn retrieve(base: &CaseBase<'_>, problem: &Problem, settings: &Settings) -> Retrieval {
    let query = Query::new(problem, settings);
    let mut best: Option<Found> = None;
    let mut candidates = 0;
    each_gated(base, &query, |case, exponent| {
        if let Some(found) = query.candidate(case, exponent) {
            candidates += 1;
            keep_better(&mut best, found, settings);
        }
        ControlFlow::Continue(())
    });
    Retrieval { best: best.map(Found::into_match), candidates }
}

/// The best case alone, without counting the candidates: cases that cannot win are not looked into.
pub fn retrieve_best(base: &CaseBase<'_>, problem: &Problem, settings: &Settings) -> Option<Match> {
    let query = Query::new(problem, settings);
    let in_order = settings.ranking == [Criterion::Conditions, Criterion::Teammates, Criterion::IntervalCost];
    let mut best: Option<Found> = None;
    each_gated(base, &query, |case, exponent| {
        let mut key = Key {
            conditions: case.raw_opponents().len() as u8,
            teammates: case.teammates() as u8,
            free: 1.0,
            exponent,
            cost: 0.0,
            case: case.id().0,
        };
        if let Some(found) = &best {
            let promise = (key.conditions, key.teammates);
            if in_order && promise < (found.key.conditions, found.key.teammates) {
                // The lists of the index fall in just this order: what follows in this one promises no more.
                return ControlFlow::Break(());
            }
            if key_order(&key, &found.key, settings).is_gt() {
                return ControlFlow::Continue(());
            }
            key.conditions = query.conditions(case);
            if key_order(&key, &found.key, settings).is_gt() {
                return ControlFlow::Continue(());
            }
        }
        if let Some(found) = query.candidate(case, exponent) {
            keep_better(&mut best, found, settings);
        }
        ControlFlow::Continue(())
    });
    best.map(Found::into_match)
}

/// Shows every case under the problem's goal whose ball scope holds the ball, until `visit` breaks off the list it
/// is in. Without the index (another threshold than it was made for) there is one list in no useful order, which is
/// never broken off.
fn each_gated<'a>(
    base: &CaseBase<'a>,
    query: &Query<'_>,
    mut visit: impl FnMut(&Case<'a>, f32) -> ControlFlow<()>,
) {
    let (ball, goal) = (query.problem.ball, query.problem.defending);
    if CaseBase::index_serves(query.limit) {
        for (list, flip) in base.near(ball, goal) {
            for id in list {
                let id = CaseId(id ^ flip);
                let Some(exponent) = gated(base, id, query) else { continue };
                let Some(case) = base.case(id) else { continue };
                if visit(&case, exponent).is_break() {
                    break;
                }
            }
        }
    } else {
        for case in base.cases().filter(|case| case.defending() == goal) {
            if let Some(exponent) = gated(base, case.id(), query) {
                let _ = visit(&case, exponent);
            }
        }
    }
}

/// The ball's exponent in the case's scope, where it lies inside.
#[inline]
fn gated(base: &CaseBase<'_>, id: CaseId, query: &Query<'_>) -> Option<f32> {
    let Gate { ball, inverse_scope } = base.gates.get(usize::from(id.0))?;
    let [dx, dy] = query.problem.ball.minus(crate::case::widen(*ball)).to_f32();
    let exponent = gauss_exponent(dx, dy, inverse_scope[0], inverse_scope[1]);
    (exponent < query.limit).then_some(exponent)
}

fn keep_better(best: &mut Option<Found>, found: Found, settings: &Settings) {
    if best.as_ref().is_none_or(|best| key_order(&found.key, &best.key, settings).is_lt()) {
        *best = Some(found);
    }
}

/// A candidate: what it is ranked by, and who plays whom.
pub(crate) struct Found {
    pub(crate) key: Key,
    pub(crate) assignment: Assignment,
}

impl Found {
    /// With its similarity, the one exponential of a retrieval.
    pub(crate) fn into_match(self) -> Match {
        let Key { conditions, teammates, free, exponent, cost, case } = self.key;
        Match {
            case: CaseId(case),
            similarity: math::exp(-exponent),
            exponent,
            cost,
            free,
            conditions,
            teammates,
            correspondence: self.assignment.players,
        }
    }
}

/// A problem made ready: everything relative to the ball.
pub(crate) struct Query<'p> {
    pub(crate) problem: &'p Problem,
    pub(crate) settings: &'p Settings,
    /// The exponent at which scopes end.
    pub(crate) limit: f32,
    teammates: Vec<[f32; 2], PROBLEM_TEAMMATES_MAX>,
    opponents: Vec<[f32; 2], PROBLEM_OPPONENTS_MAX>,
}

impl<'p> Query<'p> {
    pub(crate) fn new(problem: &'p Problem, settings: &'p Settings) -> Self {
        let mut query =
            Self { problem, settings, limit: settings.limit(), teammates: Vec::new(), opponents: Vec::new() };
        // Both lists have the capacity of the problem's: every push fits.
        for (_, place) in &problem.teammates {
            let _ = query.teammates.push(place.minus(problem.ball).to_f32());
        }
        for place in &problem.opponents {
            let _ = query.opponents.push(place.minus(problem.ball).to_f32());
        }
        query
    }

    /// A case whose ball scope holds the ball: is it a candidate, and how does it rank?
    fn candidate(&self, case: &Case<'_>, exponent: f32) -> Option<Found> {
        if case.teammates() > self.teammates.len() || self.robot_outside(case).is_some() {
            return None;
        }
        let free = self.freedom(case)?;
        let distances = self.distances(case);
        let limit = self.settings.travel_max_mm;
        if distances.leave_a_part_alone(limit) {
            return None;
        }
        let assignment = assign(&distances, self.settings).filter(|found| found.distance <= limit)?;
        Some(self.found(case, exponent, free, assignment))
    }

    pub(crate) fn found(&self, case: &Case<'_>, exponent: f32, free: f32, assignment: Assignment) -> Found {
        let key = Key {
            conditions: self.conditions(case),
            teammates: case.teammates() as u8,
            free,
            exponent,
            cost: assignment.cost,
            case: case.id().0,
        };
        Found { key, assignment }
    }

    /// How many of the case's opponent scopes are occupied.
    pub(crate) fn conditions(&self, case: &Case<'_>) -> u8 {
        let moved_by = match self.settings.scopes {
            ScopeRule::Translated => PointMm::new(0, 0),
            ScopeRule::Absolute => PointMm::new(0, 0).minus(case.shift(self.problem.ball)),
        };
        conditions(case, moved_by, &self.opponents, self.limit)
    }

    /// How free the ball's path is; `None` where it is blocked.
    pub(crate) fn freedom(&self, case: &Case<'_>) -> Option<f32> {
        let least = least_exponent(case, self.problem.ball, &self.opponents, self.settings);
        if least.is_some_and(|exponent| is_blocking(exponent, self.settings)) {
            return None;
        }
        Some(match self.settings.free_path {
            FreePathRule::Crisp => 1.0,
            FreePathRule::Fuzzy => freedom(least),
        })
    }

    /// A robot whose adapted position lies outside the field, where that matters.
    pub(crate) fn robot_outside(&self, case: &Case<'_>) -> Option<CaseRobot> {
        if self.settings.out_of_field != OutOfField::Reject {
            return None;
        }
        let field = case.base().field();
        case.robots().find(|robot| !field.contains(case.adapted(*robot, self.problem.ball)))
    }

    /// How far every present robot is from every adapted position.
    pub(crate) fn distances(&self, case: &Case<'_>) -> Distances {
        let ball = self.problem.ball;
        let mut distances = Distances { columns: Vec::new(), parts: case.teammates() };
        for (id, _) in &self.problem.teammates {
            // There is room for every teammate a problem can have.
            let _ = distances.columns.push((*id, [0.0; TEAMMATES_MAX]));
        }
        for robot in case.robots() {
            let place = adapted_position(case, robot, ball, self.settings).minus(ball).to_f32();
            for ((_, column), at) in distances.columns.iter_mut().zip(&self.teammates) {
                column[robot.index()] = math::hypot(at[0] - place[0], at[1] - place[1]);
            }
        }
        distances
    }
}

/// Where a robot of the case should stand for a ball at `ball`, as the settings have it: adapted, and clamped to the
/// field only where they say so.
pub fn adapted_position(case: &Case<'_>, robot: CaseRobot, ball: PointMm, settings: &Settings) -> PointMm {
    let adapted = case.adapted(robot, ball);
    match settings.out_of_field {
        OutOfField::Clamp => case.base().field().clamp(adapted),
        OutOfField::Keep | OutOfField::Reject => adapted,
    }
}
