//! `readme`: check of the documented commands: those of README and docs/commands.md that run the program are
//! run, in the given order; those of the start pages by the test `start_pages`, which knows what the pages
//! promise.

use std::path::Path;
use std::{fs, io};

use crate::context::{Context, Failure, run};

/// The property checked by the step.
pub(crate) const WHAT: &str =
    "the commands of README and docs/commands.md run, and those of docs/start do what the pages say";

/// Runs every `cargo run` of the pages' shell blocks; the xtask commands beside them are this program. What
/// they write is cleared first: results that another commit has left are refused. A command that a start page
/// has too is run there alone.
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
    let (first, start) = texts.split_at(PAGES.len() - START_PAGES);
    let started: Vec<_> = start.iter().flat_map(|text| commands(text)).collect();
    let mut others =
        first.iter().flat_map(|text| commands(text)).filter(|command| !started.contains(command));
    others.try_for_each(|command| run(&mut context.cargo(command)))?;
    let line = "test --workspace --features onetwo/png --test start_pages";
    run(&mut context.cargo(line))
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

/// Number of start pages, the last of [`PAGES`].
const START_PAGES: usize = 3;
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
