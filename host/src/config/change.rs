//! `change`: changes of one parameter: written into the text of a `team.toml` (comments and order stay), and
//! from there into a running host's settings, so that a change is checked as the file is.

use protocol::RobotId;
use protocol::host::DriveLimits;
use serde::{Deserialize, Serialize};
use toml::Value;
use toml_edit::{ArrayOfTables, DocumentMut, Item, Table};

use super::parameters::{ACCELERATION, PARAMETERS, Parameter, SPEED};
use super::{ConfigError, TeamConfig, TeamSettings, error};
use crate::HostSettings;

/// Longest part of an unknown key that is told, characters.
const KEY_CHARS_MAX: usize = 40;

/// A new value for a parameter, as the page sends it and a trace keeps it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ParameterChange {
    /// The parameter's key, as [`Parameter::key`].
    pub key: String,
    /// The robot that it is for, where the parameter is each robot's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub robot: Option<u8>,
    /// The value; none: what holds where the parameter is left out.
    #[serde(default)]
    pub value: Option<Value>,
}

impl ParameterChange {
    /// From the JSON of a request or a trace's record.
    pub fn from_json(json: &[u8]) -> Result<Self, ConfigError> {
        serde_json::from_slice(json).map_err(|broken| error("parameter", broken.to_string()))
    }

    /// JSON of the change, for a trace.
    pub fn to_json(&self) -> String {
        // Strings and numbers: JSON can represent all of it but a number that is none, which reads as no
        // value.
        serde_json::to_string(self).unwrap_or_default()
    }

    /// The parameter, if the change names one and a robot where it must.
    fn parameter(&self) -> Result<&'static Parameter, ConfigError> {
        let Some(parameter) = PARAMETERS.iter().find(|parameter| parameter.key == self.key) else {
            return Err(error(
                "parameter",
                format!("`{}` is none", foreign::excerpt(&self.key, KEY_CHARS_MAX)),
            ));
        };
        match (parameter.is_each_robots(), self.robot) {
            (true, None) => Err(error(parameter.key, "it is a robot's: name the robot, 0 to 15")),
            (false, Some(_)) => Err(error(parameter.key, "it is the team's: leave the robot out")),
            (true, Some(number)) if RobotId::new(number).is_none() => {
                Err(error(parameter.key, format!("{number} is no robot; ids are 0 to 15")))
            }
            _ => Ok(parameter),
        }
    }

    /// The text of a `team.toml` with this change; all else stays as it is.
    pub fn write_into(&self, text: &str) -> Result<String, ConfigError> {
        let parameter = self.parameter()?;
        let mut file: DocumentMut =
            text.parse().map_err(|broken: toml_edit::TomlError| error("team.toml", broken.to_string()))?;
        let broken = || error(parameter.key, "the file has something else under this name");
        if let (true, Some(table)) = (parameter.is_each_robots(), parameter.table()) {
            let item = file.entry(table).or_insert(Item::ArrayOfTables(ArrayOfTables::new()));
            let list = item.as_array_of_tables_mut().ok_or_else(broken)?;
            self.write_robot(parameter, list)?;
        } else if let Some(table) = parameter.table() {
            let mut fresh = Table::new();
            fresh.set_implicit(self.value.is_none());
            let item = file.entry(table).or_insert(Item::Table(fresh));
            self.write_value(parameter, item.as_table_mut().ok_or_else(broken)?)?;
        } else {
            self.write_value(parameter, file.as_table_mut())?;
        }
        Ok(file.to_string())
    }

    fn write_robot(&self, parameter: &Parameter, list: &mut ArrayOfTables) -> Result<(), ConfigError> {
        let robot = i64::from(self.robot.unwrap_or_default());
        // The last of a robot's entries holds.
        let found = list
            .iter_mut()
            .filter(|table| table.get("robot").and_then(Item::as_integer) == Some(robot))
            .last();
        if let Some(table) = found {
            return self.write_value(parameter, table);
        }
        if self.value.is_some() {
            let mut table = Table::new();
            table.insert("robot", toml_edit::value(robot));
            self.write_value(parameter, &mut table)?;
            list.push(table);
        }
        Ok(())
    }

    fn write_value(&self, parameter: &Parameter, table: &mut Table) -> Result<(), ConfigError> {
        let name = parameter.name();
        let Some(value) = &self.value else {
            table.remove(name);
            return Ok(());
        };
        let value = match value {
            Value::Boolean(on) => toml_edit::Value::from(*on),
            Value::Integer(number) => (*number).into(),
            Value::Float(number) => (*number).into(),
            Value::String(text) => text.as_str().into(),
            _ => return Err(error(parameter.key, "expected a number, a word, true or false")),
        };
        match table.get_mut(name).and_then(Item::as_value_mut) {
            // What stands behind it on its line stays there.
            Some(had) => {
                let decor = had.decor().clone();
                *had = value;
                *had.decor_mut() = decor;
            }
            None => _ = table.insert(name, Item::Value(value)),
        }
        Ok(())
    }
}

impl TeamConfig {
    /// This configuration as it is with `change`, checked as a file is. Refused are parameters that a host
    /// reads only when it starts.
    pub fn changed(&self, change: &ParameterChange) -> Result<Self, ConfigError> {
        let parameter = change.parameter()?;
        if !parameter.live {
            let description = "read when the program starts: write it into team.toml and start again";
            return Err(error(parameter.key, description));
        }
        let text = change.write_into(&self.to_toml())?;
        TeamSettings::from_toml(&text)?.complete()
    }

    /// The configuration that a host with these settings has of what concerns it; all else as in an empty
    /// file.
    pub fn of(settings: &HostSettings) -> Result<Self, ConfigError> {
        let usual = TeamSettings::default().complete()?;
        let usual = Self { colour: settings.us, league: settings.league, keeper: settings.keeper, ..usual };
        Ok(usual.with_live(settings))
    }

    /// This one with the host's present values of all that can change while it runs.
    #[must_use]
    pub fn with_live(mut self, settings: &HostSettings) -> Self {
        self.kick = settings.kick;
        self.numbers = settings.radio.numbers;
        self.roll = settings.roll;
        self.limits = settings.limits;
        self.tactics = settings.tactics;
        self.practice = settings.practice;
        self
    }

    /// Gives a host's settings this one's values of all that can change while it runs.
    pub(crate) fn apply(&self, settings: &mut HostSettings) {
        settings.kick = self.kick;
        settings.radio.numbers = self.numbers;
        settings.roll = self.roll;
        settings.limits = self.limits;
        settings.tactics = self.tactics;
        settings.practice = self.practice;
    }
}

/// Limits of our robots' motion; their own limits hold where they are stricter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DriveSettings {
    /// Greatest speed of our robots, m/s.
    pub speed: Option<f32>,
    /// Greatest acceleration of our robots, m/s².
    pub acceleration: Option<f32>,
}

impl DriveSettings {
    /// The same, if both are within their ranges.
    pub(crate) fn checked(self) -> Result<Self, ConfigError> {
        let within = |parameter: &Parameter, limit: Option<f32>| {
            limit.map(|limit| parameter.checked(limit)).transpose()
        };
        Ok(Self {
            speed: within(&SPEED, self.speed)?,
            acceleration: within(&ACCELERATION, self.acceleration)?,
        })
    }

    /// Speed and acceleration as a host sends them, mm/s and mm/s² ([`DriveLimits`]).
    pub(crate) fn on_air(self) -> [u16; 2] {
        let millimetres = |limit: Option<f32>| limit.map_or(DriveLimits::NONE, |limit| (limit * 1e3) as u16);
        [millimetres(self.speed), millimetres(self.acceleration)]
    }
}

#[cfg(test)]
mod tests {
    use rules::{Colour, League};

    use super::*;

    fn change(json: &str) -> ParameterChange {
        ParameterChange::from_json(json.as_bytes()).unwrap()
    }

    fn usual() -> TeamConfig {
        TeamConfig::of(&HostSettings::new(Colour::Yellow, League::DivisionB, 1)).unwrap()
    }

    #[test]
    fn a_change_has_the_same_effect_as_the_line_in_the_file() {
        for (json, line) in [
            (r#"{"key":"ball.roll","value":0.41}"#, "[ball]\nroll = 0.41"),
            (r#"{"key":"limits.speed","value":2}"#, "[limits]\nspeed = 2.0"),
            (r#"{"key":"limits.acceleration","value":1.5}"#, "[limits]\nacceleration = 1.5"),
            (r#"{"key":"tactics","value":"none"}"#, "tactics = 'none'"),
            (r#"{"key":"practice.within","value":"+x"}"#, "[practice]\nwithin = '+x'"),
            (
                r#"{"key":"calibration.kick","robot":3,"value":1.06}"#,
                "[[calibration]]\nrobot = 3\nkick = 1.06",
            ),
            (r#"{"key":"numbers.radio","robot":4,"value":0}"#, "[[numbers]]\nrobot = 4\nradio = 0"),
        ] {
            let file = TeamSettings::from_toml(&format!("colour = 'yellow'\n{line}"));
            let changed = usual().changed(&change(json)).unwrap();
            assert_eq!(Ok(&changed), file.and_then(TeamSettings::complete).as_ref(), "{json}");
            assert_ne!(changed, usual(), "{json}");
            let back = ParameterChange { value: None, ..change(json) };
            assert_eq!(changed.changed(&back), Ok(usual()), "{json}");
            let mut settings = HostSettings::new(Colour::Yellow, League::DivisionB, 1);
            changed.apply(&mut settings);
            assert_eq!(TeamConfig::of(&settings), Ok(changed), "{json}");
        }
    }

    #[test]
    fn comments_and_order_of_the_file_stay() {
        let text = "# ours\nkeeper = 2 # the tall one\n\n[[calibration]]\nrobot = 3 # repaired\nkick = 1.06 # by hand\n\n[ball]\nroll = 0.41\n";
        let kick = change(r#"{"key":"calibration.kick","robot":3,"value":1.1}"#);
        assert_eq!(kick.write_into(text).unwrap(), text.replace("1.06", "1.1"));
        let other = change(r#"{"key":"calibration.kick","robot":5,"value":0.9}"#).write_into(text).unwrap();
        assert!(other.contains("robot = 5\nkick = 0.9") && other.contains("# repaired"), "{other}");
        let limits = change(r#"{"key":"limits.speed","value":1.5}"#).write_into(text).unwrap();
        assert_eq!(limits, format!("{text}\n[limits]\nspeed = 1.5\n"));
        let back = change(r#"{"key":"ball.roll"}"#).write_into(text).unwrap();
        assert!(!back.contains("roll = ") && back.contains("# by hand"), "{back}");
    }

    #[test]
    fn what_cannot_be_changed_is_refused_with_the_key_and_the_remedy() {
        for (json, key, part) in [
            (r#"{"key":"speed","value":1}"#, "parameter", "`speed` is none"),
            (r#"{"key":"vision","value":"127.0.0.1:1"}"#, "vision", "start again"),
            (r#"{"key":"ball.roll","robot":3,"value":0.4}"#, "ball.roll", "leave the robot out"),
            (r#"{"key":"calibration.kick","value":1.1}"#, "calibration.kick", "name the robot"),
            (r#"{"key":"calibration.kick","robot":16,"value":1.1}"#, "calibration.kick", "0 to 15"),
            (r#"{"key":"calibration.kick","robot":1,"value":9}"#, "calibration.kick", "0.4 to 2"),
            (r#"{"key":"limits.speed","value":0}"#, "limits.speed", "0.3 to"),
            (r#"{"key":"limits.speed","value":[1]}"#, "limits.speed", "expected a number"),
            (r#"{"key":"tactics","value":"hope"}"#, "tactics", "`hope` is no tactic"),
        ] {
            let refused = usual().changed(&change(json)).unwrap_err();
            assert!(refused.key == key && refused.description.contains(part), "{json}: {refused}");
        }
        let refused = usual().changed(&change(r#"{"key":"limits.speed","value":"fast"}"#)).unwrap_err();
        assert!(refused.description.contains("fast"), "{refused}");
        assert!(ParameterChange::from_json(b"[1]").is_err());
    }
}
