//! `text`: a team's settings as the text of a `team.toml`, every setting with what it means: for
//! `onetwo control --print-config` and `--init`.

use std::fmt::{self, Write as _};
use std::net::SocketAddr;

use serde::de::Error as _;
use serde::{Deserialize as _, Deserializer};
use ssl::net::{addresses, resolve, resolve_destination};

use super::parameters::PARAMETERS;
use super::{RobotLink, TeamConfig};

/// Comment at the head of a written `team.toml`.
const HEADING: &str = "\
# Settings of a team, for `onetwo control --config team.toml`; a flag of the same name overrules each.

";

impl TeamConfig {
    /// These settings as a `team.toml` that [`super::TeamSettings::from_toml`] reads; those that are not set
    /// are comments with an example.
    pub fn to_toml(&self) -> String {
        let mut text = String::from(HEADING);
        let mut table = None;
        for parameter in PARAMETERS.iter().filter(|parameter| !parameter.is_each_robots()) {
            if parameter.table() != table {
                table = parameter.table();
                let _ = writeln!(text, "\n[{}]", table.unwrap_or_default());
            }
            let name = parameter.name();
            let line = match (parameter.once(self), parameter.left_out) {
                (Some(value), _) => format!("{name} = {value}"),
                (None, left_out) => format!("# {name} = {}", left_out.map_or("", |(_, example)| example)),
            };
            let _ = writeln!(text, "{line:<40} # {parameter}");
        }
        for parameter in PARAMETERS.iter().filter(|parameter| parameter.is_each_robots()) {
            let _ = writeln!(text, "\n# {parameter}");
            let (table, name) = (parameter.table().unwrap_or_default(), parameter.name());
            let robots = parameter.robots(self);
            if robots.is_empty() {
                let example = parameter.left_out.map_or("", |(_, example)| example);
                let _ = writeln!(text, "# [[{table}]]\n# robot = 3\n# {name} = {example}");
            }
            for (id, value) in robots {
                let _ = writeln!(text, "[[{table}]]\nrobot = {id}\n{name} = {value}\n");
            }
        }
        text
    }
}

impl fmt::Display for RobotLink {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Simulator(host) => write!(f, "sim://{host}"),
            Self::Udp(address) => write!(f, "udp://{address}"),
            Self::Serial { device, baud } => write!(f, "serial:{device}:{baud}"),
        }
    }
}

/// An address to receive on, in a file of settings.
pub(super) fn address<'de, D: Deserializer<'de>>(file: D) -> Result<Option<SocketAddr>, D::Error> {
    read(file, |text| resolve(text, None))
}

/// An address to send to.
pub(super) fn destination<'de, D: Deserializer<'de>>(file: D) -> Result<Option<SocketAddr>, D::Error> {
    read(file, |text| resolve_destination(text, None))
}

/// A game controller's port for teams.
pub(super) fn team_port<'de, D: Deserializer<'de>>(file: D) -> Result<Option<SocketAddr>, D::Error> {
    read(file, |text| resolve_destination(text, Some(addresses::TEAM_PORT)))
}

fn read<'de, D: Deserializer<'de>>(
    file: D,
    resolve: fn(&str) -> Result<SocketAddr, String>,
) -> Result<Option<SocketAddr>, D::Error> {
    let text = String::deserialize(file)?;
    resolve(&text).map(Some).map_err(D::Error::custom)
}

#[cfg(test)]
mod tests {
    use super::super::TeamSettings;
    use super::*;

    fn read(text: &str) -> TeamConfig {
        TeamSettings::from_toml(text)
            .and_then(TeamSettings::complete)
            .unwrap_or_else(|error| panic!("{error}:\n{text}"))
    }

    #[test]
    fn settings_are_the_same_after_they_were_written_and_read() {
        let set = "name = 'A \"b\"'\ncolour = 'yellow'\nleague = 'division-a'\nkeeper = 7\ninterface = '10.0.0.1'\n\
                   robots = 'serial:COM3:115200'\nkey_file = 'a b.key'\ninsecure_zero_key = true\nvision = '127.0.0.1:1'\n\
                   referee = '127.0.0.1:2'\nreferee_source = 'gc'\nreferee_silence = 'go-on'\ntracker = '127.0.0.1:3'\ntracker_in = '127.0.0.1:5,a b'\n\
                   game_controller = '127.0.0.1:4'\nstrategy = 'python3 \"x y.py\"'\ntactics = 'threats,rated'\n[ball]\nroll = 0.41\n\
                   [limits]\nspeed = 1.7\nacceleration = 2.3\n[radio]\nchannel = 40\nrate = 1\n[practice]\nwithin = '-x'\nwithout = '0,0,9,9'\ncameras = '1,4'\n\
                   [[calibration]]\nrobot = 3\nkick = 1.06\n[[calibration]]\nrobot = 15\nkick = 0.9\n\
                   [[numbers]]\nrobot = 4\nradio = 0\n";
        for text in ["", set, "robots = 'udp://10.0.0.2:10'"] {
            let config = read(text);
            assert_eq!(read(&config.to_toml()), config, "{text}");
        }
    }

    #[test]
    fn every_setting_that_is_read_is_written() {
        let known = TeamSettings::from_toml("nonsense = 1").unwrap_err().description;
        let keys: Vec<&str> = known.split('`').skip(3).step_by(2).filter(|key| !key.contains(' ')).collect();
        assert!(keys.len() >= 17, "{keys:?} of {known}");
        let text = read("").to_toml();
        for key in keys {
            let written = [format!("\n{key} = "), format!("\n# {key} = "), format!("[{key}]")];
            assert!(written.iter().any(|form| text.contains(form)), "{key} is not in\n{text}");
        }
    }
}
