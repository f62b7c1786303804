//! What can a walking robot do, as its own brain believes? Speeds, reach and kicks of an AIBO; SI units.
//!
//! Walking speeds lie between CMU's own gait (180 mm/s, Tekkotsu's `CMPackWalkMC`) and learned ones (291 mm/s, UT Austin
//! 2003; 350–450 mm/s reported for the ERS-7).

/// Wanted walking speed ahead, m/s.
pub const WALK_FORWARD: f32 = 0.3;
/// Wanted walking speed sideways and backwards, m/s.
pub const WALK_SIDEWAYS: f32 = 0.2;
/// Wanted turning rate, rad/s.
pub const TURN_RATE: f32 = 2.0;
/// Walking with the ball between the legs: half the speed, as carrying ties the front legs, m/s.
pub const CARRY_SPEED: f32 = 0.15;
/// Turning with the ball, rad/s.
pub const CARRY_TURN_RATE: f32 = 1.0;
/// Ball within this distance of the body's centre, ahead: a grab may succeed, m.
pub const GRAB_REACH: f32 = 0.165;
/// Half the angle of the grab's zone, rad.
pub const GRAB_HALF_ANGLE: f32 = 0.4;
