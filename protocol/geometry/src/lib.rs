//! `geometry`: frames, axes and units (docs/architecture.md §2.1).
//!
//! | frame | origin | axes | used by |
//! |---|---|---|---|
//! | [`Field`] | centre of the field | +x along the length, +y to the left of +x | cases, robots, wire, simulator |
//! | [`Attack`] | centre of the field | +x towards the goal we attack | the host's strategy only |
//! | [`Body`] | centre of the robot | +x where the robot faces, +y to its left | drives, kicks, sensors |
//!
//! Angles are radians, counter-clockwise. Lengths are metres, times seconds, all `f32`. A frame is a type
//! parameter, so that mixing frames does not compile:
//!
//! ```compile_fail
//! use geometry::{Body, Field, Point};
//! let ball: Point<Field> = Point::new(1.0, 0.0);
//! let dribbler: Point<Body> = Point::new(0.1, 0.0);
//! let _ = ball - dribbler;
//! ```
//!
//! **Invariants.** No I/O, no clock, no allocation. Everything beyond `+ − × ÷` goes through [`math`], so
//! that the same program gives the same bits on a PC and on a Cortex-M (checked by a golden hash, see
//! [`math::golden_hash`]).
#![cfg_attr(doctest, doc = include_str!("../README.md"))]
// On the robot one function is assembly.
#![cfg_attr(not(target_arch = "arm"), forbid(unsafe_code))]
#![no_std]

mod angle;
mod frame;
mod goal;
mod labels;
pub mod math;
mod pose;
mod segment;
mod shape;

pub use angle::Angle;
pub use frame::{Attack, Body, Field, Point, Vector};
pub use goal::GoalEnd;
pub use pose::{Pose, Twist};
pub use segment::Segment;
pub use shape::Shape;
