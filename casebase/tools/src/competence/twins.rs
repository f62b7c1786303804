//! `twins`: pairs of cases that answer the same problems: their shared problems, and the similarity of their
//! coverage sets.

use std::collections::BTreeMap;

use crate::coverage::Counters;

/// Two authored cases that are candidates in the same problems.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shared {
    /// The two, in rising order.
    pub cases: [u16; 2],
    /// Number of problems both are candidates in.
    pub problems: u64,
    /// Number of problems at least one of them is a candidate in.
    pub either: u64,
}

impl Shared {
    /// Jaccard's index of the two coverage sets: 1 where they are candidates in the same problems.
    pub fn likeness(&self) -> f64 {
        self.problems as f64 / self.either.max(1) as f64
    }
}

/// Every pair that shares a problem, in the order of their numbers.
pub fn shared(counters: &Counters) -> Vec<Shared> {
    let mut both: BTreeMap<[u16; 2], u64> = BTreeMap::new();
    for (cases, reach) in &counters.reaches {
        for (at, a) in cases.iter().enumerate() {
            for b in &cases[at + 1..] {
                *both.entry([*a, *b]).or_default() += reach.problems;
            }
        }
    }
    let covers = |case: u16| counters.cases[usize::from(case)].candidate();
    both.into_iter()
        .map(|([a, b], problems)| Shared {
            cases: [a, b],
            problems,
            either: covers(a) + covers(b) - problems,
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::coverage::Reach;

    #[test]
    fn likeness_is_the_shared_part_of_what_either_covers() {
        let mut counters = Counters::new(2, 0);
        // Both in 3 problems, the first alone in 2, the second alone in 1.
        for (cases, problems) in [(vec![0, 1], 3), (vec![0], 2), (vec![1], 1)] {
            for case in &cases {
                counters.cases[usize::from(*case)].verdicts[5] += problems;
            }
            counters.reaches.insert(cases, Reach { problems, first: 0 });
        }
        let pairs = shared(&counters);
        assert_eq!(pairs, [Shared { cases: [0, 1], problems: 3, either: 6 }]);
        assert_eq!(pairs[0].likeness(), 0.5);
    }
}
