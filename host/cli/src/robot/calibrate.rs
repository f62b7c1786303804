//! `onetwo robot calibrate`: measured kicks and drives into a description. Comments and order of the file
//! stay; what results is checked before it is written.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use robots::{Description, Finding};
use toml_edit::{Array, DocumentMut, Item, Value};

use super::{fit, measurements};
use crate::Failure;
use crate::destination;
use crate::output::print_text;
use crate::robot_description::{DescriptionError, read};

/// Arguments of `robot calibrate`.
#[derive(Debug, Args)]
#[command(group = clap::ArgGroup::new("measured").required(true).multiple(true).args(["flat", "chip", "drive"]))]
pub(crate) struct CalibrateArgs {
    /// The description, a file; it is changed.
    #[arg(value_name = "FILE")]
    file: String,
    /// Kicks of the flat kicker, a CSV file with the columns pulse_us and speed, m/s.
    #[arg(long, value_name = "CSV")]
    flat: Option<PathBuf>,
    /// The same of the chip kicker: speed along the chip's path.
    #[arg(long, value_name = "CSV")]
    chip: Option<PathBuf>,
    /// Drives, a CSV file with the columns distance_m, by tape, and counts, a wheel's that stands along the
    /// drive. A counter has 16 bits: drive at most four fifths of the distance that `onetwo robot show`
    /// prints for it, or give the sum.
    #[arg(long, value_name = "CSV")]
    drive: Option<PathBuf>,
    /// What a drive is put down to: the wheels' radius, or the encoders' gear.
    #[arg(long, value_enum, default_value_t = Fitted::Radius)]
    fit: Fitted,
    /// Most pairs of a table of pulses.
    #[arg(long, value_name = "N", default_value_t = 6, value_parser = clap::value_parser!(u8).range(2..=16))]
    points: u8,
    /// Print the values and write nothing.
    #[arg(long)]
    dry_run: bool,
}

/// What driven distances are put down to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Fitted {
    /// `wheels.radius`.
    Radius,
    /// `wheels.encoder_gear`.
    Gear,
}

/// A value to be written: its key, the value, and the comment that says where it is from.
struct Change {
    key: &'static str,
    value: Value,
    source: String,
}

pub(super) fn run(args: &CalibrateArgs) -> Result<(), Failure> {
    let (chosen, description) = read(&args.file)?;
    let Some(file) = chosen.file else { return Err(DescriptionError::BuiltIn(args.file.clone()).into()) };
    let mut changes = Vec::new();
    for (key, measured) in [("kicker.flat_pulses", &args.flat), ("kicker.chip_pulses", &args.chip)] {
        if let Some(measured) = measured {
            changes.push(of_kicks(key, measured, usize::from(args.points))?);
        }
    }
    if let Some(measured) = &args.drive {
        changes.push(of_drives(&description, measured, args.fit)?);
    }
    let text = written(&chosen.text, &changes)
        .map_err(|what| DescriptionError::Measurements { file: file.clone(), what })?;
    let refused = |findings: Vec<Finding>| DescriptionError::Faulty(findings);
    let changed = Description::read(&args.file, &text).map_err(refused)?;
    let mut out = String::new();
    for Change { key, value, source } in &changes {
        let _ = writeln!(out, "{key} = {}  # {source}", value.to_string().trim());
    }
    for finding in changed.warnings() {
        let _ = writeln!(out, "{finding}");
    }
    if args.dry_run {
        out.push_str("nothing is written (--dry-run)\n");
    } else {
        destination::replace(&file, &text)?;
        let _ = writeln!(out, "written to {}; build for it again", args.file);
    }
    print_text(&out)
}

fn of_kicks(key: &'static str, file: &Path, points: usize) -> Result<Change, DescriptionError> {
    let refused = |what| DescriptionError::Measurements { file: file.to_owned(), what };
    let measured = measurements::kicks(file).map_err(refused)?;
    let fit = fit::pulses(&measurements::values(&measured), points)
        .map_err(|what| DescriptionError::NoFit { key, what })?;
    measurements::check_kicks(&measured, &fit).map_err(refused)?;
    let mut value = Array::new();
    for (speed, micros) in fit.table {
        let pair: Array = [Value::from(shortest(speed)), Value::from(micros as i64)].into_iter().collect();
        value.push(pair);
    }
    let source = format!("Fitted to {} kicks of {}: rms {:.2} m/s.", fit.count, name_of(file), fit.rms);
    Ok(Change { key, value: Value::Array(value), source })
}

fn of_drives(of: &Description, file: &Path, fitted: Fitted) -> Result<Change, DescriptionError> {
    let key = match fitted {
        Fitted::Radius => "wheels.radius",
        Fitted::Gear => "wheels.encoder_gear",
    };
    let refused = |what| DescriptionError::Measurements { file: file.to_owned(), what };
    let driven = measurements::drives(file, of).map_err(refused)?;
    let (per_metre, deviation) = fit::counts_per_metre(&measurements::values(&driven))
        .map_err(|what| DescriptionError::NoFit { key, what })?;
    measurements::check_drives(&driven, per_metre).map_err(refused)?;
    let [lines, gear, radius] = ["wheels.encoder_lines", "wheels.encoder_gear", "wheels.radius"]
        .map(|path| f64::from(of.number(path)));
    let around = 2.0 * std::f64::consts::PI;
    let value = match fitted {
        Fitted::Radius => 4.0 * lines * gear.abs() / (around * per_metre.abs()),
        Fitted::Gear => (around * radius * per_metre / (4.0 * lines)).abs().copysign(gear),
    };
    let digits = 1e6;
    let value = Value::from((value * digits).round() / digits);
    let count = driven.len();
    let source =
        format!("Fitted to {count} drives of {}: each within {:.1} %.", name_of(file), 100.0 * deviation);
    Ok(Change { key, value, source })
}

/// The text with the changes; comments and order stay, and a comment of an earlier fit is replaced.
fn written(text: &str, changes: &[Change]) -> Result<String, String> {
    let mut file: DocumentMut = text.parse().map_err(|error: toml_edit::TomlError| error.to_string())?;
    for Change { key, value, source } in changes {
        let missing = || format!("there is no {key}");
        let (table, name) = key.split_once('.').ok_or_else(missing)?;
        let table = file.get_mut(table).and_then(Item::as_table_mut).ok_or_else(missing)?;
        let had = table.get_mut(name).and_then(Item::as_value_mut).ok_or_else(missing)?;
        let decor = had.decor().clone();
        *had = value.clone();
        // What stands behind it on its line stays there.
        *had.decor_mut() = decor;
        let mut word = table.key_mut(name).ok_or_else(missing)?;
        let decor = word.leaf_decor_mut();
        let before = decor.prefix().and_then(|prefix| prefix.as_str()).unwrap_or_default();
        let kept: Vec<_> = before.lines().filter(|line| !line.starts_with(FITTED)).collect();
        let kept = if kept.is_empty() { String::new() } else { kept.join("\n") + "\n" };
        decor.set_prefix(format!("{kept}# {source}\n"));
    }
    Ok(file.to_string())
}

/// The shortest decimal number that reads as this one.
fn shortest(number: f32) -> f64 {
    number.to_string().parse().unwrap_or(f64::from(number))
}

fn name_of(file: &Path) -> String {
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    foreign::excerpt(&name, 80)
}

/// Start of the comment of a fit.
const FITTED: &str = "# Fitted to ";

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    fn measured(name: &str, text: &str) -> PathBuf {
        let file = std::env::temp_dir().join(format!("onetwo-{}-{name}", std::process::id()));
        fs::write(&file, text).unwrap();
        file
    }

    #[test]
    fn fitted_values_replace_theirs_and_every_comment_stays() {
        let ours = robots::built_in("ours").unwrap();
        let kicks =
            measured("kicks.csv", "pulse_us, speed\n1000,1.1\n2000,2.4\n3000,3.9\n4000,5.2\n5000,6.3\n");
        let drives = measured("drives.csv", "distance_m,counts\n1.0,25000\n2.0,50000\n");
        let description = Description::read("ours", ours).unwrap();
        let changes = [
            of_kicks("kicker.flat_pulses", &kicks, 4).unwrap(),
            of_drives(&description, &drives, Fitted::Radius).unwrap(),
        ];
        let once = written(ours, &changes).unwrap();
        let twice = written(&once, &changes).unwrap();
        assert_eq!(once, twice, "a second fit replaces the comment of the first");
        let fresh = Description::read("fresh", &once).unwrap();
        assert_eq!(fresh.differences(&description), ["wheels.radius", "kicker.flat_pulses"]);
        // 4096 / (2π · 25000).
        assert!((fresh.number("wheels.radius") - 0.026_076).abs() < 1e-6);
        assert_eq!(fresh.pulses("kicker.flat_pulses").len(), 4);
        assert_eq!(fresh.pulses("kicker.flat_pulses").last(), Some(&(6.3, 5000)));
        let added: Vec<_> = once.lines().filter(|line| !ours.lines().any(|had| had == *line)).collect();
        assert_eq!(added.len(), 4, "{added:?}");
        assert!(added.iter().any(|line| line.contains("# estimates; `onetwo robot calibrate`")), "{added:?}");
        let gear = of_drives(&description, &drives, Fitted::Gear).unwrap();
        // 2π · 0.027 · 25000 / 4096.
        assert!(gear.value.to_string().trim().starts_with("1.0354"), "{}", gear.value);
        for file in [kicks, drives] {
            fs::remove_file(file).unwrap();
        }
    }
}
