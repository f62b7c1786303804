//! `parameters`: what a team sets, each once: key, unit, range, meaning and its value in a
//! [`TeamConfig`]. The text of a `team.toml`, the errors of its ranges and the list as JSON are made from
//! [`PARAMETERS`].
//!
//! Reading is the other half: the fields of [`super::TeamSettings`]; a test holds the two to the same keys.

use std::fmt;
use std::ops::RangeInclusive;

use protocol::RobotId;
use serde::Serialize;
use toml::Value;

use super::{ConfigError, TeamConfig, TeamSettings, error};

/// One parameter of a team.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// Key in `team.toml`, after its table and a dot where it is in one: `keeper`, `ball.roll`.
    pub key: &'static str,
    /// Unit of the value; empty where it has none.
    pub unit: &'static str,
    /// Least and greatest value, in `unit`; none: not a number, or any that its type takes.
    pub range: Option<RangeInclusive<f32>>,
    /// Meaning of the value, and the words it takes.
    pub meaning: &'static str,
    /// Default where it is left out, and an example as it stands in the file; none: it always has a value.
    pub left_out: Option<(&'static str, &'static str)>,
    /// Whether it can change while a host runs ([`TeamConfig::changed`]).
    pub live: bool,
    /// Place of its value in a configuration.
    value: Holds,
}

/// Place in a configuration that holds a parameter; `None` is one that is not set.
#[derive(Clone, Copy, Debug)]
enum Holds {
    /// One value for the team.
    Once(fn(&TeamConfig) -> Option<Value>),
    /// One value for each robot that has another than the default.
    EachRobot(fn(&TeamConfig, RobotId) -> Option<Value>),
}

/// A parameter with its value, for a list of them.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ParameterValue {
    /// The parameter's key in `team.toml`.
    pub key: &'static str,
    /// The robot that it is for; none: the team.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub robot: Option<u8>,
    /// Unit of value and range.
    pub unit: &'static str,
    /// [`Parameter::range`], least and greatest.
    pub range: Option<[f32; 2]>,
    /// What the parameter changes, for operators.
    pub meaning: &'static str,
    /// Whether it can change while a host runs.
    pub live: bool,
    /// Whether each robot has its own.
    pub each_robot: bool,
    /// Present value; none: not set.
    pub value: Option<Value>,
    /// Value in an empty file; none: not set.
    pub default: Option<Value>,
}

impl Parameter {
    /// The table that it is in; none: the top of the file.
    pub fn table(&self) -> Option<&'static str> {
        self.key.split_once('.').map(|(table, _)| table)
    }

    /// Key within its table.
    pub fn name(&self) -> &'static str {
        self.key.split_once('.').map_or(self.key, |(_, name)| name)
    }

    /// Whether each robot has its own value.
    pub fn is_each_robots(&self) -> bool {
        matches!(self.value, Holds::EachRobot(_))
    }

    /// Value for the team; none: not set, or each robot has its own.
    pub(super) fn once(&self, config: &TeamConfig) -> Option<Value> {
        match self.value {
            Holds::Once(value) => value(config),
            Holds::EachRobot(_) => None,
        }
    }

    /// The robots that have another value than the default, with it.
    pub(super) fn robots(&self, config: &TeamConfig) -> Vec<(RobotId, Value)> {
        match self.value {
            Holds::Once(_) => Vec::new(),
            Holds::EachRobot(value) => {
                RobotId::all().filter_map(|id| Some((id, value(config, id)?))).collect()
            }
        }
    }

    /// `number`, or the error that names key, value and range.
    pub(super) fn checked(&self, number: f32) -> Result<f32, ConfigError> {
        match &self.range {
            Some(range) if !range.contains(&number) => Err(error(self.key, format!("{number}; {self}"))),
            _ => Ok(number),
        }
    }
}

impl fmt::Display for Parameter {
    /// Meaning with range and unit.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.meaning)?;
        if let Some(range) = &self.range {
            write!(f, ", {} to {}", range.start(), range.end())?;
        }
        if !self.unit.is_empty() {
            write!(f, " {}", self.unit)?;
        }
        self.left_out.map_or(Ok(()), |(then, _)| write!(f, "; left out: {then}"))
    }
}

impl TeamConfig {
    /// Every parameter with its value, in the file's order; one of each robot once for each that has another
    /// than the default, and once without a robot where none has.
    pub fn parameters(&self) -> Vec<ParameterValue> {
        let usual = TeamSettings::default().complete().ok();
        let mut list = Vec::new();
        for parameter in &PARAMETERS {
            let Parameter { key, unit, meaning, live, .. } = *parameter;
            let each_robot = parameter.is_each_robots();
            let range = parameter.range.as_ref().map(|range| [*range.start(), *range.end()]);
            let default = usual.as_ref().and_then(|usual| parameter.once(usual));
            let one = |robot: Option<RobotId>, value| ParameterValue {
                key,
                robot: robot.map(RobotId::number),
                unit,
                range,
                meaning,
                live,
                each_robot,
                value,
                default: default.clone(),
            };
            let robots = parameter.robots(self);
            if robots.is_empty() {
                list.push(one(None, parameter.once(self)));
            }
            list.extend(robots.into_iter().map(|(id, value)| one(Some(id), Some(value))));
        }
        list
    }
}

/// The value with the digits of its shortest form: 0.41, and not 0.4099999964.
fn decimal(number: f32) -> Value {
    Value::from(number.to_string().parse().unwrap_or(f64::from(number)))
}

fn text_of(value: &dyn fmt::Display) -> Value {
    Value::from(value.to_string())
}

const fn usual(
    key: &'static str,
    meaning: &'static str,
    value: fn(&TeamConfig) -> Option<Value>,
) -> Parameter {
    Parameter { key, unit: "", range: None, meaning, left_out: None, live: false, value: Holds::Once(value) }
}

const fn optional(
    key: &'static str,
    meaning: &'static str,
    left_out: (&'static str, &'static str),
    value: fn(&TeamConfig) -> Option<Value>,
) -> Parameter {
    Parameter { left_out: Some(left_out), ..usual(key, meaning, value) }
}

const fn practice(
    key: &'static str,
    meaning: &'static str,
    left_out: (&'static str, &'static str),
    value: fn(&TeamConfig) -> Option<Value>,
) -> Parameter {
    Parameter { live: true, ..optional(key, meaning, left_out, value) }
}

/// Deceleration of a rolling ball; the range is that of [`crate::learned`].
pub(super) const ROLL: Parameter = Parameter {
    key: "ball.roll",
    unit: "m/s²",
    range: Some(0.05..=1.5),
    meaning: "deceleration of a rolling ball",
    left_out: Some(("vision's", "0.41")),
    live: true,
    value: Holds::Once(|config| config.roll.map(decimal)),
};

/// Range of a kicker's gain (ball speed over speed ordered), as [`crate::learned`] bounds it.
pub(crate) const KICK_RANGE: RangeInclusive<f32> = 0.4..=2.0;

/// The gain of a robot's kicker.
pub(crate) const KICK: Parameter = Parameter {
    key: "calibration.kick",
    unit: "",
    range: Some(KICK_RANGE),
    meaning: "kick gain: measured / ordered ball speed",
    left_out: Some(("1", "1.06")),
    live: true,
    value: Holds::EachRobot(|config, id| {
        Some(config.kick[id.index()]).filter(|factor| *factor != 1.0).map(decimal)
    }),
};

/// The radio number of a robot.
pub(crate) const RADIO: Parameter = Parameter {
    key: "numbers.radio",
    unit: "",
    range: Some(0.0..=15.0),
    meaning: "number that a robot was flashed with, where its shell has another",
    left_out: Some(("the shell's", "0")),
    live: true,
    value: Holds::EachRobot(|config, id| {
        config.numbers.given(id).map(|radio| Value::from(i64::from(radio.number())))
    }),
};

/// Greatest speed of our robots; the least is what a robot accepts
/// ([`DriveLimits::SPEED_MIN`](protocol::host::DriveLimits)), the greatest beyond every robot of the league.
pub(super) const SPEED: Parameter = Parameter {
    key: "limits.speed",
    unit: "m/s",
    range: Some(0.3..=6.0),
    meaning: "greatest speed of our robots",
    left_out: Some(("their own limit", "2.0")),
    live: true,
    value: Holds::Once(|config| config.limits.speed.map(decimal)),
};

/// Greatest acceleration of our robots; the bounds are those of [`SPEED`], likewise.
pub(super) const ACCELERATION: Parameter = Parameter {
    key: "limits.acceleration",
    unit: "m/s²",
    range: Some(0.5..=10.0),
    meaning: "greatest acceleration of our robots; they brake as before",
    left_out: Some(("their own limit", "2.5")),
    live: true,
    value: Holds::Once(|config| config.limits.acceleration.map(decimal)),
};

/// Channel of a base station; the range is that of [`protocol::station::RadioPlan`].
pub(super) const CHANNEL: Parameter = Parameter {
    range: Some(2.0..=80.0),
    unit: "MHz above 2400",
    ..optional(
        "radio.channel",
        "where a base station and its robots are on the air",
        ("by the team's number", "40"),
        |c| c.air.channel.map(|channel| Value::from(i64::from(channel))),
    )
};

/// Rate of a base station on the air.
pub(super) const AIR_RATE: Parameter = Parameter {
    range: Some(1.0..=2.0),
    unit: "Mbit/s",
    ..optional("radio.rate", "rate of a base station on the air", ("2", "1"), |c| {
        c.air.rate.map(|rate| Value::from(i64::from(rate)))
    })
};

/// Every parameter, in the order of the file: those of no table first.
pub const PARAMETERS: [Parameter; 27] = [
    usual("name", "as the game controller knows the team", |c| Some(text_of(&c.name))),
    usual("colour", "blue or yellow", |c| Some(text_of(&c.colour.label()))),
    usual("league", "ssl-2013, division-b or division-a", |c| Some(text_of(&c.league.name()))),
    Parameter {
        range: Some(0.0..=15.0),
        ..usual("keeper", "our goalkeeper until the referee names another", |c| {
            Some(Value::from(i64::from(c.keeper.number())))
        })
    },
    optional("interface", "interface for multicast", ("every interface", "\"eth0\""), |c| {
        c.interface.as_ref().map(|name| text_of(name))
    }),
    usual("robots", "sim://HOST, udp://HOST:PORT or serial:DEVICE[:BAUD]", |c| Some(text_of(&c.robots))),
    optional("key_file", "32 hexadecimal digits", ("zeros, for sim:// only", "\"team.key\""), |c| {
        c.key_file.as_ref().map(|path| text_of(&path.display()))
    }),
    usual("insecure_zero_key", "true: real robots may use the key of zeros, which is public", |c| {
        Some(Value::from(c.insecure_zero_key))
    }),
    usual("vision", "multicast group and port of vision", |c| Some(text_of(&c.vision))),
    usual("referee", "multicast group and port of the referee", |c| Some(text_of(&c.referee))),
    optional(
        "referee_source",
        "accept only this referee: address or identifier",
        ("the strictest", "\"192.168.1.5\""),
        |c| c.referee_source.as_ref().map(|pin| text_of(pin)),
    ),
    usual("referee_silence", "after 2 s without a referee: halt, or go-on by its last command", |c| {
        Some(text_of(&c.referee_silence.label()))
    }),
    usual("tracker", "where our tracker's packets go", |c| Some(text_of(&c.tracker))),
    optional(
        "tracker_in",
        "another program's tracker in place of vision while it sends: HOST:PORT[,NAME]",
        ("vision alone", "\"224.5.23.2:10010,TIGERs\""),
        |c| c.tracker_in.as_ref().map(|tracker| text_of(tracker)),
    ),
    optional(
        "game_controller",
        "its port for teams",
        ("no messages to the controller", "\"127.0.0.1:10008\""),
        |c| c.game_controller.map(|address| text_of(&address)),
    ),
    optional(
        "strategy",
        "program that gives the orders",
        ("the coach does", "\"python3 my_team.py\""),
        |c| c.strategy.as_ref().map(|command| text_of(command)),
    ),
    Parameter {
        live: true,
        ..usual(
            "tactics",
            "the coach's: default, none, all, round-1, or some of threats, second-level, pass-ahead, coerce, attack, bridge, rated, by-score",
            |config| Some(text_of(&config.tactics.description())),
        )
    },
    ROLL,
    SPEED,
    ACCELERATION,
    CHANNEL,
    AIR_RATE,
    practice(
        "practice.within",
        "played in: half +x, -x, +y or -y, or X,Y,X,Y in mm; what is seen beyond is ignored",
        ("all of the field", "\"+x\""),
        |c| c.practice.words().within.map(Value::from),
    ),
    practice(
        "practice.without",
        "a rectangle that is left out, in the same words",
        ("nothing", "\"0,2000,1000,3000\""),
        |c| c.practice.words().without.map(Value::from),
    ),
    practice("practice.cameras", "cameras that are left out", ("none", "\"2,3\""), |c| {
        c.practice.words().cameras.map(Value::from)
    }),
    KICK,
    RADIO,
];

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<TeamConfig, ConfigError> {
        TeamSettings::from_toml(text).and_then(TeamSettings::complete)
    }

    #[test]
    fn the_written_file_and_the_list_as_json_have_the_same_parameters() {
        let config = read("[[calibration]]\nrobot = 3\nkick = 1.06").unwrap();
        let json = serde_json::to_value(config.parameters()).unwrap();
        let listed: Vec<&str> =
            json.as_array().unwrap().iter().filter_map(|one| one["key"].as_str()).collect();
        let mut table = String::new();
        let mut written = Vec::new();
        for line in config.to_toml().lines() {
            let line = line.trim_start_matches("# ");
            if line.starts_with('[') {
                table = line.trim_matches(['[', ']']).to_owned() + ".";
            } else if let Some((name, _)) = line.split_once(" = ")
                && !name.contains(' ')
                && name != "robot"
            {
                written.push(format!("{table}{name}"));
            }
        }
        assert_eq!(listed, written);
        assert_eq!(listed.len(), PARAMETERS.len());
    }

    #[test]
    fn a_number_out_of_its_range_is_refused_with_key_value_and_range() {
        let refused = |text: &str| read(text).unwrap_err().to_string();
        let error = refused("[ball]\nroll = 1.6");
        assert!(error.contains("ball.roll: 1.6;") && error.contains("0.05 to 1.5 m/s²"), "{error}");
        let error = refused("[[calibration]]\nrobot = 1\nkick = 0.3");
        assert!(error.contains("calibration.kick: robot 1: 0.3;") && error.contains("0.4 to 2"), "{error}");
        for good in ["[ball]\nroll = 1.5", "[[calibration]]\nrobot = 1\nkick = 0.4"] {
            assert!(read(good).is_ok(), "{good}");
        }
        assert!(refused("[ball]\nroll = nan").contains("ball.roll"));
    }

    #[test]
    fn what_differs_from_an_empty_file_is_marked_and_nothing_else() {
        let changed = |text: &str| -> Vec<_> {
            let list = read(text).unwrap().parameters();
            list.into_iter().filter(|one| one.value != one.default).map(|one| (one.key, one.robot)).collect()
        };
        assert_eq!(changed(""), []);
        assert_eq!(changed("keeper = 0\ncolour = 'blue'"), []);
        let text = "keeper = 4\n[ball]\nroll = 0.41\n[[calibration]]\nrobot = 3\nkick = 1.06";
        assert_eq!(changed(text), [("keeper", None), ("ball.roll", None), ("calibration.kick", Some(3))]);
        let list = read(text).unwrap().parameters();
        assert_eq!(list[17].value, Some(Value::from(0.41)));
    }
}
