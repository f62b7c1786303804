//! `bench`: what the benches of this crate share: their arguments and exit code.

use std::process::ExitCode;

/// Runs a bench with its arguments; `done` is `None` where they are wrong. Exit code 1 where it fails, 2 for
/// wrong usage.
pub fn run(name: &str, usage: &str, done: impl FnOnce(&[&str]) -> Option<Result<(), String>>) -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    // Cargo's own argument.
    let arguments: Vec<&str> =
        arguments.iter().map(String::as_str).filter(|argument| *argument != "--bench").collect();
    match done(&arguments) {
        None => {
            eprintln!("{usage}");
            ExitCode::from(2)
        }
        Some(Ok(())) => ExitCode::SUCCESS,
        Some(Err(why)) => {
            eprintln!("bench {name}: {why}");
            ExitCode::FAILURE
        }
    }
}
