//! `robot_description`: the description of a robot, `robot.toml`, that a command line names: read, checked,
//! and compared with the one that this program is built for (docs/robots.md).

use std::io;
use std::path::{Path, PathBuf};

use foreign::{excerpt, printable_path};
use robots::{Chosen, Description, Finding, Unreadable, VARIABLE};
use rules::{BatterySpec, DribblerSpec, HardwareSpec, HullSpec, KickerSpec, RobotSpec, WheelSpec};
use thiserror::Error;

use crate::output::note;

/// Why a description cannot be used.
#[derive(Debug, Error)]
pub(crate) enum DescriptionError {
    #[error("{0}")]
    Unreadable(Unreadable),
    #[error("{}", lines(.0))]
    Faulty(Vec<Finding>),
    /// This many files or more were refused; their findings are printed already.
    #[error("{}", refused(*.0))]
    Refused(usize),
    #[error(
        "this program is built for the robot {built_for}; {} differs in {} keys ({}). Build it for that robot, in a \
         clone of the project: {VARIABLE}={} cargo run --release -- …",
        excerpt(asked, NAME_LEN),
        keys.len(),
        shown(keys),
        excerpt(asked, NAME_LEN)
    )]
    OtherRobot { asked: String, built_for: &'static str, keys: Vec<&'static str> },
    #[error(
        "{name} comes with the program; keep a copy of it and change that: onetwo robot show {0} --text > FILE",
        name = excerpt(.0, NAME_LEN)
    )]
    BuiltIn(String),
    #[error("{}: {what}", printable_path(file))]
    Measurements { file: PathBuf, what: String },
    #[error("{key} cannot be fitted: {what}")]
    NoFit {
        /// The key that was to be fitted.
        key: &'static str,
        what: String,
    },
    #[error("cannot write {}: {error}", printable_path(.0), error = .1)]
    Write(PathBuf, io::Error),
}

fn lines(findings: &[Finding]) -> String {
    findings.iter().map(Finding::to_string).collect::<Vec<_>>().join("\n")
}

fn refused(descriptions: usize) -> String {
    match descriptions {
        1 => "a description is refused; see its findings".to_owned(),
        count => format!("{count} descriptions are refused; see their findings"),
    }
}

fn shown(keys: &[&str]) -> String {
    let more = if keys.len() > KEYS_SHOWN { ", …" } else { "" };
    keys[..keys.len().min(KEYS_SHOWN)].join(", ") + more
}

/// Keys of a difference that are named.
const KEYS_SHOWN: usize = 4;
/// Longest name of a description that is printed, characters.
const NAME_LEN: usize = 300;

/// A description by its name or file; relative paths start at the working directory.
pub(crate) fn read(asked: &str) -> Result<(Chosen, Description), DescriptionError> {
    let chosen = robots::chosen(asked, Path::new("")).map_err(DescriptionError::Unreadable)?;
    let description = Description::read(&chosen.source, &chosen.text).map_err(DescriptionError::Faulty)?;
    Ok((chosen, description))
}

/// The description that this program is built for.
pub(crate) fn own() -> Result<Description, DescriptionError> {
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

/// The robot of a description, as the simulator takes it; what only brains, hosts and boards compute with
/// stays the reference robot's.
pub(crate) fn simulated(asked: Option<&str>) -> Result<RobotSpec, DescriptionError> {
    let Some(asked) = asked else { return Ok(RobotSpec::OURS) };
    let (_, of) = read(asked)?;
    for finding in of.warnings() {
        note!("{finding}");
    }
    let (reference, slots) = (RobotSpec::REFERENCE, robots::wheel_slots(&of.wheels()));
    Ok(RobotSpec {
        hull: HullSpec {
            radius: of.number("body.radius"),
            front: of.number("body.front"),
            opening: of.number("body.opening"),
        },
        kicker: KickerSpec { chip_degrees: of.number("kicker.chip_degrees"), ..reference.kicker },
        dribbler: DribblerSpec { full_rpm: of.number("dribbler.full_rpm") },
        wheels: WheelSpec {
            count: slots.count,
            degrees: slots.degrees,
            levers: slots.levers,
            distance: slots.distance,
            free_speed: of.number("wheels.free_speed"),
            ..reference.wheels
        },
        battery: BatterySpec { low: of.number("battery.low"), full: of.number("battery.full") },
        hardware: HardwareSpec {
            height: of.number("body.height"),
            mouth: of.number("body.mouth"),
            mass: of.number("body.mass"),
            speed: of.number("hardware.speed"),
            turn_speed: of.number("hardware.turn_speed"),
            forward: of.number("hardware.forward"),
            side: of.number("hardware.side"),
            brake: of.number("hardware.brake"),
            turn: of.number("hardware.turn"),
            rim_acceleration: of.number("hardware.rim_acceleration"),
            flat: of.number("hardware.flat"),
            chip: of.number("hardware.chip"),
            recharge: of.number("hardware.recharge"),
            pull: of.number("hardware.pull"),
        },
        ..reference
    })
}

/// Inputs of a build for another robot: the value of the environment variable, and the robot's name. The
/// description is checked first.
pub(crate) fn to_build(asked: &str) -> Result<(String, String), DescriptionError> {
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
    fn another_robot_is_refused_with_the_command_that_builds_for_it() {
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
    fn constants_match_the_description() {
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
        let slots = robots::wheel_slots(&own.wheels());
        assert_eq!((slots.degrees, slots.levers), (spec.wheels.degrees, spec.wheels.levers));
    }
}
