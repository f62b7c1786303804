//! `air`: where a base station and its robots are on the air, `[radio]` in team.toml.

use protocol::TeamId;
use protocol::frame::TeamKey;
use protocol::station::RadioPlan;
use serde::Deserialize;

use super::{ConfigError, parameters};

/// Place of a base station and its robots on the air.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AirSettings {
    /// MHz above 2,400; left out: by the team's number.
    pub channel: Option<u8>,
    /// Mbit/s on the air, 1 or 2; left out: 2.
    pub rate: Option<u8>,
}

impl AirSettings {
    /// The team's channel, MHz above 2,400.
    pub fn channel_of(&self, team: TeamId) -> u8 {
        self.channel.unwrap_or(RadioPlan::of_team(team).channel)
    }

    /// The plan of a team with that key, by which its radios have addresses of their own.
    pub fn plan(&self, team: TeamId, key: TeamKey) -> RadioPlan {
        let default = RadioPlan::of_team(team);
        RadioPlan {
            channel: self.channel_of(team),
            megabits: self.rate.unwrap_or(default.megabits),
            address: key.of_team().team().radio_address(),
        }
    }

    pub(super) fn checked(self) -> Result<Self, ConfigError> {
        for (parameter, value) in [(&parameters::CHANNEL, self.channel), (&parameters::AIR_RATE, self.rate)] {
            value.map(|value| parameter.checked(f32::from(value))).transpose()?;
        }
        Ok(self)
    }
}
