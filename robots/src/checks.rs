//! `checks`: values of a description against each other: what no single range finds.

use crate::description::{Description, Value};
use crate::wheels::{condition, wheel_slots};
use foreign::{Finding, Severity};

impl Description {
    /// Reads `text`; `file` names it in findings. The error is every fault that was found, in the file's
    /// order: first those of single values, and where there is none those of values against each other.
    pub fn read(file: &str, text: &str) -> Result<Self, Vec<Finding>> {
        let read = Self::parse(file, text)?;
        let (mut errors, warnings): (Vec<_>, Vec<_>) =
            findings(&read).into_iter().partition(|finding| finding.severity == Severity::Error);
        errors.sort_by_key(|finding| finding.line);
        if errors.is_empty() { Ok(read.doubted(warnings)) } else { Err(errors) }
    }
}

/// Every contradiction, and every doubt.
fn findings(of: &Description) -> Vec<Finding> {
    let mut list = List { of, findings: Vec::new() };
    list.body();
    list.wheels();
    list.motion();
    list.kicker();
    list.electrics();
    list.findings
}

struct List<'d> {
    of: &'d Description,
    findings: Vec<Finding>,
}

impl List<'_> {
    fn add(&mut self, severity: Severity, path: &str, message: String, hint: &str) {
        let finding = self.of.finding(severity, "inconsistent", path, message, hint.to_owned());
        self.findings.push(finding);
    }

    /// `path` may not be above `limit`, which `other` has.
    fn at_most(&mut self, path: &str, other: &str, hint: &str) {
        let (value, limit) = (self.of.number(path), self.of.number(other));
        if value > limit {
            self.add(Severity::Error, path, format!("{path} is {value}, above {other}, {limit}"), hint);
        }
    }

    fn below(&mut self, path: &str, other: &str, hint: &str) {
        let (value, limit) = (self.of.number(path), self.of.number(other));
        if value >= limit {
            self.add(Severity::Error, path, format!("{path} is {value}, not below {other}, {limit}"), hint);
        }
    }

    fn body(&mut self) {
        self.below(
            "body.front",
            "body.radius",
            "the flat front cuts the disc of the hull: measure both again",
        );
        let (reach, hull) = (wheel_slots(&self.of.wheels()).distance, self.of.number("body.radius"));
        if reach >= hull {
            let message = format!("wheels.distance is {reach}, not below body.radius, {hull}");
            let hint = "wheels stand within the hull: measure both again";
            self.add(Severity::Error, "wheels.distance", message, hint);
        }
        let [radius, front, mouth] =
            ["body.radius", "body.front", "body.mouth"].map(|path| self.of.number(path));
        let half = (radius * radius - front * front).max(0.0).sqrt();
        if front < radius && mouth > half {
            let message = format!("body.mouth is {mouth} m, wider than half the front, {half:.4} m");
            self.add(Severity::Error, "body.mouth", message, "give half the roller's width");
        }
        if front < radius * FRONT_SHARE_MIN {
            let message = format!("body.front is {front} m, less than a third of body.radius");
            self.add(Severity::Error, "body.front", message, "measure from the centre of the hull");
        }
    }

    fn wheels(&mut self) {
        let wheels = self.of.wheels();
        for path in ["wheels.distance", "wheels.skew", "wheels.outputs"] {
            if let Value::Wheels(list) = self.of.value(path)
                && (list.len() < wheels.len() || list.len() > wheels.len() && path != "wheels.outputs")
            {
                let message = format!("{path} has {} numbers for {} wheels", list.len(), wheels.len());
                self.add(Severity::Error, path, message, "give one for each wheel of wheels.degrees");
            }
        }
        let degrees: Vec<f32> = wheels.iter().map(|wheel| wheel.place).collect();
        let ordered = match degrees[..] {
            [front_right, back_right, back_left, front_left] => {
                (-180.0 < back_right && back_right < front_right && front_right <= 0.0)
                    && (0.0 <= front_left && front_left < back_left && back_left < 180.0)
            }
            _ => degrees.iter().map(|place| (-place).rem_euclid(360.0)).is_sorted(),
        };
        if !ordered {
            let message =
                format!("wheels.degrees is {degrees:?}: not front right, back right, back left, front left");
            let hint = "four: right wheels have angles of 0 to -180, left ones 0 to 180, those in front the smaller; \
                        three: clockwise from ahead";
            self.add(Severity::Error, "wheels.degrees", message, hint);
        }
        let condition = condition(&wheels);
        if condition > CONDITION_MAX {
            let message = format!(
                "wheels.degrees: the wheels do not drive in every direction (condition {condition:.0})"
            );
            let hint =
                "give angles that span the plane and the turn; the usual ones have a condition below 2";
            self.add(Severity::Error, "wheels.degrees", message, hint);
        } else if condition > CONDITION_GOOD {
            let message =
                format!("wheels.degrees: one direction is driven weakly (condition {condition:.1})");
            self.add(Severity::Warning, "wheels.degrees", message, "see `onetwo robot show`");
        }
        self.at_most("wheels.rim_max", "wheels.free_speed", "no rim is faster than without load");
        if self.of.number("wheels.encoder_gear").abs() < GEAR_MIN {
            let message = "wheels.encoder_gear is 0: the encoder does not turn".to_owned();
            self.add(
                Severity::Error,
                "wheels.encoder_gear",
                message,
                "1 for an encoder on the wheel's shaft",
            );
        }
        // A tenth of the counter's half a millisecond: it must not wrap unseen, and count at a slow walk.
        let counts =
            4.0 * self.of.number("wheels.encoder_lines") * self.of.number("wheels.encoder_gear").abs();
        let around = 2.0 * std::f32::consts::PI * self.of.number("wheels.radius");
        let per_ms = counts / around * self.of.number("wheels.free_speed") * 1e-3;
        if per_ms > COUNTS_PER_MS_MAX {
            let message =
                format!("wheels.encoder_lines: {per_ms:.0} counts a millisecond wrap the counter of 16 bits");
            self.add(Severity::Error, "wheels.encoder_lines", message, "check lines, gear and radius");
        } else if counts / around < COUNTS_PER_METRE_MIN {
            let message = format!("wheels.encoder_lines: {:.0} counts a metre are few", counts / around);
            self.add(Severity::Warning, "wheels.encoder_lines", message, "slow motion will be rough");
        }
    }

    fn motion(&mut self) {
        for plan in ["plan", "plan_holding"] {
            for (key, limit) in [
                ("speed", "governor.speed"),
                ("speed", "hardware.speed"),
                ("acceleration", "hardware.forward"),
                ("acceleration", "hardware.side"),
                ("braking", "governor.brake"),
            ] {
                self.at_most(&format!("{plan}.{key}"), limit, "a plan beyond it cannot be kept");
            }
        }
        // A wheel along the direction of motion turns at the body's speed.
        self.at_most("plan.speed", "wheels.rim_max", "a wheel may stand along the motion");
        for turn in ["turn", "turn_holding", "turn_placing"] {
            for (key, limit) in [
                ("rate", "governor.turn"),
                ("rate", "hardware.turn_speed"),
                ("acceleration", "governor.brake_turn"),
                ("acceleration", "hardware.turn"),
            ] {
                self.at_most(&format!("{turn}.{key}"), limit, "a turn beyond it cannot be kept");
            }
        }
        self.at_most("governor.brake", "hardware.brake", "wheels that slip brake less");
        self.at_most("governor.brake_turn", "hardware.turn", "wheels that slip brake less");
        self.at_most("plan_holding.speed", "plan.speed", "a ball makes no robot faster");
    }

    fn kicker(&mut self) {
        for (path, limit) in [("kicker.fastest", 6.5_f32), ("kicker.fastest_2013", 8.0)] {
            let value = self.of.number(path);
            if value * KICK_MARGIN > limit {
                let most = limit / KICK_MARGIN;
                let message = format!(
                    "{path} is {value} m/s; with 4 % more the ball is faster than the rules' {limit}"
                );
                self.add(Severity::Error, path, message, &format!("give at most {most:.2}"));
            }
        }
        self.at_most("kicker.fastest", "hardware.flat", "the kicker does not reach it");
        let [fastest, last] = [self.of.number("kicker.fastest"), last_speed(self.of, "kicker.flat_pulses")];
        if fastest > last {
            let message = format!("kicker.flat_pulses ends at {last} m/s, below kicker.fastest, {fastest}");
            let hint = "measure a longer pulse (`onetwo robot calibrate`), or order slower kicks";
            self.add(Severity::Error, "kicker.flat_pulses", message, hint);
        }
        self.below("kicker.empty_volts", "kicker.full_volts", "an empty capacitor has less than a full one");
        let [pause, recharge] = [self.of.number("kicker.pause_ms"), self.of.number("hardware.recharge")];
        if pause > 1000.0 * recharge {
            let message =
                format!("kicker.pause_ms is {pause} ms, longer than hardware.recharge, {recharge} s");
            self.add(
                Severity::Error,
                "kicker.pause_ms",
                message,
                "a kick is ready when both have passed: measure again",
            );
        }
    }

    fn electrics(&mut self) {
        self.below("battery.low", "battery.full", "give the voltages of the whole battery");
        let cells = self.of.number("battery.cells");
        let [low, full] = [self.of.number("battery.low") / cells, self.of.number("battery.full") / cells];
        if !(CELL_LOW..=CELL_NOMINAL).contains(&low) {
            let message = format!("battery.low is {low:.2} V a cell");
            self.add(Severity::Error, "battery.low", message, "lithium cells are empty at 3.0 to 3.7 V each");
        }
        if !(CELL_CHARGED..=CELL_CHARGED_MAX).contains(&full) {
            let message = format!("battery.full is {full:.2} V a cell");
            self.add(
                Severity::Error,
                "battery.full",
                message,
                "lithium cells are full at 4.2 V each; give 4.1 to 4.4",
            );
        }
        self.below("break_beam.hidden", "break_beam.seen", "a beam that is seen lifts the receiver more");
    }
}

fn last_speed(of: &Description, path: &str) -> f32 {
    of.pulses(path).last().map_or(0.0, |(speed, _)| *speed)
}

/// Smallest distance of the flat front from the centre, share of the radius (the simulator's limit).
const FRONT_SHARE_MIN: f32 = 0.31;
/// Largest condition of the wheels' matrix (rims' speed over the body's in the strongest direction against
/// the weakest): beyond it there is a direction in which a robot cannot be controlled.
const CONDITION_MAX: f64 = 8.0;
/// Condition above which one direction is driven weakly; teams' robots lie between 1.4 and 2.
const CONDITION_GOOD: f64 = 3.0;
/// Smallest gear between wheel and encoder.
const GEAR_MIN: f32 = 1e-3;
/// Largest number of counts in a millisecond: a quarter of a counter of 16 bits, so that no wrap is missed.
const COUNTS_PER_MS_MAX: f32 = 16_384.0;
/// Smallest number of counts a metre: with fewer a control step of 1 ms at 1 m/s sees none or one.
const COUNTS_PER_METRE_MIN: f32 = 2_000.0;
/// Factor by which a kicker may kick above its order.
const KICK_MARGIN: f32 = 1.04;
/// V of a lithium cell: lowest and highest end of a discharge, and of a charge.
const CELL_LOW: f32 = 3.0;
const CELL_NOMINAL: f32 = 3.7;
const CELL_CHARGED: f32 = 4.1;
const CELL_CHARGED_MAX: f32 = 4.4;

#[cfg(test)]
mod tests {
    use super::*;

    const OURS: &str = include_str!("../ours.toml");

    fn refused(changes: &[(&str, &str)]) -> String {
        let text = changes.iter().fold(OURS.to_owned(), |text, (from, to)| {
            assert!(text.contains(from), "{from}");
            text.replacen(from, to, 1)
        });
        let findings = Description::read("r.toml", &text).unwrap_err();
        findings.iter().map(Finding::to_string).collect::<Vec<_>>().join("\n")
    }

    #[test]
    fn a_body_that_does_not_hold_together_is_refused() {
        assert!(
            refused(&[("front = 0.073 ", "front = 0.09 ")])
                .contains("body.front is 0.09, not below body.radius")
        );
        assert!(refused(&[("front = 0.073 ", "front = 0.085 ")]).contains("body.mouth is 0.035 m, wider"));
        assert!(refused(&[("front = 0.073 ", "front = 0.021 ")]).contains("less than a third"));
        assert!(
            refused(&[("distance = 0.081 ", "distance = 0.09 ")])
                .contains("wheels.distance is 0.09, not below")
        );
    }

    #[test]
    fn wheels_that_do_not_span_the_plane_or_stand_in_another_order_are_refused() {
        let angles = "[-60.0, -135.0, 135.0, 60.0]";
        let parallel = refused(&[(angles, "[-89.0, -91.0, 91.0, 89.0]")]);
        assert!(
            parallel.contains("do not drive in every direction") && parallel.contains("r.toml:"),
            "{parallel}"
        );
        assert!(refused(&[(angles, "[60.0, 135.0, -135.0, -60.0]")]).contains("not front right, back right"));
        assert!(refused(&[("encoder_gear = 1.0 ", "encoder_gear = 0.0 ")]).contains("does not turn"));
        assert!(
            refused(&[("encoder_lines = 1024 ", "encoder_lines = 99000 "), ("gear = 1.0 ", "gear = 2.0 ")])
                .contains("wrap the counter")
        );
        assert!(refused(&[("rim_max = 5.0 ", "rim_max = 7.0 ")]).contains("wheels.rim_max is 7, above"));
    }

    #[test]
    fn plans_beyond_governor_or_hardware_are_refused() {
        assert!(
            refused(&[("speed = 3.5 ", "speed = 2.9 ")])
                .contains("plan.speed is 3, above hardware.speed, 2.9")
        );
        assert!(
            refused(&[("side = 3.5 ", "side = 2.0 ")])
                .contains("plan.acceleration is 3, above hardware.side")
        );
        assert!(
            refused(&[("brake = 5.5 ", "brake = 4.5 ")])
                .contains("governor.brake is 5, above hardware.brake")
        );
        assert!(
            refused(&[("turn = 50.0 ", "turn = 20.0 ")])
                .contains("turn.acceleration is 30, above hardware.turn")
        );
    }

    #[test]
    fn kicks_faster_than_rules_kicker_or_table_are_refused() {
        assert!(refused(&[("fastest = 6.24 ", "fastest = 6.3 ")]).contains("give at most 6.25"));
        assert!(
            refused(&[("flat = 8.0 ", "flat = 5.0 ")])
                .contains("kicker.fastest is 6.24, above hardware.flat")
        );
        assert!(refused(&[("[6.5, 4500]", "[5.0, 4500]")]).contains("kicker.flat_pulses ends at 5 m/s"));
        assert!(
            refused(&[
                ("empty_volts = 30.0 ", "empty_volts = 60.0 "),
                ("full_volts = 200.0 ", "full_volts = 50.0 ")
            ])
            .contains("kicker.empty_volts is 60, not below")
        );
        assert!(refused(&[("recharge = 0.5 ", "recharge = 0.4 ")]).contains("longer than hardware.recharge"));
    }

    #[test]
    fn batteries_and_light_barriers_that_cannot_be_are_refused() {
        assert!(refused(&[("cells = 4 ", "cells = 3 ")]).contains("battery.low is 4.67 V a cell"));
        assert!(refused(&[("hidden = 0.08 ", "hidden = 0.2 ")]).contains("break_beam.hidden"));
        assert!(refused(&[("full = 17.0 ", "full = 18.0 ")]).contains("battery.full is 4.50 V a cell"));
    }

    #[test]
    fn a_weak_direction_is_a_doubt() {
        let text = OURS.replace("[-60.0, -135.0, 135.0, 60.0]", "[-75.0, -110.0, 110.0, 75.0]");
        let read = Description::read("r.toml", &text).unwrap();
        assert!(read.warnings()[0].to_string().contains("warning[inconsistent]"), "{:?}", read.warnings());
    }
}
