//! `readme`: check of the documented commands: those of README, docs/commands.md and docs/start that run the
//! program are run, in the given order.

use std::fs;

use crate::context::{Context, Failure, run};

/// The property checked by the step.
pub(crate) const WHAT: &str =
    "the commands of README, docs/commands.md and docs/start run, README's first one among them";

/// Runs every `cargo run` of the pages' shell blocks; the xtask commands beside them are this program.
pub(crate) fn check(context: &Context) -> Result<(), Failure> {
    for page in PAGES {
        let file = context.root().join(page);
        let text = fs::read_to_string(&file)
            .map_err(|error| Failure::Start { line: file.display().to_string(), error })?;
        for command in commands(&text) {
            run(&mut context.cargo(command))?;
        }
    }
    Ok(())
}

/// Pages whose commands are run; tests/tests/readme.rs reads this list.
const PAGES: [&str; 5] = [
    "README.md",
    "docs/commands.md",
    "docs/start/league-team.md",
    "docs/start/cbr-researcher.md",
    "docs/start/embedded.md",
];

/// The arguments after `cargo ` of the lines in README's shell blocks that run the program.
fn commands(readme: &str) -> Vec<&str> {
    let shell = readme.split("```").filter_map(|block| block.strip_prefix("sh\n"));
    shell
        .flat_map(str::lines)
        .filter_map(|line| line.strip_prefix("cargo "))
        .filter(|command| command.starts_with("run "))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn programs_are_run_and_tasks_are_not() {
        let readme = "text `cargo run x`\n```sh\ncargo run --release -- play\ncargo xtask test\n```\n```text\ncargo run no\n```\n";
        assert_eq!(commands(readme), ["run --release -- play"]);
    }
}
