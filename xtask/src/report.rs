//! `report`: each step as it starts and ends, and the summary of a run: results, times, and how to repeat a
//! failure.

use std::fmt::{self, Write as _};
use std::fs;
use std::time::{Duration, Instant};

use crate::context::{Context, Failure};
use crate::steps::Step;

/// How one step ended.
pub(crate) struct Outcome {
    name: &'static str,
    took: Took,
    pub(crate) failure: Option<Failure>,
}

impl Outcome {
    fn verdict(&self) -> &'static str {
        if self.failure.is_none() { "passed" } else { "FAILED" }
    }
}

#[derive(Clone, Copy)]
struct Took {
    wall: Duration,
    /// Of all processors, by the step's programs that have ended; where the system tells it.
    processor: Option<Duration>,
}

impl fmt::Display for Took {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (minutes, seconds) = (self.wall.as_secs() / 60, self.wall.as_secs() % 60);
        write!(f, "{minutes:>3} min {seconds:>2} s")?;
        match self.processor {
            Some(processor) => write!(f, "  {:>5} s of processor", processor.as_secs()),
            None => Ok(()),
        }
    }
}

/// Runs a step, the `number`-th of so many, and prints how it goes.
pub(crate) fn run(step: &Step, (number, of): (usize, usize), context: &Context) -> Outcome {
    println!("\nxtask: == {number} of {of}: {}: {}", step.name, step.what);
    let (started, before) = (Instant::now(), processor_time());
    let failure = (step.run)(context).err();
    if let Some(failure) = &failure {
        println!("xtask: {} failed: {failure}", step.name);
    }
    let processor = processor_time().zip(before).map(|(after, before)| after.saturating_sub(before));
    let outcome = Outcome { name: step.name, took: Took { wall: started.elapsed(), processor }, failure };
    println!("xtask: == {number} of {of}: {} {} after {}", outcome.name, outcome.verdict(), outcome.took);
    outcome
}

/// Processor time of all programs that this one has started and that have ended, on Linux.
fn processor_time() -> Option<Duration> {
    let ticks = children_ticks(&fs::read_to_string("/proc/self/stat").ok()?)?;
    Some(Duration::from_millis(ticks * 1_000 / TICKS_A_SECOND))
}

/// User and system time of ended children, fields 16 and 17 of proc(5); the program's name before may contain
/// blanks.
fn children_ticks(stat: &str) -> Option<u64> {
    let mut fields = stat.rsplit_once(')')?.1.split_whitespace().skip(13);
    Some(fields.next()?.parse::<u64>().ok()? + fields.next()?.parse::<u64>().ok()?)
}

/// Unit of times in `/proc`, the same on all Linux systems that are in use.
const TICKS_A_SECOND: u64 = 100;

/// Times of all steps, then the failures, one paragraph each.
pub(crate) fn summary(outcomes: &[Outcome]) -> String {
    let mut text = String::new();
    for outcome in outcomes {
        // Writing to a String cannot fail.
        let _ = write!(text, "\nxtask: {:<16} {}  {}", outcome.name, outcome.took, outcome.verdict());
    }
    let wall: Duration = outcomes.iter().map(|outcome| outcome.took.wall).sum();
    let processor = outcomes.iter().map(|outcome| outcome.took.processor).sum();
    let _ = write!(text, "\nxtask: {:<16} {}", "in all", Took { wall, processor });
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
        let took = Took { wall: Duration::from_secs(83), processor: Some(Duration::from_mins(2)) };
        Outcome { name, took, failure }
    }

    #[test]
    fn failures_come_last_each_with_its_repetition() {
        let text = summary(&[outcome("clippy", Some(Failure::Component("clippy"))), outcome("doc", None)]);
        let last = text.lines().last().unwrap();
        assert!(
            last.starts_with("xtask: FAILED clippy, again with `cargo xtask test --only clippy`: "),
            "{text}"
        );
        assert!(text.contains("doc                1 min 23 s    120 s of processor  passed"), "{text}");
        assert!(text.contains("in all             2 min 46 s    240 s of processor"), "{text}");
        assert!(!text.contains("passed, "), "{text}");
    }

    #[test]
    fn times_of_ended_children_are_read_behind_a_name_with_blanks() {
        let stat = "7 (a b) c) S 1 2 3 4 5 6 7 8 9 10 11 12 500 25 20 0";
        assert_eq!(children_ticks(stat), Some(525));
        assert_eq!(children_ticks("7 (a) S 1"), None);
    }

    #[test]
    fn without_a_failure_it_says_so() {
        assert!(summary(&[outcome("doc", None)]).ends_with("xtask: passed, 1 of 1"));
    }
}
