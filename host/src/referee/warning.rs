//! `warning`: warnings to the operator about the referee's sources, as text for terminal and page. Evidence:
//! sources, commands and times. Times: µs.

use std::fmt;

use protocol::{Duration, Instant};
use rules::Phase;
use rules::state::RefereeCommand;

use super::identity::{SourceKey, SourcePin};
use super::verdict::Doubt;
use super::{HALT_AFTER, Listener, OnSilence, SILENCE};

/// Time for which a step of the clock is reported.
const STEP_REPORTED: Duration = Duration::millis(5_000);

/// A fault of the referee's sources that persists now.
#[derive(Clone, Debug, PartialEq)]
pub enum Warning {
    /// Two sources give different commands.
    Disagreement {
        /// The source that is followed.
        followed: SourceKey,
        /// Newest command of that source.
        command: RefereeCommand,
        /// A source that contradicts it.
        other: SourceKey,
        /// Newest command of the other source.
        others: RefereeCommand,
        /// The phase that robots obey.
        obeyed: Phase<rules::Colour>,
    },
    /// Two sources agree: one controller on two networks, or two programs.
    Several {
        /// The source that is followed.
        followed: SourceKey,
        /// The source that agrees with it.
        other: SourceKey,
    },
    /// Packets of a source are not in order.
    OutOfOrder {
        /// The source that sent them.
        source: SourceKey,
        /// The check that they failed.
        doubt: Doubt,
    },
    /// A source's clock has stepped, and the step was followed.
    ClockStepped {
        /// The source whose clock stepped.
        source: SourceKey,
        /// The step, µs; negative: back.
        by: i64,
    },
    /// No packet came from the source that is followed, nor from another, for [`HALT_AFTER`] or longer.
    Silent {
        /// The source that was followed.
        source: SourceKey,
        /// Duration of the silence.
        since: Duration,
        /// The configured behaviour of robots meanwhile.
        robots: OnSilence,
    },
    /// A source is excluded by `--referee-source`.
    Excluded {
        /// The source that is excluded.
        source: SourceKey,
        /// The source that is obeyed instead.
        pin: SourcePin,
    },
}

impl Listener {
    /// The faults of the sources now; empty while one referee sends packets in order.
    pub fn warnings(&self, now: Instant) -> Vec<Warning> {
        let mut warnings = Vec::new();
        let lately = |at: Instant| now.since(at) < SILENCE;
        let Some((followed, others)) = self.sources.split_first() else {
            warnings.extend(self.exclusions(now));
            return warnings;
        };
        let newest = self.sources.iter().map(|source| source.received).fold(followed.received, Instant::max);
        let since = now.since(newest);
        if since >= HALT_AFTER {
            warnings.push(Warning::Silent { source: followed.key.clone(), since, robots: self.on_silence });
        }
        let heard = others.iter().filter(|other| lately(other.received) && !other.is_same_referee(followed));
        for other in heard {
            warnings.push(if other.command == followed.command {
                Warning::Several { followed: followed.key.clone(), other: other.key.clone() }
            } else {
                Warning::Disagreement {
                    followed: followed.key.clone(),
                    command: followed.command,
                    other: other.key.clone(),
                    others: other.command,
                    obeyed: followed.game.phase,
                }
            });
        }
        for source in &self.sources {
            if let Some((by, at)) = source.stepped
                && now.since(at) < STEP_REPORTED
            {
                warnings.push(Warning::ClockStepped { source: source.key.clone(), by });
            }
            if let Some(doubt) = source.reportable_doubt(now) {
                warnings.push(Warning::OutOfOrder { source: source.key.clone(), doubt });
            }
        }
        warnings.extend(self.exclusions(now));
        warnings
    }

    fn exclusions(&self, now: Instant) -> impl Iterator<Item = Warning> {
        let lately = self.excluded.iter().filter(move |(_, at)| now.since(*at) < SILENCE);
        lately.filter_map(|(source, _)| {
            Some(Warning::Excluded { source: source.clone(), pin: self.pin.clone()? })
        })
    }
}

/// The pin that selects the first of two sources: its machine, or its address where both are on one.
fn pin_for(source: &SourceKey, other: &SourceKey) -> String {
    let (one, two) = (source.address, other.address);
    if one.ip() == two.ip() { one.to_string() } else { one.ip().to_string() }
}

impl Warning {
    /// Identity without numbers: warnings with the same text are one warning at several times.
    pub fn matter(&self) -> String {
        match self {
            Self::Disagreement { followed, other, .. } => format!("disagreement {followed} {other}"),
            Self::Several { followed, other } => format!("several {followed} {other}"),
            Self::OutOfOrder { source, .. } => format!("order {source}"),
            Self::ClockStepped { source, by } => format!("clock {source} {by}"),
            Self::Silent { source, .. } => format!("silent {source}"),
            Self::Excluded { source, .. } => format!("excluded {source}"),
        }
    }

    /// Whether robots may halt or play because of it, so that it is repeated while it lasts.
    pub const fn is_urgent(&self) -> bool {
        !matches!(self, Self::Several { .. })
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Disagreement { followed, command, other, others, obeyed } => write!(
                f,
                "two referees disagree: {followed} says {command:?}, {other} says {others:?}; robots obey {obeyed:?}, the stricter. \
                 End the wrong program, or choose one: --referee-source {}",
                pin_for(followed, other)
            ),
            Self::Several { followed, other } => write!(
                f,
                "two referees are received and agree: {followed} is followed, {other} is the other one; where they disagree the \
                 stricter is obeyed (--referee-source chooses one)"
            ),
            Self::OutOfOrder { source, doubt } => write!(
                f,
                "packets of {source} are {doubt}: HALT and STOP of them are obeyed, other commands are not; a clock was set, or \
                 another program forges them"
            ),
            Self::ClockStepped { source, by } => write!(
                f,
                "the clock of {source} has stepped by {:+.1} s and is followed; is its machine set by NTP?",
                *by as f64 * 1e-6
            ),
            Self::Silent { source, since, robots } => {
                let robots = match robots {
                    OnSilence::Halt => {
                        "the robots halt until it is back (--referee-silence go-on lets its last command stand)"
                    }
                    OnSilence::GoOn => {
                        "its last command stands (--referee-silence halt lets the robots halt)"
                    }
                };
                write!(
                    f,
                    "nothing came from {source} for {:.0} s: {robots}. Is the game controller running, and its network cable in?",
                    since.as_secs_f32()
                )
            }
            Self::Excluded { source, pin } => {
                write!(
                    f,
                    "{source} is ignored: --referee-source chooses {}",
                    foreign::printable(&pin.to_string())
                )
            }
        }
    }
}
