//! `onetwo robot`: work with the description of a robot, `robot.toml`. Check it, show it with what follows
//! from it, fit it to measurements (docs/robots.md); and show the checks of a robot's first start. Runs on a
//! PC.

mod bring_up;
mod calibrate;
mod derived;
mod fit;
mod measurements;
pub(crate) mod scan;
mod show;

use std::fmt::Write as _;
use std::process::ExitCode;

use clap::{Args, Subcommand};

use crate::Failure;
use crate::output::print_text;
use crate::robot_description::{DescriptionError, read};

/// What to do with a description.
#[derive(Debug, Subcommand)]
pub(crate) enum RobotVerb {
    /// Check descriptions: what is wrong, in which file, line and key, and how to mend it. Exit 1 on errors,
    /// and with --strict on warnings.
    Check(CheckArgs),
    /// Show every value with its unit, and what follows from them: wheels, speeds, times to stop, kicks.
    Show(show::ShowArgs),
    /// Fit pulses, or the wheels' radius or gear, to measurements, and write them into the description.
    Calibrate(calibrate::CalibrateArgs),
    /// Show the checks of a robot's first start as its image bring_up tells them by radio. Exit 1 if one
    /// failed.
    BringUp(bring_up::BringUpArgs),
    /// Measure the power on the radio's channels with a base station, while no host speaks: a table, a plot,
    /// and the quietest channels.
    Scan(scan::ScanArgs),
}

/// Arguments of `robot check`.
#[derive(Debug, Args)]
pub(crate) struct CheckArgs {
    /// Descriptions: files or built-in names.
    #[arg(required = true, value_name = "FILE")]
    files: Vec<String>,
    /// Warnings fail too.
    #[arg(long)]
    strict: bool,
}

pub(crate) fn run(verb: &RobotVerb) -> Result<ExitCode, Failure> {
    match verb {
        RobotVerb::Check(args) => check(args)?,
        RobotVerb::Show(args) => show::run(args)?,
        RobotVerb::Calibrate(args) => calibrate::run(args)?,
        RobotVerb::BringUp(args) => return bring_up::run(args),
        RobotVerb::Scan(args) => scan::run(args)?,
    }
    Ok(ExitCode::SUCCESS)
}

fn check(args: &CheckArgs) -> Result<(), Failure> {
    let (mut text, mut refused) = (String::new(), 0);
    for file in &args.files {
        match read(file) {
            Ok((_, description)) => {
                for finding in description.warnings() {
                    let _ = writeln!(text, "{finding}");
                }
                refused += usize::from(args.strict && !description.warnings().is_empty());
                let count = description.entries().count();
                let _ = writeln!(text, "{file}: robot {}, {count} values", description.name());
            }
            Err(DescriptionError::Faulty(findings)) => {
                for finding in findings {
                    let _ = writeln!(text, "{finding}");
                }
                refused += 1;
            }
            Err(other) => return Err(other.into()),
        }
    }
    print_text(&text)?;
    if refused > 0 { Err(DescriptionError::Refused(refused).into()) } else { Ok(()) }
}
