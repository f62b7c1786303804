//! `retrieve`: case retrieval (Ros et al. 2009, §3, Algorithms 1 and 2; docs/case-format.md §3).
//!
//! A case is a candidate if the ball lies in its ball scope, the robots are near enough to their adapted
//! positions, the ball's path is free and its opponent scopes' demands are met; candidates are ranked by
//! [`rank_order`](crate::rank_order). Cheap checks come first, and checks that cannot change the answer are
//! skipped; the answer equals that of the plain order.

use protocol::CaseId;

use crate::best_search::BestSearch;
use crate::problem::Problem;
use crate::query::{Found, Query};
use crate::rank::{Match, key_order};
use crate::settings::{
    CorrespondenceRule, CostRule, Criterion, FreePathRule, OutOfField, RetrievalSettings, ScopeRule,
};
use crate::stored::Stored;
use crate::table::CaseBase;
use crate::word_search::{each_in_words, search_words};

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
        if cfg!(feature = "words") && !base.words.is_empty() {
            return each_in_words(base, query, visit);
        }
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
        let mut search = BestSearch::new(base, query);
        if cfg!(feature = "words") && !base.words.is_empty() {
            search_words(&mut search);
            return search.best.map(Found::into_match);
        }
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
