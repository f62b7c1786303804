//! `played`: tests: the table of played cases is correct. Repeats a part of it, and searches it for every
//! case.

use std::path::Path;

use arena::{CaseNames, CaseTrial, Opposition, Score, markdown};
use casebase::RetrievalSettings;
use rules::League;

/// What `onetwo cases play --trials 200 --seed 1 --markdown` wrote.
const TRIALS: u32 = 200;
const SEED: u64 = 1;

fn file() -> String {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../casebase/library/cases/four-legged/played.md");
    std::fs::read_to_string(file).expect("the table is committed")
}

fn names() -> &'static [&'static str] {
    let league = case_library::league("four-legged");
    league.expect("the built-in league").names
}

#[test]
fn the_table_of_played_cases_lists_every_case_against_both_kinds_of_opponents() {
    let (file, names) = (file(), names());
    for name in names {
        for opponents in Opposition::ALL {
            let row = format!("| {name} | {} | ", opponents.label());
            assert_eq!(file.matches(&row).count(), 1, "{name} {}; {AGAIN}", opponents.label());
        }
    }
    assert_eq!(file.lines().filter(|line| line.starts_with("| ")).count(), 1 + 2 * names.len(), "{AGAIN}");
}

#[test]
fn rows_of_the_table_come_out_again() {
    let (file, names) = (file(), names());
    let case_trial = CaseTrial {
        league: League::FourLegged,
        base: case_library::four_legged(),
        names: CaseNames::new(names.iter().copied()),
        settings: RetrievalSettings::default(),
        trials: TRIALS,
        seed: SEED,
    };
    for authored in (0..names.len()).step_by(8) {
        let case = case_trial.case(authored).expect("a stored case for every authored one");
        for opponents in Opposition::ALL {
            let attempts = case_trial.play(&case, opponents, &|| ()).expect("the simulator runs");
            let score = Score::of(names[authored].to_owned(), opponents.label(), &attempts);
            let table = markdown(&[score]);
            let row = table.lines().last().unwrap_or_default();
            assert!(file.contains(row), "the file has no row {row}; {AGAIN}");
        }
    }
}

#[test]
fn a_case_completed_by_less_than_sixty_in_a_hundred_says_why_in_its_file() {
    let file = file();
    let league = case_library::league("four-legged").expect("built in");
    for (name, text) in league.names.iter().zip(league.sources) {
        for opponents in Opposition::ALL.map(Opposition::label) {
            let row = file.lines().find(|line| line.starts_with(&format!("| {name} | {opponents} |")));
            let completed: f64 =
                row.and_then(|row| row.split('|').nth(4)?.trim().parse().ok()).expect("a share");
            let message =
                format!("# Completed by fewer than 60 in 100 against {opponents} opponents (played.md):");
            let reason =
                text.lines().skip_while(|line| *line != message).nth(1).filter(|line| line.starts_with("# "));
            assert_eq!(
                completed < 60.0,
                reason.is_some(),
                "{name}: {completed} % completed against {opponents} opponents; the file has to say why just where it is \
                 below 60: `{message}` and the reason in the next line"
            );
        }
    }
}

const AGAIN: &str = "if a case, the brain or the simulator changed, write it again: \
    cargo run --release -- cases play --trials 200 --seed 1 --markdown > casebase/library/cases/four-legged/played.md";
