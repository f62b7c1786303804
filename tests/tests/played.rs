//! `played`: tests: the table of played cases is correct. Repeats a part of it, and searches it for every
//! case.

use std::path::Path;

use arena::{CaseNames, CaseTrial, Opposition, Score, markdown};
use casebase::{CaseBase, RetrievalSettings};
use rules::League;

/// A league's table: what `onetwo cases play` wrote.
struct Table {
    league: League,
    base: fn() -> CaseBase<'static>,
    trials: u32,
    /// Every n-th case is played again here.
    repeats: usize,
    command: &'static str,
}

const TABLES: [Table; 2] = [
    Table {
        league: League::FourLegged,
        base: case_library::four_legged,
        trials: 200,
        repeats: 8,
        command: "cargo run --release -- cases play --trials 200 --seed 1 --markdown \
                  > casebase/library/cases/four-legged/played.md",
    },
    Table {
        league: League::DivisionB,
        base: case_library::division_b,
        trials: 100,
        repeats: 15,
        command: "cargo run --release -- cases play --league division-b --trials 100 --seed 1 --markdown \
                  > casebase/library/cases/division-b/played.md",
    },
];

impl Table {
    fn file(&self) -> String {
        let directory = Path::new(env!("CARGO_MANIFEST_DIR")).join("../casebase/library/cases");
        let file = directory.join(self.league.name()).join("played.md");
        std::fs::read_to_string(file).expect("the table is committed")
    }

    fn names(&self) -> &'static [&'static str] {
        case_library::league(self.league.name()).expect("the built-in league").names
    }

    fn again(&self) -> String {
        format!("if a case, the brain or the simulator changed, write it again: {}", self.command)
    }
}

#[test]
fn the_table_of_played_cases_lists_every_case_against_both_kinds_of_opponents() {
    for table in &TABLES {
        let (file, names, again) = (table.file(), table.names(), table.again());
        for name in names {
            for opponents in Opposition::ALL {
                let row = format!("| {name} | {} | ", opponents.label());
                assert_eq!(file.matches(&row).count(), 1, "{name} {}; {again}", opponents.label());
            }
        }
        assert_eq!(
            file.lines().filter(|line| line.starts_with("| ")).count(),
            1 + 2 * names.len(),
            "{again}"
        );
    }
}

#[test]
fn rows_of_the_table_are_read_as_written() {
    for table in &TABLES {
        let (file, names, again) = (table.file(), table.names(), table.again());
        let case_trial = CaseTrial {
            league: table.league,
            base: (table.base)(),
            names: CaseNames::new(names.iter().copied()),
            settings: RetrievalSettings::default(),
            trials: table.trials,
            seed: 1,
        };
        for authored in (0..names.len()).step_by(table.repeats) {
            let case = case_trial.case(authored).expect("a stored case for every authored one");
            for opponents in Opposition::ALL {
                let attempts = case_trial.play(&case, opponents, &|| ()).expect("the simulator runs");
                let score = Score::of(names[authored].to_owned(), opponents.label(), &attempts);
                let rows = markdown(&[score]);
                let row = rows.lines().last().unwrap_or_default();
                assert!(file.contains(row), "the file has no row {row}; {again}");
            }
        }
    }
}

#[test]
fn a_case_completed_in_less_than_60_percent_explains_it_in_its_file() {
    let four_legged = &TABLES[0];
    let file = four_legged.file();
    let league = case_library::league(four_legged.league.name()).expect("built in");
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
