//! `count`: what another case, or other settings of retrieval, would change over the problems of a match.

use std::collections::BTreeMap;

use arena::cases::problem;
use case_tools::Library;
use casebase::{Problem, RetrievalSettings, retrieve_best};
use page::MatchProblem;
use serde::Serialize;

/// The problems of a match that can be read.
pub(super) struct Problems(Vec<Problem>);

impl Problems {
    pub(super) fn of(problems: &[MatchProblem]) -> Self {
        Self(problems.iter().filter_map(|one| problem::parse(&one.problem.to_string()).ok()).collect())
    }

    /// The name of the case that is retrieved for each; none where no case fits.
    fn answers<'l>(&self, library: &'l Library, settings: &RetrievalSettings) -> Vec<Option<&'l str>> {
        let base = library.base();
        let answer = |problem| {
            let best = retrieve_best(&base, problem, settings)?;
            library.names.get(usize::from(best.case.0) / 4).map(String::as_str)
        };
        self.0.iter().map(answer).collect()
    }
}

#[derive(Debug, PartialEq, Eq, Serialize)]
pub(super) struct CaseCount {
    /// Problems that were counted.
    problems: usize,
    /// Of them with a case, before and with it.
    answered: [usize; 2],
    /// Number of problems that it is retrieved for, before and with its changes.
    wins: [usize; 2],
    /// From which cases it takes how many, the most first; null is no case.
    takes: Vec<(Option<String>, usize)>,
    /// To which cases it gives how many.
    gives: Vec<(Option<String>, usize)>,
}

/// Problems that the case `name` wins where `after` holds it as it is edited, and `before` as it is on disk.
pub(super) fn wins(
    problems: &Problems,
    before: &Library,
    after: &Library,
    name: &str,
    settings: &RetrievalSettings,
) -> CaseCount {
    let [before, after] = [problems.answers(before, settings), problems.answers(after, settings)];
    let (mut takes, mut gives) = (BTreeMap::new(), BTreeMap::new());
    for (old, new) in before.iter().zip(&after).filter(|(old, new)| old != new) {
        if *new == Some(name) {
            *takes.entry(*old).or_default() += 1;
        } else if *old == Some(name) {
            *gives.entry(*new).or_default() += 1;
        }
    }
    let count = |answers: &[Option<&str>]| answers.iter().filter(|answer| **answer == Some(name)).count();
    CaseCount {
        problems: problems.0.len(),
        answered: [answered(&before), answered(&after)],
        wins: [count(&before), count(&after)],
        takes: listed(takes),
        gives: listed(gives),
    }
}

/// Changes by other settings over a match's problems.
#[derive(Debug, PartialEq, Eq, Serialize)]
pub(super) struct Changes {
    /// Problems that were counted.
    problems: usize,
    /// Of them with a case, under the match's settings and under the others.
    answered: [usize; 2],
    /// Problems with another answer.
    changed: usize,
    /// Cases that are retrieved at another number of problems: name, before, then; null is no case.
    cases: Vec<(Option<String>, [usize; 2])>,
}

/// Changes that `then` would make.
pub(super) fn changes(
    problems: &Problems,
    library: &Library,
    now: &RetrievalSettings,
    then: &RetrievalSettings,
) -> Changes {
    let answers = [problems.answers(library, now), problems.answers(library, then)];
    let mut cases: BTreeMap<Option<&str>, [usize; 2]> = BTreeMap::new();
    for (side, answers) in answers.iter().enumerate() {
        for answer in answers {
            cases.entry(*answer).or_default()[side] += 1;
        }
    }
    let mut cases: Vec<_> = cases.into_iter().filter(|(_, [now, then])| now != then).collect();
    cases.sort_by_key(|(_, [now, then])| std::cmp::Reverse(now.abs_diff(*then)));
    let [now, then] = &answers;
    Changes {
        problems: problems.0.len(),
        answered: [answered(now), answered(then)],
        changed: now.iter().zip(then).filter(|(a, b)| a != b).count(),
        cases: cases.into_iter().map(|(name, counts)| (name.map(str::to_owned), counts)).collect(),
    }
}

fn answered(answers: &[Option<&str>]) -> usize {
    answers.iter().flatten().count()
}

/// The most first.
fn listed(counts: BTreeMap<Option<&str>, usize>) -> Vec<(Option<String>, usize)> {
    let mut list: Vec<_> = counts.into_iter().map(|(name, count)| (name.map(str::to_owned), count)).collect();
    list.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    list
}
