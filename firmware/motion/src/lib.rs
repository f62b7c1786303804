//! `motion`: motion models of balls and bodies. Models for decisions, not the simulator's physics.
//!
//! | question | answer |
//! |---|---|
//! | How soon can a robot be there and at rest, and how? (paper 2 §2, CalcMotion2D) | [`trajectory`] |
//! | Where will a kicked or chipped ball be? | [`ball`], [`ball::chip`] |
//! | Where along a moving ball's way can a robot meet it, soonest or with most time to spare? (paper 2 §2) | [`intercept`] |
//! | How does it get around others and forbidden places? | [`avoid`] |
//! | Which rim speeds drive a body with four wheels like this, and how fast can it go that way? | [`omni`] |
//! | The walking league: a ball that only rolls, and what an AIBO can do | [`rolling`], [`legged`] |
//!
//! ```
//! use geometry::{Field, Point, Vector};
//! use rules::RobotSpec;
//! use motion::trajectory::{CalcMotion, FreeLimits, Motion};
//!
//! let robot = FreeLimits::of(&RobotSpec::OURS.plan);
//! let motion = robot.plan(Point::<Field>::new(0.0, 0.0), Vector::new(0.0, 1.0), Point::new(2.0, 0.5));
//! // What to drive at the end of a control step of 10 ms, and when it will be there.
//! let (next, arrival) = (motion.at(0.01), motion.duration());
//! assert!(next.velocity.x() > 0.0 && arrival < 2.0);
//! ```
//!
//! **Invariants.** No I/O, no clock, no allocation, SI units. Every input is answered; what is not a number rests. The
//! simulator's physics are written apart from these models, so that a wrong model shows as missed passes instead of hiding.
#![forbid(unsafe_code)]
#![no_std]

pub mod avoid;
pub mod ball;
pub mod intercept;
pub mod legged;
pub mod omni;
pub mod rolling;
pub mod trajectory;
