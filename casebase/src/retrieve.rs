//! `retrieve`: case retrieval (Ros et al. 2009, §3, Algorithms 1 and 2; docs/case-format.md §3).
//!
//! A case is a candidate if the ball lies in its ball scope, the robots are near enough to their adapted
//! positions, the ball's path is free and its opponent scopes' demands are met; candidates are ranked by
//! [`rank_order`](crate::rank_order). Cheap checks come first, and checks that cannot change the answer are
//! skipped; the answer equals that of the plain order.

use core::ops::ControlFlow;

use protocol::CaseId;

use crate::problem::Problem;
use crate::query::{Found, Query};
use crate::rank::{Key, Match, interval, key_order};
use crate::settings::{
    CorrespondenceRule, CostRule, Criterion, FreePathRule, OutOfField, RetrievalSettings, ScopeRule,
};
use crate::stored::Stored;
use crate::table::{CaseBase, RecordHeader};

/// Result of a retrieval.
#[derive(Clone, Debug, PartialEq)]
pub struct Retrieval {
    /// The case that ranks first.
    pub best: Option<Match>,
    /// Number of cases that passed every check.
    pub candidates: u16,
}

/// The best case and the number of candidates.
pub fn retrieve(base: &CaseBase<'_>, problem: &Problem, settings: &RetrievalSettings) -> Retrieval {
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

/// Passes every case under the problem's goal whose scope may contain the ball to a callback. Without the
/// index (with another threshold than it was built for) that is every case.
#[inline]
fn each_near<'q, 'a>(base: &'q CaseBase<'a>, query: &Query<'_>, visit: impl FnMut(Stored<'q, 'a>)) {
    let goal = query.problem.defending;
    let listed = |id: usize| Stored::new(base, CaseId(id as u16));
    if CaseBase::index_serves(query.key.limit) {
        let (list, flip) = base.near(query.key.ball, goal);
        list.iter().filter_map(|id| listed(usize::from(*id) ^ flip)).for_each(visit);
    } else {
        let under_goal = base.cases().filter(|case| case.defending() == goal);
        under_goal.filter_map(|case| listed(usize::from(case.id().0))).for_each(visit);
    }
}

/// The case as a candidate with its ranking key; `None` where it is none.
fn candidate(query: &Query<'_>, case: &Stored<'_, '_>) -> Option<Found> {
    let exponent = query.key.exponent(case.record_header)?;
    if query.robot_outside(case).is_some() {
        return None;
    }
    let free = query.freedom(case)?;
    if query.unmet_demand(case).is_some() {
        return None;
    }
    let players = query.cheapest(case)?;
    Some(query.found(case, exponent, free, players))
}

/// The best case alone, without counting the candidates: cases that cannot win are skipped.
#[inline(never)]
pub fn retrieve_best(base: &CaseBase<'_>, problem: &Problem, settings: &RetrievalSettings) -> Option<Match> {
    if !are_the_papers(settings) {
        return retrieve(base, problem, settings).best;
    }
    Query::with(problem, settings, |query| {
        if !CaseBase::index_serves(query.key.limit) {
            return retrieve(base, problem, settings).best;
        }
        let mut search = BestSearch { base, query, class: Class(0), best: None };
        let key = query.key;
        let (mut list, flip) = base.near(key.ball, problem.defending);
        while let Some((id, rest)) = list.split_first() {
            list = rest;
            let id = usize::from(*id) ^ flip;
            let Some(record_header) = base.record_headers.get(id) else { continue };
            if usize::from(record_header.teammates) > key.robots {
                list = beyond(list, base, flip, record_header.opponents, key.robots);
                continue;
            }
            let Some(exponent) = key.exponent_in_scope(record_header) else { continue };
            if search.consider(CaseId(id as u16), record_header, exponent).is_break() {
                break;
            }
        }
        search.best.map(Found::into_match)
    })
}

/// The part of a sorted list behind the cases that have this number of opponents and more than `robots`
/// robots.
#[inline(never)]
fn beyond<'l>(list: &'l [u16], base: &CaseBase<'_>, flip: usize, opponents: u8, robots: usize) -> &'l [u16] {
    let too_many = |id: &u16| {
        let record_header = base.record_headers.get(usize::from(*id) ^ flip);
        record_header
            .is_some_and(|header| header.opponents >= opponents && usize::from(header.teammates) > robots)
    };
    list.get(list.partition_point(too_many)..).unwrap_or(&[])
}

/// Returns whether these are the choices of the paper, for which the bounds hold and the fast path is
/// written. Numbers may differ.
#[inline]
fn are_the_papers(settings: &RetrievalSettings) -> bool {
    let RetrievalSettings { ranking: [first, second, third], .. } = *settings;
    let RetrievalSettings { out_of_field, correspondence, cost, scopes, free_path, .. } = *settings;
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
    // One number is compared faster than eight choices.
    u64::from_le_bytes(choices) == u64::from_le_bytes(PAPER)
}

/// Choices of the paper, one byte each.
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

/// Conditions (from bit 10), then teammates (from bit 2), then three minus the interval: the ranking criteria
/// before cost, in one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Class(u32);

impl Class {
    /// Upper bound of a case's class, for any position of the ball.
    #[inline]
    fn promise(record_header: &RecordHeader) -> Self {
        Self(u32::from(u16::from_le_bytes([record_header.teammates, record_header.opponents])) << 2 | 3)
    }

    /// The same with the ball in the interval of that exponent.
    #[inline]
    fn in_interval_of(self, exponent: f32) -> Self {
        // Three minus the interval, in the two lowest bits.
        Self(self.0 ^ u32::from(interval(exponent) & 3))
    }

    /// The same with `conditions` of its scopes empty.
    #[inline]
    fn without(self, conditions: u32) -> Self {
        Self(self.0.wrapping_sub(conditions << 10))
    }

    #[inline]
    fn conditions(self) -> u8 {
        (self.0 >> 10) as u8
    }

    /// Number of conditions it could lose without falling behind `other`, which is no better.
    #[inline]
    fn conditions_above(self, other: Self) -> u32 {
        self.0.wrapping_sub(other.0) >> 10
    }
}

/// State of the search for the best candidate among cases with the ball in their scope.
struct BestSearch<'q, 'a> {
    base: &'q CaseBase<'a>,
    query: &'q Query<'q>,
    /// The class of the best candidate so far.
    class: Class,
    best: Option<Found>,
}

impl<'a> BestSearch<'_, 'a> {
    /// Tests a case whose bound reaches the class of the best candidate. Breaks where neither it nor any case
    /// with no higher bound can.
    #[inline(always)]
    fn consider(&mut self, case: CaseId, record_header: &'a RecordHeader, exponent: f32) -> ControlFlow<()> {
        // Lists are sorted by falling bound.
        let promise = Class::promise(record_header);
        if promise < self.class {
            return ControlFlow::Break(());
        }
        let allowed = promise.in_interval_of(exponent);
        if allowed >= self.class
            && let Some(scopes) = record_header.opponents(self.base.places)
            && let Some(empty) = self.query.empty_scopes(scopes, allowed.conditions_above(self.class))
        {
            self.judge(case, record_header, exponent, allowed.without(empty));
        }
        ControlFlow::Continue(())
    }

    /// Tests a case whose class is at least the best candidate's, and replaces that candidate if this one is
    /// better.
    #[inline(never)]
    fn judge(&mut self, id: CaseId, record_header: &'a RecordHeader, exponent: f32, class: Class) {
        let Self { base, query, .. } = *self;
        let case = &Stored { base, id, record_header };
        let Some(nearest) = query.nearest(case) else { return };
        if class == self.class
            && let Some(candidate) = &self.best
            && nearest.players.cost > candidate.key.cost
        {
            return;
        }
        if query.is_crisply_blocked(case) || query.unmet_demand(case).is_some() {
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
            && let Some(candidate) = &self.best
            && key_order(&key, &candidate.key, query.settings).is_ge()
        {
            return;
        }
        (self.class, self.best) = (class, Some(Found { key, players: players.ids }));
    }
}
