//! `legged`: abilities of a walking robot, as its own brain assumes them. Speeds, reach and kicks of an AIBO;
//! SI units.
//!
//! Walking speeds lie between CMU's own gait (180 mm/s, Tekkotsu's `CMPackWalkMC`) and learned ones (291
//! mm/s, UT Austin 2003; 350–450 mm/s reported for the ERS-7).

/// Commanded walking speed ahead, m/s.
pub const WALK_FORWARD: f32 = 0.3;
/// Commanded walking speed sideways and backwards, m/s.
pub const WALK_SIDEWAYS: f32 = 0.2;
/// Acceleration of the gait, m/s²: twice the largest speed a second (Tekkotsu).
pub const WALK_ACCELERATION: f32 = 0.6;
/// Commanded turning rate, rad/s.
pub const TURN_RATE: f32 = 2.0;
/// Walking with the ball between the legs: half the speed, as carrying ties the front legs, m/s.
pub const CARRY_SPEED: f32 = 0.15;
/// Turning with the ball, rad/s.
pub const CARRY_TURN_RATE: f32 = 1.0;
/// Ball within this distance of the body's centre, ahead: a grab may succeed, m.
pub const GRAB_REACH: f32 = 0.165;
/// A held ball lies this far ahead of the body's centre, m.
pub const HOLD_DISTANCE: f32 = 0.13;
/// Half the angle of the grab's zone, rad.
pub const GRAB_HALF_ANGLE: f32 = 0.4;
/// Standard deviation of a kick's direction, rad: 10°, UT Austin's 9.5° at 2 m over 50 kicks.
pub const KICK_ANGLE_SPREAD: f32 = 0.174_532_93;
/// Standard deviation of a kick's length, as a share of it: about UT Austin's 0.35.
pub const KICK_LENGTH_SPREAD: f32 = 0.3;
