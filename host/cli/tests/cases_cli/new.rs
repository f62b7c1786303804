//! `new`: tests of `onetwo cases new`.

use std::fs;

use crate::common::{PROBLEM, cases, command, library};

#[test]
fn a_draft_of_a_problem_is_checked_and_retrieved_from_it() {
    let directory = library("new", &[]);
    fs::create_dir(directory.join("center")).unwrap();
    let file = directory.join("center/draft.toml");
    let out = ["--from", "-", "--out", file.to_str().unwrap()];
    let run = cases("new", &directory, &out, format!("\n{PROBLEM}\n"));
    assert_eq!((run.code, run.stdout.as_str(), run.stderr.as_str()), (0, "", ""));
    let checked = cases("check", &directory, &["--strict", "--problems", "0"], "");
    assert_eq!((checked.code, checked.lines().len()), (0, 1), "{}", checked.stdout);
    let found = cases("retrieve", &directory, &[], PROBLEM);
    assert!(found.stdout.starts_with(r#"{"case":"center/draft","id":0,"#), "{}", found.stdout);

    let text = fs::read_to_string(&file).unwrap();
    let mine = format!("# mine\n{text}");
    fs::write(&file, &mine).unwrap();
    let again = cases("new", &directory, &out, PROBLEM);
    assert!(again.code == 1 && again.stderr.contains("--force writes over it"), "{}", again.stderr);
    assert_eq!(fs::read_to_string(&file).unwrap(), mine);
    assert_eq!(cases("new", &directory, &[&out[..], &["--force"]].concat(), PROBLEM).code, 0);
    assert_eq!(fs::read_to_string(&file).unwrap(), text);
}

#[test]
fn a_file_s_problem_may_be_spread_over_lines_and_what_is_left_out_is_reported() {
    let directory = library("new-file", &[]);
    let robots: Vec<_> = (1..=6).map(|id| format!("\"{id}\": [{}, 0]", -650 - 200 * id)).collect();
    let problem = format!(
        "{{\n \"ball\": [-600, 10],\n \"defending\": \"yellow\",\n \"teammates\": {{{}}},\n \"opponents\": []\n}}\n",
        robots.join(", ")
    );
    let file = directory.join("problem.json");
    fs::write(&file, problem).unwrap();
    let run = cases("new", &directory, &["--from", file.to_str().unwrap()], "");
    assert_eq!(run.code, 0, "{}", run.stderr);
    assert!(run.stderr.starts_with("note: left out") && run.stderr.contains("robot 5, 6"), "{}", run.stderr);
    assert_eq!(run.stdout.matches("[[teammates]]").count(), 4);
}

#[test]
fn what_is_no_single_problem_is_refused_in_words() {
    let directory = library("new-refused", &[]);
    let refused = |input: &str, description: &str| {
        let run = cases("new", &directory, &["--from", "-"], input);
        assert_eq!((run.code, run.stdout.as_str()), (1, ""), "{input}");
        assert!(run.stderr.contains(description), "{}", run.stderr);
    };
    refused("", "holds no problem");
    refused("{}", "stdin: ball: missing");
    refused(&format!("{PROBLEM}\n{PROBLEM}\n"), "more than one problem");
    refused(&PROBLEM.replace("\"1\":[-700,0],\"3\":[200,800]", ""), "no teammate");
    let missing = cases("new", &directory, &["--from", "no/such.json"], "");
    assert!(missing.code == 1 && missing.stderr.contains("no/such.json"), "{}", missing.stderr);
    let nowhere = cases("new", &directory, &["--from", "-", "--out", "no/such/folder/a.toml"], PROBLEM);
    assert!(nowhere.code == 1 && nowhere.stderr.contains("create its directory first"), "{}", nowhere.stderr);
    assert_eq!(command(&["cases", "new"]).output().unwrap().status.code(), Some(2));
}
