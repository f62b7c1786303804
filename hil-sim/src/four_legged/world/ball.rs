//! `ball`: motion of a free ball. Constant deceleration until it stops, and a goal net that stops it; m, s,
//! field frame.
//!
//! Written independently of `motion`'s model on purpose: an error of the robots' model must become visible as
//! a missed pass.

use geometry::{Field, Point, Vector, math};
use rules::FieldSpec;

/// The ball's true state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeggedBall {
    /// Position of its centre, m.
    pub position: Point<Field>,
    /// Velocity along the ground, m/s.
    pub velocity: Vector<Field>,
}

impl LeggedBall {
    /// A ball that rests at `position`, m.
    pub fn at(position: Point<Field>) -> Self {
        Self { position, velocity: Vector::default() }
    }

    /// Rolls for `dt` seconds, exactly: the last step ends at the stopping distance v²/2a.
    pub fn roll(&mut self, deceleration: f32, dt: f32) {
        let speed = self.velocity.norm();
        if speed <= 0.0 {
            return;
        }
        let time = if speed < deceleration * dt { speed / deceleration } else { dt };
        let direction = self.velocity * (1.0 / speed);
        self.position += direction * (speed * time - 0.5 * deceleration * time * time);
        self.velocity = if time < dt { Vector::default() } else { direction * (speed - deceleration * dt) };
    }

    /// Stop position of the ball if nothing touches it.
    pub fn rest(&self, deceleration: f32) -> Point<Field> {
        self.position + self.velocity * (self.velocity.norm() / (2.0 * deceleration))
    }

    /// Gives it the velocity with which it stops after `displacement`, if nothing touches it.
    pub fn send(&mut self, deceleration: f32, displacement: Vector<Field>) {
        let distance = displacement.norm();
        let speed = math::sqrt(2.0 * deceleration * distance);
        self.velocity = displacement.unit().unwrap_or_default() * speed;
    }

    /// Behind a goal line and between the posts, the back and sides of the goal stop the ball.
    pub fn stay_in_net(&mut self, field: &FieldSpec, radius: f32) {
        let (x, y) = (self.position.x(), self.position.y());
        let line = field.length * 0.5;
        if x.abs() <= line || y.abs() > field.goal_width * 0.5 {
            return;
        }
        let back = line + field.goal_depth - radius;
        let side = field.goal_width * 0.5 - radius;
        let (mut vx, mut vy) = (self.velocity.x(), self.velocity.y());
        if x.abs() > back && vx * x > 0.0 {
            vx = 0.0;
        }
        if y.abs() > side && vy * y > 0.0 {
            vy = 0.0;
        }
        self.position = Point::new(x.clamp(-back, back), y.clamp(-side, side));
        self.velocity = Vector::new(vx, vy);
    }
}

#[cfg(test)]
mod tests {
    use rules::League;

    use super::*;

    #[test]
    fn a_ball_rolls_v_squared_over_two_a_and_stops_after_v_over_a() {
        let mut ball = LeggedBall { velocity: Vector::new(1.0, 0.0), ..LeggedBall::at(Point::default()) };
        assert!((ball.rest(0.35).x() - 1.428_571).abs() < 1e-5);
        let mut steps = 0;
        while ball.velocity.norm() > 0.0 {
            ball.roll(0.35, 0.01);
            steps += 1;
        }
        // 1/(2·0.35) = 1.428571 m, 1/0.35 = 2.857 s.
        assert!((ball.position.x() - 1.428_571).abs() < 1e-4, "{:?}", ball.position);
        assert_eq!(steps, 286);
    }

    #[test]
    fn a_ball_sent_two_metres_rests_two_metres_away() {
        let mut ball = LeggedBall::at(Point::new(-1.0, 0.5));
        ball.send(0.35, Vector::new(0.0, -2.0));
        for _ in 0..600 {
            ball.roll(0.35, 0.01);
        }
        assert!(ball.position.distance(Point::new(-1.0, -1.5)) < 1e-3, "{:?}", ball.position);
        ball.send(0.35, Vector::default());
        assert_eq!(ball.velocity, Vector::default());
    }

    #[test]
    fn the_net_stops_what_crossed_the_goal_line_between_the_posts() {
        let field = League::FourLegged.field();
        let mut ball = LeggedBall { velocity: Vector::new(2.0, 0.0), ..LeggedBall::at(Point::new(2.6, 0.1)) };
        for _ in 0..100 {
            ball.roll(0.35, 0.01);
            ball.stay_in_net(&field, 0.0425);
        }
        assert!((ball.position.x() - (3.0 - 0.0425)).abs() < 1e-3 && ball.velocity.norm() == 0.0);
    }
}
