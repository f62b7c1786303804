//! `camera`: belief of a walking robot from its camera and legs: pose by odometry and landmarks, the ball from its
//! sight. SI units, field frame.

use geometry::{Angle, Body, Point, Twist, Vector};
use motion::legged::HOLD_DISTANCE;
use protocol::Instant;
use protocol::robot_io::{CameraFrame, Sight};
use rules::LANDMARKS;

use super::Belief;

impl Belief {
    /// Takes in a camera frame; `moves` if the pose is to be carried on by the odometry.
    pub(super) fn look(&mut self, now: Instant, moves: bool, camera: &CameraFrame, odometry: Twist<Body>) {
        let dt = self.looked.replace(now).map_or(0.0, |before| now.since(before).as_secs_f32());
        if moves && odometry.linear.is_finite() && odometry.angular.is_finite() {
            self.pose.position += self.pose.vector_to_field(odometry.linear) * dt;
            self.pose.heading = self.pose.heading + Angle::new(odometry.angular * dt);
        }
        for seen in &camera.landmarks {
            let Some(&landmark) = LANDMARKS.get(usize::from(seen.landmark)) else { continue };
            let (range, bearing) = (seen.sight.range(), seen.sight.bearing());
            let turned = (self.pose.turn_to(landmark) - bearing).radians();
            let implied = landmark - Vector::polar(range, self.pose.heading + bearing);
            self.pose.heading = self.pose.heading + Angle::new(GAIN * turned);
            self.pose.position += (implied - self.pose.position) * GAIN;
        }
        if self.holds_ball {
            let held = self.pose.to_field(Point::new(HOLD_DISTANCE, 0.0));
            self.see(now, held, HELD_SIGMA);
        } else if let Some(ball) = camera.ball {
            self.see(now, self.pose.to_field(body(ball)), ball_sigma(ball.range()));
        }
    }
}

/// A sight as a point of the body's frame.
fn body(sight: Sight) -> Point<Body> {
    let seen = Vector::<Body>::polar(sight.range(), sight.bearing());
    Point::new(seen.x(), seen.y())
}

/// Standard deviation of a ball's sight at that range, m: a column of the image (0.274°) of a ball of 85 mm.
fn ball_sigma(range: f32) -> f32 {
    0.01 + range * range * (0.004_782 / 0.085)
}

/// Share of what a landmark's sight corrects.
const GAIN: f32 = 0.05;
/// Standard deviation of a held ball's place, m.
const HELD_SIGMA: f32 = 0.01;
