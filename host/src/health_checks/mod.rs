//! `health_checks`: checks field, network and computer against the host's settings; each finding has its
//! evidence and a remedy as text. Sans-IO; times on the host's clock.
//!
//! | module | finds |
//! |---|---|
//! | `field` | more robots than the league allows; a field that is not the league's |
//! | `side` | keepers or teams at the goals that the other team defends |
//! | `second_host` | another host of the same team number |
//! | `port` | no camera frames on vision's port, or another program's packets |
//! | `stall` | a stall of this computer, vision or the radio |
//!
//! [`HealthChecks::look`] is called at least every [`LOOK_EVERY_MAX`]. A finding is given within two seconds
//! of its cause and for as long as that lasts. A match without a fault has none.

mod field;
mod port;
mod second_host;
mod side;
mod stall;

/// [`HealthChecks::look`] is called at least this often, so that "within two seconds" holds.
pub const LOOK_EVERY_MAX: Duration = Duration::millis(200);
/// A fault on the field must last this long before it is a finding: longer than a misread pattern can persist
/// in tracking (0.2 s), and half of the two seconds.
const FAULT_LASTS_MIN: Duration = Duration::millis(1_000);
/// The field is checked only with camera frames of this age or newer.
const FRAME_AGE_MAX: Duration = Duration::millis(300);

#[cfg(test)]
mod tests;

use std::fmt;

use protocol::{Duration, Instant};

use crate::Host;

pub use field::{OtherField, TooManyRobots};
pub use port::VisionPort;
pub use second_host::SecondHost;
pub use side::{SideEvidence, WrongSide};
pub use stall::Stall;

/// A deviation from the settings.
#[derive(Clone, Debug, PartialEq)]
pub enum Finding {
    /// More robots than the league allows.
    Robots(TooManyRobots),
    /// Vision sends a field that is not the league's.
    Field(OtherField),
    /// The teams stand at each other's goals.
    Side(WrongSide),
    /// Another host commands, or tries to command, our robots.
    SecondHost(SecondHost),
    /// No camera frames come on vision's port.
    VisionPort(VisionPort),
    /// The host, vision or the radio has stalled.
    Stall(Stall),
}

impl Finding {
    /// Identity without numbers: findings with the same text are one finding at several times.
    pub fn matter(&self) -> String {
        match self {
            Self::Robots(found) => format!("robots {:?}", found.team),
            Self::Field(_) => "field".to_owned(),
            Self::Side(_) => "side".to_owned(),
            Self::SecondHost(_) => "second host".to_owned(),
            Self::VisionPort(_) => "vision port".to_owned(),
            Self::Stall(stall) => format!("stall {}", stall.place()),
        }
    }

    /// The label that heads its line: `field`, `robots`, `vision`, `radio` or `host`.
    pub const fn heading(&self) -> &'static str {
        match self {
            Self::Robots(_) => "robots",
            Self::Field(_) | Self::Side(_) => "field",
            Self::SecondHost(_) => "radio",
            Self::VisionPort(_) => "vision",
            Self::Stall(stall) => stall.place(),
        }
    }

    /// Whether it is repeated while it lasts.
    pub const fn is_urgent(&self) -> bool {
        match self {
            Self::Robots(_) | Self::Side(_) | Self::SecondHost(_) | Self::Stall(_) => true,
            // A laboratory's own field, or a camera that is not switched on yet: reported once.
            Self::Field(found) => found.fits.is_some(),
            Self::VisionPort(_) => false,
        }
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Robots(found) => found.fmt(f),
            Self::Field(found) => found.fmt(f),
            Self::Side(found) => found.fmt(f),
            Self::SecondHost(found) => found.fmt(f),
            Self::VisionPort(found) => found.fmt(f),
            Self::Stall(found) => found.fmt(f),
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
}

impl HealthChecks {
    /// The host's loop runs now. A program that calls this calls it at least every 100 ms: a longer pause is
    /// a stall of the computer. A simulation in virtual time does not call it.
    pub fn ran(&mut self, now: Instant) {
        self.stalls.ran(now);
    }

    /// The findings that persist now.
    pub fn look(&mut self, now: Instant, host: &Host) -> Vec<Finding> {
        if self.looked.is_some_and(|last| now < last) {
            // A recording that is rewound, or a match that restarts.
            *self = Self::default();
        }
        self.looked = Some(now);
        let mut found = Vec::new();
        let sees = host.last_camera_frame().is_some_and(|at| now.since(at) < FRAME_AGE_MAX);
        let reported =
            host.announced_field().and_then(|reported| field::other_field(host.settings().league, reported));
        found.extend(reported.map(Finding::Field));
        found.extend(self.crowd.look(now, host, sees).map(Finding::Robots));
        found.extend(self.side.look(now, host, sees).map(Finding::Side));
        found.extend(second_host::look(now, host).map(Finding::SecondHost));
        found.extend(self.port.look(now, host).map(Finding::VisionPort));
        found.extend(self.stalls.look(now, host).map(Finding::Stall));
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
