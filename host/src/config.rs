//! `config`: the team's configuration: `team.toml`, and the flags that overrule it (docs/case-format.md §5).
//!
//! ```toml
//! name = "onetwo"                 # as the game controller knows the team
//! colour = "blue"                 # blue or yellow; the referee may change sides, not colours
//! league = "division-b"           # ssl-2013, division-b or division-a
//! keeper = 0
//! interface = "192.168.1.7"       # interface for multicast; left out: every interface
//! robots = "sim://127.0.0.1"      # sim://HOST, udp://HOST:PORT or serial:DEVICE[:BAUD]
//! key_file = "team.key"           # 32 hexadecimal digits; may be left out for sim:// only
//! insecure_zero_key = false       # true: real robots may use the key of zeros, which is public
//! vision = "224.5.23.2:10006"
//! referee = "224.5.23.1:10003"
//! referee_source = "192.168.1.5"  # accept only this referee: address or identifier; left out: the strictest
//! referee_silence = "halt"        # after 2 s without a referee; "go-on": its last command is kept
//! tracker = "224.5.23.2:10010"
//! tracker_in = "224.5.23.2:10010,TIGERs"  # another program's tracker in place of vision while it sends
//! game_controller = "127.0.0.1:10008"   # the team's port; left out: no messages to the controller
//! strategy = "python3 my_team.py" # program that gives the orders; left out: the program's own coach does
//! tactics = "default"             # of the coach; none, all, or some of their names
//!
//! [[calibration]]                 # how a robot deviates from what is ordered
//! robot = 3
//! kick = 1.06                     # kick gain: measured / ordered ball speed
//! latency_ms = 45                 # from an order to its motion; displayed, not used
//!
//! [[numbers]]                     # a robot whose shell has another number than it was flashed with
//! robot = 4                       # number on the shell
//! radio = 0                       # number it was flashed with
//!
//! [ball]
//! roll = 0.41                     # deceleration of a rolling ball, m/s²; left out: vision's
//!
//! [practice]                      # on a part of the field; left out: all of it
//! within = "+x"                   # half +x, -x, +y or -y, or two corners X,Y,X,Y in mm
//! without = "0,2000,1000,3000"    # a rectangle that is left out
//! cameras = "2,3"                 # cameras that are left out
//!
//! [limits]                        # of our robots' drives; their own hold where they are stricter
//! speed = 2.0                     # m/s; left out: their own
//! acceleration = 2.5              # m/s²; left out: their own
//!
//! [radio]                         # of a base station at serial:
//! channel = 40                    # MHz above 2,400; left out: by the team's number
//! rate = 2                        # Mbit/s on the air, 1 or 2
//! ```

mod air;
mod change;
mod numbers;
pub mod parameters;
mod text;
mod tracker_in;

use std::net::SocketAddr;
use std::path::PathBuf;

use foreign::excerpt;
use protocol::RobotId;
use rules::{Colour, League};
use serde::Deserialize;
use ssl::net::{addresses, split_address};

use crate::practice::Practice;
use crate::radio::RobotNumbers;
use crate::referee::{OnSilence, SourcePin};
use crate::strategy::Tactics;

pub use crate::practice::PracticeSettings;
pub use air::AirSettings;
pub use change::{DriveSettings, ParameterChange};
pub use numbers::RadioNumber;
pub(crate) use parameters::KICK_RANGE;
pub use tracker_in::TrackerIn;

/// Longest part of an error in a file of settings that is printed, characters.
const MESSAGE_CHARS_MAX: usize = 400;
/// Longest part of its line that is printed, characters.
const LINE_CHARS_MAX: usize = 80;
const LEAGUES: [League; 3] = [League::Ssl2013, League::DivisionB, League::DivisionA];
/// Default baud rate, bits a second: it carries 100 snapshots a second for a team of six (some 50 kB/s) and
/// 75 for one of eleven (80).
const BAUD_DEFAULT: u32 = 1_000_000;

/// A team's settings: from a file or flags; every field is optional.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TeamSettings {
    /// The team's name, as registered with the game controller.
    pub name: Option<String>,
    /// The team's colour: `blue` or `yellow`.
    pub colour: Option<String>,
    /// The league's name: `ssl-2013`, `division-b` or `division-a`.
    pub league: Option<String>,
    /// The keeper's number, 0–15.
    pub keeper: Option<u8>,
    /// The interface on which multicast is received: its name or IPv4 address.
    pub interface: Option<String>,
    /// Address of the robots: see [`RobotLink`].
    pub robots: Option<String>,
    /// The file of the team's key.
    pub key_file: Option<PathBuf>,
    /// Real robots may be commanded with the key of zeros.
    pub insecure_zero_key: Option<bool>,
    /// Multicast group and port of vision.
    #[serde(default, deserialize_with = "text::address")]
    pub vision: Option<SocketAddr>,
    /// Multicast group and port of the referee.
    #[serde(default, deserialize_with = "text::address")]
    pub referee: Option<SocketAddr>,
    /// The only referee that robots obey: see [`SourcePin`].
    pub referee_source: Option<String>,
    /// `halt` or `go-on`: see [`OnSilence`].
    pub referee_silence: Option<String>,
    /// Address to which tracker packets are sent.
    #[serde(default, deserialize_with = "text::destination")]
    pub tracker: Option<SocketAddr>,
    /// Another program's tracker that is followed: see [`TrackerIn`].
    pub tracker_in: Option<String>,
    /// The game controller's port for teams.
    #[serde(default, deserialize_with = "text::team_port")]
    pub game_controller: Option<SocketAddr>,
    /// Command of the strategy that gives the orders ([`crate::external`]).
    pub strategy: Option<String>,
    /// The tactics of the program's coach: see [`Tactics::parse`].
    pub tactics: Option<String>,
    /// Deviations of the robots from what is ordered.
    #[serde(default)]
    pub calibration: Vec<Calibration>,
    /// Robots whose radio number is not the number on their shell.
    #[serde(default)]
    pub numbers: Vec<RadioNumber>,
    /// Motion of the ball on this field.
    #[serde(default)]
    pub ball: BallSettings,
    /// Limits of our robots' motion.
    #[serde(default)]
    pub limits: DriveSettings,
    /// Place of a base station and its robots on the air.
    #[serde(default)]
    pub radio: AirSettings,
    /// The part of the field that is practised on.
    #[serde(default)]
    pub practice: PracticeSettings,
}

/// Motion of the ball on the field.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BallSettings {
    /// Deceleration of a rolling ball, m/s².
    pub roll: Option<f32>,
}

/// Deviations of one robot from what is ordered.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Calibration {
    /// The robot's number, 0–15.
    pub robot: u8,
    /// Ball speed over speed ordered.
    #[serde(default = "one")]
    pub kick: f32,
    /// Latency from an order to its motion, ms: written by `control --learned`, not used yet.
    #[serde(default)]
    pub latency_ms: Option<f32>,
}

fn one() -> f32 {
    1.0
}

/// A team's settings, complete and checked.
#[derive(Clone, Debug, PartialEq)]
pub struct TeamConfig {
    /// Name of the team as the game controller knows it.
    pub name: String,
    /// The colour our robots play with.
    pub colour: Colour,
    /// The league, which sets field and rules.
    pub league: League,
    /// The keeper, until the referee names another.
    pub keeper: RobotId,
    /// The interface on which multicast is received, by name or address; `None`: every interface that
    /// supports it.
    pub interface: Option<String>,
    /// Link to the robots.
    pub robots: RobotLink,
    /// The file of the team's key.
    pub key_file: Option<PathBuf>,
    /// Real robots may be commanded with the key of zeros, which is public.
    pub insecure_zero_key: bool,
    /// Multicast group and port of vision.
    pub vision: SocketAddr,
    /// Multicast group and port of the referee.
    pub referee: SocketAddr,
    /// The only referee that is obeyed; none: the strictest of all.
    pub referee_source: Option<SourcePin>,
    /// Behaviour of our robots when the referee falls silent.
    pub referee_silence: OnSilence,
    /// Address to which tracker packets are sent.
    pub tracker: SocketAddr,
    /// The tracker of another program that is followed while it sends; none: vision alone.
    pub tracker_in: Option<TrackerIn>,
    /// The game controller's port for teams.
    pub game_controller: Option<SocketAddr>,
    /// Command of the strategy that gives the orders; none: the coach does.
    pub strategy: Option<String>,
    /// Ball speed over speed ordered, by robot.
    pub kick: [f32; RobotId::COUNT],
    /// Radio numbers of the shells.
    pub numbers: RobotNumbers,
    /// Deceleration of a rolling ball, m/s²; none: from vision.
    pub roll: Option<f32>,
    /// Limits of our robots' motion.
    pub limits: DriveSettings,
    /// Place of a base station on the air.
    pub air: AirSettings,
    /// The tactics of the program's coach.
    pub tactics: Tactics,
    /// The part of the field that is practised on.
    pub practice: Practice,
}

/// Links to the robots.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum RobotLink {
    /// Our virtual robots, in a simulator on that host.
    Simulator(String),
    /// A base station, or robots' own network, at this address: a datagram is a frame.
    Udp(String),
    /// A base station at a serial line: frames between zero bytes (COBS).
    Serial {
        /// The line's device, such as `/dev/ttyUSB0`.
        device: String,
        /// Rate of the line, bits/s.
        baud: u32,
    },
}

/// An error in a team's settings, with its remedy.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{key}: {description}")]
pub struct ConfigError {
    /// The key or flag.
    pub key: String,
    /// Text on what is wrong, and what to write.
    pub description: String,
}

fn error(key: &str, description: impl Into<String>) -> ConfigError {
    ConfigError { key: key.to_owned(), description: description.into() }
}

/// Error text for a file of settings, with its place; of a long line only the start.
fn place_of(text: &str, broken: &toml::de::Error) -> String {
    let what = excerpt(broken.message(), MESSAGE_CHARS_MAX);
    let before = broken.span().and_then(|span| text.get(..span.start));
    let Some(number) = before.map(|before| before.matches('\n').count()) else { return what };
    let line = text.lines().nth(number).unwrap_or_default();
    format!("line {}: {what}: `{}`", number + 1, excerpt(line.trim(), LINE_CHARS_MAX))
}

impl TeamSettings {
    /// Reads `team.toml`; unknown keys are errors.
    pub fn from_toml(text: &str) -> Result<Self, ConfigError> {
        toml::from_str(text).map_err(|broken| error("team.toml", place_of(text, &broken)))
    }

    /// These settings; where one is missing, that of `below`.
    #[must_use]
    pub fn over(self, below: Self) -> Self {
        Self {
            name: self.name.or(below.name),
            colour: self.colour.or(below.colour),
            league: self.league.or(below.league),
            keeper: self.keeper.or(below.keeper),
            interface: self.interface.or(below.interface),
            robots: self.robots.or(below.robots),
            key_file: self.key_file.or(below.key_file),
            insecure_zero_key: self.insecure_zero_key.or(below.insecure_zero_key),
            vision: self.vision.or(below.vision),
            referee: self.referee.or(below.referee),
            referee_source: self.referee_source.or(below.referee_source),
            referee_silence: self.referee_silence.or(below.referee_silence),
            tracker: self.tracker.or(below.tracker),
            tracker_in: self.tracker_in.or(below.tracker_in),
            game_controller: self.game_controller.or(below.game_controller),
            strategy: self.strategy.or(below.strategy),
            calibration: if self.calibration.is_empty() { below.calibration } else { self.calibration },
            numbers: if self.numbers.is_empty() { below.numbers } else { self.numbers },
            ball: BallSettings { roll: self.ball.roll.or(below.ball.roll) },
            limits: DriveSettings {
                speed: self.limits.speed.or(below.limits.speed),
                acceleration: self.limits.acceleration.or(below.limits.acceleration),
            },
            radio: AirSettings {
                channel: self.radio.channel.or(below.radio.channel),
                rate: self.radio.rate.or(below.radio.rate),
            },
            tactics: self.tactics.or(below.tactics),
            practice: PracticeSettings {
                within: self.practice.within.or(below.practice.within),
                without: self.practice.without.or(below.practice.without),
                cameras: self.practice.cameras.or(below.practice.cameras),
            },
        }
    }

    /// Complete and checked; defaults of the league for missing fields.
    pub fn complete(self) -> Result<TeamConfig, ConfigError> {
        let league = match self.league.as_deref() {
            None => League::DivisionB,
            Some(name) => LEAGUES.into_iter().find(|league| league.name() == name).ok_or_else(|| {
                error("league", format!("`{name}` is none; ssl-2013, division-b or division-a"))
            })?,
        };
        let mut kick = [1.0; RobotId::COUNT];
        for Calibration { robot, kick: factor, .. } in self.calibration {
            let id = robot_id("calibration.robot", robot)?;
            let named =
                |refused: ConfigError| error(&refused.key, format!("robot {robot}: {}", refused.description));
            kick[id.index()] = parameters::KICK.checked(factor).map_err(named)?;
        }
        let roll = self.ball.roll.map(|roll| parameters::ROLL.checked(roll)).transpose()?;
        let tactics = Tactics::parse(self.tactics.as_deref().unwrap_or("default"));
        Ok(TeamConfig {
            name: self.name.unwrap_or_else(|| "onetwo".to_owned()),
            colour: colour(self.colour.as_deref().unwrap_or("blue"))?,
            league,
            keeper: robot_id("keeper", self.keeper.unwrap_or(0))?,
            interface: self.interface,
            robots: RobotLink::parse(self.robots.as_deref().unwrap_or("sim://127.0.0.1"))?,
            key_file: self.key_file,
            insecure_zero_key: self.insecure_zero_key.unwrap_or(false),
            vision: self.vision.unwrap_or_else(|| addresses::VISION.into()),
            referee: self.referee.unwrap_or_else(|| addresses::REFEREE.into()),
            referee_source: self.referee_source.as_deref().map(pin).transpose()?,
            referee_silence: self.referee_silence.as_deref().map_or(Ok(OnSilence::default()), on_silence)?,
            tracker: self.tracker.unwrap_or_else(|| addresses::TRACKER.into()),
            tracker_in: self.tracker_in.as_deref().map(TrackerIn::parse).transpose()?,
            game_controller: self.game_controller,
            strategy: self.strategy,
            kick,
            numbers: numbers::parse(&self.numbers)?,
            roll,
            limits: self.limits.checked()?,
            air: self.radio.checked()?,
            tactics: tactics.map_err(|description| error("tactics", description))?,
            practice: Practice::parse(&self.practice)
                .map_err(|(key, description)| error(key, description))?,
        })
    }
}

fn colour(label: &str) -> Result<Colour, ConfigError> {
    [Colour::Blue, Colour::Yellow]
        .into_iter()
        .find(|colour| colour.label() == label)
        .ok_or_else(|| error("colour", format!("`{label}` is none; blue or yellow")))
}

fn pin(text: &str) -> Result<SourcePin, ConfigError> {
    let description = "empty; an address such as 192.168.1.5, one with a port, or a referee's identifier";
    if text.trim().is_empty() {
        Err(error("referee_source", description))
    } else {
        Ok(SourcePin::of(text.trim()))
    }
}

fn on_silence(label: &str) -> Result<OnSilence, ConfigError> {
    let known = OnSilence::ALL.into_iter().find(|(known, _)| *known == label);
    known.map(|(_, known)| known).ok_or_else(|| {
        error(
            "referee_silence",
            format!("`{label}` is none; halt (after 2 s) or go-on (by its last command)"),
        )
    })
}

fn robot_id(key: &str, number: u8) -> Result<RobotId, ConfigError> {
    RobotId::new(number).ok_or_else(|| error(key, format!("{number} is no robot; ids are 0 to 15")))
}

impl RobotLink {
    /// From `sim://HOST`, `udp://HOST:PORT` or `serial:DEVICE[:BAUD]`.
    pub fn parse(text: &str) -> Result<Self, ConfigError> {
        let wrong = || {
            error(
                "robots",
                format!("`{text}` is no link; sim://HOST, udp://HOST:PORT or serial:DEVICE[:BAUD]"),
            )
        };
        if let Some(host) = text.strip_prefix("sim://") {
            let known =
                split_address(host, Some(addresses::SIMULATOR_PORT)).is_some_and(|(_, port)| port > 0);
            return if known { Ok(Self::Simulator(host.to_owned())) } else { Err(wrong()) };
        }
        if let Some(address) = text.strip_prefix("udp://") {
            let known = split_address(address, None).is_some_and(|(_, port)| port > 0);
            return if known { Ok(Self::Udp(address.to_owned())) } else { Err(wrong()) };
        }
        let line = text.strip_prefix("serial:").ok_or_else(wrong)?;
        let (device, baud) = match line.rsplit_once(':') {
            // A device's name may hold a colon itself; only digits after it are a rate.
            Some((device, baud)) if baud.bytes().all(|b| b.is_ascii_digit()) && !baud.is_empty() => {
                (device, baud.parse().map_err(|_| wrong())?)
            }
            _ => (line, BAUD_DEFAULT),
        };
        if device.is_empty() { Err(wrong()) } else { Ok(Self::Serial { device: device.to_owned(), baud }) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_example_of_this_file_is_read_to_its_last_key() {
        let text: String = include_str!("config.rs")
            .lines()
            .skip_while(|line| *line != "//! ```toml")
            .skip(1)
            .take_while(|line| *line != "//! ```")
            .map(|line| line.trim_start_matches("//!").to_owned() + "\n")
            .collect();
        let config = TeamSettings::from_toml(&text).unwrap().complete().unwrap();
        assert_eq!(config.colour, Colour::Blue);
        assert_eq!(config.robots, RobotLink::Simulator("127.0.0.1".to_owned()));
        assert_eq!((config.kick[3], config.roll), (1.06, Some(0.41)));
        assert_eq!(config.referee_source, Some(SourcePin::of("192.168.1.5")));
        assert_eq!(config.referee_silence, OnSilence::Halt);
        assert_eq!(config.game_controller.unwrap().port(), 10_008);
    }

    #[test]
    fn flags_overrule_the_file() {
        let file = TeamSettings::from_toml("colour = \"yellow\"\nkeeper = 4").unwrap();
        let flags = TeamSettings { keeper: Some(2), ..TeamSettings::default() };
        let config = flags.over(file).complete().unwrap();
        assert_eq!((config.colour, config.keeper.number()), (Colour::Yellow, 2));
    }

    #[test]
    fn every_mistake_names_its_key_and_what_would_be_right() {
        let refused =
            |text: &str| TeamSettings::from_toml(text).and_then(TeamSettings::complete).unwrap_err();
        assert!(refused("color = \"blue\"").description.contains("color"));
        assert!(refused("colour = \"red\"").to_string().contains("blue or yellow"));
        assert!(refused("keeper = 16").to_string().contains("0 to 15"));
        assert!(refused("referee_source = ' '").to_string().contains("192.168.1.5"));
        assert!(refused("referee_silence = 'wait'").to_string().contains("halt (after 2 s) or go-on"));
        assert!(refused("league = \"four-legged\"").to_string().contains("division-b"));
        assert!(refused("[[calibration]]\nrobot = 1\nkick = 9.0").to_string().contains("calibration.kick"));
        assert!(
            refused("[[numbers]]\nrobot = 1\nradio = 16").to_string().contains("numbers.radio: 16 is no")
        );
        let twice = "[[numbers]]\nrobot = 1\nradio = 3\n[[numbers]]\nrobot = 2\nradio = 3";
        assert!(refused(twice).to_string().contains("robots 1 and 2 are given the same"));
        assert!(refused("[practice]\nwithin = 'left'").to_string().contains("practice.within: `left`"));
        assert!(refused("[practice]\ncameras = '16'").to_string().contains("practice.cameras"));
        assert!(refused("tracker_in = 'x,'").to_string().contains("HOST:PORT,NAME"));
        assert!(refused("[ball]\nroll = 9.0").to_string().contains("ball.roll"));
        for link in [
            "",
            "tcp://x:1",
            "udp://x",
            "udp://:1",
            "sim://",
            "sim://x:0",
            "udp://x:0",
            "udp://:::9",
            "serial:",
        ] {
            assert!(RobotLink::parse(link).unwrap_err().to_string().contains("sim://HOST"), "{link}");
        }
    }

    #[test]
    fn a_broken_line_is_reported_with_its_place_and_without_its_length() {
        let refused = |text: &str| TeamSettings::from_toml(text).unwrap_err().description;
        let error = refused(&format!("colour = \"blue\"\nname = {}\n", "x".repeat(1_000_000)));
        assert!(error.starts_with("line 2: "), "{error}");
        assert!(error.len() < 600, "{} bytes", error.len());
        let error = refused("name = \"a\"\nkeeper = \u{1b}[2J\u{1b}]0;pwn\u{7}");
        assert!(error.contains("line 2") && !error.contains(char::is_control), "{error:?}");
    }

    #[test]
    fn a_serial_line_has_its_rate_behind_a_colon() {
        let serial = |device: &str, baud| Ok(RobotLink::Serial { device: device.to_owned(), baud });
        assert_eq!(RobotLink::parse("serial:/dev/ttyACM0"), serial("/dev/ttyACM0", BAUD_DEFAULT));
        assert_eq!(RobotLink::parse("serial:COM3:115200"), serial("COM3", 115_200));
    }
}
