//! `numbers`: radio numbers of shells, `[[numbers]]` in team.toml.

use protocol::RobotId;
use serde::Deserialize;

use super::{ConfigError, error, parameters, robot_id};
use crate::radio::RobotNumbers;

/// A robot's number on its shell, and the one that it was flashed with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RadioNumber {
    /// Number on the shell, 0–15.
    pub robot: u8,
    /// Number that it was flashed with, 0–15; none: as if the entry were left out.
    #[serde(default)]
    pub radio: Option<u8>,
}

/// The mapping that these entries give; an error where two shells would have one number.
pub(super) fn parse(entries: &[RadioNumber]) -> Result<RobotNumbers, ConfigError> {
    let mut given = [None; RobotId::COUNT];
    for entry in entries {
        let shell = robot_id("numbers.robot", entry.robot)?;
        given[shell.index()] = entry.radio.map(|radio| robot_id(parameters::RADIO.key, radio)).transpose()?;
    }
    RobotNumbers::new(given).map_err(|[one, other]| {
        let description = format!("robots {one} and {other} are given the same; give each another");
        error(parameters::RADIO.key, description)
    })
}
