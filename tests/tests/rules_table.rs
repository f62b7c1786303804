//! `rules_table`: tests: `docs/rules.md` agrees with the repository: one row for every rule, and every `file:
//! item` it names exists.

use match_tests::workspace::root;

/// The rules that need a row, by the start of its first column.
const RULES: [&str; 35] = [
    "field",
    "surface",
    "margin",
    "defence area",
    "goal inside",
    "penalty mark",
    "centre circle",
    "robots of a team",
    "robot",
    "numbers of robots",
    "ball",
    "ball covered",
    "ball speed",
    "dribbling",
    "STOP",
    "HALT",
    "free kick",
    "free-kick spot",
    "attackers",
    "defenders",
    "attacker",
    "keeper holds",
    "no progress",
    "kick-off",
    "penalty",
    "ball placement",
    "no placement needed",
    "over a touch line",
    "goal kick",
    "goal counts",
    "crash",
    "cards",
    "substitution",
    "halves",
    "autonomy",
];

/// The cells of the table's rows, without its head.
fn rows() -> Vec<Vec<String>> {
    let text = std::fs::read_to_string(root().join("docs/rules.md")).expect("docs/rules.md");
    let table = text.lines().filter(|line| line.starts_with('|')).skip(2);
    let cells = |line: &str| line.trim_matches('|').split(" | ").map(|cell| cell.trim().to_owned()).collect();
    table.take_while(|line| line.matches(" | ").count() == 5).map(cells).collect()
}

/// The names in backquotes that point into the repository: file and item.
fn pointers(cell: &str) -> Vec<(String, String)> {
    let quoted = cell.split('`').skip(1).step_by(2);
    quoted.filter_map(|name| name.split_once(": ")).map(|(file, item)| (file.into(), item.into())).collect()
}

#[test]
fn every_rule_has_one_row_with_every_cell_filled() {
    let rows = rows();
    for (row, rule) in rows.iter().zip(RULES) {
        assert!(row[0].starts_with(rule), "the rule at the place of {rule} is {}", row[0]);
    }
    assert_eq!(rows.len(), RULES.len(), "a row without a rule in this test, or a rule without a row");
    for row in &rows {
        assert_eq!(row.len(), 6, "{row:?}");
        assert!(row.iter().all(|cell| !cell.is_empty() && !cell.starts_with('@')), "an empty cell: {row:?}");
    }
}

#[test]
fn every_file_and_test_named_in_the_rules_table_exists() {
    for row in rows() {
        assert!(!pointers(&row[4]).is_empty(), "{}: no test is named", row[0]);
        for (file, item) in pointers(&row[3]).into_iter().chain(pointers(&row[4])) {
            let text = std::fs::read_to_string(root().join(&file));
            let text = text.unwrap_or_else(|error| panic!("docs/rules.md, {}: {file}: {error}", row[0]));
            let wanted = ["fn ", "const ", "struct ", "enum "].map(|kind| format!("{kind}{item}"));
            let found = wanted.iter().any(|wanted| text.contains(wanted))
                || text.contains(&format!("pub {item}: "))
                || text.contains(&format!("    {item},"));
            assert!(found, "docs/rules.md, {}: {file} has no {item}", row[0]);
        }
        for (file, item) in pointers(&row[4]) {
            let text = std::fs::read_to_string(root().join(&file)).expect("read above");
            assert!(
                text.contains(&format!("#[test]\nfn {item}("))
                    || text.contains(&format!("#[test]\n    fn {item}(")),
                "docs/rules.md, {}: {item} of {file} is no test",
                row[0]
            );
        }
    }
}
