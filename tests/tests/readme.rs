//! `readme`: tests: README's commands, links and crate table are true. Its commands are those that are
//! checked, its links lead somewhere, and its table names every crate.

use match_tests::workspace::{Source, members, root};

#[test]
fn the_two_commands_come_first_and_are_the_ones_we_check() {
    let blocks = shell_blocks(&read("README.md"));
    assert_eq!(
        blocks.first().map(Vec::as_slice),
        Some(["cargo run --release -- play --headless", "cargo xtask test"].map(String::from).as_slice())
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
fn every_chore_in_readme_is_one_that_xtask_knows() {
    let steps = read("xtask/src/steps.rs");
    let knows = |step: &str| steps.contains(&format!("name: \"{step}\""));
    assert!(knows("clippy"), "steps are found by how they are written in xtask/src/steps.rs");
    for command in shell_blocks(&read("README.md")).concat() {
        let Some(chore) = command.strip_prefix("cargo xtask ") else { continue };
        let words: Vec<_> = chore.split_whitespace().collect();
        let known = match words.as_slice() {
            ["test" | "pictures" | "evaluation"] | ["test", "--list"] => true,
            ["test", "--only", step] => knows(step),
            _ => false,
        };
        assert!(known, "README: `{command}` is no chore");
    }
}

#[test]
fn every_other_command_in_readme_runs_the_program() {
    for command in shell_blocks(&read("README.md")).concat() {
        let known =
            ["cargo run --release -- ", "cargo xtask "].iter().any(|start| command.starts_with(start));
        assert!(known, "README: `{command}` is neither the program nor a chore");
    }
}

#[test]
fn every_link_to_a_file_leads_somewhere() {
    let readme = read("README.md");
    let links: Vec<_> = readme.split("](").skip(1).filter_map(|rest| rest.split(')').next()).collect();
    assert!(links.contains(&"LICENSE-MIT"));
    for link in links.into_iter().filter(|link| !link.contains("://") && !link.starts_with('#')) {
        assert!(root().join(link).exists(), "README links {link}, which is not there");
    }
}

#[test]
fn the_table_names_every_crate_and_where_it_lies() {
    let readme = read("README.md");
    for crate_ in members() {
        let row = format!("| `{}` | {} |", crate_.name, crate_.folder);
        assert!(readme.contains(&row), "README's table lacks a row `{row}`");
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
