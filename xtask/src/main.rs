//! What does a person type to have everything checked? `cargo xtask test`, on a laptop and in CI alike.
//!
//! It installs what is missing or says what to install, runs every step whatever failed before, and tells all
//! failures last, each with the command that repeats it.

mod bench;
mod context;
mod determinism;
mod evaluation;
mod images;
mod page;
mod pictures;
mod readme;
mod report;
mod simulator_cost;
mod steps;
mod strategy_cost;
mod trial_cost;

use std::env;
use std::process::ExitCode;

use context::Context;
use steps::{STEPS, Step};

fn main() -> ExitCode {
    let words: Vec<String> = env::args().skip(1).collect();
    match Request::from_words(&words) {
        Ok(Request::Test(steps)) => test(&steps),
        Ok(Request::List) => {
            for step in &STEPS {
                println!("{:<16} {}", step.name, step.what);
            }
            ExitCode::SUCCESS
        }
        Ok(Request::TrialCost) => told(trial_cost::run_bench(&Context::new())),
        Ok(Request::StrategyCost) => told(strategy_cost::run_bench(&Context::new())),
        Ok(Request::SimulatorCost { write }) => told(simulator_cost::run_bench(&Context::new(), write)),
        Ok(Request::Bench(name, words)) => told(bench::start(&Context::new(), name, &words)),
        Ok(Request::Screenshots) => told(page::pictures(&Context::new())),
        Ok(Request::PageCost) => told(page::bench(&Context::new())),
        Ok(Request::Pictures) => told(pictures::draw(&Context::new())),
        Ok(Request::Faults(name, words)) => told(bench::start_example(&Context::new(), name, &words)),
        Ok(Request::Evaluation) => told(evaluation::write(&Context::new())),
        Ok(Request::Help) => {
            println!("{USAGE}");
            ExitCode::SUCCESS
        }
        Err(wrong) => {
            eprintln!("xtask: {wrong}\n{USAGE}");
            ExitCode::from(2)
        }
    }
}

/// A chore's end, said on stderr where it failed.
fn told(end: Result<(), context::Failure>) -> ExitCode {
    match end {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("xtask: {failure}");
            ExitCode::FAILURE
        }
    }
}

fn test(steps: &[&'static Step]) -> ExitCode {
    let context = Context::new();
    let outcomes: Vec<_> = steps.iter().map(|step| report::run(step, &context)).collect();
    println!("{}", report::summary(&outcomes));
    if outcomes.iter().all(|outcome| outcome.failure.is_none()) {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}

/// What was asked for.
#[derive(Debug)]
enum Request {
    Test(Vec<&'static Step>),
    List,
    Pictures,
    /// Of the page, in a browser.
    Screenshots,
    /// What a frame costs the page's script, and viewers the match.
    PageCost,
    Evaluation,
    /// What a simulated second costs.
    TrialCost,
    /// What a second of the Small Size simulator costs; the table goes into its README.
    SimulatorCost {
        write: bool,
    },
    /// What strategy's decisions cost.
    StrategyCost,
    /// Retrieval, motion or radio, with these words for the bench.
    Bench(&'static str, Vec<String>),
    /// The swarm, or another of the faults' programs, with these words for it.
    Faults(&'static str, Vec<String>),
    Help,
}

impl Request {
    fn from_words(words: &[String]) -> Result<Self, String> {
        let mut words = words.iter().map(String::as_str);
        match words.next() {
            None | Some("help" | "--help" | "-h") => return Ok(Self::Help),
            Some("test") => {}
            Some("swarm") => return Ok(Self::Faults("swarm", words.map(String::from).collect())),
            Some("faults") => return Ok(Self::Faults("faults", words.map(String::from).collect())),
            Some(verb @ ("pictures" | "screenshots" | "evaluation")) => {
                return match words.next() {
                    None if verb == "evaluation" => Ok(Self::Evaluation),
                    None if verb == "screenshots" => Ok(Self::Screenshots),
                    None => Ok(Self::Pictures),
                    Some(word) => Err(format!("unknown argument `{word}`")),
                };
            }
            Some("bench") => {
                return match words.next() {
                    Some("retrieval") => Ok(Self::Bench("retrieval", words.map(String::from).collect())),
                    Some("radio") => Ok(Self::Bench("radio", words.map(String::from).collect())),
                    Some("motion") => Ok(Self::Bench("motion", words.map(String::from).collect())),
                    Some("hil") => Ok(Self::Faults("hil", words.map(String::from).collect())),
                    Some("trial") => Ok(Self::TrialCost),
                    Some("strategy") => Ok(Self::StrategyCost),
                    Some("page") => Ok(Self::PageCost),
                    Some("simulator") => match words.next() {
                        None => Ok(Self::SimulatorCost { write: false }),
                        Some("--write") => Ok(Self::SimulatorCost { write: true }),
                        Some(word) => Err(format!("unknown argument `{word}`")),
                    },
                    _ => Err("bench needs a name: retrieval, motion, radio, hil, trial, strategy, page or simulator"
                        .into()),
                };
            }
            Some(verb) => return Err(format!("no verb `{verb}`")),
        }
        let mut chosen = Vec::new();
        while let Some(word) = words.next() {
            match word {
                "--list" => return Ok(Self::List),
                "--help" | "-h" => return Ok(Self::Help),
                "--only" => {
                    let name = words.next().ok_or("--only needs the name of a step")?;
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
usage: cargo xtask test [--only STEP]... [--list] | cargo xtask swarm | cargo xtask faults | cargo xtask pictures | cargo xtask screenshots | cargo xtask evaluation | cargo xtask bench NAME
  test           check everything: style, tests, documentation, firmware, QEMU, determinism
    --only STEP  this step alone; may be repeated
    --list       name the steps
  swarm [--seeds N] [--first N] [--jobs J]
                 play N runs (100 if not told) with faults drawn from their seeds, and hold them to what is promised
  faults [--seeds N] [--write]
                 what loss costs a team; --write puts table and picture into docs/faults.md
  pictures       draw the documentation's pictures anew
  screenshots    take the page's pictures anew, in a browser; they lie in docs/page
  evaluation     play the paper's evaluation and write docs/evaluation.md's figures; the report lies in out/evaluation
  bench retrieval [--write | --guest | --verify]
                 count a retrieval's instructions on the robot's processor and here, and hold them to the budgets;
                 --write puts the table into casebase/README.md, --guest leaves this machine out,
                 --verify holds 10^6 answers to a plain scan's instead
  bench motion [--write | --guest | --verify]
                 likewise for planned motions, interception and ways around others; the table is firmware/motion/README.md's,
                 --verify holds 10^6 times to the best of all shares between the axes instead
  bench radio [--write]
                 likewise for radio frames on the robot's processor; the table is protocol/README.md's
  bench hil [--seconds N] [--seed N]
                 play a match with six robots as images under QEMU and with native ones in one run; compare hashes and wall speed
  bench page     measure what a frame costs the page's script, full over empty, and count what five viewers cost a match
  bench trial    count the instructions of a simulated second and hold them to the budget
  bench strategy count the instructions of strategy's decisions and hold them to the budgets
  bench simulator [--write]
                 the same of eleven against eleven on wheels; --write puts the table into hil-sim/README.md";

#[cfg(test)]
mod tests {
    use super::*;

    fn ask(line: &str) -> Result<Request, String> {
        Request::from_words(&line.split_whitespace().map(String::from).collect::<Vec<_>>())
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
    fn what_is_not_understood_is_named() {
        assert!(ask("test --only nothing").unwrap_err().contains("no step `nothing`"));
        assert!(ask("test --only").unwrap_err().contains("needs the name"));
        assert!(ask("test --fast").unwrap_err().contains("--fast"));
        assert!(ask("deploy").unwrap_err().contains("deploy"));
        assert!(matches!(ask(""), Ok(Request::Help)));
        assert!(matches!(ask("test --list"), Ok(Request::List)));
        assert!(matches!(ask("pictures"), Ok(Request::Pictures)));
        assert!(ask("pictures now").is_err());
        assert!(matches!(ask("screenshots"), Ok(Request::Screenshots)));
        assert!(matches!(ask("bench page"), Ok(Request::PageCost)));
        assert!(matches!(ask("evaluation"), Ok(Request::Evaluation)));
        assert!(ask("evaluation soon").is_err());
        assert!(
            matches!(ask("bench retrieval --guest"), Ok(Request::Bench("retrieval", words)) if words == ["--guest"])
        );
        assert!(matches!(ask("bench motion"), Ok(Request::Bench("motion", words)) if words.is_empty()));
        assert!(
            matches!(ask("swarm --seeds 9"), Ok(Request::Faults("swarm", words)) if words == ["--seeds", "9"])
        );
        assert!(matches!(ask("bench trial"), Ok(Request::TrialCost)));
        assert!(matches!(ask("bench strategy"), Ok(Request::StrategyCost)));
        assert!(matches!(ask("bench simulator --write"), Ok(Request::SimulatorCost { write: true })));
        assert!(ask("bench simulator --fast").unwrap_err().contains("--fast"));
        assert!(ask("bench").unwrap_err().contains("retrieval"));
    }
}
