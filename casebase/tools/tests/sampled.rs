//! `sampled`: tests: a case that no drawn problem retrieves is reported, with what is retrieved instead, and
//! no other case is (docs/case-format.md §1.2).

mod common;

use case_tools::{Finding, Library, code, never_retrieved};
use casebase::{RetrievalSettings, explain, retrieve_best};
use common::{library, single};

const DRAWN: u64 = 3_000;

fn findings(library: &Library) -> Vec<Finding> {
    let sampler = library.sampler(1);
    let survey = library.survey().expect("the defaults are settings");
    never_retrieved(library, &survey.over((0..DRAWN).map(|number| (number, sampler.problem(number)))))
}

/// One robot behind a ball in the middle of the field; `rest` is appended.
fn shot(scope: &str, rest: &str) -> String {
    single("[0, 0]", scope, ", { kick = \"forward\" }") + rest
}

#[test]
fn a_case_that_another_always_beats_gets_a_warning_that_names_it() {
    // Same position, but `candidate` dribbles and has an opponent scope over the whole field: where
    // `shadowed` is a candidate, `candidate` is one with one condition or two more, or by its lower id with
    // the same.
    let everywhere = "[[opponents]]\nat = [0, 0]\nscope = [9000, 9000]\n";
    let candidate = shot("[800, 600]", everywhere).replace("kick = \"forward\"", "dribble_to = [9, 0]");
    let shadowed = shot("[800, 600]", "");
    let library = library(&[("a/rival", &candidate), ("a/shadowed", &shadowed)]);
    let found = findings(&library);
    let [one] = found.as_slice() else { panic!("{found:?}") };
    assert_eq!((one.code, one.line, one.file.ends_with("a/shadowed.toml")), (code::NEVER_RETRIEVED, 3, true));

    // The same by asking case by case.
    let (base, sampler, settings) = (library.base(), library.sampler(1), RetrievalSettings::default());
    let mut beaten = 0;
    for number in 0..DRAWN {
        let problem = sampler.problem(number);
        let mut candidate = false;
        explain(&base, &problem, &settings, |id, verdict| {
            candidate |=
                library.names[usize::from(id.0 / 4)] == "a/shadowed" && verdict.label() == "candidate";
        });
        beaten += u64::from(candidate);
        let best = retrieve_best(&base, &problem, &settings);
        assert!(best.is_none_or(|best| best.case.0 / 4 == 0), "{number}");
    }
    assert!(beaten > 100, "{beaten}");
    let description = format!(
        "never retrieved in {DRAWN} drawn problems: a candidate in {beaten} of them, beaten most often by a/rival \
         ({beaten} times)"
    );
    assert_eq!(one.message, description);
    assert!(one.hint.contains("tell them apart"));
}

#[test]
fn a_case_that_is_sometimes_retrieved_gets_no_warning() {
    // Its scope is larger than the rival's: the balls there are its own.
    let everywhere = "[[opponents]]\nat = [0, 0]\nscope = [9000, 9000]\n";
    let candidate = shot("[600, 600]", everywhere).replace("kick = \"forward\"", "dribble_to = [9, 0]");
    let library = library(&[("a/rival", &candidate), ("a/wide", &shot("[800, 600]", ""))]);
    assert_eq!(findings(&library), []);
}
