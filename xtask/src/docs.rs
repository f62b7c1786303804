//! `docs`: `cargo xtask docs`: measures, plays and draws what the documentation shows, and notes in each page
//! the commit that made its figures.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::context::{Context, Failure, output_of, run};
use crate::{bench, budgets, evaluation, example_cost, page, pictures};

/// Figures that one program makes, and the pages that show them.
struct Figures {
    name: &'static str,
    /// What is shown, and how long it takes where that is more than a few minutes.
    what: &'static str,
    pages: &'static [&'static str],
    make: fn(&Context) -> Result<(), Failure>,
}

/// Makes the named figures, or all of them in the order of the table; `--list` names them.
pub(crate) fn make(context: &Context, arguments: &[String]) -> Result<(), Failure> {
    let chosen = chosen(arguments).map_err(Failure::Documentation)?;
    if chosen.is_empty() {
        for figures in &ALL {
            println!("{:<12} {} ({})", figures.name, figures.what, figures.pages.join(", "));
        }
        return Ok(());
    }
    let commit = commit(context)?;
    for figures in chosen {
        (figures.make)(context)?;
        for page in figures.pages {
            stamp(&context.root().join(page), figures.name, &commit)?;
        }
    }
    Ok(())
}

/// The figures that the arguments name; none where they ask for the list.
fn chosen(arguments: &[String]) -> Result<Vec<&'static Figures>, String> {
    let mut chosen = Vec::new();
    let mut arguments = arguments.iter().map(String::as_str);
    while let Some(argument) = arguments.next() {
        match argument {
            "--list" => return Ok(Vec::new()),
            "--only" => {
                let name = arguments.next().ok_or("--only needs the name of figures")?;
                let figures = ALL.iter().find(|figures| figures.name == name);
                chosen.push(
                    figures.ok_or_else(|| {
                        format!("no figures `{name}`; `cargo xtask docs --list` has them all")
                    })?,
                );
            }
            other => {
                return Err(format!("unknown argument `{other}`; `docs` takes [--only NAME]... [--list]"));
            }
        }
    }
    Ok(if chosen.is_empty() { ALL.iter().collect() } else { chosen })
}

/// The commit that figures are made of. Sources that were changed since would not be told by its name.
fn commit(context: &Context) -> Result<String, Failure> {
    let status = "status --porcelain --untracked-files=no -- *.rs *.toml *.js *.lock";
    let changed = git(context, status)?;
    if !changed.is_empty() {
        return Err(Failure::Documentation(format!(
            "figures name the commit that made them: commit first\n{changed}"
        )));
    }
    git(context, "rev-parse --short=8 HEAD")
}

fn git(context: &Context, arguments: &str) -> Result<String, Failure> {
    let mut command = Command::new("git");
    let printed = output_of(command.current_dir(context.root()).args(arguments.split(' ')))?;
    Ok(printed.trim().to_owned())
}

/// Notes the commit in a page: in place of an earlier one, or at the end.
fn stamp(page: &Path, name: &str, commit: &str) -> Result<(), Failure> {
    let text = fs::read_to_string(page).map_err(|error| Failure::at(page, error))?;
    fs::write(page, stamped(&text, name, commit)).map_err(|error| Failure::at(page, error))
}

fn stamped(text: &str, name: &str, commit: &str) -> String {
    let begin = stamp_begin(name);
    let line = format!("{begin}{commit}.");
    match text.lines().find(|line| line.starts_with(&begin)) {
        Some(known) => text.replacen(known, &line, 1),
        None => format!("{}\n\n{line}\n", text.trim_end()),
    }
}

fn stamp_begin(name: &str) -> String {
    format!("Figures by `cargo xtask docs --only {name}`, commit ")
}

fn onetwo(context: &Context, arguments: &str) -> Result<(), Failure> {
    run(&mut context.cargo(&format!("run --release -- {arguments}")))
}

const fn figures(
    name: &'static str,
    what: &'static str,
    pages: &'static [&'static str],
    make: fn(&Context) -> Result<(), Failure>,
) -> Figures {
    Figures { name, what, pages, make }
}

const ALL: [Figures; 13] = [
    figures("budgets", "cost of simulator, trials, strategy and host", &["docs/budgets.md"], budgets::write),
    figures("firmware", "size, stack and steps of the images", &["docs/firmware.md"], |context| {
        onetwo(context, "firmware report --write")
    }),
    figures("retrieval", "cost of a retrieval", &["casebase/README.md"], |context| {
        bench::start(context, "retrieval", &[WRITE.into()])
    }),
    figures("motion", "cost of planned motion", &["firmware/motion/README.md"], |context| {
        bench::start(context, "motion", &[WRITE.into()])
    }),
    figures("radio", "cost of radio frames", &["protocol/README.md"], |context| {
        bench::start(context, "radio", &[WRITE.into()])
    }),
    figures(
        "simulator",
        "cost of the simulator's parts",
        &["hil-sim/README.md"],
        example_cost::write_simulator,
    ),
    figures("page", "cost of a frame and of viewers", &["host/page/README.md"], |context| {
        page::bench(context, true)
    }),
    figures(
        "pictures",
        "cases, trials and strategy",
        &["casebase/README.md", "docs/strategy.md"],
        pictures::draw,
    ),
    figures("screenshots", "the page in a browser", &["docs/commands.md"], page::pictures),
    figures("faults", "play under loss", &["docs/faults.md"], |context| {
        bench::start_example(context, "faults", &[WRITE.into()])
    }),
    figures("skills", "single skills", &["docs/skills.md"], evaluation::write_skills),
    figures("evaluation", "the paper's trials", &["docs/results/evaluation.md"], evaluation::write),
    figures("matches", "whole matches, 45 minutes of one core", &["docs/results/matches.md"], |context| {
        evaluation::write_matches(context, false)
    }),
];

/// Argument of programs that write their table into a page.
const WRITE: &str = "--write";

#[cfg(test)]
mod tests {
    use super::*;

    fn ask(line: &str) -> Result<Vec<&'static str>, String> {
        let arguments: Vec<_> = line.split_whitespace().map(str::to_owned).collect();
        chosen(&arguments).map(|all| all.into_iter().map(|figures| figures.name).collect())
    }

    #[test]
    fn every_page_with_figures_names_the_commit_that_made_them() {
        let root = firmware_build::workspace_root();
        for figures in &ALL {
            for page in figures.pages {
                let text =
                    fs::read_to_string(root.join(page)).unwrap_or_else(|error| panic!("{page}: {error}"));
                let begin = stamp_begin(figures.name);
                let commit = text.lines().find_map(|line| line.strip_prefix(&begin)?.strip_suffix('.'));
                assert!(
                    commit.is_some_and(
                        |hash| hash.len() >= 8 && hash.bytes().all(|digit| digit.is_ascii_hexdigit())
                    ),
                    "{page} has no line `{begin}…`: make its figures with `cargo xtask docs --only {}`",
                    figures.name
                );
            }
        }
    }

    #[test]
    fn figures_are_chosen_by_name_all_or_listed() {
        assert_eq!(ask("").unwrap().len(), ALL.len());
        assert_eq!(ask("--only radio --only motion").unwrap(), ["radio", "motion"]);
        assert!(ask("--list").unwrap().is_empty());
        assert!(ask("--only nothing").unwrap_err().contains("no figures `nothing`"));
        assert!(ask("--fast").unwrap_err().contains("--fast"));
    }

    #[test]
    fn a_stamp_takes_the_place_of_the_one_before() {
        let first = stamped("# Page\n\n| 1 |\n", "radio", "01234567");
        assert_eq!(
            first,
            "# Page\n\n| 1 |\n\nFigures by `cargo xtask docs --only radio`, commit 01234567.\n"
        );
        assert_eq!(stamped(&first, "radio", "89abcdef"), first.replace("01234567", "89abcdef"));
        assert_eq!(stamped(&first, "motion", "89abcdef").matches("Figures by").count(), 2);
    }
}
