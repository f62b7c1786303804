//! `world`: physics of the four-legged league. Ball and walking robots in steps of 10 ms; m, s, rad, field
//! frame (docs/architecture.md §7.1).
//!
//! A step: primitives progress (`primitives`), robots walk (`walker`) and are pushed apart, the ball rolls (`ball`) or is
//! carried, and what touches it pushes it (`contact`). What happened comes out as [`WorldEvent`]s. Robots are named
//! by their place in [`World::walkers`]: attackers by id, then opponents.
//!
//! **Invariants.** No clock and no unseeded chance; the order of every loop is fixed; `geometry::math` only.

mod ball;
mod contact;
mod primitives;
mod walker;

pub use ball::Ball;
pub use walker::{Primitive, PrimitiveKind, Side, Walker};

use geometry::{Field, Point, Vector};
use protocol::robot_io::{ActuatorFrame, LeggedKick};
use rules::{FieldSpec, League};

use crate::four_legged::parameters::Parameters;
use crate::rng::Stream;

/// The true state of everything on the carpet.
#[derive(Clone, Debug)]
pub struct World {
    /// The ball.
    pub ball: Ball,
    /// The robots.
    pub walkers: Vec<Walker>,
    /// Who has the ball between the legs, if somebody has.
    hold: Option<Hold>,
    /// Who just kicked the ball and does not collide with it until it is clear of the body.
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
    /// The grab has ended and succeeded; before, the legs are closing.
    firm: bool,
}

/// What happened in a step, by robots' places in [`World::walkers`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WorldEvent {
    /// A robot's body is in contact with the ball (comes again every step that it is).
    Touched {
        /// Who.
        robot: usize,
    },
    /// A grab succeeded.
    Grabbed {
        /// Who.
        robot: usize,
    },
    /// A grab ended without the ball.
    GrabFailed {
        /// Who.
        robot: usize,
    },
    /// The ball was kicked.
    Kicked {
        /// Who.
        robot: usize,
        /// How.
        kick: LeggedKick,
        /// From here.
        from: Point<Field>,
        /// It would come to rest here, undisturbed.
        rest: Point<Field>,
    },
    /// A kick began without the ball in the robot's grip: nothing moved.
    KickedNothing {
        /// Who.
        robot: usize,
    },
    /// A grab took the ball out of another robot's grip.
    Stolen {
        /// Who took it.
        by: usize,
        /// Who had it.
        from: usize,
    },
}

impl World {
    /// A four-legged field with a ball at rest; chance comes from `seed`.
    pub fn new(parameters: &Parameters, seed: u64, ball: Point<Field>, walkers: Vec<Walker>) -> Self {
        let league = League::FourLegged;
        Self {
            ball: Ball::at(ball),
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

    /// What a robot's brain wants of its body; a body without wheels ignores orders for wheels.
    pub fn command(&mut self, robot: usize, order: &ActuatorFrame) {
        let (Some(walker), ActuatorFrame::Legged { walk, primitive }) = (self.walkers.get_mut(robot), order)
        else {
            return;
        };
        walker.order(*walk, *primitive, self.parameters.grab.duration, self.parameters.kick.duration);
    }

    /// A robot's computer stopped: it stands, its legs open, and what it was doing ends.
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

    /// 10 ms pass.
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
            walker.stay_on_carpet(&self.field, self.robot_radius);
        }
        if self.hold.is_some() {
            self.carry_ball();
        } else {
            self.ball.roll(self.parameters.ball.deceleration, STEP);
            self.collide_with_ball();
            self.ball.stay_in_net(&self.field, self.ball_radius);
        }
    }

    /// What happened since the last call, in order, to the end of `into`.
    pub fn take_events(&mut self, into: &mut Vec<WorldEvent>) {
        into.append(&mut self.events);
    }

    /// Who holds the ball in a grip that a grab has made firm.
    pub fn holder(&self) -> Option<usize> {
        self.hold.filter(|hold| hold.firm).map(|hold| hold.robot)
    }

    /// The ball lies at the holder's legs and moves with it; who of the other team reaches it, touches it.
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

/// Seconds in a step of physics (docs/architecture.md §2.3: four-legged, every 10 ms).
pub const STEP: f32 = 0.01;

#[cfg(test)]
mod tests;
