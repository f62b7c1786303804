//! `walker`: motion of a walking robot. It follows the ordered velocity as fast as its legs permit; m, s,
//! rad.

use geometry::{Angle, Body, Field, Point, Pose, Twist, Vector};
use protocol::robot_io::{LeggedKick, LeggedPrimitive};
use rules::FieldSpec;

use crate::four_legged::parameters::{CarryParameters, WalkParameters};

/// The team of a robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Plays towards +x, controlled by brains.
    Attackers,
    /// Guards the goal at +x, scripted.
    Opponents,
}

/// A robot's true state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Walker {
    /// Team of the robot.
    pub side: Side,
    /// Position and heading.
    pub pose: Pose<Field>,
    /// Velocity in the body frame.
    pub twist: Twist<Body>,
    /// Ordered velocity, body frame, m/s and rad/s.
    pub wanted: Twist<Body>,
    /// The running primitive; `None` while it only walks.
    pub action: Option<Primitive>,
}

/// A primitive that is running.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Primitive {
    /// Grab, or which kick.
    pub what: PrimitiveKind,
    /// Seconds until it ends (a grab) or touches the ball (a kick).
    pub left: f32,
}

/// The primitives of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PrimitiveKind {
    /// Taking the ball between the front legs.
    Grab,
    /// Kicking the ball that is held.
    Kick(LeggedKick),
}

impl Walker {
    /// A robot that stands still, without an order.
    pub fn at(side: Side, pose: Pose<Field>) -> Self {
        Self { side, pose, twist: Twist::default(), wanted: Twist::default(), action: None }
    }

    /// Takes an order: walking velocity, and a primitive unless one is running. NaN counts as 0.
    pub fn order(&mut self, walk: Twist<Body>, primitive: LeggedPrimitive, grab_lasts: f32, kick_lasts: f32) {
        let linear = if walk.linear.is_finite() { walk.linear } else { Vector::default() };
        let angular = if walk.angular.is_finite() { walk.angular } else { 0.0 };
        self.wanted = Twist { linear, angular };
        if self.action.is_none() {
            self.action = match primitive {
                LeggedPrimitive::None => None,
                LeggedPrimitive::Grab => Some(Primitive { what: PrimitiveKind::Grab, left: grab_lasts }),
                LeggedPrimitive::Kick(kick) => {
                    Some(Primitive { what: PrimitiveKind::Kick(kick), left: kick_lasts })
                }
            };
        }
    }

    /// Walks for `dt` seconds; stands while a primitive is running.
    pub fn walk(&mut self, limits: &WalkParameters, carry: Option<&CarryParameters>, dt: f32) {
        let target =
            if self.action.is_some() { Twist::default() } else { limited(self.wanted, limits, carry) };
        let change = (target.linear - self.twist.linear).clamped(limits.acceleration * dt);
        let turn = limits.turn_acceleration * dt;
        self.twist.linear += change;
        self.twist.angular += (target.angular - self.twist.angular).clamp(-turn, turn);
        self.pose.position += self.pose.vector_to_field(self.twist.linear) * dt;
        self.pose.heading = Angle::new(self.pose.heading.radians() + self.twist.angular * dt);
    }

    /// Keeps the robot within the field surface.
    pub fn stay_on_surface(&mut self, field: &FieldSpec, radius: f32) {
        self.pose.position = field.clamp(self.pose.position, radius - field.margin);
    }

    /// Velocity of its centre on the field, m/s.
    pub fn velocity(&self) -> Vector<Field> {
        self.pose.vector_to_field(self.twist.linear)
    }

    /// Velocity of the body's point over `point` of the field, m/s.
    pub fn velocity_at(&self, point: Point<Field>) -> Vector<Field> {
        let arm = point - self.pose.position;
        self.velocity() + Vector::new(-arm.y(), arm.x()) * self.twist.angular
    }

    /// Distance of `point` from its centre, and the angle from its heading.
    pub fn bearing(&self, point: Point<Field>) -> (f32, Angle) {
        (self.pose.position.distance(point), self.pose.turn_to(point))
    }
}

/// The ordered velocity within what legs can do: an ellipse of speeds, shorter behind than ahead.
fn limited(wanted: Twist<Body>, limits: &WalkParameters, carry: Option<&CarryParameters>) -> Twist<Body> {
    let ahead = if wanted.linear.x() >= 0.0 { limits.forward } else { limits.sideways };
    let (ahead, aside, turn) = match carry {
        Some(carry) => (carry.speed, carry.speed, carry.turn),
        None => (ahead, limits.sideways, limits.turn),
    };
    let scaled = Vector::<Body>::new(wanted.linear.x() / ahead, wanted.linear.y() / aside).clamped(1.0);
    Twist {
        linear: Vector::new(scaled.x() * ahead, scaled.y() * aside),
        angular: wanted.angular.clamp(-turn, turn),
    }
}

#[cfg(test)]
mod tests {
    use rules::League;

    use super::*;
    use crate::Parameters;

    fn walker(wanted: Twist<Body>) -> Walker {
        Walker { wanted, ..Walker::at(Side::Attackers, Pose::default()) }
    }

    fn twist(x: f32, y: f32, angular: f32) -> Twist<Body> {
        Twist { linear: Vector::new(x, y), angular }
    }

    fn after(mut walker: Walker, steps: u32, carry: bool) -> Walker {
        let p = Parameters::four_legged();
        for _ in 0..steps {
            walker.walk(&p.walk, carry.then_some(&p.carry), 0.01);
        }
        walker
    }

    #[test]
    fn full_speed_takes_speed_over_acceleration() {
        let walker = walker(twist(9.0, 0.0, 0.0));
        // 0.3 m/s at 0.6 m/s²: half a second, and ½·0.6·0.5² = 0.075 m (a step of 10 ms early or late is 3
        // mm).
        assert!((after(walker, 25, false).twist.linear.x() - 0.15).abs() < 1e-5);
        let at_full_speed = after(walker, 50, false);
        assert!((at_full_speed.twist.linear.x() - 0.3).abs() < 1e-5);
        assert!((at_full_speed.pose.position.x() - 0.075).abs() < 0.003);
        assert!((after(walker, 150, false).pose.position.x() - 0.375).abs() < 0.003);
    }

    #[test]
    fn legs_are_slower_aside_behind_and_with_the_ball() {
        let speed = |x, y, carry| after(walker(twist(x, y, 9.0)), 200, carry).twist;
        assert!((speed(0.0, 9.0, false).linear.y() - 0.2).abs() < 1e-5);
        assert!((speed(-9.0, 0.0, false).linear.x() + 0.2).abs() < 1e-5);
        assert!((speed(9.0, 0.0, true).linear.x() - 0.15).abs() < 1e-5);
        assert_eq!(speed(0.0, 0.0, false).angular, 2.0);
        assert_eq!(speed(0.0, 0.0, true).angular, 1.0);
        // Diagonally: on the ellipse, (0.3/√2, 0.2/√2) for an order in that direction.
        let diagonal = speed(3.0, 2.0, false).linear;
        assert!((diagonal.x() - 0.212_13).abs() < 1e-4 && (diagonal.y() - 0.141_42).abs() < 1e-4);
    }

    #[test]
    fn a_robot_stands_while_it_kicks_and_takes_no_other_primitive() {
        let mut walker = walker(twist(0.3, 0.0, 0.0));
        walker.order(walker.wanted, LeggedPrimitive::Grab, 0.5, 0.4);
        walker.order(walker.wanted, LeggedPrimitive::Kick(LeggedKick::Left), 0.5, 0.4);
        assert_eq!(walker.action, Some(Primitive { what: PrimitiveKind::Grab, left: 0.5 }));
        assert_eq!(after(walker, 50, false).pose.position, Point::default());
    }

    #[test]
    fn an_order_of_nan_is_an_order_to_stand() {
        let mut walker = walker(Twist::default());
        walker.order(twist(f32::NAN, 0.0, f32::INFINITY), LeggedPrimitive::None, 0.5, 0.4);
        assert_eq!(walker.wanted, Twist::default());
    }

    #[test]
    fn the_edge_of_the_field_surface_stops_robots() {
        let field = League::FourLegged.field();
        let mut walker = Walker::at(Side::Attackers, Pose::from_mm_deg(5000.0, -5000.0, 0.0));
        walker.stay_on_surface(&field, 0.12);
        assert!(walker.pose.position.distance(Point::new(2.88, -1.98)) < 1e-5);
    }
}
