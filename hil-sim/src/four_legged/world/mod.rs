//! `world`: physics of the four-legged league. Ball and walking robots in steps of 10 ms; m, s, rad, field
//! frame (docs/architecture.md §7.1).
//!
//! A step: primitives progress (`primitives`), robots walk (`walker`) and are pushed apart, the ball rolls
//! (`ball`) or is carried, and bodies in contact push it (`contact`). What happened is returned as
//! [`WorldEvent`]s. Robots are named by their index in [`LeggedWorld::walkers`]: attackers by id, then
//! opponents.
//!
//! **Invariants.** No clock and no unseeded randomness; the order of every loop is fixed; `geometry::math`
//! only.

mod ball;
mod contact;
mod primitives;
mod walker;

pub use ball::LeggedBall;
pub use walker::{Primitive, PrimitiveKind, Side, Walker};

use geometry::{Field, Point, Vector};
use protocol::robot_io::{ActuatorFrame, LeggedKick};
use rules::{FieldSpec, League};

use crate::four_legged::parameters::Parameters;
use crate::rng::Stream;

/// The true state of ball and robots.
#[derive(Clone, Debug)]
pub struct LeggedWorld {
    /// True state of the ball.
    pub ball: LeggedBall,
    /// True states of all robots, both teams.
    pub walkers: Vec<Walker>,
    /// The robot that has the ball between its legs, if any.
    hold: Option<Hold>,
    /// The robot that just kicked the ball and does not collide with it until it is clear of the body.
    leaving: Option<usize>,
    parameters: Parameters,
    field: FieldSpec,
    robot_radius: f32,
    ball_radius: f32,
    kicks: Stream,
    grabs: Stream,
    events: Vec<WorldEvent>,
}

/// The ball between a robot's legs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Hold {
    robot: usize,
    /// True when the grab has ended and succeeded; false while the legs are closing.
    firm: bool,
}

/// Events of a step; robots are indices in [`LeggedWorld::walkers`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WorldEvent {
    /// A robot's body is in contact with the ball (repeated in every step of the contact).
    Touched {
        /// Index of the robot in [`LeggedWorld::walkers`].
        robot: usize,
    },
    /// A grab succeeded: the robot holds the ball.
    Grabbed {
        /// Index of the robot in [`LeggedWorld::walkers`].
        robot: usize,
    },
    /// A grab ended without the ball.
    GrabFailed {
        /// Index of the robot in [`LeggedWorld::walkers`].
        robot: usize,
    },
    /// The ball was kicked.
    Kicked {
        /// Index of the robot in [`LeggedWorld::walkers`].
        robot: usize,
        /// The kind of kick.
        kick: LeggedKick,
        /// Position of the ball at the kick.
        from: Point<Field>,
        /// The ball's stop position if nothing touches it.
        rest: Point<Field>,
    },
    /// A kick started without the ball held by the robot: nothing moved.
    KickedNothing {
        /// Index of the robot in [`LeggedWorld::walkers`].
        robot: usize,
    },
    /// A grab took the ball out of another robot's legs.
    Stolen {
        /// The robot that took it.
        by: usize,
        /// The robot that had it.
        from: usize,
    },
}

impl LeggedWorld {
    /// A four-legged field with a resting ball; random streams come from `seed`.
    pub fn new(parameters: &Parameters, seed: u64, ball: Point<Field>, walkers: Vec<Walker>) -> Self {
        let league = League::FourLegged;
        Self {
            ball: LeggedBall::at(ball),
            walkers,
            hold: None,
            leaving: None,
            parameters: parameters.clone(),
            field: league.field(),
            robot_radius: league.robot().radius,
            ball_radius: league.ball().radius,
            kicks: Stream::new(seed, "kicks"),
            grabs: Stream::new(seed, "grabs"),
            events: Vec::new(),
        }
    }

    /// Gives a robot's body its brain's order; a body without wheels ignores orders for wheels.
    pub fn command(&mut self, robot: usize, order: &ActuatorFrame) {
        let (Some(walker), ActuatorFrame::Legged { walk, primitive }) = (self.walkers.get_mut(robot), order)
        else {
            return;
        };
        walker.order(*walk, *primitive, self.parameters.grab.duration, self.parameters.kick.duration);
    }

    /// A robot's computer stopped: the body stands, its legs open, and its primitive ends.
    pub fn let_go(&mut self, robot: usize) {
        if let Some(walker) = self.walkers.get_mut(robot) {
            walker.wanted = geometry::Twist::default();
            walker.action = None;
        }
        if self.hold.is_some_and(|hold| hold.robot == robot) {
            self.hold = None;
            self.ball.velocity = Vector::default();
        }
    }

    /// Advances by 10 ms.
    pub fn step(&mut self) {
        for robot in 0..self.walkers.len() {
            self.progress(robot);
        }
        for robot in 0..self.walkers.len() {
            let carry = (self.hold.is_some_and(|hold| hold.robot == robot)).then_some(&self.parameters.carry);
            self.walkers[robot].walk(&self.parameters.walk, carry, STEP);
        }
        self.push_robots_apart();
        for walker in &mut self.walkers {
            walker.stay_on_surface(&self.field, self.robot_radius);
        }
        if self.hold.is_some() {
            self.carry_ball();
        } else {
            self.ball.roll(self.parameters.ball.deceleration, STEP);
            self.collide_with_ball();
            self.ball.stay_in_net(&self.field, self.ball_radius);
        }
    }

    /// Appends the events since the last call, in order, to `into`.
    pub fn take_events(&mut self, into: &mut Vec<WorldEvent>) {
        into.append(&mut self.events);
    }

    /// The robot that holds the ball after a successful grab.
    pub fn holder(&self) -> Option<usize> {
        self.hold.filter(|hold| hold.firm).map(|hold| hold.robot)
    }

    /// The ball lies at the holder's legs and moves with it; a robot of the other team that reaches it,
    /// touches it.
    fn carry_ball(&mut self) {
        let Some(Hold { robot, .. }) = self.hold else { return };
        let walker = &self.walkers[robot];
        self.ball.position = walker.pose.to_field(Point::new(self.parameters.grab.hold_distance, 0.0));
        self.ball.velocity = walker.velocity_at(self.ball.position);
        let (side, touching) = (walker.side, self.robot_radius + self.ball_radius);
        for (other, walker) in self.walkers.iter().enumerate() {
            if walker.side != side && walker.pose.position.distance(self.ball.position) < touching {
                self.events.push(WorldEvent::Touched { robot: other });
            }
        }
    }
}

/// Seconds in a physics step (docs/architecture.md §2.3: four-legged, every 10 ms).
pub const STEP: f32 = 0.01;

#[cfg(test)]
mod tests;
