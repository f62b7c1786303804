//! `left`: balls that a robot had to itself and left lying. s, m, field frame.

use geometry::{Field, Point};
use protocol::Who;
use rules::Colour;
use rules::contact::TOUCHES_WITHIN;

/// Robots that had a ball to themselves, and when.
#[derive(Clone, Debug, Default)]
pub(super) struct LeftBalls {
    had: Vec<Had>,
}

/// The last moment at which a robot had the ball to itself.
#[derive(Clone, Copy, Debug)]
struct Had {
    who: Who,
    at: f64,
    ball: Point<Field>,
}

impl LeftBalls {
    /// Takes a moment with the true places of ball and robots; returns the teams that have left a ball.
    pub(super) fn look(
        &mut self,
        now: f64,
        ball: Point<Field>,
        robots: impl Iterator<Item = (Who, Point<Field>)>,
        run: bool,
    ) -> Vec<Colour> {
        if !run {
            self.forget();
            return Vec::new();
        }
        let robots: Vec<_> = robots.map(|(who, at)| (who, at.distance(ball))).collect();
        for &(who, distance) in &robots {
            let free = robots.iter().all(|(other, off)| other.colour == who.colour || *off > FREE_BEYOND_M);
            if distance < TOUCHES_WITHIN && free {
                self.had.retain(|had| had.who != who);
                self.had.push(Had { who, at: now, ball });
            }
        }
        let mut teams = Vec::new();
        self.had.retain(|had| {
            let lies = had.ball.distance(ball) < LIES_WITHIN_M;
            if lies && now - had.at < LEFT_AFTER_S {
                return true;
            }
            let off = robots.iter().find(|(who, _)| *who == had.who).map_or(0.0, |(_, off)| *off);
            let taken = robots.iter().any(|(_, off)| *off < TOUCHES_WITHIN);
            if lies && off > LEFT_BEYOND_M && !taken {
                teams.push(had.who.colour);
            }
            false
        });
        teams
    }

    pub(super) fn forget(&mut self) {
        self.had.clear();
    }
}

/// A ball with no opponent this near is free, m.
const FREE_BEYOND_M: f32 = 0.45;
/// A ball lies where it moved by less than this, m.
const LIES_WITHIN_M: f32 = 0.1;
/// Time after which it is looked at, s.
const LEFT_AFTER_S: f64 = 0.8;
/// A robot farther away has left it, m.
const LEFT_BEYOND_M: f32 = 0.25;
