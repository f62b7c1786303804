//! Which case fits the situation best? (Ros et al. 2009, §3, Algorithms 1 and 2; DESIGN §4.3)
//!
//! A case is a candidate if the ball lies in its ball scope, the robots are near enough to their adapted positions
//! and the ball's path is free; candidates are ranked by [`rank_order`](crate::rank_order). Cheap checks come
//! first, and none is made that cannot change the answer, which is the one of the plain order.

use core::ops::ControlFlow;

use protocol::CaseId;

use crate::problem::Problem;
use crate::query::{Found, Query};
use crate::rank::{Key, Match, interval, key_order};
use crate::settings::{CostRule, Criterion, FreePathRule, OutOfField, Settings};
use crate::stored::Stored;
use crate::table::CaseBase;

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
    let mut query = Query::new(problem, settings);
    query.fill();
    let mut best: Option<Found> = None;
    let mut candidates = 0;
    each_near(base, &query, |case| {
        if let Some(exponent) = query.ball_inside(case)
            && let Some(found) = candidate(&query, case, exponent)
        {
            candidates += 1;
            keep_better(&mut best, found, settings);
        }
        ControlFlow::Continue(())
    });
    Retrieval { best: best.map(Found::into_match), candidates }
}

/// The best case alone, without counting the candidates: cases that cannot win are not looked into.
#[inline(never)]
pub fn retrieve_best(base: &CaseBase<'_>, problem: &Problem, settings: &Settings) -> Option<Match> {
    if !can_be_bounded(settings) {
        return retrieve(base, problem, settings).best;
    }
    let mut query = Query::new(problem, settings);
    query.fill();
    // The lists of the index fall in the order of promises; without it there is one list in no useful order.
    let in_order = CaseBase::index_serves(query.limit);
    let mut best = Best::default();
    each_near(base, &query, |case| {
        if in_order && Class::promise(case) < best.class {
            return ControlFlow::Break(());
        }
        // The cheapest question first: it needs the case's counts alone.
        if query.robots_suffice(case)
            && let Some(exponent) = query.ball_inside(case)
        {
            let allowed = Class::of(case, case.opponents_count(), interval(exponent));
            if allowed >= best.class {
                best.look_at(&query, case, exponent, allowed);
            }
        }
        ControlFlow::Continue(())
    });
    best.found.map(Found::into_match)
}

/// Conditions, then teammates, then the interval: what a candidate is ranked by before cost, in one number.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
struct Class(u32);

impl Class {
    #[inline]
    fn of(case: &Stored<'_, '_>, conditions: u8, interval: u8) -> Self {
        let teammates = u32::from(case.teammates());
        Self(u32::from(conditions) << 8 | teammates << 4 | (3 - u32::from(interval & 3)))
    }

    /// The best the case could come to, wherever the ball lies.
    #[inline]
    fn promise(case: &Stored<'_, '_>) -> Self {
        Self::of(case, case.opponents_count(), 0)
    }

    /// The same with other conditions.
    #[inline]
    fn with(self, conditions: u8) -> Self {
        Self(self.0 & 0xff | u32::from(conditions) << 8)
    }
}

/// The best candidate so far.
#[derive(Default)]
struct Best {
    class: Class,
    found: Option<Found>,
}

impl Best {
    /// A case with robots enough and the ball in its scope, which could come to `allowed`, no less than the best: takes it
    /// over if it is a better candidate.
    #[inline(never)]
    fn look_at(&mut self, query: &Query<'_>, case: &Stored<'_, '_>, exponent: f32, allowed: Class) {
        // So many of its scopes may be empty before it is behind.
        let missing_max = ((allowed.0 - self.class.0) >> 8) as u8;
        let Some(conditions) = query.conditions(case, missing_max) else { return };
        let class = allowed.with(conditions);
        let Some(free) = query.freedom(case) else { return };
        let Some(nearest) = query.nearest(case) else { return };
        if let Some(found) = self.found.as_ref().filter(|_| class == self.class)
            && nearest.cost() > found.key.cost
        {
            return;
        }
        let Some(assignment) = query.cheapest(case, nearest) else { return };
        let (teammates, case) = (case.teammates(), case.id.0);
        let key = Key { conditions, teammates, free, exponent, cost: assignment.cost, case };
        let found = Found { key, assignment };
        if class > self.class {
            (self.class, self.found) = (class, Some(found));
        } else {
            keep_better(&mut self.found, found, query.settings);
        }
    }
}

/// Do bounds hold under these settings? Those of the paper, and all that rank in its order by what [`Class`] tells.
fn can_be_bounded(settings: &Settings) -> bool {
    settings.ranking == [Criterion::Conditions, Criterion::Teammates, Criterion::IntervalCost]
        && settings.free_path == FreePathRule::Crisp
        && settings.cost == CostRule::Sum
        && settings.out_of_field != OutOfField::Reject
}

/// Shows every case under the problem's goal that may hold the ball in its scope, until `visit` breaks off the list it
/// is in. Without the index (another threshold than it was made for) that is every case, in no useful order.
#[inline]
fn each_near<'q, 'a>(
    base: &'q CaseBase<'a>,
    query: &Query<'_>,
    mut visit: impl FnMut(&Stored<'q, 'a>) -> ControlFlow<()>,
) {
    let (ball, goal) = (query.problem.ball, query.problem.defending);
    if CaseBase::index_serves(query.limit) {
        for (list, flip) in base.near(ball, goal) {
            for id in list {
                let Some(case) = Stored::new(base, CaseId(id ^ flip)) else { continue };
                if visit(&case).is_break() {
                    break;
                }
            }
        }
    } else {
        for case in base.cases().filter(|case| case.defending() == goal) {
            if let Some(case) = Stored::new(base, case.id()) {
                let _ = visit(&case);
            }
        }
    }
}

/// A case whose ball scope holds the ball: is it a candidate, and how does it rank?
fn candidate(query: &Query<'_>, case: &Stored<'_, '_>, exponent: f32) -> Option<Found> {
    if !query.robots_suffice(case) || query.robot_outside(case).is_some() {
        return None;
    }
    let free = query.freedom(case)?;
    let nearest = query.nearest(case)?;
    let assignment = query.cheapest(case, nearest)?;
    Some(query.found(case, exponent, free, assignment))
}

fn keep_better(best: &mut Option<Found>, found: Found, settings: &Settings) {
    if best.as_ref().is_none_or(|best| key_order(&found.key, &best.key, settings).is_lt()) {
        *best = Some(found);
    }
}
