//! `render`: tests of `onetwo cases render` (docs/case-format.md §5).

use std::fs;

use crate::common::{PROBLEM, cases, worked_example};

#[test]
fn a_library_is_drawn_as_files_and_on_one_page() {
    let directory = worked_example("render-all");
    let (out, page) = (directory.with_extension("out"), directory.with_extension("svg"));
    let [out, page] = [&out, &page].map(|path| path.to_str().unwrap());
    let run = cases("render", &directory, &["--all", "--out", out, "--sheet", page], "");
    assert_eq!((run.code, run.stderr.as_str()), (0, ""));
    let one = fs::read_to_string(format!("{out}/center/pass-around.svg")).unwrap();
    assert!(one.contains("pass around it and shoot") && one.contains(">tm2</text>"));
    let all = fs::read_to_string(page).unwrap();
    assert!(all.contains(">render-all: 1 case</text>") && all.contains(">pass-around</text>"), "{all}");
}

#[test]
fn a_problem_over_its_case_reports_the_rank() {
    let run = cases("render", &worked_example("render-rank"), &["--problem", PROBLEM], "");
    assert_eq!(run.code, 0, "{}", run.stderr);
    assert!(run.stdout.contains("Candidate, rank 1 of 1: occupied opponent scopes 1, teammates 2"));
}

#[test]
fn what_cannot_be_drawn_is_reported_with_the_hint() {
    let directory = worked_example("render-wrong");
    let out = directory.with_extension("jpg");
    for (arguments, description) in [
        (vec!["center/pas-around"], "did you mean center/pass-around?"),
        (vec!["0", "--out", out.to_str().unwrap()], "expected a name that ends in .svg or .png"),
        (vec!["0", "--problem", "{}"], "--problem: "),
    ] {
        let run = cases("render", &directory, &arguments, "");
        assert!(run.code == 1 && run.stderr.contains(description), "{arguments:?}: {}", run.stderr);
    }
}
