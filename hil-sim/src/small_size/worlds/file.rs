//! `file`: named profiles: what a file of `hil-sim/data/worlds` changes in a league's parameters, checked;
//! each number with its source there.
//!
//! Tables `ball`, `field`, `bounce`, `robot`, `drive`, `kick`, `dribbler`, `battery`, `camera` and `noise`
//! hold keys of the league's file; `spread`, `link` and `vision` those of [`RobotSpread`], [`LinkModel`] and
//! [`VisionModel`]; `bystanders` is a number. Keys that a file leaves out keep the league's value.

use std::fmt;

use serde::{Deserialize, Serialize};
use thiserror::Error;
use toml::{Table, Value};

use super::{LinkModel, NamedWorld, RobotSpread, VisionModel, WorldModel};
use crate::parameters::{ParameterError, within};
use crate::small_size::Parameters;

impl NamedWorld {
    /// The text of its file.
    pub const fn text(self) -> &'static str {
        match self {
            Self::Grsim => include_str!("../../../data/worlds/grsim.toml"),
            Self::Erforce => include_str!("../../../data/worlds/erforce.toml"),
            Self::ErforceNone => include_str!("../../../data/worlds/erforce-none.toml"),
            Self::Sumatra => include_str!("../../../data/worlds/sumatra.toml"),
            Self::SlowDribbler => include_str!("../../../data/worlds/slow-dribbler.toml"),
            Self::PoorVision => include_str!("../../../data/worlds/poor-vision.toml"),
            Self::WeakKickers => include_str!("../../../data/worlds/weak-kickers.toml"),
        }
    }
}

/// Tables of a file besides the league's; not given: no difference.
#[derive(Clone, Debug, Default, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
struct Beside {
    spread: RobotSpread,
    link: LinkModel,
    vision: VisionModel,
    bystanders: u8,
}

impl WorldModel {
    /// `league` with the changes of the file `name` with this text.
    pub fn from_toml(name: &str, text: &str, league: &Parameters) -> Result<Self, WorldError> {
        let wrong = |error| WorldError { file: name.to_owned(), error };
        let syntax = |e: &dyn fmt::Display| wrong(ParameterError::Syntax(e.to_string()));
        let mut changes: Table = text.parse().map_err(|e: toml::de::Error| syntax(&e))?;
        let mut beside = Table::new();
        for key in ["spread", "link", "vision", "bystanders"] {
            beside.extend(changes.remove(key).map(|value| (key.to_owned(), value)));
        }
        let beside: Beside = Value::Table(beside).try_into().map_err(|e: toml::de::Error| syntax(&e))?;
        let mut whole = Table::try_from(league).map_err(|e| syntax(&e))?;
        for (table, keys) in changes {
            match (whole.get_mut(&table), keys) {
                (Some(Value::Table(of_league)), Value::Table(keys)) => of_league.extend(keys),
                (Some(_), _) => return Err(syntax(&format!("{table} is the league's, not a world's"))),
                (None, _) => return Err(syntax(&format!("there is no table {table}"))),
            }
        }
        let parameters: Parameters =
            Value::Table(whole).try_into().map_err(|e: toml::de::Error| syntax(&e))?;
        let Beside { spread, link, vision, bystanders } = beside;
        let model = Self { name: name.to_owned(), parameters, robots: spread, link, vision, bystanders };
        model.check().map_err(wrong)?;
        Ok(model)
    }

    /// Checks every number against the limits of the physics.
    pub fn check(&self) -> Result<(), ParameterError> {
        self.parameters.check()?;
        let Self { robots: of, link, vision, .. } = self;
        for (name, [low, high], [least, most]) in [
            ("spread.kick_gain (from, to)", of.kick_gain, [0.1, 2.0]),
            ("spread.chip_ratio (from, to)", of.chip_ratio, [0.1, 2.0]),
            ("spread.acceleration (from, to)", of.acceleration, [0.1, 2.0]),
            ("spread.speed (from, to)", of.speed, [0.1, 2.0]),
            ("spread.pull (from, to)", of.pull, [0.0, 2.0]),
            ("spread.slip (from, to)", of.slip, [0.0, 0.5]),
            ("vision.gap_ms (from, to)", vision.gap_ms.map(|ms| ms as f32), [0.0, 1000.0]),
            ("vision.swap_frames (from, to)", vision.swap_frames.map(|n| n as f32), [0.0, 1000.0]),
        ] {
            within(name, low, least, most)?;
            within(name, high, low, most)?;
        }
        within("link.latency_ms", link.latency_ms as f32, 0.0, 500.0)?;
        within("link.jitter_ms", link.jitter_ms as f32, 0.0, 500.0)?;
        within("link.loss", link.loss, 0.0, 0.9)?;
        within("vision.jitter_ms", vision.jitter_ms as f32, 0.0, 500.0)?;
        within("vision.gap_every_s", vision.gap_every_s, 0.0, 1e6)?;
        within("vision.swap_every_s", vision.swap_every_s, 0.0, 1e6)?;
        within("bystanders", f32::from(self.bystanders), 0.0, 20.0)
    }
}

/// Error of a profile, with the file that has it.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("world {file}: {error}")]
pub struct WorldError {
    /// Name of the file.
    pub file: String,
    /// Error in the file.
    pub error: ParameterError,
}

#[cfg(test)]
mod tests {
    use rules::League;

    use super::*;
    use crate::small_size::worlds::WorldChoice;

    const LEAGUES: [League; 3] = [League::Ssl2013, League::DivisionB, League::DivisionA];

    fn read(text: &str) -> Result<WorldModel, WorldError> {
        WorldModel::from_toml("a-world", text, Parameters::of(League::DivisionB).unwrap())
    }

    #[test]
    fn every_profile_loads_in_every_league_and_changes_something() {
        for named in NamedWorld::ALL {
            for league in LEAGUES {
                let of_league = Parameters::of_file(league).unwrap();
                let model = WorldModel::from_toml(named.label(), named.text(), of_league).unwrap();
                assert_ne!(
                    WorldModel { name: "nominal".into(), ..model.clone() },
                    WorldModel::nominal(of_league.clone())
                );
                let described = model.parameters.for_robot(&rules::RobotSpec::OURS);
                let model = WorldModel { parameters: described, ..model };
                assert_eq!(WorldModel::of(league, &WorldChoice::Named(named)), Some(model));
            }
            assert_eq!(WorldModel::of(League::FourLegged, &WorldChoice::Named(named)), None);
        }
    }

    #[test]
    fn every_number_of_a_profile_has_its_source_beside_it() {
        for named in NamedWorld::ALL {
            for line in named.text().lines().filter(|line| line.contains(" = ")) {
                let source = line.split_once('#').map_or("", |(_, comment)| comment);
                assert!(source.contains('['), "{}: {line}", named.label());
            }
        }
    }

    #[test]
    fn an_empty_profile_is_the_leagues_world() {
        let nominal = WorldModel::of(League::DivisionB, &WorldChoice::Nominal).unwrap();
        assert_eq!(read("").unwrap(), WorldModel { name: "a-world".into(), ..nominal });
    }

    #[test]
    fn errors_name_file_key_and_bound() {
        let refuse = |text: &str, parts: &[&str]| {
            let error = read(text).unwrap_err().to_string();
            for part in parts.iter().chain(&["a-world"]) {
                assert!(error.contains(part), "{text}: {error}");
            }
        };
        refuse("[ball]\nroll = -0.1", &["ball.roll", "-0.1", "0.0001", "10"]);
        refuse("[dribbler]\npull = inf", &["dribbler.pull", "1000"]);
        refuse("[link]\nloss = 1.5", &["link.loss", "1.5", "0.9"]);
        refuse("[link]\nlatency_ms = 0.5", &["latency_ms"]);
        refuse("[spread]\nkick_gain = [1.1, 0.6]", &["spread.kick_gain", "0.6", "1.1"]);
        refuse("[vision]\ngap_ms = [150, 40]", &["vision.gap_ms", "40", "150"]);
        refuse("[vision]\ngaps = 3", &["gaps"]);
        refuse("[ball]\nrol = 0.3", &["rol"]);
        refuse("[bal]\nroll = 0.3", &["no table bal"]);
        refuse("robots = 7", &["robots is the league's"]);
        refuse("bystanders = 21", &["bystanders", "21", "20"]);
        refuse("bystanders = 300", &["bystanders"]);
        refuse("[ball", &["parameters"]);
    }
}
