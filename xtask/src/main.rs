//! `xtask`: entry point of `cargo xtask`. `cargo xtask test`, on a laptop and in CI alike.
//!
//! It installs missing tools or prints how to install them, runs every step even after failures, and reports
//! all failures last, each with the command that repeats it.
#![forbid(unsafe_code)]

mod bench;
mod budgets;
mod context;
mod cost;
mod deny;
mod determinism;
mod docs;
mod emulate;
mod evaluation;
mod example_cost;
mod first_build;
mod game_cost;
mod images;
mod page;
mod pictures;
mod python;
mod readme;
mod release;
mod report;
mod robots;
mod space;
mod steps;
mod tasks;
mod trial_cost;
mod wheels;

use std::env;
use std::process::ExitCode;

use context::Context;
use steps::{STEPS, Step};
use tasks::Task;

fn main() -> ExitCode {
    let arguments: Vec<String> = env::args().skip(1).collect();
    match Request::from_arguments(&arguments) {
        Ok(Request::Test(steps)) => test(&steps),
        Ok(Request::List) => {
            for step in &STEPS {
                println!("{:<16} {}", step.name, step.what);
            }
            ExitCode::SUCCESS
        }
        Ok(Request::Task(task, arguments)) => match (task.run)(&Context::new(), &arguments) {
            Ok(()) => ExitCode::SUCCESS,
            Err(failure) => {
                eprintln!("xtask: {failure}");
                ExitCode::FAILURE
            }
        },
        Ok(Request::Help) => {
            println!("{USAGE}{}", tasks::usage());
            ExitCode::SUCCESS
        }
        Err(wrong) => {
            eprintln!("xtask: {wrong}\n{USAGE}{}", tasks::usage());
            ExitCode::from(2)
        }
    }
}

fn test(steps: &[&'static Step]) -> ExitCode {
    let context = Context::new();
    if let Some(warning) = space::warning(context.root()) {
        eprintln!("xtask: {warning}");
    }
    let numbered = (1..).zip(steps);
    let outcomes: Vec<_> =
        numbered.map(|(number, step)| report::run(step, (number, steps.len()), &context)).collect();
    println!("{}", report::summary(&outcomes));
    if outcomes.iter().all(|outcome| outcome.failure.is_none()) {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}

/// The parsed command line.
#[derive(Debug)]
enum Request {
    Test(Vec<&'static Step>),
    List,
    /// A command with its own arguments.
    Task(&'static Task, Vec<String>),
    Help,
}

impl Request {
    fn from_arguments(arguments: &[String]) -> Result<Self, String> {
        match arguments.first().map(String::as_str) {
            None | Some("help" | "--help" | "-h") => return Ok(Self::Help),
            Some("test") => {}
            Some(_) => {
                return Task::asked(arguments).map(|(task, arguments)| Self::Task(task, arguments));
            }
        }
        let mut chosen = Vec::new();
        let mut arguments = arguments[1..].iter().map(String::as_str);
        while let Some(label) = arguments.next() {
            match label {
                "--list" => return Ok(Self::List),
                "--help" | "-h" => return Ok(Self::Help),
                "--only" => {
                    let name = arguments.next().ok_or("--only needs the name of a step")?;
                    let step = STEPS.iter().find(|step| step.name == name);
                    chosen.push(step.ok_or_else(|| {
                        format!("no step `{name}`; `cargo xtask test --list` has them all")
                    })?);
                }
                other => return Err(format!("unknown argument `{other}`")),
            }
        }
        Ok(Self::Test(if chosen.is_empty() { STEPS.iter().collect() } else { chosen }))
    }
}

const USAGE: &str = "\
usage: cargo xtask test [--only STEP]... [--list], or one of the chores below
  test           check everything: style, tests, documentation, firmware, QEMU, the page, determinism
    --only STEP  this step alone; may be repeated
    --list       name the steps
";

#[cfg(test)]
mod tests {
    use super::*;

    fn ask(line: &str) -> Result<Request, String> {
        Request::from_arguments(&line.split_whitespace().map(String::from).collect::<Vec<_>>())
    }

    /// The command that a line names, and its arguments.
    fn task(line: &str) -> Option<(&'static str, Vec<String>)> {
        match ask(line) {
            Ok(Request::Task(task, arguments)) => Some((task.name, arguments)),
            _ => None,
        }
    }

    #[test]
    fn test_alone_means_every_step_in_order() {
        let Ok(Request::Test(steps)) = ask("test") else { panic!("not understood") };
        let names: Vec<_> = steps.iter().map(|step| step.name).collect();
        assert_eq!(names, STEPS.iter().map(|step| step.name).collect::<Vec<_>>());
    }

    #[test]
    fn chosen_steps_run_in_the_order_they_were_named() {
        let Ok(Request::Test(steps)) = ask("test --only doc --only fmt") else { panic!("not understood") };
        assert_eq!(steps.iter().map(|step| step.name).collect::<Vec<_>>(), ["doc", "fmt"]);
    }

    #[test]
    fn tasks_are_found_by_all_their_words_and_get_the_rest() {
        let arguments =
            |list: &[&str]| list.iter().map(|argument| (*argument).to_owned()).collect::<Vec<_>>();
        assert_eq!(task("pictures"), Some(("pictures", arguments(&[]))));
        assert_eq!(task("budgets"), Some(("budgets", arguments(&[]))));
        assert_eq!(task("bench game"), Some(("bench game", arguments(&[]))));
        assert_eq!(task("bench simulator --write"), Some(("bench simulator", arguments(&["--write"]))));
        assert_eq!(task("bench retrieval --guest"), Some(("bench retrieval", arguments(&["--guest"]))));
        assert_eq!(task("swarm --seeds 9"), Some(("swarm", arguments(&["--seeds", "9"]))));
        assert!(tasks::usage().contains("bench hil [--seconds N]"));
    }

    #[test]
    fn what_is_not_understood_is_named() {
        assert!(ask("test --only nothing").unwrap_err().contains("no step `nothing`"));
        assert!(ask("test --only").unwrap_err().contains("needs the name"));
        assert!(ask("test --fast").unwrap_err().contains("--fast"));
        assert!(ask("deploy").unwrap_err().contains("deploy"));
        assert!(matches!(ask(""), Ok(Request::Help)));
        assert!(matches!(ask("test --list"), Ok(Request::List)));
        assert!(ask("pictures now").unwrap_err().contains("takes none"));
        assert!(ask("bench simulator --fast").unwrap_err().contains("takes [--write]"));
        assert!(ask("bench").unwrap_err().contains("retrieval, motion"));
    }
}
