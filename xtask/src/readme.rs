//! `readme`: check of the documented commands: those of README, docs/commands.md and docs/start that run the
//! program are run, in the given order.

use std::path::Path;
use std::{fs, io};

use crate::context::{Context, Failure, run};

/// The property checked by the step.
pub(crate) const WHAT: &str =
    "the commands of README, docs/commands.md and docs/start run, README's first one among them";

/// Runs every `cargo run` of the pages' shell blocks; the xtask commands beside them are this program. What
/// they write is cleared first: results that another commit has left are refused.
pub(crate) fn check(context: &Context) -> Result<(), Failure> {
    let texts = PAGES.map(|page| {
        let file = context.root().join(page);
        fs::read_to_string(&file).map_err(|error| Failure::at(&file, error))
    });
    let texts: Vec<String> = texts.into_iter().collect::<Result<_, _>>()?;
    for result in texts.iter().flat_map(|text| commands(text)).filter_map(result) {
        let place = context.root().join(result);
        clear(&place).map_err(|error| Failure::at(&place, error))?;
    }
    texts.iter().flat_map(|text| commands(text)).try_for_each(|command| run(&mut context.cargo(command)))
}

/// Where a command writes, if that is below `out`.
fn result(command: &str) -> Option<&str> {
    let mut words = command.split_whitespace();
    words.find(|word| *word == "--out")?;
    words.next().filter(|path| {
        path.strip_prefix("out/").is_some_and(|below| !below.is_empty() && !below.contains(".."))
    })
}

/// Removes a file or a directory; none is fine.
fn clear(place: &Path) -> io::Result<()> {
    let removed = if place.is_dir() { fs::remove_dir_all(place) } else { fs::remove_file(place) };
    removed.or_else(|error| if error.kind() == io::ErrorKind::NotFound { Ok(()) } else { Err(error) })
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

    #[test]
    fn what_a_command_writes_below_out_is_cleared_and_nothing_else() {
        assert_eq!(result("run -- cases learn --out out/learned --dry-run"), Some("out/learned"));
        for command in [
            "run -- play",
            "run -- x --out /etc",
            "run -- x --out out/",
            "run -- x --out out/../a",
            "run -- x --out",
        ] {
            assert_eq!(result(command), None, "{command}");
        }
        let place = std::env::temp_dir().join(format!("onetwo-readme-{}", std::process::id()));
        fs::create_dir_all(place.join("in")).unwrap();
        fs::write(place.join("in/file"), "left").unwrap();
        clear(&place.join("in/file")).unwrap();
        fs::write(place.join("in/file"), "left").unwrap();
        clear(&place).unwrap();
        assert!(!place.exists());
        clear(&place).unwrap();
    }
}
