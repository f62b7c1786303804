//! `contact`: how near a robot's centre is to a ball that it touches, m, by who judges it.
//!
//! All of them are [`CENTERS`] and an allowance; the allowances differ with what sees robot and ball, and
//! with what a wrong answer costs.

use crate::limits::{BALL_RADIUS, ROBOT_RADIUS};

/// From a robot's centre to the ball's when hull and ball touch.
pub const CENTERS: f32 = ROBOT_RADIUS + BALL_RADIUS;
/// An opponent this near has the ball (`brain`): a centimetre, as one snapshot shows both.
pub const HELD_WITHIN: f32 = CENTERS + 0.01;
/// A robot this near touches the ball: 13.5 mm for the vision's noise. The robot's own view, the tracker's
/// kicks, a ball at a robot's front.
pub const TOUCHES_WITHIN: f32 = CENTERS + 0.0135;
/// The coach's view of the same: has the pass ended, has another robot touched the ball since our kicker did.
pub const COACH_TOUCHES_WITHIN: f32 = CENTERS + 0.0145;
/// A pass is taken by a robot this near: what two positions of vision err by together. A touch that is
/// overlooked would be counted as a missed pass.
pub const PASS_TOUCHED_WITHIN: f32 = CENTERS + 0.02;
/// A pass has left a passer whose centre is farther away.
pub const PASS_LEFT_BEYOND: f32 = CENTERS + 0.05;
/// The page counts possession of a robot this near: it sees both from vision alone, and not every frame.
pub const POSSESSION_WITHIN: f32 = CENTERS + 0.0285;
