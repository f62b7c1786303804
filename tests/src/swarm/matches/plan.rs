//! `plan`: manual acts in the match of a seed. Cards, keeper changes, restarts, halts, timeouts, and moved
//! balls, drawn from the seed alone. ms since the match's start, field frame, m.

use std::fmt;

use geometry::{Field, Point, Vector};
use hil_sim::Stream;
use protocol::RobotId;
use rules::{Colour, League};

/// A manual act during a match.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Act {
    /// A yellow card for this playing time, ms.
    Yellow(Colour, u32),
    /// A red card for that team.
    Red(Colour),
    /// The team names this robot its keeper.
    Keeper(Colour, RobotId),
    /// A penalty for that team.
    Penalty(Colour),
    /// A kick-off for that team.
    Kickoff(Colour),
    /// A free kick for that team from the valid position nearest to this one.
    FreeKick(Colour, Point<Field>),
    /// A force start there, likewise.
    ForceStart(Point<Field>),
    /// HALT, which lasts until [`Act::GoOn`].
    Halt,
    /// STOP, which lasts until [`Act::GoOn`].
    Stop,
    /// The game continues by itself.
    GoOn,
    /// That team requests a timeout of this length, ms.
    Timeout(Colour, u32),
    /// The ball is placed there at once.
    Ball(Point<Field>),
    /// The ball is at once there and rolls, m/s.
    Roll(Point<Field>, Vector<Field>),
}

impl fmt::Display for Act {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let at = |f: &mut fmt::Formatter<'_>, p: &Point<Field>| write!(f, " ({:.2}, {:.2})", p.x(), p.y());
        match self {
            Self::Yellow(team, ms) => write!(f, "yellow card for {} of {ms} ms", team.label()),
            Self::Red(team) => write!(f, "red card for {}", team.label()),
            Self::Keeper(team, robot) => write!(f, "keeper of {}: {robot}", team.label()),
            Self::Penalty(team) => write!(f, "penalty for {}", team.label()),
            Self::Kickoff(team) => write!(f, "kick-off for {}", team.label()),
            Self::FreeKick(team, p) => write!(f, "free kick for {}", team.label()).and_then(|()| at(f, p)),
            Self::ForceStart(p) => f.write_str("force start").and_then(|()| at(f, p)),
            Self::Halt => f.write_str("halt"),
            Self::Stop => f.write_str("stop"),
            Self::GoOn => f.write_str("go on"),
            Self::Timeout(team, ms) => write!(f, "timeout for {} of {ms} ms", team.label()),
            Self::Ball(p) => f.write_str("ball put").and_then(|()| at(f, p)),
            Self::Roll(p, v) => {
                f.write_str("ball rolls").and_then(|()| at(f, p))?;
                write!(f, " at ({:.2}, {:.2}) m/s", v.x(), v.y())
            }
        }
    }
}

/// A match: its settings and manual acts.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Seed from which everything is drawn.
    pub seed: u64,
    /// Division A or B.
    pub league: League,
    /// Whether the teams change ends in the middle of it.
    pub half_time: bool,
    /// Length of the match, ms.
    pub length: u32,
    /// The manual acts with their times, in order.
    pub acts: Vec<(u32, Act)>,
}

impl Plan {
    /// The match of that seed, of this length in ms.
    pub fn drawn(seed: u64, length: u32) -> Self {
        let mut chance = Stream::new(seed, "swarm referee plan");
        let league = if seed.is_multiple_of(2) { League::DivisionB } else { League::DivisionA };
        let half_time = chance.chance(0.3);
        let mut acts = Vec::new();
        let mut at = chance.whole(500, 6_000);
        let mut reds = [0_u32; 2];
        while at < length {
            let act = draw(league, &mut reds, &mut chance);
            acts.push((at, act));
            if matches!(act, Act::Halt | Act::Stop) {
                at += chance.whole(300, 6_000);
                acts.push((at, Act::GoOn));
            }
            at += chance.whole(500, 9_000);
        }
        Self { seed, league, half_time, length, acts }
    }
}

impl fmt::Display for Plan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}", self.league.name(), if self.half_time { " with half-time" } else { "" })?;
        self.acts.iter().try_for_each(|(ms, act)| write!(f, "; {:.1} s {act}", f64::from(*ms) / 1000.0))
    }
}

fn draw(league: League, reds: &mut [u32; 2], chance: &mut Stream) -> Act {
    let team = if chance.chance(0.5) { Colour::Yellow } else { Colour::Blue };
    match chance.whole(0, 19) {
        0 | 1 => Act::Yellow(team, chance.whole(3_000, 40_000)),
        2 if reds[team as usize] == 0 => {
            reds[team as usize] += 1;
            Act::Red(team)
        }
        2..=4 => {
            let robots = if league == League::DivisionA { 11 } else { 6 };
            let number = chance.whole(0, robots - 1) as u8;
            RobotId::new(number).map_or(Act::Stop, |robot| Act::Keeper(team, robot))
        }
        5..=7 => Act::Penalty(team),
        8 => Act::Kickoff(team),
        9..=11 => Act::FreeKick(team, on_field(league, chance)),
        12 => Act::ForceStart(on_field(league, chance)),
        13 => Act::Halt,
        14 => Act::Stop,
        15 => Act::Timeout(team, chance.whole(1_000, 5_000)),
        16 | 17 => Act::Ball(anywhere(league, chance)),
        _ => {
            let velocity = Vector::new(chance.between(-3.0, 3.0), chance.between(-3.0, 3.0));
            Act::Roll(on_field(league, chance), velocity)
        }
    }
}

fn on_field(league: League, chance: &mut Stream) -> Point<Field> {
    let field = league.field();
    let (x, y) = (field.length * 0.5, field.width * 0.5);
    Point::new(chance.between(-x, x), chance.between(-y, y))
}

/// On the field surface within the walls, and in a tenth of the cases up to half a metre beyond them.
fn anywhere(league: League, chance: &mut Stream) -> Point<Field> {
    let field = league.field();
    let beyond = if chance.chance(0.1) { 0.5 } else { 0.0 };
    let x = field.length * 0.5 + field.goal_line_margin + beyond;
    let y = field.width * 0.5 + field.margin + beyond;
    Point::new(chance.between(-x, x), chance.between(-y, y))
}
