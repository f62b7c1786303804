//! `readme`: tests: README's commands are those that are run, and the table of crates names every one.

#[path = "start_pages/promises.rs"]
mod promises;

use match_tests::workspace::{Source, members, root};
use promises::{PAGES, all, blocks, command_of, promised};

#[test]
fn the_two_commands_come_first_and_are_the_ones_we_check() {
    let blocks = shell_blocks(&read("README.md"));
    assert_eq!(
        blocks.first().map(Vec::as_slice),
        Some(
            ["cargo run --profile first -- play --headless", "cargo xtask test"].map(String::from).as_slice()
        )
    );
    let script = read(".ci/run");
    let last = script.lines().rev().find(|line| !line.is_empty());
    assert_eq!(
        last,
        Some("exec cargo xtask test \"$@\""),
        ".ci/run calls nothing weaker than README's test command"
    );
    assert!(
        read("xtask/src/steps.rs").contains("run: readme::check"),
        "a step of xtask runs README's commands"
    );
}

#[test]
fn every_command_in_a_shell_block_runs_the_program_or_is_xtasks() {
    let xtask = read("xtask/src/readme.rs");
    let pages: Vec<&str> = list_of_pages(&xtask).collect();
    assert!(pages.len() > 1 && pages[0] == "README.md", "{pages:?}");
    for page in pages {
        for command in shell_blocks(&read(page)).concat() {
            let known = KNOWN.iter().any(|start| command.starts_with(start));
            assert!(known, "{page}: `{command}` is neither the program nor xtask");
        }
    }
}

#[test]
fn every_command_of_a_start_page_has_a_promise_and_every_promise_a_command() {
    let texts = PAGES.map(read);
    let of = |text| [blocks(text, "sh"), blocks(text, "terminals")].concat().concat();
    let lines: Vec<&str> = texts.iter().flat_map(|text| of(text)).collect();
    assert!(lines.len() > 20, "{lines:?}");
    for line in &lines {
        assert!(!promised(line).is_empty(), "nothing is promised of `{line}`");
    }
    for (command, promises) in all() {
        assert!(!promises.is_empty(), "`{command}` is no promise");
        assert!(lines.iter().any(|line| command_of(line) == command), "no start page has `{command}`");
    }
}

#[test]
fn the_table_names_every_crate_and_where_it_lies() {
    let table = read("docs/architecture.md");
    for crate_ in members() {
        let row = format!("| `{}` | {} |", crate_.name, crate_.directory);
        assert!(table.contains(&row), "docs/architecture.md §1.1 lacks a row `{row}`");
    }
}

/// The commands of each ```` ```sh ```` block, one a line.
fn shell_blocks(text: &str) -> Vec<Vec<String>> {
    let blocks = text.split("```sh\n").skip(1).filter_map(|rest| rest.split("```").next());
    blocks.map(|block| block.lines().map(String::from).collect()).collect()
}

fn read(path: &str) -> String {
    Source::read(&root().join(path)).text
}

/// The pages whose shell blocks `cargo xtask test --only readme` runs, from its source.
fn list_of_pages(xtask: &str) -> impl Iterator<Item = &str> {
    let list = xtask.split("const PAGES").nth(1).and_then(|rest| rest.split("];").next()).unwrap_or_default();
    list.split('"').skip(1).step_by(2)
}

/// Starts of the commands that pages may show.
const KNOWN: [&str; 3] = ["cargo run --profile first -- ", "cargo run --release -- ", "cargo xtask "];
