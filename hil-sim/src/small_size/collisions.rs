//! `collisions`: collisions of robots. Discs against discs, boards and goals; m, s, field frame.
//!
//! Overlapping robots are moved apart in proportion to their masses, and their closing speed is exchanged as
//! an impact. Only pairs that could touch within the next milliseconds are checked.

use geometry::{Field, Point, Vector};

use super::event::PhysicsEvent;
use super::robot::Robot;
use super::{STEP, World};

impl World {
    /// Robots against each other, goals and boards.
    pub(super) fn part_robots(&mut self) {
        for k in 0..self.pairs.len() {
            let (a, b) = self.pairs[k];
            self.part(usize::from(a), usize::from(b));
        }
        let [x, y] = self.pitch.corner();
        let (zone, walls) = (self.goal_zone, self.goal_walls);
        let bounce = self.parameters.bounce.robots;
        for &i in &self.near_edge {
            let robot = &mut self.robots[usize::from(i)];
            let (p, radius) = (robot.pose.position, robot.body.radius);
            let at_boards = p.x().abs() > x - radius || p.y().abs() > y - radius;
            if at_boards {
                let held =
                    Point::new(p.x().clamp(radius - x, x - radius), p.y().clamp(radius - y, y - radius));
                push_out(robot, held - p, bounce);
            }
            if p.x().abs() > zone {
                let mirror = if p.x() < 0.0 { -1.0 } else { 1.0 };
                for wall in &walls {
                    let p = robot.pose.position;
                    let found = wall.nearest([p.x() * mirror, p.y()]);
                    if found.distance < radius {
                        let normal = Vector::new(found.normal[0] * mirror, found.normal[1]);
                        push_out(robot, normal * (radius - found.distance), bounce);
                    }
                }
            }
        }
    }

    /// Finds the robots that could touch one another, the ball, a board or a goal before the next search.
    pub(super) fn look_around(&mut self) {
        if self.step >= self.pairs_until {
            self.find_pairs();
        }
        self.near_ball.clear();
        self.near_edge.clear();
        self.near_until = self.step + NEAR_STEPS;
        let [x, y] = self.pitch.corner();
        let x = x.min(self.goal_zone);
        let ball_reach = self.parameters.ball.radius + BALL_REACH;
        for (i, robot) in self.robots.iter_mut().enumerate() {
            let (p, reach) = (robot.pose.position, robot.body.radius + ball_reach);
            let away = self.ball.position - p;
            if robot.present && away.dot(away) < reach * reach {
                self.near_ball.push(i as u8);
            } else {
                robot.leave_ball();
            }
            let edge = robot.body.radius + EDGE_DISTANCE;
            if robot.present && (p.x().abs() > x - edge || p.y().abs() > y - edge) {
                self.near_edge.push(i as u8);
            }
        }
    }

    /// Pairs of robots that could touch before the next search for pairs.
    fn find_pairs(&mut self) {
        self.pairs.clear();
        self.pairs_until = self.step + PAIRS_STEPS;
        let fastest = self.robots.iter().map(|robot| robot.limits().speed).fold(0.0, f32::max);
        let closing = 2.0 * fastest * (PAIRS_STEPS as f32 * STEP) + PUSHED_DISTANCE_MAX;
        for a in 0..self.robots.len() {
            let (first, rest) = self.robots.split_at(a + 1);
            let one = &first[a];
            if !one.present {
                continue;
            }
            let (x, y) = (one.pose.position.x(), one.pose.position.y());
            for (b, other) in (a + 1..).zip(rest) {
                let (dx, dy) = (other.pose.position.x() - x, other.pose.position.y() - y);
                let reach = one.body.radius + other.body.radius + closing;
                if dx * dx + dy * dy < reach * reach && other.present {
                    self.pairs.push((a as u8, b as u8));
                }
            }
        }
    }

    fn part(&mut self, a: usize, b: usize) {
        let (first, rest) = self.robots.split_at_mut(b);
        let (one, two) = (&mut first[a], &mut rest[0]);
        let between = two.pose.position - one.pose.position;
        let touching = one.body.radius + two.body.radius;
        let squared = between.dot(between);
        if squared >= touching * touching {
            return;
        }
        let normal = between.unit().unwrap_or(Vector::new(1.0, 0.0));
        let depth = touching - between.dot(normal);
        let closing = (one.velocity - two.velocity).dot(normal);
        let (robots, velocities) = ([one.who, two.who], [one.velocity, two.velocity]);
        let heavy = one.body.mass + two.body.mass;
        let (share_one, share_two) = (two.body.mass / heavy, one.body.mass / heavy);
        one.pose.position += normal * (-depth * share_one);
        two.pose.position += normal * (depth * share_two);
        if closing > 0.0 {
            let of = &self.parameters.bounce;
            let push = (1.0 + of.robots) * closing;
            let along = (one.velocity - two.velocity) - normal * closing;
            let sliding = along.norm();
            let rub = if sliding > 0.0 { (of.friction * push).min(sliding) / sliding } else { 0.0 };
            let change = normal * push + along * rub;
            one.velocity += change * -share_one;
            two.velocity += change * share_two;
        }
        let at = one.pose.position + normal * one.body.radius;
        let place = robots[0].slot() * super::SLOTS + robots[1].slot();
        let before = std::mem::replace(&mut self.crashes[place], self.step + 1);
        if before == 0 || self.step + 1 - before > super::TOUCH_GAP_STEPS {
            self.events.push(PhysicsEvent::Crash { robots, at, velocities, closing });
        }
    }
}

/// Moves a robot by `by`, and removes its speed in the opposite direction.
fn push_out(robot: &mut Robot, by: Vector<Field>, bounce: f32) {
    robot.pose.position += by;
    if let Some(normal) = by.unit() {
        let into = -robot.velocity.dot(normal);
        if into > 0.0 {
            robot.velocity += normal * (into * (1.0 + bounce));
        }
    }
}

/// Steps between searches for pairs of near robots.
const PAIRS_STEPS: u64 = 24;
/// Distance, m, that others push a robot in that time beyond its own limits.
const PUSHED_DISTANCE_MAX: f32 = 0.05;
/// Steps between searches for robots near the ball, a board or a goal.
const NEAR_STEPS: u64 = 8;
/// Maximum distance between hull and ball, m, that both can close in that time and then be in the dribbler
/// opening: 8 ms at 20 and 10 m/s, and the opening's depth.
const BALL_REACH: f32 = 0.24 + 0.1;
/// Distance between hull and board, m, that a robot can close in that time: 8 ms at 10 m/s.
const EDGE_DISTANCE: f32 = 0.08;
