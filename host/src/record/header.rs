//! `header`: header of a trace, as JSON (docs/architecture.md §7.4): the settings from which the hosts of
//! a recording can be rebuilt.
//!
//! A team's key is never in a file that is passed on: the header states only that there was one
//! ([`HostHeader::keyed`]), and the caller that rebuilds the host supplies it.

use casebase::CaseBase;
use geometry::GoalEnd;
use protocol::frame::TeamKey;
use protocol::{Duration, Instant, RobotId, TeamId};
use rules::{Colour, League};
use serde::{Deserialize, Serialize};

use super::case_table;
use crate::HostSettings;
use crate::config::{DriveSettings, KICK_RANGE};
use crate::practice::Practice;
use crate::radio::{RadioSettings, Relay, RobotNumbers};
use crate::referee::{OnSilence, SourcePin};
use crate::strategy::cases_of;
use crate::strategy::{Tactics, Team};

const RELAYS: [(&str, Relay); 3] = [("no", Relay::No), ("to-each", Relay::ToEach), ("to-all", Relay::ToAll)];

/// The header of a trace.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RecordingHeader {
    /// Version of the program that recorded.
    pub version: String,
    /// The commit it was built from.
    pub commit: String,
    /// Random seed of a simulated match; none on a real field.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seed: Option<u64>,
    /// The league's name, such as `division-b`.
    pub league: String,
    /// Name of the simulated world; none on a real field, and in recordings from before there were several.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub world: Option<String>,
    /// Unix time of the hosts' instant 0, µs, where it is known: their clock counts from it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub zero_unix_us: Option<u64>,
    /// The hosts, by the number that records have.
    pub hosts: Vec<HostHeader>,
    /// The table of the hosts' case base where it is not the one that comes with the league, in hexadecimal
    /// digits.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub case_table: Option<String>,
}

/// The settings one host started with.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct HostHeader {
    /// Colour of the team: `blue` or `yellow`.
    pub colour: String,
    /// Goal that it defends until the referee reports it: `yellow` is the one at −x, `cyan` the one at +x, as
    /// in problems.
    pub defending: String,
    /// Number of its keeper until the referee names one.
    pub keeper: u8,
    /// Ball speed over speed ordered, by robot.
    pub kick: Vec<f32>,
    /// Configured deceleration of a rolling ball, m/s².
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub roll: Option<f32>,
    /// Whether it played by what it learned.
    #[serde(default)]
    pub learns: bool,
    /// When it started, on its own clock, µs.
    #[serde(default)]
    pub began_us: u64,
    /// Team that decided open play: ours or an opponent team.
    #[serde(default)]
    pub plays: Team,
    /// The team's number on the radio.
    pub team: u8,
    /// Epoch of the host on the radio.
    pub epoch: u32,
    /// Forwarding of beacons: `no`, `to-each` or `to-all`.
    pub relay: String,
    /// One-way latency of a packet, µs.
    pub way_us: u64,
    /// The only referee that was obeyed, as `--referee-source` takes it; none: every one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub referee_source: Option<String>,
    /// Behaviour of its robots when the referee fell silent, as `--referee-silence` takes it; none: its last
    /// command was kept.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub referee_silence: Option<String>,
    /// Whether frames were sealed with a key other than zeros.
    #[serde(default)]
    pub keyed: bool,
    /// Tactics that the host played.
    #[serde(default = "Tactics::none")]
    pub tactics: Tactics,
    /// The hash of the case base in which its robots' cases were looked up, where its tactics needed one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cases: Option<String>,
    /// Greatest speed of its robots, m/s; none: their own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed_limit: Option<f32>,
    /// Greatest acceleration of its robots, m/s²; none: their own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub acceleration_limit: Option<f32>,
    /// The part of the field that it practised on.
    #[serde(default, skip_serializing_if = "Practice::is_all")]
    pub practice: Practice,
    /// Whether a strategy in another program gave orders.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub external: bool,
    /// Robots that were given a radio number: shell number and radio number.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub numbers: Vec<(RobotId, RobotId)>,
}

/// Why a header builds no host.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the recording's header: {description}")]
pub struct HeaderError {
    /// Text on what is wrong, with its place.
    pub description: String,
}

fn wrong(description: impl Into<String>) -> HeaderError {
    HeaderError { description: description.into() }
}

impl RecordingHeader {
    /// Header of one host that starts at its instant 0; what the program knows besides is left out.
    pub fn of(settings: &HostSettings) -> Self {
        Self {
            version: String::new(),
            commit: String::new(),
            seed: None,
            league: settings.league.name().to_owned(),
            world: None,
            zero_unix_us: None,
            hosts: vec![HostHeader::of(settings, Instant(0))],
            case_table: None,
        }
        .with_cases(settings.cases)
    }

    /// The same with the table of this case base, unless it comes with the league.
    #[must_use]
    pub fn with_cases(mut self, cases: Option<CaseBase<'static>>) -> Self {
        let own = self.league().map(|league| cases_of(league).hash());
        self.case_table = cases.filter(|cases| own != Ok(cases.hash())).and_then(case_table::write);
        self
    }

    /// The case base of its hosts where it is written down.
    pub fn cases(&self) -> Result<Option<CaseBase<'static>>, HeaderError> {
        let read = self.case_table.as_deref().map(case_table::read).transpose();
        read.map_err(|error| wrong(format!("case_table: {error}")))
    }

    /// JSON at the start of a trace.
    pub fn to_json(&self) -> String {
        // Strings, numbers and lists of them: JSON can represent all of it.
        serde_json::to_string(self).unwrap_or_default()
    }

    /// From the JSON at the start of a trace.
    pub fn from_json(text: &str) -> Result<Self, HeaderError> {
        serde_json::from_str(text).map_err(|error| wrong(error.to_string()))
    }

    /// The league of that name.
    pub fn league(&self) -> Result<League, HeaderError> {
        [League::Ssl2013, League::DivisionB, League::DivisionA]
            .into_iter()
            .find(|league| league.name() == self.league)
            .ok_or_else(|| {
                wrong(format!("league: `{}` is none; ssl-2013, division-b or division-a", self.league))
            })
    }
}

fn hash_of(cases: CaseBase<'_>) -> String {
    format!("{:08x}", cases.hash())
}

impl HostHeader {
    /// The header of one host that starts at `began`.
    pub fn new(
        (colour, keeper, defending): (Colour, RobotId, GoalEnd),
        kick: &[f32; RobotId::COUNT],
        radio: &RadioSettings,
        began: Instant,
    ) -> Self {
        let relay = RELAYS.iter().find(|(_, relay)| *relay == radio.relay).map_or("no", |(label, _)| label);
        Self {
            colour: colour.label().to_owned(),
            defending: defending.label().to_owned(),
            keeper: keeper.number(),
            kick: kick.to_vec(),
            roll: None,
            learns: false,
            began_us: began.0,
            plays: Team::Ours,
            team: radio.team.0,
            epoch: radio.epoch,
            relay: relay.to_owned(),
            way_us: radio.latency.0,
            referee_source: None,
            referee_silence: None,
            keyed: radio.key != TeamKey::ZERO,
            tactics: Tactics::NONE,
            cases: None,
            speed_limit: None,
            acceleration_limit: None,
            practice: Practice::default(),
            external: false,
            numbers: RobotId::all().filter_map(|id| Some((id, radio.numbers.given(id)?))).collect(),
        }
    }

    /// The header of a host with these settings that starts at `began`.
    pub fn of(settings: &HostSettings, began: Instant) -> Self {
        let who = (settings.us, settings.keeper, settings.defending);
        Self {
            plays: settings.team,
            roll: settings.roll,
            learns: settings.learns,
            referee_source: settings.referee.as_ref().map(ToString::to_string),
            referee_silence: Some(settings.referee_silence.label().to_owned()),
            tactics: settings.tactics,
            cases: settings.tactics.bridge.then(|| hash_of(settings.case_base())),
            speed_limit: settings.limits.speed,
            acceleration_limit: settings.limits.acceleration,
            practice: settings.practice,
            external: settings.external,
            ..Self::new(who, &settings.kick, &settings.radio, began)
        }
    }

    /// The settings it started with; the caller supplies the key, and the case base that the recording has.
    pub fn settings(
        &self,
        league: League,
        cases: Option<CaseBase<'static>>,
        key: TeamKey,
    ) -> Result<HostSettings, HeaderError> {
        let ours = hash_of(cases.unwrap_or_else(|| cases_of(league)));
        if let Some(theirs) = self.cases.as_ref().filter(|hash| self.tactics.bridge && **hash != ours) {
            return Err(wrong(format!(
                "cases: it understood its robots by case base {theirs}, this program's is {ours}; take the program of the recording"
            )));
        }
        Ok(HostSettings {
            us: self.colour()?,
            league,
            keeper: self.keeper()?,
            defending: self.defending()?,
            kick: self.kick()?,
            roll: self.roll.filter(|roll| (0.05..=1.5).contains(roll)),
            learns: self.learns,
            referee: self.referee_source.as_deref().map(SourcePin::of),
            referee_silence: self.referee_silence()?,
            team: self.plays,
            radio: self.radio(key)?,
            tactics: self.tactics,
            limits: self.limits()?,
            practice: self.practice,
            external: self.external,
            cases,
            expected: None,
        })
    }

    fn referee_silence(&self) -> Result<OnSilence, HeaderError> {
        let Some(label) = &self.referee_silence else { return Ok(OnSilence::GoOn) };
        let known = OnSilence::ALL.into_iter().find(|(known, _)| known == label);
        known
            .map(|(_, known)| known)
            .ok_or_else(|| wrong(format!("referee_silence: `{label}` is none; halt or go-on")))
    }

    /// The colour of that name.
    pub fn colour(&self) -> Result<Colour, HeaderError> {
        [Colour::Blue, Colour::Yellow]
            .into_iter()
            .find(|colour| colour.label() == self.colour)
            .ok_or_else(|| wrong(format!("colour: `{}` is none; blue or yellow", self.colour)))
    }

    /// The goal it defended at the start.
    pub fn defending(&self) -> Result<GoalEnd, HeaderError> {
        GoalEnd::from_label(&self.defending).ok_or_else(|| {
            wrong(format!("defending: `{}` is no goal; yellow (−x) or cyan (+x)", self.defending))
        })
    }

    /// The keeper of that number.
    pub fn keeper(&self) -> Result<RobotId, HeaderError> {
        RobotId::new(self.keeper)
            .ok_or_else(|| wrong(format!("keeper: {} is no robot; ids are 0 to 15", self.keeper)))
    }

    /// Ball speed over speed ordered, by robot.
    pub fn kick(&self) -> Result<[f32; RobotId::COUNT], HeaderError> {
        let good = self.kick.iter().all(|factor| KICK_RANGE.contains(factor));
        <[f32; RobotId::COUNT]>::try_from(&self.kick[..]).ok().filter(|_| good).ok_or_else(|| {
            let (count, low, high) = (RobotId::COUNT, KICK_RANGE.start(), KICK_RANGE.end());
            wrong(format!("kick: {count} factors of {low} to {high}, one for each robot"))
        })
    }

    /// Limits of its robots' motion.
    fn limits(&self) -> Result<DriveSettings, HeaderError> {
        let limits = DriveSettings { speed: self.speed_limit, acceleration: self.acceleration_limit };
        limits.checked().map_err(|error| wrong(error.to_string()))
    }

    /// When it started, on its own clock.
    pub fn began(&self) -> Instant {
        Instant(self.began_us)
    }

    /// Settings of its radio, sealed with that key.
    pub fn radio(&self, key: TeamKey) -> Result<RadioSettings, HeaderError> {
        let relay = RELAYS.iter().find(|(label, _)| *label == self.relay);
        let (_, relay) =
            relay.ok_or_else(|| wrong(format!("relay: `{}`; no, to-each or to-all", self.relay)))?;
        Ok(RadioSettings {
            team: TeamId(self.team),
            key,
            epoch: self.epoch,
            relay: *relay,
            latency: Duration(self.way_us),
            numbers: self.numbers()?,
        })
    }

    fn numbers(&self) -> Result<RobotNumbers, HeaderError> {
        let mut given = [None; RobotId::COUNT];
        for (shell, radio) in &self.numbers {
            given[shell.index()] = Some(*radio);
        }
        RobotNumbers::new(given)
            .map_err(|[one, other]| wrong(format!("numbers: robots {one} and {other} have one radio number")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn header() -> RecordingHeader {
        let mut kick = [1.0; RobotId::COUNT];
        kick[3] = 1.06;
        let radio = RadioSettings {
            key: TeamKey([7; 16]),
            relay: Relay::ToEach,
            ..RadioSettings::new(TeamId(2), 1_795_000_000)
        };
        let who = (Colour::Blue, RobotId::new(0).unwrap(), GoalEnd::Positive);
        RecordingHeader {
            version: "0.1.0".to_owned(),
            commit: "unknown".to_owned(),
            seed: Some(7),
            league: "division-b".to_owned(),
            world: Some("random:7".to_owned()),
            zero_unix_us: None,
            hosts: vec![HostHeader::new(who, &kick, &radio, Instant(25))],
            case_table: None,
        }
    }

    #[test]
    fn what_a_host_began_with_is_read_again_from_the_words() {
        let written = header();
        let read = RecordingHeader::from_json(&written.to_json()).unwrap();
        assert_eq!(read, written);
        assert_eq!(read.league().unwrap(), League::DivisionB);
        let host = &read.hosts[0];
        assert_eq!((host.colour().unwrap(), host.defending().unwrap()), (Colour::Blue, GoalEnd::Positive));
        assert_eq!(
            (host.keeper().unwrap(), host.kick().unwrap()[3], host.began()),
            (RobotId::new(0).unwrap(), 1.06, Instant(25))
        );
        let radio = host.radio(TeamKey([7; 16])).unwrap();
        assert_eq!((radio.team, radio.epoch, radio.relay), (TeamId(2), 1_795_000_000, Relay::ToEach));
        assert_eq!(radio.latency, Duration::millis(3));
    }

    #[test]
    fn a_key_is_never_written_down_but_that_there_was_one_is() {
        let written = header();
        assert!(written.hosts[0].keyed);
        assert!(!written.to_json().contains("7,7,7"), "{}", written.to_json());
    }

    #[test]
    fn an_old_recordings_header_means_no_tactics_and_a_new_one_names_them() {
        let mut settings = HostSettings::new(Colour::Blue, League::DivisionB, 1);
        settings.tactics = Tactics { threats: true, ..Tactics::NONE };
        let reported = serde_json::to_string(&HostHeader::of(&settings, Instant(0))).unwrap();
        let read: HostHeader = serde_json::from_str(&reported).unwrap();
        assert_eq!(read.settings(League::DivisionB, None, TeamKey::ZERO).unwrap().tactics, settings.tactics);
        let tactics = reported.find(",\"tactics\"").unwrap();
        let old: HostHeader = serde_json::from_str(&format!("{}}}", &reported[..tactics])).unwrap();
        assert_eq!(old.tactics, Tactics::NONE);
    }

    #[test]
    fn a_header_names_its_case_base_only_where_the_bridge_was_played() {
        let mut settings = HostSettings::new(Colour::Blue, League::DivisionB, 1);
        settings.tactics = Tactics { bridge: false, ..Tactics::ALL };
        assert_eq!(HostHeader::of(&settings, Instant(0)).cases, None);
        settings.tactics.bridge = true;
        let mut reported = HostHeader::of(&settings, Instant(0));
        assert_eq!(reported.cases, Some(format!("{:08x}", case_library::division_b().hash())));
        assert!(reported.settings(League::DivisionB, None, TeamKey::ZERO).is_ok());
        reported.cases = Some("01234567".to_owned());
        let error = reported.settings(League::DivisionB, None, TeamKey::ZERO).unwrap_err().to_string();
        assert!(error.contains("01234567"), "{error}");
    }

    #[test]
    fn every_fault_of_a_header_names_its_place() {
        let faulty = |change: fn(&mut HostHeader)| {
            let mut host = header().hosts.remove(0);
            change(&mut host);
            host
        };
        assert!(
            faulty(|h| h.colour = "red".into()).colour().unwrap_err().to_string().contains("blue or yellow")
        );
        assert!(
            faulty(|h| h.defending = "blue".into()).defending().unwrap_err().to_string().contains("cyan")
        );
        assert!(faulty(|h| h.keeper = 16).keeper().unwrap_err().to_string().contains("0 to 15"));
        assert!(faulty(|h| h.kick.truncate(15)).kick().unwrap_err().to_string().contains("16"));
        assert!(faulty(|h| h.kick[0] = f32::NAN).kick().unwrap_err().to_string().contains("0.4 to 2"));
        assert!(
            faulty(|h| h.relay = "x".into()).radio(TeamKey::ZERO).unwrap_err().to_string().contains("to-all")
        );
        let other = RecordingHeader { league: "four-legged".into(), ..header() };
        assert!(other.league().unwrap_err().to_string().contains("division-b"));
        assert!(RecordingHeader::from_json("{\"version\":1}").unwrap_err().to_string().contains("line 1"));
    }
}
