//! `competence`: contribution of each case to a library (Smyth & Keane 1995; Smyth & McKenna 2001, on sampled
//! problems).
//!
//! A case's *coverage set* are the problems it is a candidate for, a problem's *reachability set* the cases
//! that are candidates for it (authored cases: a file counts with its four copies). With C(x) for the
//! coverage set of x:
//!
//! - **pivotal**: some problem is reached by x alone; deleting x loses it.
//! - **auxiliary**: not pivotal, and C(x) lies within C(y), and is smaller, for one other case y.
//! - **support**: neither, and C(y) lies within C(x) for one other case y that covers anything: they back
//!   each other up.
//! - **spanning**: none of these: C(x) overlaps cases that cover its problems only together.
//! - **idle**: C(x) is empty.
//!
//! *Competence groups* are the connected components of cases that share a problem. All results are about the
//! sampled problems: with more of them a case can only become more important.

mod twins;

use crate::coverage::Counters;

pub use twins::{Shared, shared};

geometry::labels! {
    /// Role of a case in the library's coverage, the most important first.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
    pub enum CompetenceRole {
        /// The only candidate for some problem.
        Pivotal = "pivotal",
        /// Covers its problems as others do together.
        Spanning = "spanning",
        /// Covers the problems of another case.
        Support = "support",
        /// Within another case's coverage.
        Auxiliary = "auxiliary",
        /// Covers none of the problems.
        Idle = "idle",
    }
}

/// The role of every authored case.
pub fn roles(counters: &Counters, shared: &[Shared]) -> Vec<CompetenceRole> {
    let mut roles: Vec<CompetenceRole> = counters
        .cases
        .iter()
        .map(|case| match (case.candidate(), case.sole) {
            (0, _) => CompetenceRole::Idle,
            (_, 0) => CompetenceRole::Spanning,
            _ => CompetenceRole::Pivotal,
        })
        .collect();
    for pair in shared {
        let within = pair.cases.map(|case| pair.problems == counters.cases[usize::from(case)].candidate());
        let pair_roles = match within {
            [true, true] => [CompetenceRole::Support; 2],
            [true, false] => [CompetenceRole::Auxiliary, CompetenceRole::Support],
            [false, true] => [CompetenceRole::Support, CompetenceRole::Auxiliary],
            [false, false] => continue,
        };
        for (case, role) in pair.cases.into_iter().zip(pair_roles) {
            let slot = &mut roles[usize::from(case)];
            if *slot != CompetenceRole::Pivotal {
                *slot = (*slot).max(role);
            }
        }
    }
    roles
}

/// The competence groups, largest coverage first: their cases in rising order, and the number of problems
/// they cover.
pub fn groups(counters: &Counters) -> Vec<(Vec<u16>, u64)> {
    let mut parent: Vec<usize> = (0..counters.cases.len()).collect();
    for cases in counters.reaches.keys() {
        for pair in cases.windows(2) {
            let [a, b] = [pair[0], pair[1]].map(|case| root(&mut parent, usize::from(case)));
            parent[a.max(b)] = a.min(b);
        }
    }
    let mut groups: Vec<(Vec<u16>, u64)> = vec![(Vec::new(), 0); parent.len()];
    for case in 0..parent.len() {
        let root = root(&mut parent, case);
        groups[root].0.push(case as u16);
    }
    for (cases, reach) in &counters.reaches {
        if let Some(first) = cases.first() {
            groups[root(&mut parent, usize::from(*first))].1 += reach.problems;
        }
    }
    groups.retain(|(_, problems)| *problems > 0);
    groups.sort_by(|a, b| b.1.cmp(&a.1).then(a.0.cmp(&b.0)));
    groups
}

/// One step of deleting cases one after another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Deletion {
    /// Number of the authored case that is deleted, from 0.
    pub case: u16,
    /// Number of problems that this step leaves without any candidate.
    pub lost: u64,
    /// The same, summed with the steps before.
    pub lost_so_far: u64,
}

/// Deletes, again and again, the case with the smallest loss (ties: the one that covers fewest, then the
/// highest number) while at most `loss_max` problems are lost in total.
pub fn thin_out(counters: &Counters, loss_max: u64) -> Vec<Deletion> {
    let mut left: Vec<bool> = vec![true; counters.cases.len()];
    let mut deletions: Vec<Deletion> = Vec::new();
    let mut lost_so_far = 0;
    loop {
        let mut sole = vec![0_u64; left.len()];
        for (cases, reach) in &counters.reaches {
            let mut rest = cases.iter().filter(|case| left[usize::from(**case)]);
            if let (Some(only), None) = (rest.next(), rest.next()) {
                sole[usize::from(*only)] += reach.problems;
            }
        }
        let key = |case: &usize| (sole[*case], counters.cases[*case].candidate(), usize::MAX - *case);
        let Some(case) = (0..left.len()).filter(|case| left[*case]).min_by_key(key) else { break };
        if lost_so_far + sole[case] > loss_max {
            break;
        }
        left[case] = false;
        lost_so_far += sole[case];
        deletions.push(Deletion { case: case as u16, lost: sole[case], lost_so_far });
    }
    deletions
}

fn root(parent: &mut [usize], mut case: usize) -> usize {
    while parent[case] != case {
        parent[case] = parent[parent[case]];
        case = parent[case];
    }
    case
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::coverage::{CaseCounters, Reach};

    /// Counts of problems with these reachability sets.
    fn counters(cases: usize, reaches: &[(&[u16], u64)]) -> Counters {
        let mut counters = Counters::new(cases, 0);
        for (first, (cases, problems)) in (0..).zip(reaches) {
            counters.reaches.insert(cases.to_vec(), Reach { problems: *problems, first });
            for case in *cases {
                let CaseCounters { verdicts, sole, .. } = &mut counters.cases[usize::from(*case)];
                verdicts[5] += problems;
                *sole += if cases.len() == 1 { *problems } else { 0 };
            }
        }
        counters
    }

    #[test]
    fn roles_are_those_a_hand_finds() {
        // 0 alone covers 4; 1's problems are all 0's; 2 and 3 cover the same; 4 overlaps 0 and 2; 5 covers
        // nothing.
        let counters =
            counters(6, &[(&[0], 4), (&[0, 1], 3), (&[2, 3], 5), (&[0, 4], 1), (&[2, 3, 4], 2), (&[], 9)]);
        let roles = roles(&counters, &shared(&counters));
        use CompetenceRole::{Auxiliary, Idle, Pivotal, Spanning, Support};
        assert_eq!(roles, [Pivotal, Auxiliary, Support, Support, Spanning, Idle]);
    }

    #[test]
    fn groups_are_the_connected_components_of_shared_problems() {
        let counters = counters(6, &[(&[0, 2], 3), (&[2, 4], 1), (&[1], 7), (&[3, 5], 7), (&[], 2)]);
        assert_eq!(groups(&counters), [(vec![1], 7), (vec![3, 5], 7), (vec![0, 2, 4], 4)]);
    }

    #[test]
    fn thinning_counts_what_is_lost_after_the_deletions_before() {
        // 0 and 1 back each other up: deleting the first of them loses nothing, the second all they covered.
        let counters = counters(3, &[(&[0, 1], 5), (&[2], 3), (&[0, 2], 1)]);
        let step = |case, lost, lost_so_far| Deletion { case, lost, lost_so_far };
        assert_eq!(thin_out(&counters, 0), [step(1, 0, 0)]);
        assert_eq!(thin_out(&counters, 8), [step(1, 0, 0), step(2, 3, 3),]);
        assert_eq!(thin_out(&counters, 9), [step(1, 0, 0), step(2, 3, 3), step(0, 6, 9)]);
    }
}
