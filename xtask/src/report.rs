//! `report`: summary of a run: results, times, and how to repeat a failure.

use std::fmt::Write as _;
use std::time::{Duration, Instant};

use crate::context::{Context, Failure};
use crate::steps::Step;

/// How one step ended.
pub(crate) struct Outcome {
    name: &'static str,
    took: Duration,
    pub(crate) failure: Option<Failure>,
}

pub(crate) fn run(step: &Step, context: &Context) -> Outcome {
    println!("\nxtask: == {}: {}", step.name, step.what);
    let started = Instant::now();
    let failure = (step.run)(context).err();
    if let Some(failure) = &failure {
        println!("xtask: {} failed: {failure}", step.name);
    }
    Outcome { name: step.name, took: started.elapsed(), failure }
}

/// Times of all steps, then the failures, one paragraph each.
pub(crate) fn summary(outcomes: &[Outcome]) -> String {
    let mut text = String::new();
    for Outcome { name, took, failure } in outcomes {
        let (minutes, seconds) = (took.as_secs() / 60, took.as_secs() % 60);
        let verdict = if failure.is_none() { "passed" } else { "FAILED" };
        // Writing to a String cannot fail.
        let _ = write!(text, "\nxtask: {name:<16} {minutes:>3} min {seconds:>2} s  {verdict}");
    }
    let failed: Vec<_> =
        outcomes.iter().filter_map(|outcome| Some((outcome.name, outcome.failure.as_ref()?))).collect();
    if failed.is_empty() {
        let _ = write!(text, "\nxtask: passed, {} of {0}", outcomes.len());
    }
    for (name, failure) in failed {
        let _ =
            write!(text, "\nxtask: FAILED {name}, again with `cargo xtask test --only {name}`: {failure}");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outcome(name: &'static str, failure: Option<Failure>) -> Outcome {
        Outcome { name, took: Duration::from_secs(83), failure }
    }

    #[test]
    fn failures_come_last_each_with_its_repetition() {
        let text = summary(&[outcome("clippy", Some(Failure::Component("clippy"))), outcome("doc", None)]);
        let last = text.lines().last().unwrap();
        assert!(
            last.starts_with("xtask: FAILED clippy, again with `cargo xtask test --only clippy`: "),
            "{text}"
        );
        assert!(text.contains("doc                1 min 23 s  passed"), "{text}");
        assert!(!text.contains("passed, "), "{text}");
    }

    #[test]
    fn without_a_failure_it_says_so() {
        assert!(summary(&[outcome("doc", None)]).ends_with("xtask: passed, 1 of 1"));
    }
}
