//! `rank`: ranking of candidates (Ros et al. 2009, §3.4; docs/case-format.md §3).
//!
//! More conditions, then more teammates, then the higher similarity interval, then the lower cost; ties go to
//! the higher similarity, then to the lower id. The order of the three criteria is a setting.

use core::cmp::Ordering;

use heapless::Vec;
use protocol::{CaseId, RobotId};
use serde::{Deserialize, Serialize};

use crate::action::TEAMMATES_MAX;
use crate::settings::{Criterion, FreePathRule, RetrievalSettings};

/// The players: case robot i is played by entry i.
pub type Correspondence = Vec<RobotId, TEAMMATES_MAX>;

/// A candidate with all its ranking criteria.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Match {
    /// The stored case; each symmetric copy has an id of its own.
    pub case: CaseId,
    /// sim_B, above the threshold.
    pub similarity: f32,
    /// −ln sim_B: similarities are compared by it.
    pub exponent: f32,
    /// Adaptation cost: distances to the adapted positions, mm.
    pub cost: f32,
    /// 1 − max μ over legs and opponents: 1 where no opponent is abreast of any leg. Computed only where
    /// paths are fuzzy, else 1.
    pub free: f32,
    /// Number of opponent scopes that contain an opponent.
    pub conditions: u8,
    /// Number of robots of the case.
    pub teammates: u8,
    /// The player that takes the part of each case robot.
    pub correspondence: Correspondence,
}

/// `Less` where `a` ranks before `b`.
pub fn rank_order(a: &Match, b: &Match, settings: &RetrievalSettings) -> Ordering {
    key_order(&Key::of(a), &Key::of(b), settings)
}

/// The ranking criteria of a candidate, without its correspondence.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Key {
    pub(crate) conditions: u8,
    pub(crate) teammates: u8,
    pub(crate) free: f32,
    pub(crate) exponent: f32,
    pub(crate) cost: f32,
    pub(crate) case: u16,
}

impl Key {
    fn of(candidate: &Match) -> Self {
        Self {
            conditions: candidate.conditions,
            teammates: candidate.teammates,
            free: candidate.free,
            exponent: candidate.exponent,
            cost: candidate.cost,
            case: candidate.case.0,
        }
    }
}

/// Order of two candidates by their keys, as [`rank_order`].
pub(crate) fn key_order(a: &Key, b: &Key, settings: &RetrievalSettings) -> Ordering {
    for criterion in settings.ranking {
        let order = match criterion {
            Criterion::Conditions => b.conditions.cmp(&a.conditions),
            Criterion::Teammates => b.teammates.cmp(&a.teammates),
            Criterion::IntervalCost => {
                let freer = match settings.free_path {
                    FreePathRule::Crisp => Ordering::Equal,
                    FreePathRule::Fuzzy => b.free.total_cmp(&a.free),
                };
                freer.then(interval(a.exponent).cmp(&interval(b.exponent))).then(a.cost.total_cmp(&b.cost))
            }
        };
        if order != Ordering::Equal {
            return order;
        }
    }
    a.exponent.total_cmp(&b.exponent).then(a.case.cmp(&b.case))
}

/// The similarity interval of an exponent: 0 for H, 1 for h, 2 for l, 3 for L.
#[inline]
pub(crate) fn interval(exponent: f32) -> u8 {
    INTERVAL_EXPONENTS.iter().filter(|end| exponent > **end).count() as u8
}

/// −ln of the ends 0.8, 0.6 and 0.4 of the similarity intervals; an end belongs to the higher interval.
const INTERVAL_EXPONENTS: [f32; 3] = [0.223_143_55, 0.510_825_6, 0.916_290_7];

#[cfg(test)]
mod tests {
    use super::*;

    fn candidate(case: u16, conditions: u8, teammates: u8, similarity: f32, cost: f32) -> Match {
        let exponent = -geometry::math::ln(similarity);
        let case = CaseId(case);
        Match {
            case,
            similarity,
            exponent,
            cost,
            free: 1.0,
            conditions,
            teammates,
            correspondence: Vec::new(),
        }
    }

    fn first<'a>(candidates: &'a [Match], settings: &RetrievalSettings) -> &'a Match {
        candidates.iter().min_by(|a, b| rank_order(a, b, settings)).unwrap()
    }

    #[test]
    fn the_paper_s_example_of_an_interval_is_ordered_by_cost() {
        let list =
            [candidate(3, 0, 1, 0.9, 30.0), candidate(7, 0, 1, 0.99, 40.0), candidate(10, 0, 1, 0.81, 20.0)];
        assert_eq!(first(&list, &RetrievalSettings::default()).case, CaseId(10));
    }

    #[test]
    fn a_somewhat_less_similar_case_of_a_lower_interval_never_wins_by_cost() {
        let list = [candidate(0, 0, 1, 0.80001, 900.0), candidate(4, 0, 1, 0.7999, 1.0)];
        assert_eq!(first(&list, &RetrievalSettings::default()).case, CaseId(0));
    }

    #[test]
    fn conditions_come_before_teammates_before_the_interval() {
        let list =
            [candidate(0, 0, 4, 1.0, 0.0), candidate(4, 1, 1, 0.4, 900.0), candidate(8, 1, 2, 0.4, 999.0)];
        assert_eq!(first(&list, &RetrievalSettings::default()).case, CaseId(8));
        let mut teammates_first = RetrievalSettings::default();
        teammates_first.set("ranking", "teammates,conditions,interval-cost").unwrap();
        assert_eq!(first(&list, &teammates_first).case, CaseId(0));
    }

    #[test]
    fn ties_go_to_the_higher_similarity_and_then_to_the_lower_id() {
        let list =
            [candidate(8, 0, 1, 0.9, 5.0), candidate(4, 0, 1, 0.95, 5.0), candidate(0, 0, 1, 0.95, 5.0)];
        assert_eq!(first(&list, &RetrievalSettings::default()).case, CaseId(0));
    }

    #[test]
    fn the_ends_of_the_intervals_are_those_of_the_paper() {
        for (end, exponent) in [0.8_f64, 0.6, 0.4].into_iter().zip(INTERVAL_EXPONENTS) {
            assert!((libm_ln(end) + f64::from(exponent)).abs() < 1e-6);
        }
        assert_eq!([0.0, 0.3, 0.6, 1.0].map(interval), [0, 1, 2, 3]);
    }

    fn libm_ln(x: f64) -> f64 {
        extern crate std;
        x.ln()
    }
}
