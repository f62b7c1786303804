//! `motion`: motion models of balls and bodies. Models for decisions, not the simulator's physics.
//!
//! | function | module |
//! |---|---|
//! | Time and motion of a robot to standstill at a place (paper 2 §2, CalcMotion2D) | [`trajectory`] |
//! | Position of a kicked or chipped ball | [`ball`], [`ball::chip`] |
//! | Interception point on a moving ball's path, soonest or with most slack (paper 2 §2) | [`intercept`] |
//! | Path around robots and forbidden regions | [`avoid`] |
//! | Rim speeds of four wheels for a body motion, and the largest speed in a direction | [`omni`] |
//! | The walking league: a ball that only rolls, and the abilities of an AIBO | [`rolling`], [`legged`] |
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
//! **Invariants.** No I/O, no clock, no allocation, SI units. Every input has an answer; for NaN it is to
//! stand still. The simulator's physics are written apart from these models, so that a wrong model causes
//! missed passes instead of hiding.
#![cfg_attr(doctest, doc = include_str!("../README.md"))]
#![forbid(unsafe_code)]
#![no_std]

pub mod avoid;
pub mod ball;
pub mod intercept;
pub mod legged;
pub mod omni;
pub mod rolling;
pub mod trajectory;
