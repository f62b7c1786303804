//! `best_search`: search for the best case alone: the bounds of what a case can come to, and the test of a
//! case against the best candidate so far (docs/case-format.md §3).

use core::ops::ControlFlow;

use protocol::CaseId;

use crate::query::{Found, Query};
use crate::rank::{Key, interval, key_order};
use crate::stored::Stored;
use crate::table::{CaseBase, RecordHeader};

/// Conditions (from bit 10), then teammates (from bit 2), then three minus the interval: the ranking criteria
/// before cost, in one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Class(u32);

impl Class {
    /// Upper bound of a case's class, for any position of the ball.
    #[inline]
    pub(crate) fn promise(record_header: &RecordHeader) -> Self {
        Self::bound(record_header.opponents, record_header.teammates)
    }

    /// Upper bound of the class of cases with so many conditions and robots.
    #[inline]
    pub(crate) fn bound(conditions: u8, teammates: u8) -> Self {
        Self(u32::from(u16::from_le_bytes([teammates, conditions])) << 2 | 3)
    }

    /// The same with the ball in the interval of that exponent.
    #[inline]
    pub(crate) fn in_interval_of(self, exponent: f32) -> Self {
        // Three minus the interval, in the two lowest bits.
        Self(self.0 ^ u32::from(interval(exponent) & 3))
    }

    /// The same with `conditions` of its scopes empty.
    #[inline]
    fn without(self, conditions: u32) -> Self {
        Self(self.0.wrapping_sub(conditions << 10))
    }

    #[inline]
    pub(crate) fn conditions(self) -> u8 {
        (self.0 >> 10) as u8
    }

    /// Number of conditions it could lose without falling behind `other`, which is no better.
    #[inline]
    fn conditions_above(self, other: Self) -> u32 {
        self.0.wrapping_sub(other.0) >> 10
    }
}

/// State of the search for the best candidate among cases with the ball in their scope.
pub(crate) struct BestSearch<'q, 'a> {
    pub(crate) base: &'q CaseBase<'a>,
    pub(crate) query: &'q Query<'q>,
    /// The class of the best candidate so far.
    pub(crate) class: Class,
    pub(crate) best: Option<Found>,
}

impl<'q, 'a> BestSearch<'q, 'a> {
    /// A search before its first candidate.
    #[inline]
    pub(crate) fn new(base: &'q CaseBase<'a>, query: &'q Query<'q>) -> Self {
        Self { base, query, class: Class(0), best: None }
    }

    /// Tests a case whose bound reaches the class of the best candidate. Breaks where neither it nor any case
    /// with no higher bound can.
    #[inline(always)]
    pub(crate) fn consider(
        &mut self,
        case: CaseId,
        record_header: &'a RecordHeader,
        exponent: f32,
    ) -> ControlFlow<()> {
        // Lists are sorted by falling bound.
        let promise = Class::promise(record_header);
        if promise < self.class {
            return ControlFlow::Break(());
        }
        let allowed = promise.in_interval_of(exponent);
        if allowed >= self.class {
            self.test_scopes(case, record_header, exponent, allowed);
        }
        ControlFlow::Continue(())
    }

    /// Tests a case that comes to the class `allowed` where none of its scopes is empty.
    #[inline(always)]
    pub(crate) fn test_scopes(
        &mut self,
        case: CaseId,
        record_header: &'a RecordHeader,
        exponent: f32,
        allowed: Class,
    ) {
        if let Some(scopes) = record_header.opponents(self.base.places)
            && let Some(empty) = self.query.empty_scopes(scopes, allowed.conditions_above(self.class))
        {
            self.judge(case, record_header, exponent, allowed.without(empty));
        }
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
