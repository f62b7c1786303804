//! `contact`: collisions. Robots are pushed apart; a robot pushes the ball, and between its front legs the
//! ball lies deeper and does not bounce. All are discs; m, field frame.

use geometry::{Field, Point, Vector};

use super::{LeggedWorld, WorldEvent};

impl LeggedWorld {
    /// Moves overlapping robots apart, half the overlap each; a few iterations settle several robots in
    /// contact.
    pub(super) fn push_robots_apart(&mut self) {
        let apart = 2.0 * self.robot_radius;
        for _ in 0..ROUNDS {
            let mut moved = false;
            for i in 0..self.walkers.len() {
                for j in i + 1..self.walkers.len() {
                    let between = self.walkers[j].pose.position - self.walkers[i].pose.position;
                    let squared = between.dot(between);
                    if squared >= apart * apart {
                        continue;
                    }
                    let normal = between.unit().unwrap_or(Vector::new(1.0, 0.0));
                    let half = normal * (0.5 * (apart - between.norm()));
                    self.walkers[i].pose.position += -half;
                    self.walkers[j].pose.position += half;
                    moved = true;
                }
            }
            if !moved {
                break;
            }
        }
    }

    /// Every robot in contact with the free ball pushes it.
    pub(super) fn collide_with_ball(&mut self) {
        for robot in 0..self.walkers.len() {
            let offset = self.ball.position - self.walkers[robot].pose.position;
            let touching = self.robot_radius + self.ball_radius;
            if offset.dot(offset) >= touching * touching {
                if self.leaving == Some(robot) {
                    self.leaving = None;
                }
                continue;
            }
            if self.leaving != Some(robot) {
                self.push_ball(robot, offset);
            }
        }
    }

    /// Moves the free ball at `offset` from the robot's centre out of its body, if it is inside.
    fn push_ball(&mut self, robot: usize, offset: Vector<Field>) {
        let walker = &self.walkers[robot];
        let (distance, angle) = walker.bearing(self.ball.position);
        let between_legs = angle.abs() <= self.parameters.grab.half_angle;
        let surface = if between_legs {
            self.parameters.grab.hold_distance
        } else {
            self.robot_radius + self.ball_radius
        };
        if distance >= surface {
            return;
        }
        let normal = offset.unit().unwrap_or(Vector::polar(1.0, walker.pose.heading));
        self.ball.position = walker.pose.position + normal * surface;
        let closing = -(self.ball.velocity - walker.velocity_at(self.ball.position)).dot(normal);
        if closing > 0.0 {
            let soft = between_legs && closing <= self.parameters.grab.speed_limit;
            let bounce = if soft { 0.0 } else { self.parameters.ball.bounce };
            self.ball.velocity += normal * ((1.0 + bounce) * closing);
        }
        self.events.push(WorldEvent::Touched { robot });
    }

    /// True where the ball lies where the robot's front legs could close upon it, and is slow enough.
    pub(crate) fn in_grasp(&self, robot: usize) -> bool {
        self.in_grasp_at(robot, self.ball.position)
    }

    /// The same of a ball that is believed at `ball`.
    pub(crate) fn in_grasp_at(&self, robot: usize, ball: Point<Field>) -> bool {
        let (grab, walker) = (&self.parameters.grab, &self.walkers[robot]);
        let (distance, angle) = walker.bearing(ball);
        let relative = self.ball.velocity - walker.velocity_at(self.ball.position);
        distance <= grab.reach && angle.abs() <= grab.half_angle && relative.norm() <= grab.speed_limit
    }
}

/// Iterations of pushing apart in a step: four settle a row of four robots to a fraction of a millimetre a
/// step.
const ROUNDS: usize = 4;
