//! `state`: state machine of the referee's commands. The league's state graph as a value (rules 2026,
//! appendix "game states").
//!
//! [`GameState::receive`] takes the commands, [`GameState::tick`] the time and the ball; both return the
//! resulting change. Times are µs of one clock, the caller's. Three points that the rules leave open are
//! decided here:
//!
//! - **The newest command counts.** The referee repeats its current command many times a second, so a command
//!   that does not follow from the one before means that some were missed; it is followed and reported
//!   ([`CommandVerdict::OffGraph`]).
//! - **No robot starts from a standstill without warning.** Team members may be on the field in HALT and
//!   time-outs, which STOP alone ends. Any other command is read as STOP for [`GRACE`] first
//!   ([`CommandVerdict::AsStop`]). NORMAL_START with nothing prepared (a program joins in the middle of a
//!   game) is read as STOP until the longest kick-off or penalty is over, counted from when the command was
//!   given: then the ball is in play in either case.
//! - **The same command again is no new command**, though its counter rises (operators and automatic
//!   continuation issue some twice). It only restarts the clock of a restart that is not yet in play. A free
//!   kick that comes again after the ball was in play is a new one: a ball that rolls is back in play at
//!   once, and a stationary one may not be approached.

use geometry::{Field, Point};

use crate::limits::{GRACE, IN_PLAY_DISTANCE, KICKOFF_TIME, PENALTY_TIME};
use crate::{Colour, Limits, Phase};

/// A command of the referee.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum RefereeCommand {
    /// No robot moves, by the rules of HALT.
    Halt,
    /// Slow, away from the ball.
    Stop,
    /// Kick the prepared kick-off or penalty.
    NormalStart,
    /// Play continues for both teams.
    ForceStart,
    /// Take places for this team's kick-off.
    PrepareKickoff(Colour),
    /// Take places for this team's penalty.
    PreparePenalty(Colour),
    /// This team's free kick.
    FreeKick(Colour),
    /// This team's time-out, as HALT.
    Timeout(Colour),
    /// This team places the ball.
    BallPlacement(Colour),
}

impl RefereeCommand {
    /// Every command, those of teams for each team.
    pub fn all() -> impl Iterator<Item = Self> {
        let of_teams = Colour::ALL.into_iter().flat_map(|team| {
            [
                Self::PrepareKickoff(team),
                Self::PreparePenalty(team),
                Self::FreeKick(team),
                Self::Timeout(team),
                Self::BallPlacement(team),
            ]
        });
        [Self::Halt, Self::Stop, Self::NormalStart, Self::ForceStart].into_iter().chain(of_teams)
    }

    /// The phase that it leads to; `None` for NORMAL_START without a preparation.
    pub const fn leads_to(self, from: Phase<Colour>) -> Option<Phase<Colour>> {
        Some(match self {
            Self::Halt => Phase::Halt,
            Self::Stop => Phase::Stop,
            Self::ForceStart => Phase::Run,
            Self::PrepareKickoff(who) => Phase::PrepareKickoff(who),
            Self::PreparePenalty(who) => Phase::PreparePenalty(who),
            Self::FreeKick(who) => Phase::FreeKick(who),
            Self::Timeout(who) => Phase::Timeout(who),
            Self::BallPlacement(who) => Phase::BallPlacement(who),
            Self::NormalStart => match from {
                Phase::PrepareKickoff(who) => Phase::Kickoff(who),
                Phase::PreparePenalty(who) => Phase::Penalty(who),
                _ => return None,
            },
        })
    }
}

/// The stage of a match.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Stage {
    /// Before the first half.
    FirstHalfPre,
    /// The first half is played.
    FirstHalf,
    /// The break between the halves.
    HalfTime,
    /// Before the second half.
    SecondHalfPre,
    /// The second half is played.
    SecondHalf,
    /// The break before overtime.
    ExtraTimeBreak,
    /// Before overtime's first half.
    ExtraFirstHalfPre,
    /// Overtime's first half is played.
    ExtraFirstHalf,
    /// The break between overtime's halves.
    ExtraHalfTime,
    /// Before overtime's second half.
    ExtraSecondHalfPre,
    /// Overtime's second half is played.
    ExtraSecondHalf,
    /// The break before the shoot-out.
    ShootOutBreak,
    /// The penalty shoot-out is played.
    ShootOut,
    /// The match is over.
    PostGame,
}

impl Stage {
    /// All stages, in the order of a match.
    pub const ALL: [Self; 14] = [
        Self::FirstHalfPre,
        Self::FirstHalf,
        Self::HalfTime,
        Self::SecondHalfPre,
        Self::SecondHalf,
        Self::ExtraTimeBreak,
        Self::ExtraFirstHalfPre,
        Self::ExtraFirstHalf,
        Self::ExtraHalfTime,
        Self::ExtraSecondHalfPre,
        Self::ExtraSecondHalf,
        Self::ShootOutBreak,
        Self::ShootOut,
        Self::PostGame,
    ];

    /// Returns whether teams pause and team members may enter the field.
    pub const fn is_break(self) -> bool {
        matches!(
            self,
            Self::HalfTime
                | Self::ExtraTimeBreak
                | Self::ExtraHalfTime
                | Self::ShootOutBreak
                | Self::PostGame
        )
    }
}

/// Effect of a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CommandVerdict {
    /// The command follows from the phase before.
    Followed,
    /// The command that holds already.
    Repeated,
    /// The command does not follow from this phase, but is accepted.
    OffGraph {
        /// The phase before the command.
        from: Phase<Colour>,
    },
    /// The command does not follow from this phase, and is read as STOP first.
    AsStop {
        /// The phase before the command.
        from: Phase<Colour>,
        /// The phase that follows STOP.
        then: Phase<Colour>,
        /// Time of the change, µs.
        at: u64,
    },
}

/// Effect of time and ball.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ticked {
    /// No change of the phase.
    Same,
    /// The ball has moved [`IN_PLAY_DISTANCE`] from its place: in play.
    BallMoved,
    /// The time for the restart is over: in play, or for a penalty stopped.
    TimeUp,
    /// A command that was read as STOP is followed now.
    Released,
}

/// State of a game, derived from its commands, clock and ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GameState {
    phase: Phase<Colour>,
    command: Option<RefereeCommand>,
    /// Start of the phase, µs.
    since: u64,
    /// Position of the ball when the restart started.
    ball_at: Option<Point<Field>>,
    penalty_in_play: bool,
    later: Option<(Phase<Colour>, u64)>,
    /// No robot starts before, µs: a standstill was left without a STOP.
    still_until: u64,
}

impl Default for GameState {
    fn default() -> Self {
        Self::new()
    }
}

impl GameState {
    /// A state without any command received: no robot moves.
    pub const fn new() -> Self {
        let phase = Phase::Halt;
        let (ball_at, later) = (None, None);
        Self { phase, command: None, since: 0, ball_at, penalty_in_play: false, later, still_until: 0 }
    }

    /// The present phase of the game, by team colour.
    pub const fn phase(&self) -> Phase<Colour> {
        self.phase
    }

    /// The newest command; none: nothing received yet.
    pub const fn command(&self) -> Option<RefereeCommand> {
        self.command
    }

    /// Time at which this phase started or its clock was restarted, µs.
    pub const fn since(&self) -> u64 {
        self.since
    }

    /// Returns whether a penalty's ball has left its place, which frees the keeper; in every other phase
    /// whether the ball is in play.
    pub const fn ball_in_play(&self) -> bool {
        match self.phase {
            Phase::Run => true,
            Phase::Penalty(_) => self.penalty_in_play,
            _ => false,
        }
    }

    /// A command that was given at `at`, µs; `ball` is where it lies then, if known.
    pub fn receive(
        &mut self,
        command: RefereeCommand,
        at: u64,
        ball: Option<Point<Field>>,
    ) -> CommandVerdict {
        let (from, first) = (self.phase, self.command.is_none());
        let again = self.command == Some(command);
        self.command = Some(command);
        if again {
            return self.repeat(command, at, ball);
        }
        if matches!(command, RefereeCommand::Halt | RefereeCommand::Stop | RefereeCommand::Timeout(_)) {
            self.still_until = 0;
        } else if matches!(from, Phase::Halt | Phase::Timeout(_)) && !first {
            self.still_until = at.saturating_add(micros(GRACE));
        }
        // NORMAL_START starts what is prepared, even where that is still read as STOP.
        let prepared = self.later.map_or(from, |(phase, _)| phase);
        let Some(to) = command.leads_to(prepared) else {
            let longest = micros(if KICKOFF_TIME > PENALTY_TIME { KICKOFF_TIME } else { PENALTY_TIME });
            return self.stop_first(Phase::Run, at, at.saturating_add(longest));
        };
        if at < self.still_until {
            return self.stop_first(to, at, self.still_until);
        }
        self.enter(to, at, ball);
        if first || follows(from, to) { CommandVerdict::Followed } else { CommandVerdict::OffGraph { from } }
    }

    /// Handles the time `now`, µs, and the observed position of the ball.
    pub fn tick(&mut self, now: u64, ball: Option<Point<Field>>, limits: &Limits) -> Ticked {
        if let Some((phase, at)) = self.later
            && now >= at
        {
            self.enter(phase, at, ball);
            return Ticked::Released;
        }
        let (time, then) = match self.phase {
            Phase::Kickoff(_) => (KICKOFF_TIME, Phase::Run),
            Phase::FreeKick(_) => (limits.free_kick_time, Phase::Run),
            Phase::Penalty(_) => (PENALTY_TIME, Phase::Stop),
            _ => return Ticked::Same,
        };
        if now >= self.since.saturating_add(micros(time)) {
            self.enter(then, now, None);
            return Ticked::TimeUp;
        }
        let Some(ball) = ball.filter(|ball| ball.is_finite()) else { return Ticked::Same };
        let place = *self.ball_at.get_or_insert(ball);
        if self.penalty_in_play || place.distance(ball) < IN_PLAY_DISTANCE {
            return Ticked::Same;
        }
        if matches!(self.phase, Phase::Penalty(_)) {
            self.penalty_in_play = true;
        } else {
            self.enter(Phase::Run, now, None);
        }
        Ticked::BallMoved
    }

    fn repeat(&mut self, command: RefereeCommand, at: u64, ball: Option<Point<Field>>) -> CommandVerdict {
        match (self.phase, command) {
            (Phase::Kickoff(_) | Phase::FreeKick(_) | Phase::Penalty(_), _) => {
                self.since = self.since.max(at);
                CommandVerdict::Repeated
            }
            (Phase::Run, RefereeCommand::FreeKick(who)) => {
                self.enter(Phase::FreeKick(who), at, ball);
                CommandVerdict::OffGraph { from: Phase::Run }
            }
            _ => CommandVerdict::Repeated,
        }
    }

    fn stop_first(&mut self, then: Phase<Colour>, now: u64, at: u64) -> CommandVerdict {
        let from = self.phase;
        self.enter(Phase::Stop, now, None);
        self.later = Some((then, at));
        CommandVerdict::AsStop { from, then, at }
    }

    fn enter(&mut self, phase: Phase<Colour>, at: u64, ball: Option<Point<Field>>) {
        let ball_at = ball.filter(|ball| ball.is_finite());
        *self = Self { phase, since: at, ball_at, penalty_in_play: false, later: None, ..*self };
    }
}

/// Returns whether the league's graph has this edge (commands only; time and ball make the others).
pub fn follows(from: Phase<Colour>, to: Phase<Colour>) -> bool {
    match to {
        Phase::Halt => true,
        Phase::Stop => !matches!(from, Phase::Stop),
        Phase::Timeout(_) | Phase::PrepareKickoff(_) | Phase::PreparePenalty(_) => {
            matches!(from, Phase::Stop)
        }
        Phase::BallPlacement(who) => {
            // The other team tries after a failure.
            matches!(from, Phase::Stop) || from == Phase::BallPlacement(who.other())
        }
        Phase::FreeKick(_) => matches!(from, Phase::Stop | Phase::BallPlacement(_)),
        Phase::Run => matches!(from, Phase::Stop | Phase::BallPlacement(_)),
        Phase::Kickoff(who) => from == Phase::PrepareKickoff(who),
        Phase::Penalty(who) => from == Phase::PreparePenalty(who),
    }
}

/// Converts s to µs.
const fn micros(seconds: f32) -> u64 {
    (seconds * 1e6) as u64
}

#[cfg(test)]
mod tests;
