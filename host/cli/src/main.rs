//! `onetwo`: entry point of `onetwo`. Reads the command line, passes it to the verb's file, and turns the
//! verb's result into an exit code: 0 done, 1 the command failed, 2 wrong usage (docs/case-format.md §5).
//!
//! One file per verb. A verb takes its arguments and returns an [`ExitCode`] or a [`Failure`] with what went
//! wrong and how to fix it; data goes to stdout, messages to stderr. Runs on a PC.
#![forbid(unsafe_code)]

mod args;
mod cases;
mod control;
mod destination;
mod evaluate;
mod failure;
mod firmware;
mod launch;
mod library;
#[cfg(feature = "manuals")]
mod manuals;
mod output;
mod picture;
mod play;
mod progress;
mod remote;
mod replay;
mod robot;
mod robot_description;
mod setup;
mod simulate;
mod stop;
mod trial;
mod verbs;
mod virtual_robot;

use std::process::ExitCode;

use clap::Parser;

use failure::Failure;
use verbs::{Cli, Verb};

fn main() -> ExitCode {
    let Cli { color, verb } = Cli::parse();
    color.apply();
    let outcome = match verb {
        Verb::Play(args) => play::run(&args),
        Verb::Trial(args) => trial::run(&args),
        Verb::Evaluate(args) => evaluate::run(&args),
        Verb::Remote(args) => remote::run(&args),
        Verb::Replay(args) => replay::run(&args),
        Verb::Simulate(args) => simulate::run(&args),
        Verb::Launch(args) => launch::run(&args),
        Verb::Control(args) => control::run(&args),
        Verb::Cases { verb } => cases::run(&verb),
        Verb::Firmware { verb } => firmware::run(&verb),
        Verb::Robot { verb } => robot::run(&verb),
        Verb::VirtualRobot(args) => virtual_robot::run(&args),
        #[cfg(feature = "manuals")]
        Verb::Manuals(args) => manuals::run(&args, <Cli as clap::CommandFactory>::command()),
    };
    match outcome {
        Ok(code) => code,
        Err(failure) if failure.is_closed_stdout() => ExitCode::SUCCESS,
        Err(failure) => {
            output::print_error(&failure);
            ExitCode::FAILURE
        }
    }
}
