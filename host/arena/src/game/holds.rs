//! `holds`: spells in which a robot holds the ball in play: how long, and how often it turns to and fro. From
//! the true world. s, m, rad.
//!
//! A robot holds the ball while the ball is on the field surface within [`HELD_WITHIN_M`] of its front
//! plate. A gap of up to [`GAP`] belongs to the spell: a ball that rolls off the roller and is taken again
//! was not released. A spell ends with the phase.

use hil_sim::small_size::{Ball, Robot};
use protocol::Who;
use rules::{Colour, Phase};
use serde::Serialize;

use super::Game;

/// One robot's time with the ball at its front.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Hold {
    /// Team of the robot: `blue` or `yellow`.
    pub team: &'static str,
    /// The robot's number in its team.
    pub robot: u8,
    /// Start of the spell, simulated s.
    pub from_s: f32,
    /// Duration of the spell, s.
    pub lasted_s: f32,
    /// Number of changes of the sense in which it turns, by more than 5° each.
    pub reversals: u32,
}

/// All spells of a match.
#[derive(Clone, Debug, Default)]
pub(super) struct Holds {
    open: Vec<Spell>,
    long: Vec<Hold>,
    longest: [f32; 2],
    over: [u32; 2],
}

#[derive(Clone, Copy, Debug)]
struct Spell {
    who: Who,
    from: f64,
    until: f64,
    turning: Turning,
}

/// Counter of a heading's changes of direction.
#[derive(Clone, Copy, Debug)]
struct Turning {
    heading: f32,
    /// The heading, unrolled, and its last extreme, rad.
    sum: f32,
    extreme: f32,
    /// +1 or −1, the sense in which it turns; 0 before it is known.
    sense: f32,
    reversals: u32,
}

impl Turning {
    fn new(heading: f32) -> Self {
        Self { heading, sum: 0.0, extreme: 0.0, sense: 0.0, reversals: 0 }
    }

    fn look(&mut self, heading: f32) {
        let off = heading - self.heading;
        self.sum += off.sin().atan2(off.cos());
        self.heading = heading;
        let swing = self.sum - self.extreme;
        if swing * self.sense > 0.0 {
            self.extreme = self.sum;
        } else if swing.abs() > SWING {
            self.reversals += u32::from(self.sense != 0.0);
            (self.sense, self.extreme) = (swing.signum(), self.sum);
        }
    }
}

impl Holds {
    pub(super) fn look(&mut self, game: &Game<'_>) {
        let now = game.time();
        if game.referee().phase() != Phase::Run {
            return self.end(f64::INFINITY);
        }
        let ball = &game.world().ball;
        for robot in game.world().robots().iter().filter(|robot| robot.present && holds(robot, ball)) {
            let heading = robot.pose.heading.radians();
            if let Some(spell) = self.open.iter_mut().find(|spell| spell.who == robot.who) {
                spell.until = now;
                spell.turning.look(heading);
            } else {
                let turning = Turning::new(heading);
                self.open.push(Spell { who: robot.who, from: now, until: now, turning });
            }
        }
        self.end(now);
    }

    /// Closes the spells that were interrupted for longer than [`GAP`].
    fn end(&mut self, now: f64) {
        let (open, over): (Vec<_>, Vec<_>) = self.open.iter().partition(|spell| now - spell.until <= GAP);
        self.open = open;
        for spell in over {
            self.close(&spell);
        }
    }

    fn close(&mut self, spell: &Spell) {
        let (team, lasted) = (spell.who.colour, (spell.until - spell.from) as f32);
        let longest = &mut self.longest[team as usize];
        *longest = longest.max(lasted);
        if lasted >= LONG_HOLD_S {
            self.over[team as usize] += 1;
            self.long.push(Hold {
                team: team.label(),
                robot: spell.who.id.number(),
                from_s: spell.from as f32,
                lasted_s: lasted,
                reversals: spell.turning.reversals,
            });
        }
    }

    /// The report with running spells counted as over.
    pub(super) fn closed(&self) -> Self {
        let mut all = self.clone();
        all.end(f64::INFINITY);
        all
    }

    /// The longest spell of a team, s.
    pub(super) fn longest(&self, team: Colour) -> f32 {
        self.longest[team as usize]
    }

    /// Number of a team's spells that lasted for [`LONG_HOLD_S`] and longer.
    pub(super) fn over(&self, team: Colour) -> u32 {
        self.over[team as usize]
    }

    /// These spells, oldest first.
    pub(super) fn long(&self) -> &[Hold] {
        &self.long
    }
}

fn holds(robot: &Robot, ball: &Ball) -> bool {
    let at = robot.pose.to_body(ball.position);
    let half = (robot.body.radius.powi(2) - robot.body.front.powi(2)).max(0.0).sqrt();
    let gap = at.x() - robot.body.front - BALL_RADIUS;
    ball.height < BODY_HEIGHT && at.x() > 0.0 && gap <= HELD_WITHIN_M && at.y().abs() <= half + HELD_WITHIN_M
}

/// The ball is at the front within this distance, m.
const HELD_WITHIN_M: f32 = 0.02;
/// A spell continues after a gap of at most this, s: longer than a ball bounces off a roller, shorter than it
/// takes to release it, back off and come again.
const GAP: f64 = 0.25;
/// Duration from which a spell is long, s: the opponents' robots reach it twice in ten minutes.
const LONG_HOLD_S: f32 = 2.5;
/// A turn by less than this is not counted, rad: 5°.
const SWING: f32 = 0.087;
const BALL_RADIUS: f32 = rules::limits::BALL_RADIUS;
const BODY_HEIGHT: f32 = rules::limits::ROBOT_HEIGHT;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_heading_that_swings_to_and_fro_counts_each_turn_back_and_noise_counts_none() {
        let mut turning = Turning::new(3.1);
        for heading in [3.2, 3.4, 3.38, 3.41, 3.2, 3.0, 3.2, 3.5] {
            turning.look(heading);
        }
        assert_eq!(turning.reversals, 2);
    }
}
