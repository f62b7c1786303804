//! `model`: what a walking robot assumes of its own perception: error model of camera, gait and odometry. SI
//! units, standard deviations.
//!
//! A robot's program knows its sensors by calibration; here the numbers of the simulated world
//! (`hil-sim/data/four-legged.toml`, \[noise\]), and a test there checks that they agree.

use core::f32::consts::PI;

/// An edge in the camera's image, rad: 0.274°, one of 208 columns of 56.9°.
pub const PIXEL: f32 = 0.274 * PI / 180.0;
/// Size by which the ball's range is measured, m: its diameter.
pub const BALL_SIZE: f32 = 0.085;
/// Size by which a marker's range is measured, m.
pub const MARKER_SIZE: f32 = 0.2;
/// Size by which a goal's range is measured, m.
pub const GOAL_SIZE: f32 = 0.3;
/// Landmarks of `rules::LANDMARKS` before this index are markers, the others goals.
pub const MARKERS: usize = 4;
/// A range at no distance, m.
pub const RANGE_FLOOR: f32 = 0.01;
/// All bearings of a frame together, standing, rad: 0.5°.
pub const JOINT: f32 = 0.5 * PI / 180.0;
/// Added to it while walking, rad: 2°.
pub const SWAY: f32 = 2.0 * PI / 180.0;
/// Correlation time of the sway, s.
pub const SWAY_TIME: f32 = 0.3;
/// Slower than this a robot stands, m/s and rad/s.
pub const STANDSTILL_SPEED: f32 = 0.02;
/// The pose at kick-off: m and rad (5°).
pub const PLACING: f32 = 0.05;
/// Its heading, rad.
pub const PLACING_HEADING: f32 = 5.0 * PI / 180.0;
/// Slipping as a share of the speed.
pub const SLIP: f32 = 0.15;
/// Correlation time of slipping, s.
pub const SLIP_TIME: f32 = 0.5;
/// Share by which legs mismeasure, constant in a trial.
pub const SCALE: f32 = 0.05;
/// Time over which a landmark corrects what the scale has added up, s; an estimate.
const SCALE_TIME: f32 = 4.0;
/// Variance of a motion of 1 m/s (1 rad/s), a second: a correlated error of deviation σ and time τ adds up to
/// 2 σ² τ t, a constant one to σ² t² over the time between corrections.
pub const MOTION: f32 = 2.0 * SLIP * SLIP * SLIP_TIME + SCALE * SCALE * SCALE_TIME;
/// Variance that a standing robot's place gains from pushes it does not feel, m²/s; an estimate: 2 cm in a
/// second.
pub const PUSHED: f32 = 4e-4;
/// The same of its heading, rad²/s: 1° in a second.
pub const TURNED: f32 = 3e-4;
/// Opponents' reported places, m.
pub const REPORTED: f32 = 0.1;

/// Variance of a range measured by an image of an object of `size` at `range`, m².
pub fn range_variance(range: f32, size: f32) -> f32 {
    let sigma = RANGE_FLOOR + range * range * (PIXEL / size);
    sigma * sigma
}
