//! `retrieve`: case retrieval (Ros et al. 2009, §3, Algorithms 1 and 2; docs/case-format.md §3).
//!
//! A case is a candidate if the ball lies in its ball scope, the robots are near enough to their adapted positions
//! and the ball's path is free; candidates are ranked by [`rank_order`](crate::rank_order). Cheap checks come
//! first, and none is made that cannot change the answer, which is the one of the plain order.

use core::ops::ControlFlow;

use protocol::CaseId;

use crate::problem::Problem;
use crate::query::{Found, Query};
use crate::rank::{Key, Match, interval, key_order};
use crate::settings::{
    CorrespondenceRule, CostRule, Criterion, FreePathRule, OutOfField, ScopeRule, Settings,
};
use crate::stored::Stored;
use crate::table::{CaseBase, Gate};

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
    Query::with(problem, settings, |query| {
        let mut best: Option<Found> = None;
        let mut candidates = 0;
        each_near(base, query, |case| {
            if let Some(found) = candidate(query, &case) {
                candidates += 1;
                if best.as_ref().is_none_or(|best| key_order(&found.key, &best.key, settings).is_lt()) {
                    best = Some(found);
                }
            }
        });
        Retrieval { best: best.map(Found::into_match), candidates }
    })
}

/// Shows every case under the problem's goal that may hold the ball in its scope. Without the index (another threshold
/// than it was made for) that is every case.
#[inline]
fn each_near<'q, 'a>(base: &'q CaseBase<'a>, query: &Query<'_>, visit: impl FnMut(Stored<'q, 'a>)) {
    let goal = query.problem.defending;
    let listed = |id: usize| Stored::new(base, CaseId(id as u16));
    if CaseBase::index_serves(query.door.limit) {
        let (list, flip) = base.near(query.door.ball, goal);
        list.iter().filter_map(|id| listed(usize::from(*id) ^ flip)).for_each(visit);
    } else {
        let under_goal = base.cases().filter(|case| case.defending() == goal);
        under_goal.filter_map(|case| listed(usize::from(case.id().0))).for_each(visit);
    }
}

/// Is the case a candidate, and how does it rank?
fn candidate(query: &Query<'_>, case: &Stored<'_, '_>) -> Option<Found> {
    let exponent = query.door.exponent(case.gate)?;
    if query.robot_outside(case).is_some() {
        return None;
    }
    let free = query.freedom(case)?;
    let players = query.cheapest(case)?;
    Some(query.found(case, exponent, free, players))
}

/// The best case alone, without counting the candidates: cases that cannot win are not looked into.
#[inline(never)]
pub fn retrieve_best(base: &CaseBase<'_>, problem: &Problem, settings: &Settings) -> Option<Match> {
    if !are_the_papers(settings) {
        return retrieve(base, problem, settings).best;
    }
    Query::with(problem, settings, |query| {
        if !CaseBase::index_serves(query.door.limit) {
            return retrieve(base, problem, settings).best;
        }
        let mut race = Race { base, query, class: Class(0), best: None };
        let door = query.door;
        let (list, flip) = base.near(door.ball, problem.defending);
        for id in list {
            let id = usize::from(*id) ^ flip;
            let Some(gate) = base.gates.get(id) else { continue };
            let Some(exponent) = door.exponent(gate) else { continue };
            if race.enter(CaseId(id as u16), gate, exponent).is_break() {
                break;
            }
        }
        race.best.map(Found::into_match)
    })
}

/// Are these the choices of the paper, for which bounds hold and the quick way is written? Numbers may be others.
#[inline]
fn are_the_papers(settings: &Settings) -> bool {
    let Settings { ranking: [first, second, third], .. } = *settings;
    let Settings { out_of_field, correspondence, cost, scopes, free_path, .. } = *settings;
    let choices = [
        first as u8,
        second as u8,
        third as u8,
        out_of_field as u8,
        correspondence as u8,
        cost as u8,
        scopes as u8,
        free_path as u8,
    ];
    // One number is compared quicker than eight choices.
    u64::from_le_bytes(choices) == u64::from_le_bytes(PAPER)
}

/// The paper's choices.
const PAPER: [u8; 8] = [
    Criterion::Conditions as u8,
    Criterion::Teammates as u8,
    Criterion::IntervalCost as u8,
    OutOfField::Keep as u8,
    CorrespondenceRule::MinThenTest as u8,
    CostRule::Sum as u8,
    ScopeRule::Translated as u8,
    FreePathRule::Crisp as u8,
];

/// Conditions (from bit 10), then teammates (from bit 2), then three less the interval: what a candidate is ranked by
/// before cost, in one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Class(u32);

impl Class {
    /// The best a case could come to, wherever the ball lies.
    #[inline]
    fn promise(gate: &Gate) -> Self {
        Self(u32::from(u16::from_le_bytes([gate.teammates, gate.opponents])) << 2 | 3)
    }

    /// The same with the ball in the interval of that exponent.
    #[inline]
    fn in_interval_of(self, exponent: f32) -> Self {
        // Three less the interval, in the two lowest bits.
        Self(self.0 ^ u32::from(interval(exponent) & 3))
    }

    /// The same with so many of its scopes empty.
    #[inline]
    fn without(self, conditions: u32) -> Self {
        Self(self.0.wrapping_sub(conditions << 10))
    }

    #[inline]
    fn conditions(self) -> u8 {
        (self.0 >> 10) as u8
    }

    /// How many conditions it could lose without falling behind `other`, which is no better.
    #[inline]
    fn conditions_above(self, other: Self) -> u32 {
        self.0.wrapping_sub(other.0) >> 10
    }
}

/// Cases with the ball in their scope, on their way to becoming the best candidate.
struct Race<'q, 'a> {
    base: &'q CaseBase<'a>,
    query: &'q Query<'q>,
    /// The class of the best candidate so far.
    class: Class,
    best: Option<Found>,
}

impl<'a> Race<'_, 'a> {
    /// Looks at a case that could come to the class of the best candidate. Breaks where neither it nor any that promises
    /// no more can.
    #[inline(always)]
    fn enter(&mut self, case: CaseId, gate: &'a Gate, exponent: f32) -> ControlFlow<()> {
        // Lists fall in the order of promises.
        let promise = Class::promise(gate);
        if promise < self.class {
            return ControlFlow::Break(());
        }
        let allowed = promise.in_interval_of(exponent);
        if allowed >= self.class
            && let Some(scopes) = gate.opponents(self.base.places)
            && let Some(empty) = self.query.empty_scopes(scopes, allowed.conditions_above(self.class))
        {
            self.look_at(case, gate, exponent, allowed.without(empty));
        }
        ControlFlow::Continue(())
    }

    /// A case of a class no less than the best candidate's: takes its place if it is a better candidate.
    #[inline(never)]
    fn look_at(&mut self, id: CaseId, gate: &'a Gate, exponent: f32, class: Class) {
        let Self { base, query, .. } = *self;
        let case = &Stored { base, id, gate };
        if query.is_crisply_blocked(case) {
            return;
        }
        let Some(nearest) = query.nearest(case) else { return };
        if class == self.class
            && let Some(rival) = &self.best
            && nearest.players.cost > rival.key.cost
        {
            return;
        }
        let Some(players) = query.least_sum(case, nearest) else { return };
        let key = Key {
            conditions: class.conditions(),
            teammates: case.teammates(),
            free: 1.0,
            exponent,
            cost: players.cost,
            case: case.id.0,
        };
        if class == self.class
            && let Some(rival) = &self.best
            && key_order(&key, &rival.key, query.settings).is_ge()
        {
            return;
        }
        (self.class, self.best) = (class, Some(Found { key, players: players.ids }));
    }
}
