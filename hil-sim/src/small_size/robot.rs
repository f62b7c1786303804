//! How does a robot on wheels obey? Orders, motors, grip, limits, battery; m, s, rad, field frame.
//!
//! Each wheel's rim follows its wanted speed as its motor allows; the body follows what the rims mean together as grip allows,
//! stronger ahead than to the side, stronger braking than speeding up. An order lasts `order_lasts`; without one the robot
//! brakes, its dribbler stops and its kicker is at rest.

use geometry::{Body, Field, Point, Pose, Twist, Vector, math};
use protocol::RobotId;
use protocol::robot_io::{ActuatorFrame, OmniKick};
use rules::Colour;

use super::STEP;
use super::parameters::{BatteryParameters, BodyParameters, DriveParameters, Parameters};
use super::wheels::Wheels;

/// A robot by its colour and number; sorted yellow first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Who {
    /// Its team.
    pub colour: Colour,
    /// Its number.
    pub id: RobotId,
}

/// What a robot's wheels shall do.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub enum Drive {
    /// Brake and stand.
    #[default]
    Brake,
    /// Rim speeds, m/s: front right, back right, back left, front left; positive turns the robot counter-clockwise.
    Rims([f32; 4]),
    /// A velocity in the robot's own frame.
    Local(Twist<Body>),
    /// A velocity in the field frame, held while the robot turns.
    Global(Twist<Field>),
}

/// A kick that leaves as soon as the ball lies in the mouth and the kicker is charged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kick {
    /// Speed of the ball in 3-D, m/s.
    pub speed: f32,
    /// Upwards from the carpet, rad; 0 is a flat kick.
    pub angle: f32,
}

/// What a robot was told last.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Order {
    /// Wheels.
    pub drive: Drive,
    /// Kicker.
    pub kick: Option<Kick>,
    /// Share of the dribbler's full strength, 0–1.
    pub dribbler: f32,
    /// Empty the kicker's store: it charges anew afterwards.
    pub discharge: bool,
}

impl Order {
    /// What a brain wants; a robot on wheels has nothing to do for legs.
    pub fn from_actuators(frame: &ActuatorFrame, parameters: &Parameters) -> Self {
        let ActuatorFrame::Omni { wheels, dribbler, kick } = frame else { return Self::default() };
        let kick = match *kick {
            OmniKick::None | OmniKick::Discharge => None,
            OmniKick::Flat(speed) => Some(Kick { speed, angle: 0.0 }),
            OmniKick::Chip(speed) => {
                Some(Kick { speed, angle: parameters.kick.chip_deg * (math::PI / 180.0) })
            }
        };
        let discharge = matches!(frame, ActuatorFrame::Omni { kick: OmniKick::Discharge, .. });
        Self { drive: Drive::Rims(*wheels), kick, dribbler: *dribbler, discharge }
    }

    /// The same without numbers that are none: they mean "nothing".
    fn sane(mut self) -> Self {
        let finite = match self.drive {
            Drive::Brake => true,
            Drive::Rims(rims) => rims.iter().all(|rim| rim.is_finite()),
            Drive::Local(Twist { linear, angular }) => linear.is_finite() && angular.is_finite(),
            Drive::Global(Twist { linear, angular }) => linear.is_finite() && angular.is_finite(),
        };
        if !finite {
            self.drive = Drive::Brake;
        }
        self.kick =
            self.kick.filter(|kick| kick.speed > 0.0 && kick.speed.is_finite() && kick.angle.is_finite());
        self.dribbler = if self.dribbler > 0.0 { self.dribbler.min(1.0) } else { 0.0 };
        self
    }
}

/// A robot, as it truly is.
#[derive(Clone, Debug)]
pub struct Robot {
    /// Which.
    pub who: Who,
    /// It stands on the carpet; else nothing of it is there.
    pub present: bool,
    /// Where it is and faces.
    pub pose: Pose<Field>,
    /// m/s.
    pub velocity: Vector<Field>,
    /// rad/s, counter-clockwise.
    pub turning: f32,
    /// It lies on its side: nothing drives.
    pub tipped: bool,
    /// The light barrier in its mouth sees the ball.
    pub ball_contact: bool,
    /// Ball and hull touch now.
    pub touching: bool,
    /// Where the ball was when it was last separate from this robot and came to it, while it has not left.
    pub dribbling_from: Option<Point<Field>>,
    /// Its body; the simulation protocol may give each robot its own.
    pub body: BodyParameters,
    /// Its wheels' limits.
    pub limits: DriveParameters,
    /// m/s, its strongest flat and chip kick.
    pub kick_limits: [f32; 2],
    pub(super) half_front: f32,
    pub(super) facing: [f32; 2],
    pub(super) order: Order,
    pub(super) ordered_at: Option<u64>,
    pub(super) charged_at: u64,
    pub(super) touched_at: Option<u64>,
    pub(super) dragged: Option<Drag>,
    pub(super) odometer: Odometer,
    wheels: Wheels,
    rims: [f32; 4],
    used: f32,
}

/// Somebody pulls the robot, through whatever stands in the way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Drag {
    pub to: Point<Field>,
    pub heading: Option<geometry::Angle>,
    pub until: u64,
}

/// What wheels and gyroscope have measured since they were last asked.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Odometer {
    pub along: [f32; 2],
    pub turned: f32,
    pub steps: u32,
}

impl Robot {
    /// At rest there, charged, with a full battery.
    pub fn new(who: Who, pose: Pose<Field>, parameters: &Parameters) -> Self {
        let body = parameters.robot;
        let mut robot = Self {
            who,
            present: true,
            pose,
            velocity: Vector::default(),
            turning: 0.0,
            tipped: false,
            ball_contact: false,
            touching: false,
            dribbling_from: None,
            body,
            limits: parameters.drive,
            kick_limits: [parameters.kick.flat, parameters.kick.chip],
            half_front: 0.0,
            facing: [1.0, 0.0],
            order: Order::default(),
            ordered_at: None,
            charged_at: 0,
            touched_at: None,
            dragged: None,
            odometer: Odometer::default(),
            wheels: Wheels::new(&body).expect("a checked body has wheels that drive"),
            rims: [0.0; 4],
            used: 0.0,
        };
        robot.set_body(body);
        robot.place(pose);
        robot
    }

    /// Another body, from the next step on; one that [`BodyParameters::check`] refuses changes nothing.
    pub fn set_body(&mut self, body: BodyParameters) {
        if let Some(wheels) = Wheels::new(&body) {
            self.wheels = wheels;
            self.body = body;
            self.half_front = math::sqrt((body.radius * body.radius - body.front * body.front).max(0.0));
        }
    }

    /// Stands there at once, at rest, and what it did has ended.
    pub fn place(&mut self, pose: Pose<Field>) {
        self.pose = pose;
        self.velocity = Vector::default();
        self.turning = 0.0;
        self.rims = [0.0; 4];
        self.dragged = None;
        self.dribbling_from = None;
        self.face();
    }

    /// Moves like this at once, its wheels with it.
    pub fn push(&mut self, velocity: Vector<Field>, turning: f32) {
        self.velocity = velocity;
        self.turning = turning;
        let own = self.to_body(velocity);
        self.rims = self.wheels.rims([own[0], own[1], turning]);
    }

    /// Takes an order at step `now`.
    pub(super) fn obey(&mut self, order: Order, now: u64, recharge: f32) {
        self.order = order.sane();
        if order.discharge {
            self.charged_at = self.charged_at.max(now + (recharge / STEP) as u64);
        }
        self.ordered_at = Some(now);
    }

    /// It has heard an order lately.
    pub fn is_led(&self, now: u64) -> bool {
        let lasts = (self.limits.order_lasts / STEP) as u64;
        self.ordered_at.is_some_and(|at| now - at < lasts)
    }

    /// What it was told last.
    pub fn order(&self) -> &Order {
        &self.order
    }

    /// Battery, V.
    pub fn volts(&self, of: &BatteryParameters) -> f32 {
        of.full - (of.full - of.empty) * (self.used / of.energy).min(1.0)
    }

    /// The kicker has what it needs for a kick.
    pub fn charged(&self, now: u64) -> bool {
        now >= self.charged_at
    }

    /// It kicked at step `now`.
    pub(super) fn discharge(&mut self, now: u64, recharge: f32, energy: f32) {
        self.charged_at = now + (recharge / STEP) as u64;
        self.used += energy;
    }

    /// A vector of the field in the robot's own frame.
    #[inline]
    pub(super) fn to_body(&self, v: Vector<Field>) -> [f32; 2] {
        let [c, s] = self.facing;
        [c * v.x() + s * v.y(), c * v.y() - s * v.x()]
    }

    /// A vector of the robot's own frame on the field.
    #[inline]
    pub(super) fn to_field(&self, [x, y]: [f32; 2]) -> Vector<Field> {
        let [c, s] = self.facing;
        Vector::new(c * x - s * y, s * x + c * y)
    }

    /// How fast the point of its body that is at `point` moves.
    #[inline]
    pub(super) fn velocity_at(&self, point: Point<Field>) -> Vector<Field> {
        let arm = point - self.pose.position;
        self.velocity + Vector::new(-arm.y(), arm.x()) * self.turning
    }

    /// Wheels and body for one step.
    pub(super) fn drive(&mut self, now: u64, battery: &BatteryParameters) {
        let wanted = self.wanted_rims(now);
        let of = &self.limits;
        let (full, top) = (of.rim_acceleration * STEP, 1.0 / of.rim_speed);
        for (rim, wanted) in self.rims.iter_mut().zip(wanted) {
            let change = wanted - *rim;
            // Speeding up, a motor's strength falls with its speed; braking it does not.
            let most = if change * *rim > 0.0 { full * (1.0 - rim.abs() * top).max(0.0) } else { full };
            *rim += change.clamp(-most, most);
        }
        let meant = self.wheels.motion(self.rims);
        let own = self.to_body(self.velocity);
        let gap = [meant[0] - own[0], meant[1] - own[1]];
        let braking = gap[0] * own[0] + gap[1] * own[1] < 0.0;
        let (ahead, side) = if braking { (of.brake, of.brake) } else { (of.forward, of.side) };
        let (x, y) = (gap[0] / (ahead * STEP), gap[1] / (side * STEP));
        let strain = x * x + y * y;
        let share = if strain > 1.0 { 1.0 / math::sqrt(strain) } else { 1.0 };
        let before = self.velocity;
        self.velocity += self.to_field([gap[0] * share, gap[1] * share]);
        let squared = self.velocity.dot(self.velocity);
        if squared > of.speed * of.speed {
            self.velocity = self.velocity * (of.speed / math::sqrt(squared));
        }
        let turned = self.turning;
        let most = of.turn * STEP;
        self.turning += (meant[2] - turned).clamp(-most, most);
        self.turning = self.turning.clamp(-of.turn_speed, of.turn_speed);
        self.pose.position += (before + self.velocity) * (0.5 * STEP);
        let turn = (turned + self.turning) * (0.5 * STEP);
        if turn != 0.0 {
            self.pose.heading = self.pose.heading + geometry::Angle::new(turn);
            self.face();
        }
        self.odometer.along[0] += meant[0];
        self.odometer.along[1] += meant[1];
        self.odometer.turned += self.turning;
        self.odometer.steps += 1;
        // |vx| + |vy| is near enough to the speed for a battery.
        self.used += STEP * (battery.idle + battery.drive * (own[0].abs() + own[1].abs()));
    }

    fn wanted_rims(&self, now: u64) -> [f32; 4] {
        if self.tipped {
            return [0.0; 4];
        }
        if let Some(drag) = self.dragged {
            let pull = (drag.to - self.pose.position) * DRAG_RATE;
            let pull = self.to_body(pull.clamped(self.limits.speed));
            let turn = drag.heading.map_or(0.0, |heading| (heading - self.pose.heading).radians());
            return self.wheels.rims([pull[0], pull[1], turn * DRAG_RATE]);
        }
        if !self.is_led(now) {
            return [0.0; 4];
        }
        match self.order.drive {
            Drive::Brake => [0.0; 4],
            Drive::Rims(rims) => rims,
            Drive::Local(Twist { linear, angular }) => self.wheels.rims([linear.x(), linear.y(), angular]),
            Drive::Global(Twist { linear, angular }) => {
                let [x, y] = self.to_body(linear);
                self.wheels.rims([x, y, angular])
            }
        }
    }

    fn face(&mut self) {
        let (s, c) = self.pose.heading.sin_cos();
        self.facing = [c, s];
    }
}

/// 1/s: how quickly somebody who pulls a robot closes the gap.
const DRAG_RATE: f32 = 5.0;
