//! `contact`: collisions of the ball with hulls, goals and boards; m, s, field frame.
//!
//! The ball's path in a step is swept: it advances by its distance from the nearest surface until it touches
//! one, so that it tunnels at no speed. Overlaps that remain are resolved: the ball is pushed out of robots,
//! and robots off a ball that cannot move.

use geometry::{Field, Point, Vector};

use super::ball::{Ball, Impact};
use super::event::PhysicsEvent;
use super::surface::{Nearest, hull};
use super::{STEP, World};

/// Body that the ball may collide with, by its index.
#[derive(Clone, Copy, Debug)]
enum Obstacle {
    Robot(usize),
    GoalWall(usize),
}

impl World {
    pub(super) fn move_ball(&mut self) {
        let before = self.ball;
        self.ball.advance(&self.parameters.ball, STEP);
        if before.in_the_air() && self.ball.hops != before.hops {
            self.events.push(PhysicsEvent::Landed(self.ball.position));
        }
        let near = self.robots_near_ball(&before);
        let (from, mut motion) = (before.position, self.ball.position - before.position);
        let at_goal = self.ball.position.x().abs() > self.goal_zone && !self.over_the_goal(&self.ball);
        if !near.is_empty() || at_goal {
            self.ball.position = from;
            let mut left = 1.0;
            for _ in 0..BOUNCES_PER_STEP {
                let Some((share, obstacle, nearest)) = self.first_hit(&near, at_goal, motion, left) else {
                    break;
                };
                self.ball.position += motion * share;
                // Robots have already moved for the whole step: the ball collides with them there.
                left *= 1.0 - share;
                self.hit(obstacle, nearest);
                motion = self.ball.velocity * (STEP * left);
            }
            self.ball.position += motion;
            self.push_ball_out(&near, at_goal);
        }
        self.land_on_robots(&before, &near);
        if at_goal || self.ball.position.x().abs() > self.goal_zone {
            self.hit_bar(&before);
        }
        self.stay_in_boards(&before);
        let speed = self.ball.velocity.norm();
        if speed > SPEED_MAX {
            self.ball.velocity = self.ball.velocity * (SPEED_MAX / speed);
        }
    }

    /// Indices of the robots that the ball could touch in this step.
    fn robots_near_ball(&self, before: &Ball) -> heapless::Vec<usize, NEAR_MAX> {
        let mut near = heapless::Vec::new();
        if before.height.min(self.ball.height) > self.highest_robot {
            return near;
        }
        let p = self.ball.position;
        let motion = (p - before.position).norm();
        for &i in &self.near_ball {
            let robot = &self.robots[usize::from(i)];
            let reach = robot.body.radius + self.parameters.ball.radius + motion + ROBOT_STEP;
            let (dx, dy) = (p.x() - robot.pose.position.x(), p.y() - robot.pose.position.y());
            if dx * dx + dy * dy < reach * reach && near.push(usize::from(i)).is_err() {
                break;
            }
        }
        near
    }

    /// The nearest surface of an obstacle to a ball position; the normal is in the field frame.
    fn nearest(&self, obstacle: Obstacle, at: Point<Field>) -> Nearest {
        match obstacle {
            Obstacle::Robot(i) => {
                let robot = &self.robots[i];
                let own = robot.to_body(at - robot.pose.position);
                let found = hull(&robot.body, robot.half_front, own);
                let normal = robot.to_field(found.normal);
                Nearest { normal: [normal.x(), normal.y()], ..found }
            }
            Obstacle::GoalWall(i) => {
                let mirror = if at.x() < 0.0 { -1.0 } else { 1.0 };
                let found = self.goal_walls[i].nearest([at.x() * mirror, at.y()]);
                Nearest { normal: [found.normal[0] * mirror, found.normal[1]], ..found }
            }
        }
    }

    /// The first obstacle on the ball's displacement `motion`, and the share of `motion` before the contact.
    fn first_hit(
        &self,
        near: &[usize],
        at_goal: bool,
        motion: Vector<Field>,
        left: f32,
    ) -> Option<(f32, Obstacle, Nearest)> {
        let walls = if at_goal { self.goal_walls.len() } else { 0 };
        let robots = near.iter().map(|i| Obstacle::Robot(*i));
        let mut first: Option<(f32, Obstacle, Nearest)> = None;
        for obstacle in robots.chain((0..walls).map(Obstacle::GoalWall)) {
            let height = match obstacle {
                Obstacle::Robot(i) => self.robots[i].body.height,
                Obstacle::GoalWall(_) => f32::MAX,
            };
            if self.ball.height >= height {
                continue;
            }
            // A robot has already moved for this step; relative to it, the ball starts further back on its
            // path.
            let (start, relative) = match obstacle {
                Obstacle::Robot(i) => {
                    let gone = self.robots[i].velocity * (STEP * left);
                    (self.ball.position + gone, motion - gone)
                }
                Obstacle::GoalWall(_) => (self.ball.position, motion),
            };
            let limit = first.map_or(1.0, |(share, ..)| share);
            if let Some((share, nearest)) = self.sweep(obstacle, start, relative, limit) {
                first = Some((share, obstacle, nearest));
            }
        }
        first
    }

    /// The share of `motion` from `start` after which the ball touches this obstacle, moving towards it.
    fn sweep(
        &self,
        obstacle: Obstacle,
        start: Point<Field>,
        motion: Vector<Field>,
        limit: f32,
    ) -> Option<(f32, Nearest)> {
        let length = motion.norm();
        let mut share = 0.0;
        for _ in 0..SWEEP_STEPS {
            let nearest = self.nearest(obstacle, start + motion * share);
            let gap = nearest.distance - self.parameters.ball.radius;
            if gap <= CONTACT_DISTANCE {
                let normal = Vector::new(nearest.normal[0], nearest.normal[1]);
                return (motion.dot(normal) < 0.0).then_some((share, nearest));
            }
            if length <= 0.0 {
                return None;
            }
            share += gap / length;
            if share > limit {
                return None;
            }
        }
        None
    }

    /// Applies the impact of the ball on an obstacle.
    fn hit(&mut self, obstacle: Obstacle, nearest: Nearest) {
        let normal = Vector::new(nearest.normal[0], nearest.normal[1]);
        let of = self.parameters.bounce;
        match obstacle {
            Obstacle::Robot(i) => {
                let surface = self.ball.position - normal * self.parameters.ball.radius;
                let robot = &mut self.robots[i];
                let mouth = nearest.front && !robot.tipped;
                let restitution = if !mouth {
                    of.hull
                } else if robot.order.dribbler > 0.0 && robot.is_led(self.step) {
                    of.dribbling
                } else {
                    of.front
                };
                let share = robot.body.mass / (robot.body.mass + self.parameters.ball.mass);
                let impact = Impact { restitution, friction: of.friction, spin: of.spin, share };
                let change = self.ball.bounce(normal, robot.velocity_at(surface), impact);
                robot.velocity += change * (-self.parameters.ball.mass / robot.body.mass);
                self.touch(i);
            }
            Obstacle::GoalWall(_) => {
                let speed = self.ball.velocity.norm();
                let inside = self.ball.position.y().abs() < self.pitch.field.goal_width * 0.5
                    && self.ball.position.x().abs() > self.pitch.field.length * 0.5;
                let restitution = if inside { of.net } else { of.wall };
                let impact = Impact { restitution, friction: of.friction, spin: of.spin, share: 1.0 };
                self.ball.bounce(normal, Vector::default(), impact);
                self.events.push(PhysicsEvent::GoalHit { at: self.ball.position, speed });
            }
        }
    }

    /// Resolves the remaining overlaps: the ball is moved, and where it cannot move, the robots are.
    fn push_ball_out(&mut self, near: &[usize], at_goal: bool) {
        let radius = self.parameters.ball.radius;
        let walls = if at_goal { self.goal_walls.len() } else { 0 };
        for _ in 0..PUSH_ITERATIONS {
            let mut pushed = false;
            let robots = near.iter().map(|i| Obstacle::Robot(*i));
            for obstacle in robots.chain((0..walls).map(Obstacle::GoalWall)) {
                if matches!(obstacle, Obstacle::Robot(i) if self.ball.height >= self.robots[i].body.height) {
                    continue;
                }
                let nearest = self.nearest(obstacle, self.ball.position);
                let depth = radius - nearest.distance;
                if depth > 0.0 {
                    let normal = Vector::new(nearest.normal[0], nearest.normal[1]);
                    self.ball.position += normal * depth;
                    pushed = true;
                    if let Obstacle::Robot(i) = obstacle {
                        let surface = self.ball.position - normal * radius;
                        let behind = (self.robots[i].velocity_at(surface) - self.ball.velocity).dot(normal);
                        if behind > 0.0 {
                            self.ball.velocity += normal * behind;
                        }
                        self.touch(i);
                    }
                }
            }
            if !pushed {
                return;
            }
        }
        for &i in near {
            let nearest = self.nearest(Obstacle::Robot(i), self.ball.position);
            let depth = radius - nearest.distance;
            if depth > WEDGED_OVERLAP && self.ball.height < self.robots[i].body.height {
                let normal = Vector::new(nearest.normal[0], nearest.normal[1]);
                let robot = &mut self.robots[i];
                robot.pose.position += normal * -depth;
                let into = robot.velocity.dot(normal);
                robot.velocity += normal * -into.max(0.0);
            }
        }
    }

    fn land_on_robots(&mut self, before: &Ball, near: &[usize]) {
        for &i in near {
            let top = self.robots[i].body.height;
            if before.height < top || self.ball.height >= top {
                continue;
            }
            let nearest = self.nearest(Obstacle::Robot(i), self.ball.position);
            if nearest.distance < 0.0 {
                self.ball.height = top;
                self.ball.climb = self.ball.climb.abs() * self.parameters.ball.hop_up;
                // It never stops on top: it gets at least the speed of falling from a hop's end.
                let normal = Vector::new(nearest.normal[0], nearest.normal[1]);
                self.ball.velocity += normal * SLIP_OFF_SPEED;
                self.touch(i);
            }
        }
    }

    /// True for a ball above the goals' walls.
    fn over_the_goal(&self, ball: &Ball) -> bool {
        ball.height >= self.pitch.field.goal_height
    }

    /// The bar above the goal line, and the net behind it.
    fn hit_bar(&mut self, before: &Ball) {
        let (top, radius) = (self.pitch.field.goal_height, self.parameters.ball.radius);
        let bar = top - self.pitch.around.bar;
        let ball = &mut self.ball;
        if ball.height + 2.0 * radius <= bar
            || ball.height >= top
            || ball.position.y().abs() >= self.pitch.field.goal_width * 0.5
        {
            return;
        }
        let line = self.pitch.field.length * 0.5;
        let (was, is) = (before.position.x().abs(), ball.position.x().abs());
        let speed = ball.speed();
        if was + radius <= line && is + radius > line {
            // Against the bar from the field.
            let out = if ball.position.x() > 0.0 { -1.0 } else { 1.0 };
            ball.position = Point::new(-out * (line - radius), ball.position.y());
            ball.velocity =
                Vector::new(out * ball.velocity.x().abs() * self.parameters.bounce.wall, ball.velocity.y());
            self.events.push(PhysicsEvent::GoalHit { at: self.ball.position, speed });
        } else if is > line && is < line + self.pitch.field.goal_depth && ball.climb > 0.0 {
            // Against the roof from inside.
            ball.climb = -ball.climb * self.parameters.bounce.net;
            ball.height = bar - 2.0 * radius;
            self.events.push(PhysicsEvent::GoalHit { at: self.ball.position, speed });
        }
    }

    /// Boards round the field surface, and the walls of the venue beyond them, which only flying balls reach.
    fn stay_in_boards(&mut self, before: &Ball) {
        let [x, y] = self.pitch.corner();
        let radius = self.parameters.ball.radius;
        let p = self.ball.position;
        // It came over a board: one that a robot presses into it in this step has not.
        let was = before.position;
        let outside = was.x().abs() > x || was.y().abs() > y;
        if p.x().abs() <= x - radius && p.y().abs() <= y - radius {
            return;
        }
        let over = self.ball.height >= self.pitch.around.wall_height;
        let (x, y) = if over || outside { (x + HALL_MARGIN, y + HALL_MARGIN) } else { (x, y) };
        // The walls of the hall are far enough away that a ball that passed a board stays outside.
        let bounce = if outside { self.parameters.bounce.net } else { self.parameters.bounce.wall };
        for (normal, beyond) in [
            (Vector::new(-1.0, 0.0), p.x() + radius - x),
            (Vector::new(1.0, 0.0), -p.x() + radius - x),
            (Vector::new(0.0, -1.0), p.y() + radius - y),
            (Vector::new(0.0, 1.0), -p.y() + radius - y),
        ] {
            if beyond > 0.0 {
                self.ball.position += normal * beyond;
                let of = &self.parameters.bounce;
                let impact = Impact { restitution: bounce, friction: of.friction, spin: of.spin, share: 1.0 };
                self.ball.bounce(normal, Vector::default(), impact);
                self.events.push(PhysicsEvent::BoardHit(self.ball.position));
            }
        }
    }

    /// Records a contact of ball and robot in this step.
    pub(super) fn touch(&mut self, i: usize) {
        let (now, at) = (self.step, self.ball.position);
        let robot = &mut self.robots[i];
        let is_new_touch = robot.touched_at.is_none_or(|before| now - before > super::TOUCH_GAP_STEPS);
        robot.touched_at = Some(now);
        robot.touching = true;
        if robot.dribbling_from.is_none() {
            robot.dribbling_from = Some(at);
        }
        self.last_touch = Some((robot.who, now));
        if is_new_touch {
            self.events.push(PhysicsEvent::Touched { robot: robot.who, at });
        }
    }
}

/// Maximum number of bounces of the ball in a millisecond: wedged between two bodies it would have
/// arbitrarily many; off one body and the next it has two.
const BOUNCES_PER_STEP: usize = 2;
/// Maximum iterations of a sweep; each ends at a surface or at the end of the path.
const SWEEP_STEPS: usize = 24;
/// Iterations of pushing overlaps apart.
const PUSH_ITERATIONS: usize = 2;
/// Overlap of ball and robot, m, above which the robot is moved, since the ball could not; smaller overlaps
/// are rounding errors of a push.
const WEDGED_OVERLAP: f32 = 1e-5;
/// Distance that counts as contact, m.
pub(super) const CONTACT_DISTANCE: f32 = 2e-5;
/// Maximum distance a robot moves in a step, m, with a reserve.
const ROBOT_STEP: f32 = 0.012;
/// Maximum speed of the ball, m/s.
const SPEED_MAX: f32 = super::parameters::BALL_SPEED_MAX;
/// Maximum number of robots near a ball: more than fit.
const NEAR_MAX: usize = 8;
/// Speed at which a ball that fell on a robot leaves it, m/s.
const SLIP_OFF_SPEED: f32 = 0.3;
/// Distance from the boards to the walls of the venue, m.
const HALL_MARGIN: f32 = 2.0;
