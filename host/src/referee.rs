//! What does the referee say, and does it still say anything? The game controller's packets become a [`Game`].
//!
//! [`Listener::hear`] takes packets, [`Listener::tick`] the time and the ball. Decided here:
//!
//! - **Which referee.** The first source heard is followed. Another one on the same port is counted and told, and only
//!   followed when the first has been silent for [`SILENCE`].
//! - **Which packet.** One that was sent before the newest is old and dropped, unless it is older by more than
//!   [`CLOCK_BACK`]: then the referee's clock was set back. Counters may start again; only a change of command or counter is
//!   a command, and what the same command with a new counter means is for [`rules::state`] to say (trap 4).
//! - **Silence is not loss** (trap 5). The phase stands; [`Listener::silence`] says for how long nothing came, to be told to
//!   people from [`SILENCE`] on.
//!
//! The referee's clock is Unix time, µs; ages of commands are differences on it, so that it need not agree with ours.

mod game;
pub mod team_port;
mod words;

use geometry::{Field, Point};
use protocol::{Duration, Instant};
use rules::Limits;
use rules::state::{Command, GameState, Heard, Ticked};
use ssl::referee::Referee;

pub use game::{Game, TeamAccount};
pub use words::{command_of, stage_of};

/// People are told that the referee is silent after this: it sends every 25 ms, pauses of 1.6 s were recorded on a loaded
/// machine, and twice that is no pause any more.
pub const SILENCE: Duration = Duration::millis(3_000);
/// A packet that is older than the newest by more than this says that the referee's clock was set back. Copies that
/// come over a second network are late by much less.
pub const CLOCK_BACK: Duration = Duration::millis(5_000);
/// A command without a time, as the controller's first HALT, is taken for new, µs.
const NO_TIME: u64 = 0;

/// Hears the referee.
#[derive(Clone, Debug)]
pub struct Listener {
    limits: Limits,
    state: GameState,
    source: Option<Source>,
    game: Game,
    counts: Counts,
    started: Instant,
}

/// The referee that is followed.
#[derive(Clone, Debug)]
struct Source {
    name: Option<String>,
    /// When its newest packet came, host's clock.
    heard: Instant,
    /// When that was sent, µs, its clock.
    sent: u64,
    command: i32,
    counter: u32,
}

/// How many packets came to what.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Packets that were followed.
    pub taken: u64,
    /// Commands among them, repeated ones too.
    pub commands: u64,
    /// Commands that were never heard, by the counter.
    pub missed: u64,
    /// Packets that were sent before the newest.
    pub old: u64,
    /// Copies of the newest.
    pub copies: u64,
    /// Packets of a referee that is not followed.
    pub other_source: u64,
    /// Commands whose number means nothing to us, taken for HALT.
    pub unknown: u64,
}

/// What came of a packet.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// It was followed.
    Taken(Taken),
    /// It was sent before the newest.
    Old {
        /// By how much.
        by: Duration,
    },
    /// It is the newest once more.
    Copy,
    /// Another referee sent it than the one that is followed.
    OtherSource {
        /// Its name.
        name: Option<String>,
    },
}

/// What was new in a packet.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Taken {
    /// A command, and what it means.
    pub command: Option<(Command, Heard)>,
    /// Commands that were never heard, by the counter.
    pub missed: u32,
    /// The counter began again: a new match, or another program.
    pub counter_restarted: bool,
    /// The referee's clock was set back.
    pub clock_back: bool,
    /// This referee is followed from now on; the name is the one followed before, if any.
    pub new_source: Option<Option<String>>,
    /// The command's number, if it means nothing to us.
    pub unknown: Option<i32>,
}

/// How long the referee has said nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Silence {
    /// Nothing was ever heard, for so long.
    Never(Duration),
    /// It was heard this long ago, which is nothing to worry about.
    Heard(Duration),
    /// It has been silent for so long that people should be told. What it said last stands.
    Silent(Duration),
}

impl Listener {
    /// Begins to listen at `now`, host's clock.
    pub fn new(limits: Limits, now: Instant) -> Self {
        let (state, game) = (GameState::new(), Game::default());
        Self { limits, state, source: None, game, counts: Counts::default(), started: now }
    }

    /// The game as it stands.
    pub fn game(&self) -> &Game {
        &self.game
    }

    /// The state of the game, with the ball's part in it.
    pub fn state(&self) -> &GameState {
        &self.state
    }

    /// How many packets came to what.
    pub fn counts(&self) -> Counts {
        self.counts
    }

    /// The name of the referee that is followed, if one is and it has a name.
    pub fn source(&self) -> Option<&str> {
        self.source.as_ref()?.name.as_deref()
    }

    /// How long nothing came.
    pub fn silence(&self, now: Instant) -> Silence {
        match &self.source {
            None => Silence::Never(now.since(self.started)),
            Some(source) if now.since(source.heard) < SILENCE => Silence::Heard(now.since(source.heard)),
            Some(source) => Silence::Silent(now.since(source.heard)),
        }
    }

    /// The time is `now`, and the ball is here.
    pub fn tick(&mut self, now: Instant, ball: Option<Point<Field>>) -> Ticked {
        let ticked = self.state.tick(now.0, ball, &self.limits);
        self.game.stands(&self.state);
        ticked
    }

    /// A packet that came at `now`; `ball` is where it is seen then.
    pub fn hear(&mut self, packet: &Referee, now: Instant, ball: Option<Point<Field>>) -> Verdict {
        let mut taken = Taken::default();
        match &self.source {
            None => taken.new_source = Some(None),
            Some(source) if source.name != packet.source_identifier => {
                if now.since(source.heard) < SILENCE {
                    self.counts.other_source += 1;
                    return Verdict::OtherSource { name: packet.source_identifier.clone() };
                }
                taken.new_source = Some(source.name.clone());
            }
            Some(source) => {
                let by = Duration(source.sent.saturating_sub(packet.packet_timestamp));
                let same = (source.command, source.counter) == (packet.command, packet.command_counter);
                if by.0 > CLOCK_BACK.0 {
                    taken.clock_back = true;
                } else if by.0 > 0 {
                    self.counts.old += 1;
                    return Verdict::Old { by };
                } else if source.sent == packet.packet_timestamp && same {
                    self.counts.copies += 1;
                    return Verdict::Copy;
                }
            }
        }
        self.counts.taken += 1;
        self.command(packet, now, ball, &mut taken);
        self.source = Some(Source {
            name: packet.source_identifier.clone(),
            heard: now,
            sent: packet.packet_timestamp,
            command: packet.command,
            counter: packet.command_counter,
        });
        self.game.read(packet);
        self.game.stands(&self.state);
        Verdict::Taken(taken)
    }

    fn command(&mut self, packet: &Referee, now: Instant, ball: Option<Point<Field>>, taken: &mut Taken) {
        let before = self.source.as_ref().filter(|_| taken.new_source.is_none());
        if let Some(before) = before {
            if (before.command, before.counter) == (packet.command, packet.command_counter) {
                return;
            }
            // A counter of 2³² commands may wrap; a step back of half of that is a new beginning.
            let steps = packet.command_counter.wrapping_sub(before.counter);
            if steps > u32::MAX / 2 {
                taken.counter_restarted = true;
            } else {
                taken.missed = steps.saturating_sub(1);
            }
        }
        let command = command_of(packet.command).unwrap_or_else(|| {
            taken.unknown = Some(packet.command);
            self.counts.unknown += 1;
            Command::Halt
        });
        self.counts.commands += 1;
        self.counts.missed += u64::from(taken.missed);
        let age = match packet.command_timestamp {
            NO_TIME => 0,
            given => packet.packet_timestamp.saturating_sub(given),
        };
        let heard = self.state.hear(command, now.0.saturating_sub(age), ball);
        taken.command = Some((command, heard));
    }
}

#[cfg(test)]
mod tests;
