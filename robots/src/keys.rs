//! `keys`: every key of a `robot.toml`, with unit, range and meaning. The reader refuses all others, and the
//! table of docs/robots.md is made from them.

/// A key of a description.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Key {
    /// Table and name, as `plan.speed`.
    pub path: &'static str,
    /// Unit of its numbers; empty for none.
    pub unit: &'static str,
    /// Type and range of the value.
    pub kind: Kind,
    /// Meaning of the value, and its readers.
    pub meaning: &'static str,
}

/// Type and range of a value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// A number from the first to the second.
    Number(f32, f32),
    /// A whole number from the first to the second.
    Whole(u32, u32),
    /// Three or four angles, degrees, one for each wheel.
    Angles,
    /// One number for all wheels, or a list with one for each, from the first to the second; the third where
    /// the key is absent.
    PerWheel(f32, f32, Option<f32>),
    /// For each wheel another number from 1 to 4; 1, 2, 3, 4 where the key is absent.
    Outputs,
    /// Pairs of ball speed, m/s, and pulse, µs; both rise.
    Pulses,
    /// One of these words.
    Word(&'static [&'static str]),
    /// Letters, digits, `-` and `_`.
    Name,
}

const fn number(path: &'static str, unit: &'static str, low: f32, high: f32, meaning: &'static str) -> Key {
    Key { path, unit, kind: Kind::Number(low, high), meaning }
}

/// Motor schemes; `pwm-direction` is what the boards that come with the project are wired for.
pub(crate) const SCHEMES: &[&str] = &["pwm-direction", "three-pwm", "smart"];
/// IMUs with a driver.
pub(crate) const IMUS: &[&str] = &["icm-42688-p", "none"];
/// Ends of the radio that a board has.
pub(crate) const RADIOS: &[&str] = &["serial", "nrf24"];
/// The league's greatest radius of a robot, m (rules, robots).
const RADIUS_MAX: f32 = 0.09;
/// The league's greatest height of a robot, m (rules, robots).
const HEIGHT_MAX: f32 = 0.15;

/// All keys, in the order of the built-in files.
pub const KEYS: &[Key] = &[
    Key { path: "name", unit: "", kind: Kind::Name, meaning: "name of this robot, for reports" },
    number("body.radius", "m", 0.04, RADIUS_MAX, "radius of the hull; at most the league's 90 mm"),
    number("body.height", "m", 0.03, HEIGHT_MAX, "height of the hull (simulator)"),
    number("body.front", "m", 0.02, RADIUS_MAX, "from the centre to the flat front"),
    number("body.opening", "m", 0.0, 0.03, "how far the ball enters the disc of the radius at the dribbler"),
    number("body.mouth", "m", 0.01, 0.07, "half the width in which the roller holds a ball (simulator)"),
    number("body.mass", "kg", 0.3, 6.0, "whole robot with battery (simulator)"),
    Key {
        path: "wheels.degrees",
        unit: "degrees",
        kind: Kind::Angles,
        meaning: "where the wheels stand, counter-clockwise from ahead: front right, back right, back left, front left; of three wheels clockwise",
    },
    Key {
        path: "wheels.distance",
        unit: "m",
        kind: Kind::PerWheel(0.02, RADIUS_MAX, None),
        meaning: "from the robot's centre to a wheel",
    },
    Key {
        path: "wheels.skew",
        unit: "degrees",
        kind: Kind::PerWheel(-60.0, 60.0, Some(0.0)),
        meaning: "how far a wheel's drive is turned from its tangent, counter-clockwise",
    },
    Key {
        path: "wheels.outputs",
        unit: "",
        kind: Kind::Outputs,
        meaning: "which of the board's motor outputs, with its encoder, drives each wheel (boards)",
    },
    number("wheels.radius", "m", 0.01, 0.06, "radius of a wheel on the field surface (boards)"),
    number("wheels.free_speed", "m/s", 0.5, 15.0, "rim speed at full voltage without load"),
    number("wheels.rim_max", "m/s", 0.3, 15.0, "fastest rim that is ordered"),
    number("wheels.encoder_lines", "", 4.0, 100_000.0, "lines of an encoder, each four counts (boards)"),
    number(
        "wheels.encoder_gear",
        "",
        -100.0,
        100.0,
        "turns of an encoder for a turn of the wheel; negative where it counts down when the wheel turns the robot counter-clockwise (boards)",
    ),
    Key {
        path: "motors.scheme",
        unit: "",
        kind: Kind::Word(SCHEMES),
        meaning: "how the motors are driven; a board wired for another refuses to compile",
    },
    number(
        "motors.proportional",
        "1/(m/s)",
        0.0,
        10.0,
        "share of full voltage for an error of 1 m/s at the rim",
    ),
    number(
        "motors.integral",
        "1/m",
        0.0,
        100.0,
        "share of full voltage that an error of 1 m/s adds in a second",
    ),
    number("plan.speed", "m/s", 0.2, 6.0, "greatest speed a motion is planned with"),
    number("plan.acceleration", "m/s²", 0.2, 10.0, "greatest acceleration of a plan"),
    number("plan.braking", "m/s²", 0.2, 10.0, "greatest deceleration of a plan"),
    number("plan_holding.speed", "m/s", 0.2, 6.0, "the same with the ball at the dribbler"),
    number("plan_holding.acceleration", "m/s²", 0.2, 10.0, "the same with the ball at the dribbler"),
    number("plan_holding.braking", "m/s²", 0.2, 10.0, "the same with the ball at the dribbler"),
    number("turn.rate", "rad/s", 0.5, 30.0, "greatest turning rate of a plan"),
    number("turn.acceleration", "rad/s²", 1.0, 200.0, "speeding up and slowing down a turn"),
    number("turn_holding.rate", "rad/s", 0.5, 30.0, "the same with the ball at the dribbler"),
    number("turn_holding.acceleration", "rad/s²", 1.0, 200.0, "the same with the ball at the dribbler"),
    number("turn_placing.rate", "rad/s", 0.5, 30.0, "the same while a ball is placed"),
    number("turn_placing.acceleration", "rad/s²", 1.0, 200.0, "the same while a ball is placed"),
    number("governor.speed", "m/s", 0.2, 8.0, "no order is faster"),
    number(
        "governor.turn",
        "rad/s",
        0.5,
        25.0,
        "no order turns faster; at 30 a robot counts as out of control",
    ),
    number("governor.brake", "m/s²", 0.2, 10.0, "deceleration when it brakes"),
    number("governor.brake_turn", "rad/s²", 1.0, 300.0, "the same for turning"),
    number(
        "assumed.pass.speed",
        "m/s",
        0.2,
        6.0,
        "passes, interceptions, coercion: any robot on the field, ours too",
    ),
    number("assumed.pass.acceleration", "m/s²", 0.2, 10.0, "the same robots' acceleration"),
    number("assumed.pass.braking", "m/s²", 0.2, 10.0, "the same robots' braking"),
    number("assumed.turn.rate", "rad/s", 0.5, 30.0, "the same robots' turning rate"),
    number("assumed.turn.acceleration", "rad/s²", 1.0, 200.0, "the same robots' turning acceleration"),
    number("assumed.role.speed", "m/s", 0.2, 6.0, "role assignment: average speed over a few metres"),
    number("assumed.role.acceleration", "m/s²", 0.2, 10.0, "the same, acceleration and braking"),
    number("assumed.defence_acceleration", "m/s²", 0.2, 10.0, "defence: opponents and our defenders"),
    number("assumed.blocker_acceleration", "m/s²", 0.2, 10.0, "opponents beside a gap for a shot"),
    number("assumed.kick_share", "", 0.5, 1.0, "share of the rules' ball speed that kicks are planned with"),
    number(
        "kicker.fastest",
        "m/s",
        0.5,
        6.5,
        "fastest ball that is ordered; 4 % more must stay within the rules' 6.5",
    ),
    number("kicker.fastest_2013", "m/s", 0.5, 8.0, "the same under the rules of 2013, of their 8"),
    Key {
        path: "kicker.flat_pulses",
        unit: "[m/s, µs]",
        kind: Kind::Pulses,
        meaning: "ball speed and pulse of the flat kicker, straight lines between; from 0 at 0",
    },
    Key {
        path: "kicker.chip_pulses",
        unit: "[m/s, µs]",
        kind: Kind::Pulses,
        meaning: "the same of the chip kicker, speed along its path",
    },
    number("kicker.chip_degrees", "degrees", 10.0, 80.0, "angle of a chip above the ground"),
    number("kicker.full_volts", "V", 5.0, 400.0, "the capacitor counts as full from here on"),
    number("kicker.empty_volts", "V", 1.0, 60.0, "below it is safe to touch: less than extra-low voltage"),
    Key {
        path: "kicker.pause_ms",
        unit: "ms",
        kind: Kind::Whole(50, 10_000),
        meaning: "from one kick to the next",
    },
    number("dribbler.full_rpm", "rpm", 50.0, 20_000.0, "speed of the roller at full share"),
    Key { path: "battery.cells", unit: "", kind: Kind::Whole(1, 10), meaning: "lithium cells in series" },
    number("battery.low", "V", 2.0, 45.0, "the robot stops to play below this"),
    number("battery.full", "V", 2.0, 45.0, "more is no battery but a wrong divider"),
    number(
        "break_beam.hidden",
        "",
        0.005,
        0.9,
        "the lamp lifts the receiver by less of its range: a ball is there",
    ),
    number("break_beam.seen", "", 0.005, 0.95, "the lamp lifts it by more: no ball"),
    number("break_beam.blind", "", 0.1, 1.0, "daylight above which nothing is measured"),
    Key {
        path: "imu.model",
        unit: "",
        kind: Kind::Word(IMUS),
        meaning: "the gyroscope; a board wired for another refuses to compile",
    },
    number("imu.unrest", "rad/s", 0.005, 1.0, "spread of readings of a robot that stands"),
    number("imu.offset_max", "rad/s", 0.005, 0.5, "largest offset that is believed"),
    Key {
        path: "radio.line",
        unit: "",
        kind: Kind::Word(RADIOS),
        meaning: "what the board's radio is; a board wired for another refuses to compile",
    },
    Key {
        path: "radio.baud",
        unit: "1/s",
        kind: Kind::Whole(115_200, 4_000_000),
        meaning: "rate of the serial line to the radio",
    },
    number("hardware.speed", "m/s", 0.2, 8.0, "greatest speed of the centre, measured (simulator)"),
    number("hardware.turn_speed", "rad/s", 0.5, 60.0, "greatest turning rate, measured (simulator)"),
    number("hardware.forward", "m/s²", 0.3, 15.0, "what the wheels hold, speeding up ahead (simulator)"),
    number("hardware.side", "m/s²", 0.3, 15.0, "the same to the side (simulator)"),
    number("hardware.brake", "m/s²", 0.3, 15.0, "the same, braking in any direction (simulator)"),
    number("hardware.turn", "rad/s²", 1.0, 300.0, "speeding up a turn (simulator)"),
    number(
        "hardware.rim_acceleration",
        "m/s²",
        1.0,
        300.0,
        "of a free wheel from standing: motor's torque over inertia (simulator)",
    ),
    number("hardware.flat", "m/s", 0.5, 12.0, "strongest flat kick (simulator)"),
    number("hardware.chip", "m/s", 0.0, 12.0, "strongest chip along its path; 0: none (simulator)"),
    number("hardware.recharge", "s", 0.05, 20.0, "from kick to kick (simulator)"),
    number("hardware.pull", "m/s²", 0.0, 20.0, "what the roller pulls a ball with at full speed (simulator)"),
];

impl Key {
    /// The table it stands in; empty for the top of the file.
    pub fn table(&self) -> &'static str {
        self.path.rsplit_once('.').map_or("", |(table, _)| table)
    }

    /// Name within the table.
    pub fn name(&self) -> &'static str {
        self.path.rsplit_once('.').map_or(self.path, |(_, name)| name)
    }

    /// Type and range as text, with the unit.
    pub fn allowed(&self) -> String {
        let unit = if self.unit.is_empty() { String::new() } else { format!(" {}", self.unit) };
        match self.kind {
            Kind::Number(low, high) => format!("{low} to {high}{unit}"),
            Kind::Whole(low, high) => format!("a whole number, {low} to {high}{unit}"),
            Kind::Angles => "three or four angles, -180 to 180 degrees".to_owned(),
            Kind::PerWheel(low, high, absent) => {
                let absent = absent.map_or(String::new(), |absent| format!("; {absent} where it is absent"));
                format!("{low} to {high}{unit}, or a list with one for each wheel{absent}")
            }
            Kind::Outputs => {
                "different numbers from 1 to 4, one for each wheel; absent: 1, 2, 3, 4".to_owned()
            }
            Kind::Pulses => "2 to 16 pairs [m/s, µs], both rising, at most 15 m/s and 6000 µs".to_owned(),
            Kind::Word(words) => words.join(", "),
            Kind::Name => "1 to 32 letters, digits, - and _".to_owned(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_key_is_there_once() {
        let mut paths: Vec<_> = KEYS.iter().map(|key| key.path).collect();
        paths.sort_unstable();
        assert!(paths.windows(2).all(|pair| pair[0] != pair[1]));
        let nested = KEYS.iter().find(|key| key.path == "assumed.pass.speed").unwrap();
        assert_eq!((nested.table(), nested.name(), KEYS[0].table()), ("assumed.pass", "speed", ""));
    }
}
