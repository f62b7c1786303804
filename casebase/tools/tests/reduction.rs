//! `reduction`: tests of libraries without mirrored copies or without opponents.

use std::cmp::Ordering;
use std::path::Path;

use case_tools::{Files, Library, Reduction, build_reduced};
use casebase::{CaseVerdict, Match, Problem, RetrievalSettings, explain, retrieve, retrieve_best};

fn kept(symmetry: bool, opponents: bool) -> Library {
    let directory = Path::new(env!("CARGO_MANIFEST_DIR")).join("../library/cases/four-legged");
    let files = Files::read(&directory).expect("the built-in library");
    build_reduced(&files, Reduction { symmetry, opponents }).expect("sound files")
}

fn problems(library: &Library) -> impl Iterator<Item = Problem> {
    let sampler = library.sampler(5);
    (0..PROBLEMS).map(move |number| sampler.problem(number))
}

#[test]
fn without_symmetry_the_best_authored_candidate_wins_under_its_own_id() {
    let (whole, reduced) = (kept(true, true), kept(false, true));
    assert_eq!(reduced.base().len(), whole.base().len());
    assert_ne!(reduced.base().hash(), whole.base().hash());
    let (settings, mut mirrored, mut authored) = (RetrievalSettings::default(), 0, 0);
    for problem in problems(&whole) {
        let mut candidates = Vec::new();
        explain(&whole.base(), &problem, &settings, |case, verdict| {
            if let CaseVerdict::Candidate(found) = verdict {
                candidates.push(found);
                assert_eq!(candidates.last().map(|found| found.case), Some(case));
            }
        });
        candidates.sort_by(by_hand);
        mirrored += u32::from(candidates.first().is_some_and(|found| !found.case.0.is_multiple_of(4)));
        candidates.retain(|found| found.case.0.is_multiple_of(4));
        let found = retrieve(&reduced.base(), &problem, &settings);
        assert_eq!(found.candidates as usize, candidates.len());
        assert_eq!(found.best.as_ref(), candidates.first());
        assert_eq!(retrieve_best(&reduced.base(), &problem, &settings), found.best);
        authored += u32::from(found.best.is_some());
    }
    assert!(mirrored > 50 && authored > 50, "{mirrored} {authored}: too few to tell");
}

#[test]
fn without_opponents_the_same_cases_fit_and_no_condition_speaks_for_any() {
    let (whole, reduced) = (kept(true, true), kept(true, false));
    let (settings, mut justified) = (RetrievalSettings::default(), 0);
    for problem in problems(&whole) {
        let (full, bare) =
            (retrieve(&whole.base(), &problem, &settings), retrieve(&reduced.base(), &problem, &settings));
        assert_eq!(full.candidates, bare.candidates);
        assert_eq!(bare.best.as_ref().map_or(0, |best| best.conditions), 0);
        assert_eq!(retrieve_best(&reduced.base(), &problem, &settings), bare.best);
        justified += u32::from(full.best.is_some_and(|best| best.conditions > 0));
    }
    assert!(justified > 50, "{justified}: too few to tell");
}

/// docs/case-format.md §3: conditions, teammates, interval, cost, similarity, id.
fn by_hand(a: &Match, b: &Match) -> Ordering {
    let interval = |m: &Match| [0.8, 0.6, 0.4].iter().filter(|least| m.similarity >= **least).count();
    (b.conditions.cmp(&a.conditions))
        .then(b.teammates.cmp(&a.teammates))
        .then(interval(b).cmp(&interval(a)))
        .then(a.cost.total_cmp(&b.cost))
        .then(b.similarity.total_cmp(&a.similarity))
        .then(a.case.cmp(&b.case))
}

/// Drawn over the whole field; most of them have a case.
const PROBLEMS: u64 = 2000;
