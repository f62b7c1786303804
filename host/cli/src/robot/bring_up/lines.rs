//! `lines`: what `onetwo robot bring-up` prints, as text and as JSON.

use std::path::Path;

use foreign::printable_path;
use protocol::bring_up::{CHECKS, Check, CheckState};
use protocol::pulses::{Fired, Pulse, PulseRefusal};
use serde_json::{Value, json};

use super::progress::{Event, Summary};
use super::robot_log::LogCounts;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Format {
    /// A line for each check, two for one that failed.
    Text,
    /// An object a line.
    Json,
}

impl Format {
    /// Lines of an event, each with its end.
    pub(super) fn event(self, event: &Event) -> String {
        match (self, event) {
            (Self::Text, Event::Started { robot, start }) => {
                format!("robot {robot}, start {start}: {} checks\n", CHECKS.len())
            }
            (Self::Json, Event::Started { robot, start }) => {
                format!("{}\n", json!({ "robot": robot.number(), "start": start, "checks": CHECKS.len() }))
            }
            (Self::Text, Event::Check { check, state, .. }) => text(*check, *state),
            (Self::Json, Event::Check { robot, check, state }) => {
                let mut object = json!({
                    "robot": robot.number(),
                    "number": number(*check),
                    "check": check.to_string(),
                    "verdict": verdict(*state),
                });
                match state {
                    CheckState::Running => {}
                    CheckState::Passed(value) => {
                        object["value"] = rounded(*value);
                        object["unit"] = json!(check.unit());
                    }
                    CheckState::Failed(finding) => object["finding"] = json!(finding.to_string()),
                }
                format!("{object}\n")
            }
        }
    }

    /// The line of a pulse.
    pub(super) fn pulse(self, pulse: Pulse, result: Result<Fired, PulseRefusal>) -> String {
        let (micros, coil) = (pulse.micros, if pulse.chip { "chip" } else { "flat" });
        match (self, result) {
            (Self::Text, Err(refusal)) => format!("{micros:>5} µs {coil}: refused: {refusal}\n"),
            (Self::Text, Ok(Fired { before, after, ball })) => {
                let ball = if ball { "ball" } else { "no ball" };
                format!("{micros:>5} µs {coil}: {before:>5.1} V -> {after:>5.1} V, {ball}\n")
            }
            (Self::Json, Err(refusal)) => {
                let refused = refusal.to_string();
                format!("{}\n", json!({ "coil": coil, "pulse_us": micros, "refused": refused }))
            }
            (Self::Json, Ok(Fired { before, after, ball })) => {
                let (before, after) = (rounded(before), rounded(after));
                let volts = json!({ "coil": coil, "pulse_us": micros, "ball": ball, "volts_before": before, "volts_after": after });
                format!("{volts}\n")
            }
        }
    }

    /// The line of a log's file.
    pub(super) fn log(self, file: &Path, counts: LogCounts) -> String {
        let LogCounts { written, gaps, missing } = counts;
        let file = printable_path(file);
        match self {
            Self::Json => {
                format!("{}\n", json!({ "log": file, "bytes": written, "gaps": gaps, "missing": missing }))
            }
            Self::Text => format!("log {file}: {written} bytes, {missing} missing (gaps: {gaps})\n"),
        }
    }

    /// The last line of the checks.
    pub(super) fn summary(self, summary: &Summary) -> String {
        let Summary { robot, passed, failed, open, hears_us } = summary;
        match self {
            Self::Json => {
                let counts = json!({
                    "robot": robot.number(),
                    "passed": passed,
                    "failed": failed,
                    "without_result": open,
                    "hears_us": hears_us,
                });
                format!("{counts}\n")
            }
            Self::Text if open.is_empty() => format!("robot {robot}: {passed} passed, {failed} failed\n"),
            Self::Text => {
                format!("robot {robot}: {passed} passed, {failed} failed, {} without a result\n", open.len())
            }
        }
    }
}

fn text(check: Check, state: CheckState) -> String {
    let number = number(check);
    match state {
        CheckState::Running => format!("      {number:>2}  {check}\n"),
        CheckState::Passed(value) => {
            // Frames are whole.
            let digits = if check == Check::Radio { 0 } else { 2 };
            format!("pass  {number:>2}  {check}  ({value:.digits$} {})\n", check.unit())
        }
        CheckState::Failed(finding) => format!("FAIL  {number:>2}  {check}\n          {finding}\n"),
    }
}

fn verdict(state: CheckState) -> &'static str {
    match state {
        CheckState::Running => "running",
        CheckState::Passed(_) => "pass",
        CheckState::Failed(_) => "fail",
    }
}

/// Place of a check in the list, from 1.
fn number(check: Check) -> usize {
    check.number().map_or(0, |number| number + 1)
}

/// In thousandths, which the sensors do not reach; null where it is no number.
fn rounded(value: f32) -> Value {
    json!((f64::from(value) * 1e3).round() / 1e3)
}

#[cfg(test)]
mod tests {
    use super::*;
    use protocol::RobotId;
    use protocol::bring_up::Finding;

    #[test]
    fn a_check_says_what_to_see_then_what_was_measured_or_what_to_look_at() {
        let event = |state| Event::Check { robot: RobotId::ZERO, check: CHECKS[2], state };
        let text =
            [CheckState::Running, CheckState::Passed(0.957), CheckState::Failed(Finding::CountedBy(1, 0.96))]
                .map(|state| Format::Text.event(&event(state)))
                .concat();
        assert_eq!(
            text,
            "       3  front right wheel: it turns, as to turn the robot counter-clockwise\n\
             pass   3  front right wheel: it turns, as to turn the robot counter-clockwise  (0.96 m/s)\n\
             FAIL   3  front right wheel: it turns, as to turn the robot counter-clockwise\n          \
             the encoder of the back right wheel counts 0.96 m/s in its place: swap the two encoders' cables, or the two motors'\n"
        );
        let json = Format::Json.event(&event(CheckState::Passed(0.9571)));
        let read: Value = serde_json::from_str(&json).unwrap();
        assert_eq!(
            (&read["number"], &read["verdict"], &read["unit"]),
            (&json!(3), &json!("pass"), &json!("m/s"))
        );
        assert_eq!(read["value"], json!(0.957));
        let nan: Value =
            serde_json::from_str(&Format::Json.event(&event(CheckState::Passed(f32::NAN)))).unwrap();
        assert!(nan["value"].is_null());
    }
}
