//! `health_checks`: checks field, team, network and computer against the host's settings. A [`Fault`] is what
//! does not fit; a [`Finding`] is a fault with the time since which it lasts, its evidence and its remedy:
//! one list for terminal, page and reports. Sans-IO; times on the host's clock.
//!
//! | module | finds |
//! |---|---|
//! | `field` | more robots than the league allows; a field that is not the league's |
//! | `side` | keepers or teams at the goals that the other team defends |
//! | `second_host` | another host of the same team number |
//! | `port` | no camera frames on vision's port, or another program's packets |
//! | `stall` | a stall of this computer, vision or the radio |
//! | `strategy` | a strategy in another program that does not answer, or whose answers are refused |
//! | `team` | names and colours, keeper, division, placements, robots that radio or vision alone knows |
//! | `vision` | a second vision; clocks, delays and rates of cameras |
//!
//! [`HealthChecks::look`] is called at least every [`LOOK_EVERY_MAX`]. A finding is given within two seconds
//! of its cause and for as long as that lasts. A match without a fault has none.

mod field;
mod finding;
mod port;
mod second_host;
mod side;
mod stall;
mod strategy;
mod team;
mod vision;

/// [`HealthChecks::look`] is called at least this often, so that "within two seconds" holds.
pub const LOOK_EVERY_MAX: Duration = Duration::millis(200);
/// A fault on the field must last this long before it is a finding: longer than a misread pattern can persist
/// in tracking (0.2 s), and half of the two seconds.
const FAULT_LASTS_MIN: Duration = Duration::millis(1_000);
/// The field is checked only with camera frames of this age or newer.
const FRAME_AGE_MAX: Duration = Duration::millis(300);

#[cfg(test)]
mod tests;

use protocol::{Duration, Instant};
use thiserror::Error;

use crate::Host;
use crate::referee::Warning;
use crate::tracking::senders::SecondVision;

pub use field::{OtherField, TooManyRobots, other_field};
pub use finding::{Finding, Since};
pub use port::VisionPort;
pub use second_host::SecondHost;
pub use side::{SideEvidence, WrongSide};
pub use stall::Stall;
pub use strategy::StrategyFault;
pub use team::TeamFault;
pub(crate) use team::{failed_parts, other_image};
pub use vision::CameraFault;

/// Something that does not fit.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum Fault {
    /// More robots than the league allows.
    #[error("{0}")]
    Robots(TooManyRobots),
    /// Vision sends a field that is not the league's.
    #[error("{0}")]
    Field(OtherField),
    /// The teams stand at each other's goals.
    #[error("{0}")]
    Side(WrongSide),
    /// Another host commands, or tries to command, our robots.
    #[error("{0}")]
    SecondHost(SecondHost),
    /// No camera frames come on vision's port.
    #[error("{0}")]
    VisionPort(VisionPort),
    /// Two programs send vision of one camera.
    #[error("{0}")]
    SecondVision(SecondVision),
    /// A camera's clock, delay or rate.
    #[error("{0}")]
    Camera(CameraFault),
    /// Our team by referee, vision and radio.
    #[error("{0}")]
    Team(TeamFault),
    /// The strategy in another program.
    #[error("{0}")]
    Strategy(StrategyFault),
    /// The referee's sources.
    #[error("{0}")]
    Referee(Warning),
    /// The host, vision or the radio has stalled.
    #[error("{0}")]
    Stall(Stall),
    /// Datagrams came faster than they can be used.
    #[error(
        "{dropped} {what} came faster than they can be used, the oldest were dropped; does another program flood the port?"
    )]
    Flood {
        /// What was dropped.
        what: &'static str,
        /// Number of datagrams.
        dropped: u64,
    },
    /// The line to the base station is too slow; the text has the rate that it needs.
    #[error("{0}")]
    SlowLine(String),
    /// A source that was never received; the text says how it is received.
    #[error("{0}")]
    Missing(String),
}

impl Fault {
    /// Identity without numbers: faults with the same text are one fault at several times.
    pub fn matter(&self) -> String {
        match self {
            Self::Robots(found) => format!("robots {:?}", found.team),
            Self::Stall(stall) => format!("stall {}", stall.place()),
            Self::Camera(fault) => fault.matter(),
            Self::Team(fault) => fault.matter(),
            Self::Referee(warning) => warning.matter(),
            Self::Flood { what, .. } => format!("flood of {what}"),
            Self::Missing(text) => text.clone(),
            _ => self.what().to_owned(),
        }
    }

    /// What does not fit, in two or three words.
    pub const fn what(&self) -> &'static str {
        match self {
            Self::Robots(_) => "too many robots",
            Self::Field(_) => "other field",
            Self::Side(_) => "wrong side",
            Self::SecondHost(_) => "second host",
            Self::VisionPort(_) => "no vision",
            Self::SecondVision(_) => "second vision",
            Self::Camera(CameraFault::Clock { .. }) => "camera's clock",
            Self::Camera(CameraFault::Late { .. }) => "late camera",
            Self::Camera(CameraFault::Unused { .. }) => "unused camera",
            Self::Camera(CameraFault::Slow { .. }) => "slow camera",
            Self::Team(TeamFault::OtherColour { .. }) => "name and colour",
            Self::Team(TeamFault::NoKeeper { .. }) => "no keeper",
            Self::Team(TeamFault::Division { .. }) => "other division",
            Self::Team(TeamFault::Placement { .. }) => "impossible placement",
            Self::Team(TeamFault::Command { .. }) => "unknown command",
            Self::Team(TeamFault::Unseen(_)) => "unseen robot",
            Self::Team(TeamFault::Unheard(_)) => "unheard robot",
            Self::Team(TeamFault::OtherNumber { .. }) => "other number",
            Self::Team(TeamFault::OtherImage { .. }) => "other image",
            Self::Team(TeamFault::FailedParts { .. }) => "broken part",
            Self::Strategy(StrategyFault::Refused { .. }) => "refused answers",
            Self::Strategy(StrategyFault::Silent { .. }) => "silent strategy",
            Self::Referee(_) => "referee's sources",
            Self::Stall(_) => "stall",
            Self::Flood { .. } => "flood",
            Self::SlowLine(_) => "slow line",
            Self::Missing(_) => "missing source",
        }
    }

    /// The label that heads its line.
    pub const fn heading(&self) -> &'static str {
        match self {
            Self::Robots(_) => "robots",
            Self::Field(_) | Self::Side(_) => "field",
            Self::SecondHost(_) => "radio",
            Self::VisionPort(_) | Self::SecondVision(_) | Self::Camera(_) => "vision",
            Self::Team(fault) => fault.heading(),
            Self::Strategy(_) => "strategy",
            Self::Referee(_) => "referee",
            Self::Stall(stall) => stall.place(),
            Self::Flood { .. } => "network",
            Self::SlowLine(_) => "line",
            Self::Missing(_) => "waiting",
        }
    }

    /// Whether it is repeated while it lasts.
    pub const fn is_urgent(&self) -> bool {
        match self {
            // A laboratory's own field, a camera that is not switched on yet, clocks that are taken out:
            // reported once.
            Self::Field(found) => found.fits.is_some(),
            Self::Camera(fault) => matches!(fault, CameraFault::Unused { .. } | CameraFault::Slow { .. }),
            Self::Team(fault) => fault.is_urgent(),
            Self::Referee(warning) => warning.is_urgent(),
            Self::VisionPort(_) | Self::Missing(_) => false,
            _ => true,
        }
    }
}

/// State of all checks.
#[derive(Clone, Debug, Default)]
pub struct HealthChecks {
    looked: Option<Instant>,
    crowd: field::RobotCount,
    side: side::Sides,
    port: port::Port,
    stalls: stall::Stalls,
    team: team::TeamChecks,
    answers: strategy::Answers,
    /// Our team's name, where it is known.
    name: Option<String>,
}

impl HealthChecks {
    /// The checks for a team of that name.
    #[must_use]
    pub fn of_team(self, name: &str) -> Self {
        Self { name: Some(name.to_owned()), ..self }
    }

    /// The host's loop runs now. A program that calls this calls it at least every 100 ms: a longer pause is
    /// a stall of the computer. A simulation in virtual time does not call it.
    pub fn ran(&mut self, now: Instant) {
        self.stalls.ran(now);
    }

    /// The faults that persist now.
    pub fn look(&mut self, now: Instant, host: &Host) -> Vec<Fault> {
        if self.looked.is_some_and(|last| now < last) {
            // A recording that is rewound, or a match that restarts.
            *self = Self { name: self.name.take(), ..Self::default() };
        }
        self.looked = Some(now);
        let mut found = Vec::new();
        let sees = host.last_camera_frame().is_some_and(|at| now.since(at) < FRAME_AGE_MAX);
        let reported =
            host.announced_field().and_then(|reported| other_field(host.settings().league, reported));
        found.extend(reported.map(Fault::Field));
        found.extend(self.crowd.look(now, host, sees).map(Fault::Robots));
        found.extend(self.side.look(now, host, sees).map(Fault::Side));
        found.extend(second_host::look(now, host).map(Fault::SecondHost));
        found.extend(self.port.look(now, host).map(Fault::VisionPort));
        found.extend(vision::look(now, host).map(Fault::Camera));
        found.extend(self.team.look(now, host, self.name.as_deref(), sees).into_iter().map(Fault::Team));
        found.extend(self.answers.look(now, host).map(Fault::Strategy));
        found.extend(self.stalls.look(now, host).map(Fault::Stall));
        found
    }
}

/// Something that must last for [`FAULT_LASTS_MIN`].
#[derive(Clone, Copy, Debug, Default)]
struct Lasting {
    since: Option<Instant>,
}

impl Lasting {
    /// Whether it has held for long enough; `holds`: whether it holds now.
    fn see(&mut self, now: Instant, holds: bool) -> bool {
        self.since = holds.then(|| self.since.unwrap_or(now));
        self.since.is_some_and(|since| now.since(since) >= FAULT_LASTS_MIN)
    }
}
