//! `size`: tests: no crate has more product lines than `tests/tests/tidy/product_lines.txt` records for it,
//! plus a tenth.

use std::collections::BTreeMap;
use std::{env, fs};

use match_tests::workspace::{Source, product_lines, root, rust_sources};

#[test]
fn no_crate_grows_by_more_than_a_tenth_of_its_recorded_lines() {
    let counted = product_lines(&rust_sources());
    assert!(counted.len() > 30, "{} crates", counted.len());
    let file = root().join(TABLE);
    if env::var_os(RECORDS).is_some() {
        fs::write(&file, text(&counted)).expect("the table is written");
    }
    let faults = faults(&counted, &recorded(&Source::read(&file).text));
    assert!(faults.is_empty(), "\n{}\n{HINT}", faults.join("\n"));
}

#[test]
fn a_crate_that_grows_comes_or_goes_is_a_fault() {
    let lines = |list: &[(&str, usize)]| list.iter().map(|(name, n)| ((*name).to_owned(), *n)).collect();
    let known: BTreeMap<String, usize> = lines(&[("a", 100), ("b", 7)]);
    assert_eq!(recorded(&text(&known)), known);
    assert!(faults(&lines(&[("a", 110), ("b", 0)]), &known).is_empty());
    assert_eq!(faults(&lines(&[("a", 111), ("b", 7)]), &known).len(), 1);
    assert_eq!(faults(&lines(&[("a", 1), ("c", 1)]), &known).len(), 2);
}

fn faults(counted: &BTreeMap<String, usize>, recorded: &BTreeMap<String, usize>) -> Vec<String> {
    let mut faults = Vec::new();
    for (name, lines) in counted {
        match recorded.get(name) {
            None => faults.push(format!("{name}: {lines} product lines, none recorded")),
            Some(known) if *lines > known + known / 10 => {
                faults.push(format!("{name}: {lines} product lines, {known} recorded"));
            }
            Some(_) => {}
        }
    }
    let gone = recorded.keys().filter(|name| !counted.contains_key(*name));
    faults.extend(gone.map(|name| format!("{name}: recorded, and not there")));
    faults
}

/// One crate a line: its directory and its number of lines.
fn text(counted: &BTreeMap<String, usize>) -> String {
    let lines = counted.iter().map(|(name, lines)| format!("{name} {lines}\n"));
    format!("{TABLE_HEAD}{}", lines.collect::<String>())
}

fn recorded(text: &str) -> BTreeMap<String, usize> {
    let rows = text.lines().filter(|line| !line.starts_with('#'));
    let row = |line: &str| {
        let (name, lines) = line.split_once(' ')?;
        Some((name.to_owned(), lines.parse().ok()?))
    };
    rows.map(|line| row(line).unwrap_or_else(|| panic!("{TABLE}: `{line}`"))).collect()
}

const TABLE: &str = "tests/tests/tidy/product_lines.txt";
const TABLE_HEAD: &str =
    "# Product lines by crate: neither tests, examples nor benches. Written by `cargo xtask lines`.\n";
/// Environment variable by which `cargo xtask lines` asks for the table to be written.
const RECORDS: &str = "ONETWO_RECORD_LINES";
const HINT: &str = "take something out, or record the lines again with `cargo xtask lines` and say in the commit what they \
                    are for";
