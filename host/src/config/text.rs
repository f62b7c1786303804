//! `text`: a team's settings as the text of a `team.toml`, every setting with what it means: for
//! `onetwo control --print-config` and `--init`.

use std::fmt::{self, Write as _};

use protocol::RobotId;
use toml::Value;

use super::{RobotLink, TeamConfig};

impl TeamConfig {
    /// These settings as a `team.toml` that [`super::TeamSettings::from_toml`] reads; those that are not set
    /// are comments with an example.
    pub fn to_toml(&self) -> String {
        let mut text = String::from(HEADING);
        let text_of = |value: &dyn fmt::Display| Value::from(value.to_string());
        let path = self.key_file.as_ref().map(|path| text_of(&path.display()));
        let rows: [(&str, Option<Value>, &str, &str); 15] = [
            ("name", Some(text_of(&self.name)), "", "as the game controller knows the team"),
            ("colour", Some(text_of(&self.colour.label())), "", "blue or yellow"),
            ("league", Some(text_of(&self.league.name())), "", "ssl-2013, division-b or division-a"),
            (
                "keeper",
                Some(Value::from(i64::from(self.keeper.number()))),
                "",
                "0 to 15; the referee may change it",
            ),
            (
                "interface",
                self.interface.map(|ip| text_of(&ip)),
                "\"192.168.1.7\"",
                "interface for multicast; left out: every interface",
            ),
            (
                "robots",
                Some(text_of(&self.robots)),
                "",
                "sim://HOST, udp://HOST:PORT or serial:DEVICE[:BAUD]",
            ),
            ("key_file", path, "\"team.key\"", "32 hexadecimal digits; may be left out for sim:// only"),
            (
                "insecure_zero_key",
                Some(Value::from(self.insecure_zero_key)),
                "",
                "true: real robots may use the key of zeros, which is public",
            ),
            ("vision", Some(text_of(&self.vision)), "", "multicast group and port of vision"),
            ("referee", Some(text_of(&self.referee)), "", "multicast group and port of the referee"),
            (
                "referee_source",
                self.referee_source.as_ref().map(|pin| text_of(pin)),
                "\"192.168.1.5\"",
                "only referee obeyed: address or identifier; left out: the strictest",
            ),
            (
                "referee_silence",
                Some(text_of(&self.referee_silence.label())),
                "",
                "after 2 s without a referee: halt, or go-on by its last command",
            ),
            ("tracker", Some(text_of(&self.tracker)), "", "where our tracker's packets go"),
            (
                "game_controller",
                self.game_controller.map(|address| text_of(&address)),
                "\"127.0.0.1:10008\"",
                "its port for teams; left out: no messages to the controller",
            ),
            (
                "strategy",
                self.strategy.as_ref().map(|command| text_of(command)),
                "\"python3 my_team.py\"",
                "program that gives the orders; left out: the coach does",
            ),
        ];
        for (key, value, example, comment) in rows {
            let line = match value {
                Some(value) => format!("{key} = {value}"),
                None => format!("# {key} = {example}"),
            };
            let _ = writeln!(text, "{line:<40} # {comment}");
        }
        let _ = writeln!(text, "\n[ball]");
        let roll = self.roll.map_or("# roll = 0.41".to_owned(), |roll| format!("roll = {roll:?}"));
        let _ = writeln!(
            text,
            "{roll:<40} # deceleration of a rolling ball, 0.05 to 1.5 m/s²; left out: vision's"
        );
        let _ = writeln!(
            text,
            "\n# How robots deviate from what is ordered: balls leave so much faster, 0.4 to 2."
        );
        let mut calibrated = RobotId::all().filter(|id| self.kick[id.index()] != 1.0).peekable();
        if calibrated.peek().is_none() {
            text.push_str("# [[calibration]]\n# robot = 3\n# kick = 1.06\n");
        }
        for id in calibrated {
            let _ = writeln!(text, "[[calibration]]\nrobot = {id}\nkick = {:?}\n", self.kick[id.index()]);
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

/// The first lines.
const HEADING: &str = "\
# Settings of a team, for `onetwo control --config team.toml`; a flag of the same name overrules each.

";

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
                   referee = '127.0.0.1:2'\nreferee_source = 'gc'\nreferee_silence = 'go-on'\ntracker = '127.0.0.1:3'\n\
                   game_controller = '127.0.0.1:4'\nstrategy = 'python3 \"x y.py\"'\n[ball]\nroll = 0.41\n\
                   [[calibration]]\nrobot = 3\nkick = 1.06\n[[calibration]]\nrobot = 15\nkick = 0.9\n";
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
