//! `measurements`: what was measured on a bench, as CSV files: read, and refused where it cannot be true.
//! Each refusal names line and remedy.

use std::path::Path;

use robots::Description;

use super::derived::COUNTER_MAX;
use super::fit::{PulseFit, SPEED_OF_NO_KICK};

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Row {
    /// Line of the file, from 1.
    line: u64,
    /// Value of the first column and of the second.
    values: (f32, f32),
}

impl Row {
    /// Measured speed less that of the table, m/s.
    fn off_table(&self, fit: &PulseFit) -> f64 {
        f64::from(self.values.1) - fit.speed_of(f64::from(self.values.0))
    }

    /// Counts a metre.
    fn ratio(&self) -> f64 {
        f64::from(self.values.1) / f64::from(self.values.0)
    }

    /// Share by which it is off the others' counts a metre.
    fn off_ratio(&self, others: f64) -> f64 {
        (self.ratio() / others - 1.0).abs()
    }
}

/// The rows without their lines.
pub(super) fn values(rows: &[Row]) -> Vec<(f32, f32)> {
    rows.iter().map(|row| row.values).collect()
}

/// Kicks: pulse, µs, and ball speed, m/s.
pub(super) fn kicks(file: &Path) -> Result<Vec<Row>, String> {
    let rows = read(file, ["pulse_us", "speed"])?;
    for Row { line, values: (pulse, speed) } in &rows {
        if !PULSES.contains(pulse) {
            let range = format!("{} to {} µs", PULSES.start(), PULSES.end());
            return Err(format!("line {line}: pulse_us is {pulse}; give microseconds, {range}"));
        }
        if !(0.0..=SPEED_MAX).contains(speed) {
            let range = format!("0 to {SPEED_MAX} m/s");
            return Err(format!("line {line}: speed is {speed}; give metres a second, {range}"));
        }
    }
    let kicked = rows.iter().filter(|row| row.values.1 >= SPEED_OF_NO_KICK);
    let first = kicked.clone().map(|row| row.values.0).fold(f32::INFINITY, f32::min);
    let last = kicked.map(|row| row.values.0).fold(0.0, f32::max);
    if first.is_finite() && last - first < PULSE_SPAN_MIN {
        let span = last - first;
        return Err(format!(
            "the pulses that move the ball lie within {span:.0} µs; measure from the shortest to the longest, {PULSE_SPAN_MIN} µs apart at least"
        ));
    }
    // A pulse that does not move the ball is shorter than all that do.
    let none = rows.iter().find(|row| row.values.1 < SPEED_OF_NO_KICK && row.values.0 > first);
    if let Some(Row { line, values: (pulse, speed) }) = none {
        return Err(format!(
            "line {line}: {pulse} µs gave {speed} m/s, and shorter pulses moved the ball; was the capacitor full? Measure it again, or take the line out"
        ));
    }
    Ok(rows)
}

/// Refuses a kick that the fitted table does not describe.
pub(super) fn check_kicks(rows: &[Row], fit: &PulseFit) -> Result<(), String> {
    let Some(worst) = rows.iter().max_by(|a, b| a.off_table(fit).abs().total_cmp(&b.off_table(fit).abs()))
    else {
        return Ok(());
    };
    let (pulse, speed) = worst.values;
    let fitted = fit.speed_of(f64::from(pulse));
    if worst.off_table(fit).abs() <= SPEED_OFF_MIN + SPEED_OFF_SHARE * fitted {
        return Ok(());
    }
    Err(format!(
        "line {}: {pulse} µs gave {speed} m/s, and the other kicks make {fitted:.2} m/s of it; measure it again, or take the line out",
        worst.line
    ))
}

/// Drives: distance, m, and counts of a wheel along them.
pub(super) fn drives(file: &Path, of: &Description) -> Result<Vec<Row>, String> {
    let rows = read(file, ["distance_m", "counts"])?;
    let turn = 2.0 * std::f32::consts::PI * of.number("wheels.radius");
    let per_metre = 4.0 * of.number("wheels.encoder_lines") * of.number("wheels.encoder_gear").abs() / turn;
    let longest = COUNTER_MAX / per_metre;
    for Row { line, values: (distance, counts) } in &rows {
        if !DISTANCES.contains(distance) {
            let range = format!("{} to {} m", DISTANCES.start(), DISTANCES.end());
            return Err(format!("line {line}: distance_m is {distance}; give metres by tape, {range}"));
        }
        if counts.fract() != 0.0 {
            return Err(format!("line {line}: counts is {counts}; counts are whole numbers"));
        }
        // More counts than a counter has were added up by who measured.
        if distance * per_metre > COUNTER_SHARE * COUNTER_MAX && counts.abs() <= COUNTER_MAX {
            return Err(format!(
                "line {line}: {distance} m are {:.0} counts by the description, and a counter of 16 bits begins again after {COUNTER_MAX}: drive at most {:.1} m, or give the sum of the counts",
                distance * per_metre,
                (10.0 * COUNTER_SHARE * longest).floor() / 10.0
            ));
        }
    }
    if rows.len() < DRIVES_MIN {
        return Err(format!(
            "{} drives; measure at least {DRIVES_MIN}, so that a wrong one is seen",
            rows.len()
        ));
    }
    if let Some(other) = rows.iter().find(|row| row.values.1 * rows[0].values.1 < 0.0) {
        return Err(format!(
            "line {}: the counts fall, those of line {} rise; push the robot the same way, and give one wheel's counts",
            other.line, rows[0].line
        ));
    }
    Ok(rows)
}

/// Refuses a drive that is not as the others.
pub(super) fn check_drives(rows: &[Row], per_metre: f64) -> Result<(), String> {
    // The median is the drives' own where the mean is drawn away by the one that is wrong.
    let mut ratios: Vec<_> = rows.iter().map(Row::ratio).collect();
    ratios.sort_by(f64::total_cmp);
    let middle = if rows.len() > 2 { ratios[ratios.len() / 2] } else { per_metre };
    let Some(worst) = rows.iter().max_by(|a, b| a.off_ratio(middle).total_cmp(&b.off_ratio(middle))) else {
        return Ok(());
    };
    if worst.off_ratio(middle) <= DRIVE_OFF_MAX {
        return Ok(());
    }
    let (distance, counts) = worst.values;
    Err(format!(
        "line {}: {distance} m gave {counts} counts, {:.0} % off the others; measure it again, or take the line out",
        worst.line,
        100.0 * worst.off_ratio(middle)
    ))
}

/// Two columns of a CSV file, by their names.
fn read(file: &Path, columns: [&str; 2]) -> Result<Vec<Row>, String> {
    let text = foreign::read_text(file, MEASUREMENTS_MAX).map_err(|error| error.to_string())?;
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(text.as_bytes());
    let header = reader.headers().map_err(|error| error.to_string())?.clone();
    let places = columns.map(|column| header.iter().position(|name| name == column));
    let [Some(first), Some(second)] = places else {
        return Err(format!("the first line must name the columns {} and {}", columns[0], columns[1]));
    };
    if let Some(twice) =
        columns.iter().find(|column| header.iter().filter(|name| name == *column).count() > 1)
    {
        return Err(format!("the first line names {twice} twice"));
    }
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|error| error.to_string())?;
        let line = record.position().map_or(0, csv::Position::line);
        let values = (number(&record, first), number(&record, second));
        match values {
            (Ok(first), Ok(second)) => rows.push(Row { line, values: (first, second) }),
            (Err(text), _) => return Err(no_number(line, columns[0], &text)),
            (_, Err(text)) => return Err(no_number(line, columns[1], &text)),
        }
    }
    Ok(rows)
}

/// A cell's number, or its text.
fn number(record: &csv::StringRecord, place: usize) -> Result<f32, String> {
    let text = record.get(place).unwrap_or_default();
    let number = text.parse::<f32>().ok().filter(|number| number.is_finite());
    number.ok_or_else(|| foreign::excerpt(text, 40))
}

fn no_number(line: u64, column: &str, text: &str) -> String {
    format!("line {line}: {column} is {text:?}; give a number")
}

/// Largest file of measurements, bytes.
const MEASUREMENTS_MAX: u64 = 1 << 24;
/// Pulses of a kicker, µs: as `robots` takes them.
const PULSES: std::ops::RangeInclusive<f32> = 20.0..=6_000.0;
/// Least span of the pulses that move the ball, µs.
const PULSE_SPAN_MIN: f32 = 300.0;
/// Fastest ball that a kicker gives, m/s.
const SPEED_MAX: f32 = 15.0;
/// Largest deviation of a kick from the fitted table, m/s, and as a share of the table's speed: kicks of one
/// pulse scatter by a tenth.
const SPEED_OFF_MIN: f64 = 0.3;
const SPEED_OFF_SHARE: f64 = 0.15;
/// Distances by tape, m: a shorter one measures the tape, no field is longer.
const DISTANCES: std::ops::RangeInclusive<f32> = 0.2..=30.0;
/// Share of a counter's range that a drive may take: the radius is not known before it is fitted.
const COUNTER_SHARE: f32 = 0.8;
/// Fewest drives.
const DRIVES_MIN: usize = 2;
/// Largest deviation of a drive from the others, as a share.
const DRIVE_OFF_MAX: f64 = 0.03;

#[cfg(test)]
mod tests {
    use std::fs;
    use std::path::PathBuf;

    use super::super::fit;
    use super::*;

    fn written(text: &str) -> PathBuf {
        use std::sync::atomic::{AtomicU32, Ordering};
        static NUMBER: AtomicU32 = AtomicU32::new(0);
        let number = NUMBER.fetch_add(1, Ordering::Relaxed);
        let file = std::env::temp_dir().join(format!("onetwo-measured-{}-{number}.csv", std::process::id()));
        fs::write(&file, text).unwrap();
        file
    }

    /// The refusal of these drives; `None` where they are taken.
    fn of_drives(rows: &str) -> Option<String> {
        let ours = Description::read("ours", robots::built_in("ours").unwrap()).unwrap();
        let file = written(&format!("distance_m,counts\n{rows}"));
        let checked = drives(&file, &ours).and_then(|rows| {
            let (per_metre, _) = fit::counts_per_metre(&values(&rows)).unwrap();
            check_drives(&rows, per_metre)
        });
        fs::remove_file(file).unwrap();
        checked.err()
    }

    /// The same for kicks.
    fn of_kicks(rows: &str) -> Option<String> {
        let file = written(&format!("pulse_us,speed\n{rows}"));
        let checked = kicks(&file).and_then(|rows| {
            let fit = fit::pulses(&values(&rows), 6).unwrap();
            check_kicks(&rows, &fit)
        });
        fs::remove_file(file).unwrap();
        checked.err()
    }

    #[test]
    fn drives_that_cannot_be_true_are_refused_with_their_line() {
        // 24,144 counts a metre by the description; the counter begins again after 2.7 m.
        for (rows, said) in [
            ("5,55189\n5,55189\n", "line 2: 5 m are 120722 counts"),
            ("1,24000\n3,6899\n", "line 3: 3 m are 72433 counts"),
            ("2.5,-5000\n2.5,-5000\n", "line 2: 2.5 m are"),
            ("10,44842\n10,44842\n", "line 2: 10 m are"),
            ("1000,24000\n2000,48000\n", "line 2: distance_m is 1000; give metres"),
            ("0.05,1200\n1,24000\n", "line 2: distance_m is 0.05"),
            ("-1,-24000\n-1,-24000\n", "line 2: distance_m is -1"),
            ("1,24000.5\n1,24000\n", "line 2: counts is 24000.5"),
            ("1,24000\n", "1 drives; measure at least 2"),
            ("", "0 drives"),
            ("1,24000\n1,-24000\n", "line 3: the counts fall, those of line 2 rise"),
            ("1,24000\n2,48100\n1.5,24000\n2,47900\n", "line 4: 1.5 m gave 24000 counts, 33 % off"),
            ("1,24000\n1,26000\n", "off the others"),
            ("1,fast\n1,24000\n", "line 2: counts is \"fast\"; give a number"),
        ] {
            let refused = of_drives(rows).unwrap_or_else(|| panic!("{rows:?} is taken"));
            assert!(refused.contains(said), "{rows:?}: {refused}");
        }
        // Within the counter; backwards; and added up by hand over several turns of it.
        for rows in ["1,24000\n2,48600\n", "2,-48300\n1,-24100\n", "5,120700\n4,96600\n"] {
            assert_eq!(of_drives(rows), None, "{rows:?}");
        }
    }

    #[test]
    fn kicks_that_cannot_be_true_are_refused_with_their_line() {
        let good = "1000,1.1\n2000,2.4\n3000,3.9\n4000,5.2\n5000,6.1\n";
        assert_eq!(of_kicks(good), None);
        for (row, said) in [
            ("2.5,3.0\n", "line 7: pulse_us is 2.5; give microseconds"),
            ("9000,7\n", "line 7: pulse_us is 9000"),
            ("-1000,1\n", "line 7: pulse_us is -1000"),
            ("3000,3900\n", "line 7: speed is 3900; give metres a second"),
            ("3000,-3.9\n", "line 7: speed is -3.9"),
            ("3000,0\n", "line 7: 3000 µs gave 0 m/s, and shorter pulses moved the ball"),
            ("3000,6.5\n", "line 7: 3000 µs gave 6.5 m/s, and the other kicks make"),
            ("1000,NaN\n", "line 7: speed is \"NaN\""),
        ] {
            let refused = of_kicks(&format!("{good}{row}")).unwrap_or_else(|| panic!("{row:?} is taken"));
            assert!(refused.contains(said), "{row:?}: {refused}");
        }
        let near = of_kicks("3000,3.9\n3001,3.9\n3002,3.91\n").unwrap();
        assert!(near.contains("lie within 2 µs"), "{near}");
    }

    #[test]
    fn columns_are_found_by_name_and_each_once() {
        let file = written("speed, pulse_us\n1.1,1000\n2.4,2000\n");
        assert_eq!(values(&read(&file, ["pulse_us", "speed"]).unwrap()), [(1000.0, 1.1), (2000.0, 2.4)]);
        let error = read(&file, ["distance_m", "counts"]).unwrap_err();
        assert!(error.contains("columns distance_m and counts"), "{error}");
        fs::write(&file, "speed,speed,pulse_us\n1,1,1\n").unwrap();
        assert!(read(&file, ["pulse_us", "speed"]).unwrap_err().contains("speed twice"));
        fs::remove_file(file).unwrap();
    }
}
