//! `counts`: numbers of a team's possessions by their end, kicks by speed and length, and shots.

use std::collections::BTreeMap;

use serde::Serialize;

geometry::labels! {
    /// End of a possession.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum PossessionEnd {
        /// A goal.
        Goal = "goal",
        /// A shot that scored no goal.
        Shot = "shot",
        /// A kick to an opponent.
        KickToOpponent = "kick-to-opponent",
        /// The opponents took the ball from a robot at it, or in a scrum.
        Tackle = "tackle",
        /// The opponents came to a ball that no robot of the team was at.
        Left = "left",
        /// The ball went out.
        Out = "out",
        /// The referee stopped play for another reason.
        Referee = "referee",
    }
}

/// Shots by what was open, and what became of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct ShotCounts {
    /// No line to the goal was free.
    pub closed: u32,
    /// Less than half of the lines were free.
    pub partly_open: u32,
    /// Half of the lines or more were free.
    pub open: u32,
    /// Shots at the first touch of a teammate's kick.
    pub volleys: u32,
    /// Goals by shots.
    pub goals: u32,
}

impl ShotCounts {
    /// All shots.
    pub fn all(&self) -> u32 {
        self.closed + self.partly_open + self.open
    }

    pub(super) fn add(&mut self, open: f32, volley: bool) {
        let count = if open <= 0.0 {
            &mut self.closed
        } else if open < 0.5 {
            &mut self.partly_open
        } else {
            &mut self.open
        };
        *count += 1;
        self.volleys += u32::from(volley);
    }
}

/// Possessions, kicks, shots and left balls of a team in a match.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct AttackCounts {
    /// Possessions by their end.
    pub ends: BTreeMap<&'static str, u32>,
    /// Their time, s.
    pub possessed_s: f32,
    /// Kicks that are no shots, by speed, length and who had the ball next: `2-3/4-5/team`, m/s and m.
    pub kicks: BTreeMap<String, u32>,
    /// Shots at the goal.
    pub shots: ShotCounts,
    /// Balls that a robot had and left.
    pub left_balls: u32,
}

impl AttackCounts {
    pub(super) fn ended(&mut self, end: PossessionEnd, lasted: f32) {
        *self.ends.entry(end.label()).or_default() += 1;
        self.possessed_s += lasted;
    }

    pub(super) fn kick(&mut self, speed: f32, length: f32, to_team: bool) {
        let bin = |value: f32| (value as u32).min(6);
        let (speed, length) = (bin(speed), bin(length));
        let next = if to_team { "team" } else { "lost" };
        *self.kicks.entry(format!("{speed}-{}/{length}-{}/{next}", speed + 1, length + 1)).or_default() += 1;
    }

    /// All counts by name: `end.shot`, `kick.2-3/4-5/team`, `shot.volley`, `left-ball`, …
    pub fn named(&self) -> impl Iterator<Item = (String, u32)> + '_ {
        let ends = self.ends.iter().map(|(end, n)| (format!("end.{end}"), *n));
        let kicks = self.kicks.iter().map(|(kick, n)| (format!("kick.{kick}"), *n));
        let ShotCounts { closed, partly_open, open, volleys, goals } = self.shots;
        let others = [
            ("shot.closed", closed),
            ("shot.partly-open", partly_open),
            ("shot.open", open),
            ("shot.volley", volleys),
            ("shot.goal", goals),
            ("left-ball", self.left_balls),
        ];
        ends.chain(kicks).chain(others.map(|(name, n)| (name.to_owned(), n))).filter(|(_, n)| *n > 0)
    }
}
