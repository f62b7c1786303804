//! `referee`: merges the game controller's packets into the one [`Game`] that robots obey. Times: µs of the
//! host's clock.
//!
//! [`Listener::receive`] takes packets with their sender, [`Listener::tick`] the time and the ball. All rules
//! prefer standing still, because league multicast carries no proof of its sender:
//!
//! - **Within one source** packets count by stamp and counter, but HALT and STOP count by arrival,
//!   independent of their stamp (`source`). Stamps are held to our own clock within [`WINDOW`]; a referee's
//!   clock that steps is followed within that time, and reported.
//! - **Several sources** ([`SourceKey`]: identifier and sender's address). The first is followed: its sheet
//!   (sides, cards, keeper, places) counts until it has been silent for [`SILENCE`]. Of the sources' commands
//!   the strictest is obeyed, HALT before STOP and timeouts before everything else. Where two disagree and
//!   neither is stricter, ours is STOP after [`WINDOW`]: neither can be trusted to let robots play.
//!   [`Listener::warnings`] reports every disagreement with both addresses; [`SourcePin`] ends it.
//! - **HALT that ends without a STOP** of the source that is followed (the other source fell silent, a late
//!   copy) is left through [`GRACE`] of STOP: staff may be on the field.
//! - **Silence is not loss** (trap 5). The phase is kept for [`HALT_AFTER`]; then robots halt
//!   ([`OnSilence::Halt`]) or continue by it ([`OnSilence::GoOn`]). [`Listener::silence`] returns the time
//!   without a packet.
//!
//! Only a change of command or counter is a command, and [`rules::state`] defines what the same command with
//! a new counter means (trap 4). The referee's clock is Unix time, µs; ages of commands are differences on
//! it.

mod description;
mod game;
mod identity;
pub mod remote;
mod source;
mod stamps;
pub mod team_port;
mod verdict;
mod warning;

use geometry::{Field, Point};
use protocol::{Duration, Instant};
use rules::limits::GRACE;
use rules::state::{GameState, Ticked};
use rules::{Colour, Limits, Phase};
use ssl::referee::Referee;

use source::{Outcome, Source, Strictness};

pub use description::{command_of, stage_of};
pub use game::{Game, TeamAccount};
pub use identity::{SenderAddress, SourceKey, SourcePin};
pub use source::{CONFIRM, HOLD};
pub use stamps::WINDOW;
pub use verdict::{Doubt, RefereeCounts, RefereeVerdict, Taken};
pub use warning::Warning;

/// The silence of the referee is reported to the operator after this: it sends every 25 ms, pauses of 1.6 s
/// were recorded on a loaded machine, and twice that is no pause any more. A source that is silent longer is
/// ignored.
pub const SILENCE: Duration = Duration::millis(3_000);
/// Time without a referee after which robots halt, if so configured: 80 packets of the controller, and more
/// than the longest pause recorded on a loaded machine (1.6 s).
pub const HALT_AFTER: Duration = Duration::millis(2_000);
/// Number of sources kept. When full, the least strict one is replaced, so that no flood of sources hides a
/// HALT.
const SOURCES_MAX: usize = 8;

/// Behaviour of robots during silence of a referee that was received before. Before the first packet they
/// halt in any case.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum OnSilence {
    /// Robots halt after [`HALT_AFTER`], and play again after a STOP of [`GRACE`] when it is back.
    #[default]
    Halt,
    /// Robots continue by the last command: for test days on which the controller is started for a command
    /// and ended.
    GoOn,
}

impl OnSilence {
    /// Both, with their names in `team.toml` and on the command line.
    pub const ALL: [(&'static str, Self); 2] = [("halt", Self::Halt), ("go-on", Self::GoOn)];

    /// Name in `team.toml` and on the command line.
    pub const fn label(self) -> &'static str {
        match self {
            Self::Halt => "halt",
            Self::GoOn => "go-on",
        }
    }
}

/// Receives the referee's packets and merges their sources.
#[derive(Clone, Debug)]
pub struct Listener {
    limits: Limits,
    on_silence: OnSilence,
    pin: Option<SourcePin>,
    /// The first is followed.
    sources: Vec<Source>,
    /// Sources that the pin excludes, with their newest packets; at most [`SOURCES_MAX`].
    excluded: Vec<(SourceKey, Instant)>,
    /// Strictness imposed on the source that is followed, by other sources or packets out of order.
    imposed: Strictness,
    /// Since when sources disagree and neither is stricter.
    undecided: Option<Instant>,
    /// STOP until then, because an imposed HALT ended.
    still_until: Instant,
    none: (Game, GameState),
    counts: RefereeCounts,
    /// The newest command, where its number is unknown.
    unknown: Option<i32>,
    started: Instant,
}

/// Silence of the referee.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Silence {
    /// No packet was ever received, for this time.
    Never(Duration),
    /// The newest packet was received this long ago: normal.
    Received(Duration),
    /// It has been silent long enough to warn the operator. Its last command is kept.
    Silent(Duration),
}

impl Listener {
    /// Starts to listen at `now`, to every source or only to the pinned one; a silent referee's last command
    /// is kept.
    pub fn new(limits: Limits, pin: Option<SourcePin>, now: Instant) -> Self {
        Self {
            limits,
            on_silence: OnSilence::GoOn,
            pin,
            sources: Vec::new(),
            excluded: Vec::new(),
            imposed: Strictness::Play,
            undecided: None,
            still_until: Instant(0),
            none: (Game::default(), GameState::new()),
            counts: RefereeCounts::default(),
            unknown: None,
            started: now,
        }
    }

    /// The same with that behaviour when the referee falls silent.
    #[must_use]
    pub fn on_silence(self, on_silence: OnSilence) -> Self {
        Self { on_silence, ..self }
    }

    /// The game as it is to be obeyed.
    pub fn game(&self) -> &Game {
        self.sources.first().map_or(&self.none.0, |source| &source.game)
    }

    /// The state of the game by the commands of the source that is followed, with the effects of the ball's
    /// motion.
    pub fn state(&self) -> &GameState {
        self.sources.first().map_or(&self.none.1, |source| &source.state)
    }

    /// Numbers of packets by verdict.
    pub fn counts(&self) -> RefereeCounts {
        self.counts
    }

    /// Number of the newest command, where it is unknown and the referee is heard.
    pub fn unknown_command(&self, now: Instant) -> Option<i32> {
        self.unknown.filter(|_| matches!(self.silence(now), Silence::Received(_)))
    }

    /// The source that is followed, if one is.
    pub fn source(&self) -> Option<&SourceKey> {
        self.sources.first().map(|source| &source.key)
    }

    /// Time without a packet.
    pub fn silence(&self, now: Instant) -> Silence {
        match self.sources.first() {
            None => Silence::Never(now.since(self.started)),
            Some(source) if now.since(source.received) < SILENCE => {
                Silence::Received(now.since(source.received))
            }
            Some(source) => Silence::Silent(now.since(source.received)),
        }
    }

    /// The time is `now`, and the ball is here.
    pub fn tick(&mut self, now: Instant, ball: Option<Point<Field>>) -> Ticked {
        let mut ticked = Ticked::Same;
        for (place, source) in self.sources.iter_mut().enumerate() {
            let came = source.tick(now, ball, &self.limits);
            if place == 0 {
                ticked = came;
            }
        }
        self.settle(now);
        ticked
    }

    /// Takes a packet that came from `from` at `now`; `ball` is the ball's place then.
    pub fn receive(
        &mut self,
        packet: &Referee,
        from: SenderAddress,
        now: Instant,
        ball: Option<Point<Field>>,
    ) -> RefereeVerdict {
        let key = SourceKey { identifier: packet.source_identifier.clone(), address: from };
        if self.pin.as_ref().is_some_and(|pin| !pin.matches(&key)) {
            self.counts.excluded += 1;
            self.exclude(key.clone(), now);
            return RefereeVerdict::Excluded { source: key };
        }
        let before = self.source().cloned();
        let known = self.sources.iter_mut().find(|source| source.key == key);
        let mut outcome = if let Some(source) = known {
            source.receive(packet, now, ball)
        } else {
            let (source, taken) = Source::new(key.clone(), packet, now, ball);
            self.admit(source, now);
            Outcome::Taken(taken)
        };
        self.count(&outcome);
        self.settle(now);
        if let Outcome::Taken(taken) = &mut outcome
            && self.source() == Some(&key)
            && before.as_ref() != Some(&key)
        {
            taken.new_source = Some(before);
        }
        match outcome {
            Outcome::Copy => RefereeVerdict::Copy,
            _ if self.source() != Some(&key) => {
                self.counts.other_source += 1;
                RefereeVerdict::OtherSource { source: key }
            }
            Outcome::Doubted { doubt, restrains } => RefereeVerdict::Doubted { doubt, restrains },
            Outcome::Taken(taken) => {
                self.counts.taken += 1;
                self.counts.commands += u64::from(taken.command.is_some());
                self.counts.missed += u64::from(taken.missed);
                RefereeVerdict::Taken(taken)
            }
        }
    }

    /// A new source. Where there is no room the least strict one goes, the longest silent first, but never
    /// the one that is followed; a newcomer that is less strict than all of them is not admitted, since its
    /// commands would not be obeyed.
    fn admit(&mut self, source: Source, now: Instant) {
        if self.sources.len() < SOURCES_MAX {
            self.sources.push(source);
            return;
        }
        let others = self.sources.iter_mut().skip(1);
        if let Some(weakest) = others.min_by_key(|other| (other.strictness(now), other.received))
            && weakest.strictness(now) <= source.strictness(now)
        {
            *weakest = source;
        }
    }

    fn exclude(&mut self, key: SourceKey, now: Instant) {
        self.excluded.retain(|(known, _)| *known != key);
        if self.excluded.len() == SOURCES_MAX {
            self.excluded.remove(0);
        }
        self.excluded.push((key, now));
    }

    fn count(&mut self, outcome: &Outcome) {
        match outcome {
            Outcome::Copy => self.counts.copies += 1,
            Outcome::Doubted { doubt, restrains } => {
                let old = matches!(doubt, Doubt::Old(_));
                self.counts.old += u64::from(old);
                self.counts.doubted += u64::from(!old);
                self.counts.restrained += u64::from(*restrains);
            }
            Outcome::Taken(taken) => {
                self.counts.steps += u64::from(taken.clock_stepped.is_some() || taken.counter_restarted);
                self.counts.unknown += u64::from(taken.unknown.is_some());
                if taken.command.is_some() {
                    self.unknown = taken.unknown;
                }
            }
        }
    }

    /// Chooses the source that is followed, and the strictness imposed on it.
    fn settle(&mut self, now: Instant) {
        let audible = |source: &Source| now.since(source.received) < SILENCE;
        let successor = self.sources.iter().position(audible).filter(|place| *place > 0);
        if let Some(place) = successor {
            // It has been silent, and another source is active: those before it are dropped.
            self.sources.drain(..place);
        }
        let mut place = 0;
        self.sources.retain(|source| {
            place += 1;
            place == 1 || audible(source)
        });
        let Some((followed, others)) = self.sources.split_first_mut() else { return };
        let own = Strictness::of(followed.command);
        // A source that agrees imposes only what came out of order; one that disagrees imposes its
        // strictness.
        let imposes = |other: &Source| {
            if other.command == followed.command { other.restraint(now) } else { other.strictness(now) }
        };
        let others_strictest = others.iter().map(imposes).max();
        let mut strictest = followed.restraint(now).max(others_strictest.unwrap_or(Strictness::Play));
        let contradicted = own == Strictness::Play
            && others
                .iter()
                .any(|other| Strictness::of(other.command) == own && other.command != followed.command);
        if contradicted {
            let since = *self.undecided.get_or_insert(now);
            if now.since(since).0 >= WINDOW.0 {
                strictest = strictest.max(Strictness::Stop);
            }
        } else {
            self.undecided = None;
        }
        let newest = others.iter().map(|other| other.received).fold(followed.received, Instant::max);
        if self.on_silence == OnSilence::Halt && now.since(newest) >= HALT_AFTER {
            strictest = Strictness::Halt;
        }
        let plays = !matches!(followed.state.phase(), Phase::Halt | Phase::Stop | Phase::Timeout(_));
        if self.imposed == Strictness::Halt && strictest < Strictness::Halt && plays {
            self.still_until = now + Duration::from_secs_f32(GRACE);
        }
        self.imposed = strictest;
        if now < self.still_until {
            strictest = strictest.max(Strictness::Stop);
        }
        let phase = imposed_on(followed.state.phase(), strictest);
        followed.game.stands(&followed.state, phase);
    }
}

/// The phase that is obeyed where one of that strictness is imposed.
fn imposed_on(phase: Phase<Colour>, strictness: Strictness) -> Phase<Colour> {
    match (strictness, phase) {
        (Strictness::Halt, _) => Phase::Halt,
        (Strictness::Stop, Phase::Halt) => Phase::Halt,
        (Strictness::Stop, _) => Phase::Stop,
        (Strictness::Play, phase) => phase,
    }
}

#[cfg(test)]
mod attacks;
#[cfg(test)]
mod silent;
#[cfg(test)]
mod tests;
