//! `game`: phases of the game, common to robots, host, referee and simulator (rules 2026, chapter on referee
//! commands).

use core::fmt;

use serde::{Deserialize, Serialize};

geometry::labels! {
    /// A team by its colour; not to be confused with the goals that case files call "yellow" and "cyan".
    #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
    pub enum Colour {
        /// The team with yellow centre dots.
        Yellow = "yellow",
        /// The team with blue centre dots.
        Blue = "blue",
    }
}

impl Colour {
    /// The team of the other colour.
    pub const fn other(self) -> Self {
        match self {
            Self::Yellow => Self::Blue,
            Self::Blue => Self::Yellow,
        }
    }

    /// The value of this team, of both teams' values.
    pub fn pick<T>(self, yellow: T, blue: T) -> T {
        match self {
            Self::Yellow => yellow,
            Self::Blue => blue,
        }
    }
}

/// A team from the side of one of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum Side {
    /// The team that speaks of itself.
    Ours,
    /// The team that it plays against.
    Theirs,
}

/// A robot's role under the rules.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum RuleRole {
    /// Field player without special rights.
    #[default]
    Player,
    /// The robot that may be in the own defence area.
    Keeper,
    /// The robot that kicks our restart: it may come near the ball before it is in play.
    Kicker,
}

/// A node of the league's state graph; `Who` is [`Colour`] for an outside observer and [`Side`] for a team.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Phase<Who> {
    /// No robot moves, by the rules of HALT.
    Halt,
    /// Slow, away from the ball, no robot touches it.
    Stop,
    /// A team has taken a time-out: as halt, but team members may work on robots.
    Timeout(Who),
    /// This team brings the ball to the designated position.
    BallPlacement(Who),
    /// Preparation of this team's kick-off.
    PrepareKickoff(Who),
    /// This team may kick off.
    Kickoff(Who),
    /// Preparation of this team's penalty.
    PreparePenalty(Who),
    /// This team may shoot its penalty.
    Penalty(Who),
    /// This team may take its free kick.
    FreeKick(Who),
    /// The ball is in play.
    Run,
}

impl Phase<Colour> {
    /// The same phase from the side of the team of that colour.
    pub fn seen_by(self, us: Colour) -> Phase<Side> {
        self.map(|colour| if colour == us { Side::Ours } else { Side::Theirs })
    }
}

impl fmt::Display for Phase<Colour> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (name, team) = match self {
            Self::Halt => ("halt", None),
            Self::Stop => ("stop", None),
            Self::Run => ("run", None),
            Self::Timeout(team) => ("timeout", Some(team)),
            Self::BallPlacement(team) => ("ball placement", Some(team)),
            Self::PrepareKickoff(team) => ("prepare kickoff", Some(team)),
            Self::Kickoff(team) => ("kickoff", Some(team)),
            Self::PreparePenalty(team) => ("prepare penalty", Some(team)),
            Self::Penalty(team) => ("penalty", Some(team)),
            Self::FreeKick(team) => ("free kick", Some(team)),
        };
        f.write_str(name)?;
        team.map_or(Ok(()), |team| write!(f, ", {}", team.label()))
    }
}

impl<Who> Phase<Who> {
    /// The same phase with the team named by another type.
    pub fn map<Other>(self, name: impl FnOnce(Who) -> Other) -> Phase<Other> {
        match self {
            Self::Halt => Phase::Halt,
            Self::Stop => Phase::Stop,
            Self::Run => Phase::Run,
            Self::Timeout(who) => Phase::Timeout(name(who)),
            Self::BallPlacement(who) => Phase::BallPlacement(name(who)),
            Self::PrepareKickoff(who) => Phase::PrepareKickoff(name(who)),
            Self::Kickoff(who) => Phase::Kickoff(name(who)),
            Self::PreparePenalty(who) => Phase::PreparePenalty(name(who)),
            Self::Penalty(who) => Phase::Penalty(name(who)),
            Self::FreeKick(who) => Phase::FreeKick(name(who)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_phase_is_written_in_words_with_its_team() {
        use std::string::ToString as _;

        assert_eq!(Phase::FreeKick(Colour::Blue).to_string(), "free kick, blue");
        assert_eq!(Phase::<Colour>::Halt.to_string(), "halt");
    }

    #[test]
    fn a_team_sees_its_own_free_kick_as_ours() {
        let phase = Phase::FreeKick(Colour::Blue);
        assert_eq!(phase.seen_by(Colour::Blue), Phase::FreeKick(Side::Ours));
        assert_eq!(phase.seen_by(Colour::Blue.other()), Phase::FreeKick(Side::Theirs));
    }
}
