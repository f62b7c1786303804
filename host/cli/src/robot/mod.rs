//! `onetwo robot`: work with the description of a robot, `robot.toml`. Check it, show it with what follows
//! from it, fit it to measurements (docs/robots.md); and show the checks of a robot's first start. Runs on a
//! PC.

mod bring_up;
mod calibrate;
mod derived;
mod fit;
mod show;

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Args, Subcommand};
use robots::{Chosen, Description};
use rules::RobotSpec;

use crate::Failure;
use crate::failure::DescriptionError;
use crate::output::{note, print_text};

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

/// Runs the verb.
pub(crate) fn run(verb: &RobotVerb) -> Result<ExitCode, Failure> {
    match verb {
        RobotVerb::Check(args) => check(args)?,
        RobotVerb::Show(args) => show::run(args)?,
        RobotVerb::Calibrate(args) => calibrate::run(args)?,
        RobotVerb::BringUp(args) => return bring_up::run(args),
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

/// A description by its name or file; relative paths start at the working directory.
fn read(asked: &str) -> Result<(Chosen, Description), DescriptionError> {
    let chosen = robots::chosen(asked, Path::new("")).map_err(DescriptionError::Unreadable)?;
    let description = Description::read(&chosen.source, &chosen.text).map_err(DescriptionError::Faulty)?;
    Ok((chosen, description))
}

/// The description that this program is built for.
fn own() -> Result<Description, DescriptionError> {
    Description::read(RobotSpec::SOURCE, RobotSpec::TEXT).map_err(DescriptionError::Faulty)
}

/// Refuses a description that is not the one that this program is built for: brains and host compute with
/// constants.
pub(crate) fn ensure_built_for(asked: Option<&str>) -> Result<(), DescriptionError> {
    let Some(asked) = asked else { return Ok(()) };
    let (_, description) = read(asked)?;
    for finding in description.warnings() {
        note!("{finding}");
    }
    let keys = own()?.differences(&description);
    if keys.is_empty() {
        return Ok(());
    }
    Err(DescriptionError::OtherRobot { asked: asked.to_owned(), built_for: RobotSpec::OURS.name, keys })
}

/// What a build for another robot is given: the value of the environment variable, and the robot's name. The
/// description is checked first.
pub(crate) fn to_build(asked: &str) -> Result<(String, String), Failure> {
    let (chosen, description) = read(asked)?;
    for finding in description.warnings() {
        note!("{finding}");
    }
    let source = match chosen.file {
        None => chosen.source,
        Some(file) => absolute(&file)?.to_string_lossy().into_owned(),
    };
    Ok((source, description.name().to_owned()))
}

fn absolute(file: &Path) -> Result<PathBuf, DescriptionError> {
    std::path::absolute(file).map_err(|error| DescriptionError::Write(file.to_owned(), error))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_program_refuses_another_robot_and_says_how_to_build_for_it() {
        assert!(ensure_built_for(None).is_ok());
        assert!(ensure_built_for(Some(RobotSpec::OURS.name)).is_ok());
        let other = if RobotSpec::OURS.name == "school" { "wide" } else { "school" };
        let error = ensure_built_for(Some(other)).unwrap_err().to_string();
        for part in [RobotSpec::OURS.name, "body.radius", &format!("ONETWO_ROBOT={other} cargo run")] {
            assert!(error.contains(part), "{error}");
        }
        assert!(ensure_built_for(Some("no-such.toml")).unwrap_err().to_string().contains("cannot be read"));
    }

    #[test]
    fn the_constants_are_those_of_the_description_s_text() {
        let (own, spec) = (own().unwrap(), RobotSpec::OURS);
        assert_eq!(own.name(), spec.name);
        for (path, value) in [
            ("body.front", spec.hull.front),
            ("plan.braking", spec.plan.braking),
            ("turn_placing.rate", spec.turn_placing.rate),
            ("assumed.role.speed", spec.assumed.role.speed),
            ("kicker.full_volts", spec.kicker.full_volts),
            ("wheels.rim_max", spec.wheels.rim_max),
            ("motors.integral", spec.wheels.integral),
            ("break_beam.seen", spec.break_beam.seen),
            ("hardware.pull", spec.hardware.pull),
            ("body.mass", spec.hardware.mass),
        ] {
            assert_eq!(own.number(path), value, "{path}");
        }
        assert_eq!(own.pulses("kicker.chip_pulses"), spec.kicker.chip_pulses);
        assert_eq!(own.wheel_angles(), spec.wheels.degrees);
    }
}
