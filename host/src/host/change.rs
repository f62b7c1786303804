//! `change`: changes of a parameter while a host runs.

use protocol::RobotId;

use super::{Host, InputVerdict};
use crate::config::parameters::KICK;
use crate::config::{ConfigError, ParameterChange, TeamConfig};

impl Host {
    /// Handles the JSON of a [`ParameterChange`]: all of it holds from the next plan on, or nothing of it.
    pub(super) fn handle_parameter(&mut self, json: &[u8]) -> InputVerdict {
        match self.apply_change(json) {
            Ok(()) => InputVerdict::Changed,
            Err(refused) => InputVerdict::NotChanged(refused),
        }
    }

    fn apply_change(&mut self, json: &[u8]) -> Result<(), ConfigError> {
        let change = ParameterChange::from_json(json)?;
        let before = self.settings.clone();
        TeamConfig::of(&before)?.changed(&change)?.apply(&mut self.settings);
        let settings = &self.settings;
        if settings.radio.numbers != before.radio.numbers {
            self.radio.renumber(settings.radio.numbers);
            // They were reports of other robots.
            self.robots = Default::default();
        }
        if change.key == KICK.key
            && let Some(robot) = change.robot.and_then(RobotId::new)
        {
            // Without a value what is learned holds again.
            self.gain_set.set(robot, change.value.is_some());
        }
        if settings.tactics != before.tactics {
            self.coach.set_tactics(settings.tactics, settings.league);
        }
        if settings.limits != before.limits {
            self.send_limits();
        }
        match self.settings.roll {
            Some(roll) if before.roll != Some(roll) => self.roll_with(roll),
            None if before.roll.is_some() => self.roll_as_seen(),
            _ => {}
        }
        Ok(())
    }

    /// Sends the robots their limits from now on.
    pub(super) fn send_limits(&mut self) {
        let [speed, acceleration] = self.settings.limits.on_air();
        self.radio.limit(speed, acceleration);
    }
}
