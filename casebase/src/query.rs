//! How does one stored case fare in one problem? The checks of DESIGN §4.3 one by one, everything relative to the ball, mm.
//!
//! Retrieval and explanation put the same questions, in their own order.

use geometry::math;
use heapless::Vec;
use protocol::RobotId;

use crate::action::TEAMMATES_MAX;
use crate::case::{Case, widen};
use crate::correspondence::{Assignment, Distances, Nearest, assign, nearest};
use crate::path::{conditions, freedom, is_blocking, is_crisply_blocked, least_exponent};
use crate::point::gauss_exponent;
use crate::problem::{PROBLEM_OPPONENTS_MAX, PROBLEM_TEAMMATES_MAX, Problem};
use crate::rank::{Key, Match};
use crate::settings::{CorrespondenceRule, CostRule, FreePathRule, OutOfField, ScopeRule, Settings};
use crate::stored::Stored;
use crate::{CaseRobot, PointMm};

/// A problem made ready: everything relative to the ball.
pub(crate) struct Query<'p> {
    pub(crate) problem: &'p Problem,
    pub(crate) settings: &'p Settings,
    /// The exponent at which scopes end.
    pub(crate) limit: f32,
    teammates: Vec<(RobotId, [f32; 2]), PROBLEM_TEAMMATES_MAX>,
    opponents: Vec<[f32; 2], PROBLEM_OPPONENTS_MAX>,
}

impl<'p> Query<'p> {
    /// Without places yet: [`Query::fill`] puts them in, where the query lies, as it is long to move.
    #[inline]
    pub(crate) fn new(problem: &'p Problem, settings: &'p Settings) -> Self {
        Self { problem, settings, limit: settings.limit(), teammates: Vec::new(), opponents: Vec::new() }
    }

    /// Puts the problem's places in.
    #[inline]
    pub(crate) fn fill(&mut self) {
        let ball = self.problem.ball;
        // Both lists have the capacity of the problem's: every push fits.
        for (id, place) in &self.problem.teammates {
            let _ = self.teammates.push((*id, place.minus(ball).to_f32()));
        }
        for place in &self.problem.opponents {
            let _ = self.opponents.push(place.minus(ball).to_f32());
        }
    }

    /// The ball's exponent in the case's scope, where it lies inside.
    #[inline]
    pub(crate) fn ball_inside(&self, case: &Stored<'_, '_>) -> Option<f32> {
        let [dx, dy] = self.problem.ball.minus(widen(case.gate.ball)).to_f32();
        let [inverse_x, inverse_y] = case.gate.inverse_scope;
        let exponent = gauss_exponent(dx, dy, inverse_x, inverse_y);
        (exponent < self.limit).then_some(exponent)
    }

    /// Are there robots enough?
    #[inline]
    pub(crate) fn robots_suffice(&self, case: &Stored<'_, '_>) -> bool {
        usize::from(case.teammates()) <= self.teammates.len()
    }

    /// How many of the case's opponent scopes are occupied; `None` once more than `missing_max` are known not to be.
    #[inline(always)]
    pub(crate) fn conditions(&self, case: &Stored<'_, '_>, missing_max: u8) -> Option<u8> {
        if case.opponents_count() == 0 {
            return Some(0);
        }
        let moved_by = match self.settings.scopes {
            ScopeRule::Translated => PointMm::new(0, 0),
            ScopeRule::Absolute => widen(case.gate.ball).minus(self.problem.ball),
        };
        conditions(case, moved_by, &self.opponents, self.limit, missing_max)
    }

    /// How free the ball's path is; `None` where it is blocked.
    #[inline(always)]
    pub(crate) fn freedom(&self, case: &Stored<'_, '_>) -> Option<f32> {
        let Self { problem, settings, .. } = self;
        if settings.free_path == FreePathRule::Crisp && settings.out_of_field != OutOfField::Clamp {
            let blocked = is_crisply_blocked(case, problem.ball, &self.opponents, self.limit);
            return (!blocked).then_some(1.0);
        }
        self.degree_of_freedom(case)
    }

    /// The same where paths are fuzzy or positions clamped.
    #[inline(never)]
    fn degree_of_freedom(&self, case: &Stored<'_, '_>) -> Option<f32> {
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
    pub(crate) fn robot_outside(&self, case: &Stored<'_, '_>) -> Option<CaseRobot> {
        if self.settings.out_of_field != OutOfField::Reject {
            return None;
        }
        let field = case.field();
        let outside = |at: &[i16; 2]| !field.contains(self.problem.ball.plus(widen(*at)));
        case.positions().iter().position(outside).and_then(CaseRobot::new)
    }

    /// Who is nearest to each part; `None` where nobody is near enough to one.
    #[inline(always)]
    pub(crate) fn nearest(&self, case: &Stored<'_, '_>) -> Option<Nearest> {
        let places = case.positions().iter().map(|at| self.place(case, *at));
        nearest(&self.teammates, places, self.settings.travel_max_mm)
    }

    /// The cheapest correspondence, where nobody in it has too far to go.
    #[inline]
    pub(crate) fn cheapest(&self, case: &Stored<'_, '_>, nearest: Nearest) -> Option<Assignment> {
        let settings = self.settings;
        let plain =
            settings.cost == CostRule::Sum && settings.correspondence == CorrespondenceRule::MinThenTest;
        let quick = if plain { nearest.if_distinct() } else { None };
        let found = quick.or_else(|| self.search(case))?;
        (found.distance <= settings.travel_max_mm).then_some(found)
    }

    #[inline(never)]
    fn search(&self, case: &Stored<'_, '_>) -> Option<Assignment> {
        assign(&self.distances(case), self.settings)
    }

    /// How far every present robot is from every adapted position.
    pub(crate) fn distances(&self, case: &Stored<'_, '_>) -> Distances {
        let parts = usize::from(case.teammates());
        let mut distances = Distances { columns: Vec::new(), parts };
        for (id, at) in &self.teammates {
            let mut column = [0.0; TEAMMATES_MAX];
            for (place, to) in case.positions().iter().zip(&mut column) {
                *to = distance(*at, self.place(case, *place));
            }
            // There is room for every teammate a problem can have.
            let _ = distances.columns.push((*id, column));
        }
        distances
    }

    /// What a candidate is ranked by.
    pub(crate) fn found(
        &self,
        case: &Stored<'_, '_>,
        exponent: f32,
        free: f32,
        assignment: Assignment,
    ) -> Found {
        let conditions = self.conditions(case, u8::MAX).unwrap_or(0);
        let (teammates, cost, case) = (case.teammates(), assignment.cost, case.id.0);
        Found { key: Key { conditions, teammates, free, exponent, cost, case }, assignment }
    }

    /// Where a robot that stands at `at` in the case is to stand, both relative to the ball.
    #[inline]
    fn place(&self, case: &Stored<'_, '_>, at: [i16; 2]) -> [f32; 2] {
        if self.settings.out_of_field == OutOfField::Clamp {
            let ball = self.problem.ball;
            return case.field().clamp(ball.plus(widen(at))).minus(ball).to_f32();
        }
        at.map(f32::from)
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
            case: protocol::CaseId(case),
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

#[inline]
fn distance(from: [f32; 2], to: [f32; 2]) -> f32 {
    math::hypot(from[0] - to[0], from[1] - to[1])
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
