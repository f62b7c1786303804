//! `dribbler`: dribbler, kicker and break-beam sensor. m, s, field frame.
//!
//! The dribbler pulls the ball towards the front and the middle of its roller, with at most `pull` and
//! `side`: a robot that accelerates away hard loses it, one that accelerates gently keeps it, and no force
//! pushes it away. A kick leaves along the robot's heading with the ordered speed in 3-D, independent of the
//! ball's previous motion except for the part along the front.

use geometry::{Angle, Vector, math};

use super::event::PhysicsEvent;
use super::parameters::DribblerParameters;
use super::robot::Robot;
use super::{Ball, STEP, World};

impl World {
    pub(super) fn kick(&mut self) {
        let of = self.parameters.kick;
        for k in 0..self.near_ball.len() {
            let i = usize::from(self.near_ball[k]);
            let robot = &self.robots[i];
            let Some(kick) = robot.order.kick else { continue };
            let able = !robot.tipped && robot.is_led(self.step) && robot.charged(self.step);
            if !able || !self.in_dribbler(robot, of.reach, KICKABLE_HEIGHT) {
                continue;
            }
            let scatter = self.kicks.normal_within(of.scatter_limit) * of.speed_sd;
            let askew = self.kicks.normal_within(of.scatter_limit) * of.angle_sd_deg;
            let chip = kick.angle > 0.0;
            let most = robot.kick_limits[usize::from(chip)];
            let gain = robot.traits.kick_gain * if chip { robot.traits.chip_ratio } else { 1.0 };
            let speed = (kick.speed * gain * (1.0 + scatter)).min(most);
            let (up, along) = math::sin_cos(kick.angle.clamp(0.0, math::FRAC_PI_2));
            let ahead = robot.to_field([1.0, 0.0]);
            let direction = ahead.rotated(Angle::degrees(askew));
            // The ball keeps part of its motion along the front: a kick on the move goes askew.
            let left = robot.to_field([0.0, 1.0]);
            let aside = left.dot(self.ball.velocity).clamp(-speed, speed) * ASIDE_KEPT_SHARE;
            let flat = direction * (speed * along) + left * aside;
            let velocity = flat.unit().unwrap_or(direction) * (speed * along);
            self.ball = Ball {
                position: self.ball.position,
                height: self.ball.height,
                velocity,
                climb: speed * up,
                spin: Vector::default(),
                hops: 0,
            };
            let (who, at) = (robot.who, self.ball.position);
            self.touch(i);
            let robot = &mut self.robots[i];
            robot.discharge(self.step, of.recharge, self.parameters.battery.kick);
            robot.kicked = Some((self.step, chip));
            robot.velocity += velocity * (-self.parameters.ball.mass / robot.body.mass);
            self.events.push(PhysicsEvent::Kicked { robot: who, at, velocity, speed, chip });
        }
    }

    pub(super) fn dribble(&mut self) {
        if self.ball.height > DRIBBLE_HEIGHT {
            return;
        }
        for k in 0..self.near_ball.len() {
            let i = usize::from(self.near_ball[k]);
            let robot = &self.robots[i];
            let turns = robot.order.dribbler > 0.0 && !robot.tipped;
            // A ball that has just been kicked is not caught again while it leaves, whatever the roller's
            // pull in this world.
            let leaves = robot.kicked.is_some_and(|(at, _)| self.step - at < KICK_CLEARS_STEPS);
            if !turns || leaves || !robot.is_led(self.step) {
                continue;
            }
            let Some([gap, aside]) = self.place_in_dribbler(robot) else { continue };
            if gap > self.parameters.dribbler.reach || gap < -self.parameters.ball.radius {
                continue;
            }
            let pull = pull(robot, &self.ball, [gap, aside], &self.parameters.dribbler);
            self.ball.velocity += pull;
            // A held ball is turned by the roller: on leaving, it neither runs away nor comes back by its
            // spin. But the same friction turns it: a kicked ball that passes the opening in 5 ms starts
            // sliding, as any kicked ball does.
            let turn = SPHERE_SPIN_RATIO * self.parameters.dribbler.pull * STEP;
            self.ball.spin += (self.ball.velocity - self.ball.spin).clamped(turn);
            let mass = self.parameters.ball.mass / self.robots[i].body.mass;
            let robot = &mut self.robots[i];
            robot.velocity += pull * -mass;
            self.touch(i);
        }
    }

    /// Break-beam sensors measure, and a ball that has left a robot ends its dribbling.
    pub(super) fn read_break_beams(&mut self) {
        let (now, apart) = (self.step, self.parameters.ball.radius + SEPARATION_GAP_MIN);
        for k in 0..self.near_ball.len() {
            let i = usize::from(self.near_ball[k]);
            let robot = &self.robots[i];
            if robot.dribbling_from.is_none() && !robot.ball_contact && !robot.touching {
                let reach = robot.body.radius + apart;
                let (dx, dy) = (
                    self.ball.position.x() - robot.pose.position.x(),
                    self.ball.position.y() - robot.pose.position.y(),
                );
                if dx * dx + dy * dy > reach * reach {
                    continue;
                }
            }
            let contact = self.in_dribbler(robot, self.parameters.dribbler.barrier, DRIBBLE_HEIGHT);
            let left = robot.pose.position.distance(self.ball.position) > robot.body.radius + apart
                || self.ball.height > robot.body.height;
            let robot = &mut self.robots[i];
            robot.ball_contact = contact;
            robot.touching = robot.touched_at == Some(now);
            if left {
                robot.dribbling_from = None;
            }
        }
    }

    fn in_dribbler(&self, robot: &Robot, reach: f32, height: f32) -> bool {
        self.ball.height <= height && self.place_in_dribbler(robot).is_some_and(|[gap, _]| gap <= reach)
    }

    /// The ball's distance from the front, and its offset to the left of the front's middle, if it is in
    /// front of the roller.
    fn place_in_dribbler(&self, robot: &Robot) -> Option<[f32; 2]> {
        let away = self.ball.position - robot.pose.position;
        let near = robot.body.radius + self.parameters.ball.radius + NEAR_DISTANCE;
        if away.dot(away) > near * near {
            return None;
        }
        let [ahead, aside] = robot.to_body(away);
        let gap = ahead - robot.body.front - self.parameters.ball.radius;
        // A ball that lies half within the front is not in the dribbler opening.
        let before = aside.abs() <= robot.body.mouth && gap > -self.parameters.ball.radius;
        before.then_some([gap, aside])
    }
}

/// The change of the ball's velocity by the roller in a step.
fn pull(
    robot: &Robot,
    ball: &Ball,
    [gap, aside]: [f32; 2],
    of: &DribblerParameters,
) -> Vector<geometry::Field> {
    let moves = robot.to_body(ball.velocity - robot.velocity_at(ball.position));
    let wanted = [-gap.max(0.0) * of.draw, -aside * of.center];
    // Towards the robot only: impacts on the front are handled elsewhere.
    let x = (wanted[0] - moves[0]).min(0.0);
    let y = wanted[1] - moves[1];
    // A roller whose rim is only slightly faster than the ball pulls less.
    let left = if of.fade > 0.0 { (1.0 - of.fade * ball.velocity.norm()).max(0.0) } else { 1.0 };
    let strength = robot.order.dribbler * robot.traits.pull * left * STEP;
    let (pull, side) = (of.pull * strength, of.side * strength);
    robot.to_field([x.max(-pull), y.clamp(-side, side)])
}

/// Change of a solid sphere's spin (as the velocity at which it would roll) over that of its velocity, by a
/// push at its surface: m r² / I.
const SPHERE_SPIN_RATIO: f32 = 2.5;
/// Steps in which a kicked ball is past the roller: 1.5 m/s, the slowest kick, for a reach of 12 mm and a
/// ball's radius.
const KICK_CLEARS_STEPS: u64 = 22;
/// Maximum height at which the plunger touches a ball, m.
const KICKABLE_HEIGHT: f32 = 0.02;
/// Maximum height at which the roller and the break-beam sensor reach a ball, m.
const DRIBBLE_HEIGHT: f32 = 0.03;
/// Visible separation of hull and ball, m (rules: dribbling ends at visible separation); our reading of
/// "visible".
const SEPARATION_GAP_MIN: f32 = 0.02;
/// Distance beyond contact, m, from which the dribbler opening is not checked.
const NEAR_DISTANCE: f32 = 0.1;
/// Share of its motion along the front that a kicked ball keeps: the plunger's face holds most of it by
/// friction; estimate.
const ASIDE_KEPT_SHARE: f32 = 0.5;
