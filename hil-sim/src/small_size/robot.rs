//! `robot`: motion of a wheeled robot. Orders, motors, traction, limits, battery; m, s, rad, field frame.
//!
//! Each wheel's rim follows its ordered speed as its motor permits; the body follows the motion of the rims
//! together as traction permits, stronger ahead than to the side, stronger braking than accelerating. An
//! order lasts `order_lasts`; without one the robot brakes, its dribbler stops and its kicker is off.

use geometry::{Field, Point, Pose, Twist, Vector, math};
use protocol::Who;
use serde::{Deserialize, Serialize};

use super::STEP;
use super::order::{Drive, Order};
use super::parameters::{BatteryParameters, BodyParameters, DriveParameters, Parameters};
use super::wheels::Wheels;
use super::worlds::Traits;

/// The true state of a robot.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Robot {
    /// Team and number.
    pub who: Who,
    /// True on the field surface; else the robot has no effect on the world.
    pub present: bool,
    /// Position and heading.
    pub pose: Pose<Field>,
    /// Velocity of its centre, m/s, field frame.
    pub velocity: Vector<Field>,
    /// Turning rate, rad/s, counter-clockwise.
    pub turning: f32,
    /// True on its side: nothing drives.
    pub tipped: bool,
    /// True where the break-beam sensor in the dribbler opening detects the ball.
    pub ball_contact: bool,
    /// True while ball and hull are in contact.
    pub touching: bool,
    /// Position of the ball when this robot's present dribbling started, while it lasts.
    pub dribbling_from: Option<Point<Field>>,
    /// Body; the simulation protocol may give each robot its own.
    pub body: BodyParameters,
    limits: DriveParameters,
    /// m/s, its strongest flat and chip kick.
    pub kick_limits: [f32; 2],
    /// A bystander: no computer commands it and no referee counts it.
    pub bystander: bool,
    /// Differences from the nominal robot.
    pub(super) traits: Traits,
    /// Share of the wheels' motion that reaches the field surface.
    grips: f32,
    pub(super) half_front: f32,
    pub(super) facing: [f32; 2],
    pub(super) order: Order,
    /// The step in which the order expires.
    pub(super) ordered_until: u64,
    /// Rim speeds of the order, where they do not depend on the heading.
    wanted: Wanted,
    /// True once the rims have reached them.
    settled: bool,
    /// Velocity of straight motion as long as nothing changes.
    cruise: Option<Vector<Field>>,
    pub(super) charged_at: u64,
    /// The step of its last kick, and whether that was a chip.
    pub(super) kicked: Option<(u64, bool)>,
    pub(super) touched_at: Option<u64>,
    pub(super) dragged: Option<Drag>,
    pub(super) odometer: Odometer,
    /// Steps to 1 m/s ahead and to the side: accelerating, and braking.
    grip: [[f32; 2]; 2],
    wheels: Wheels,
    rims: [f32; 4],
    used: f32,
}

/// The robot is pulled, pushing movable bodies aside.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Drag {
    pub to: Point<Field>,
    pub heading: Option<geometry::Angle>,
    /// The step in which it ends; `None`: it lasts until it is released.
    pub until: Option<u64>,
}

/// Ordered rim speeds, and the motion of the body that they give.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Wanted {
    rims: [f32; 4],
    motion: [f32; 3],
}

/// Measurements of wheels and gyroscope since the last sensor frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Odometer {
    pub along: [f32; 2],
    pub turned: f32,
    /// The step of the last sensor frame.
    pub asked: u64,
}

impl Robot {
    /// Resting there, charged, with a full battery.
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
            bystander: false,
            traits: Traits::NONE,
            grips: 1.0,
            half_front: 0.0,
            facing: [1.0, 0.0],
            order: Order::default(),
            ordered_until: 0,
            wanted: Wanted::default(),
            settled: false,
            cruise: None,
            charged_at: 0,
            kicked: None,
            touched_at: None,
            dragged: None,
            odometer: Odometer::default(),
            grip: [[1.0; 2]; 2],
            wheels: body.wheels().expect("a checked body has wheels that drive"),
            rims: [0.0; 4],
            used: 0.0,
        };
        robot.set_body(body);
        robot.set_limits(parameters.drive);
        robot.place(pose);
        robot
    }

    /// Replaces the body, from the next step on; one that [`BodyParameters::check`] refuses changes nothing.
    pub fn set_body(&mut self, body: BodyParameters) {
        if let Some(wheels) = body.wheels() {
            self.wheels = wheels;
            self.settled = false;
            self.body = body;
            self.half_front = math::sqrt((body.radius * body.radius - body.front * body.front).max(0.0));
        }
    }

    /// Replaces the limits, from the next step on.
    pub fn set_limits(&mut self, limits: DriveParameters) {
        let steps = |acceleration: f32| 1.0 / (acceleration * STEP);
        self.grip = [[steps(limits.forward), steps(limits.side)], [steps(limits.brake); 2]];
        self.limits = limits;
    }

    /// Sets its differences from the nominal robot; its present limits are scaled by them.
    pub(super) fn set_traits(&mut self, traits: Traits) {
        let of = self.limits;
        let [acceleration, speed] = [traits.acceleration, traits.speed];
        self.set_limits(DriveParameters {
            forward: of.forward * acceleration,
            side: of.side * acceleration,
            brake: of.brake * acceleration,
            turn: of.turn * acceleration,
            speed: of.speed * speed,
            turn_speed: of.turn_speed * speed,
            ..of
        });
        (self.traits, self.grips) = (traits, 1.0 - traits.slip);
    }

    /// Differences from the nominal robot.
    pub fn traits(&self) -> &Traits {
        &self.traits
    }

    /// Limits of its wheels' drive, differences from the nominal robot included.
    pub fn limits(&self) -> &DriveParameters {
        &self.limits
    }

    /// Places it there at once, resting, with no order.
    pub fn place(&mut self, pose: Pose<Field>) {
        self.pose = pose;
        self.velocity = Vector::default();
        self.turning = 0.0;
        self.rims = [0.0; 4];
        self.settled = false;
        self.dragged = None;
        self.dribbling_from = None;
        self.face();
    }

    /// Gives it this motion at once, wheels included.
    pub fn push(&mut self, velocity: Vector<Field>, turning: f32) {
        self.velocity = velocity;
        self.turning = turning;
        let own = self.to_body(velocity);
        self.rims = self.wheels.rims([own[0], own[1], turning]);
        self.settled = false;
    }

    /// Takes an order at step `now`.
    pub(super) fn obey(&mut self, order: Order, now: u64, recharge: f32) {
        self.order = order.sane();
        if order.discharge {
            self.charged_at = self.charged_at.max(now + (recharge / STEP) as u64);
        }
        self.ordered_until = now + (self.limits.order_lasts / STEP) as u64;
        self.settled = false;
        self.wanted = match self.order.drive {
            Drive::Brake | Drive::Global(_) => Wanted::default(),
            Drive::Rims(rims) => Wanted { rims, motion: self.wheels.motion(rims) },
            Drive::Local(Twist { linear, angular }) => self.moving([linear.x(), linear.y(), angular]),
        };
    }

    /// True while the order has not expired.
    pub fn is_led(&self, now: u64) -> bool {
        now < self.ordered_until
    }

    /// The order that it received last.
    pub fn order(&self) -> &Order {
        &self.order
    }

    /// Battery voltage, V: falls evenly from full to empty with the energy used.
    pub fn volts(&self, of: &BatteryParameters) -> f32 {
        of.full - (of.full - of.empty) * (self.used / of.energy).min(1.0)
    }

    /// True for a kicker that is charged for a kick.
    pub fn charged(&self, now: u64) -> bool {
        now >= self.charged_at
    }

    /// The step of its last kick, and whether that was a chip.
    pub fn kicked(&self) -> Option<(u64, bool)> {
        self.kicked
    }

    /// Records a kick at step `now`.
    pub(super) fn discharge(&mut self, now: u64, recharge: f32, energy: f32) {
        self.charged_at = now + (recharge / STEP) as u64;
        self.used += energy;
    }

    /// The ball is far away: ends contact and dribbling.
    pub(super) fn leave_ball(&mut self) {
        self.ball_contact = false;
        self.touching = false;
        self.dribbling_from = None;
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

    /// Velocity of the body's point at `point`, m/s.
    #[inline]
    pub(super) fn velocity_at(&self, point: Point<Field>) -> Vector<Field> {
        let arm = point - self.pose.position;
        self.velocity + Vector::new(-arm.y(), arm.x()) * self.turning
    }

    pub(super) fn drive(&mut self, now: u64, battery: &BatteryParameters) {
        let settled = self.settled && self.is_led(now) && !self.tipped && self.dragged.is_none();
        if settled && self.cruise == Some(self.velocity) {
            self.pose.position += self.velocity * STEP;
            self.measure(self.wanted.motion, battery);
            return;
        }
        // Wheels that slip turn on as ordered and their encoders report that: the body falls behind.
        let rolled = if settled { self.wanted.motion } else { self.turn_wheels(now) };
        let meant = rolled.map(|part| part * self.grips);
        let of = &self.limits;
        let ([c, s], (vx, vy)) = (self.facing, (self.velocity.x(), self.velocity.y()));
        let (own_x, own_y) = (c * vx + s * vy, c * vy - s * vx);
        let (gap_x, gap_y) = (meant[0] - own_x, meant[1] - own_y);
        let braking = gap_x * own_x + gap_y * own_y < 0.0;
        let [ahead, side] = if braking { self.grip[1] } else { self.grip[0] };
        let (x, y) = (gap_x * ahead, gap_y * side);
        let strain = x * x + y * y;
        let (mut new_x, mut new_y) = (meant[0], meant[1]);
        if strain > 1.0 {
            let share = 1.0 / math::sqrt(strain);
            (new_x, new_y) = (own_x + gap_x * share, own_y + gap_y * share);
        }
        let squared = new_x * new_x + new_y * new_y;
        if squared > of.speed * of.speed {
            let share = of.speed / math::sqrt(squared);
            (new_x, new_y) = (new_x * share, new_y * share);
        }
        let (to_x, to_y) = (c * new_x - s * new_y, s * new_x + c * new_y);
        self.velocity = Vector::new(to_x, to_y);
        // Straight on: the next step will change nothing, unless it is pushed or gets another order.
        let steady = vx == to_x && vy == to_y && self.turning == 0.0 && meant[2] == 0.0 && settled;
        self.cruise = steady.then_some(self.velocity);
        let p = self.pose.position;
        self.pose.position =
            Point::new(p.x() + (vx + to_x) * (0.5 * STEP), p.y() + (vy + to_y) * (0.5 * STEP));
        let turned = self.turning;
        let turning = bounded(turned + bounded(meant[2] - turned, of.turn * STEP), of.turn_speed);
        self.turning = turning;
        self.measure([rolled[0], rolled[1], turning], battery);
        let turn = (turned + turning) * (0.5 * STEP);
        if turn != 0.0 {
            self.pose.heading = geometry::Angle::new(self.pose.heading.radians() + turn);
            self.follow(turn, now);
        }
    }

    /// Measurements of wheels, gyroscope and battery in a step.
    #[inline]
    fn measure(&mut self, [x, y, turning]: [f32; 3], battery: &BatteryParameters) {
        self.odometer.along[0] += x;
        self.odometer.along[1] += y;
        self.odometer.turned += turning;
        // |x| + |y| approximates the speed accurately enough for the battery.
        self.used += STEP * (battery.idle + battery.drive * (x.abs() + y.abs()));
    }

    /// Rims follow their ordered speeds as motors permit; returns the motion of the body that they give.
    #[inline(never)]
    fn turn_wheels(&mut self, now: u64) -> [f32; 3] {
        self.settled = false;
        let Wanted { rims, motion } = self.wanted(now);
        let of = &self.limits;
        let (full, top) = (of.rim_acceleration * STEP, 1.0 / of.rim_speed);
        let (mut largest, mut fastest) = (0.0_f32, 0.0_f32);
        for (rim, wanted) in self.rims.iter().zip(rims) {
            largest = larger(largest, (wanted - rim).abs());
            fastest = larger(fastest, rim.abs());
        }
        // Most steps: every motor could do this even if it were the fastest and accelerating.
        if largest <= full * (1.0 - fastest * top) {
            self.rims = rims;
            // Not while the speeds come from something else than the order.
            self.settled = rims == self.wanted.rims && !matches!(self.order.drive, Drive::Global(_));
            return motion;
        }
        for (rim, wanted) in self.rims.iter_mut().zip(rims) {
            let change = wanted - *rim;
            // Accelerating, a motor's strength falls with its speed; braking it does not.
            let spent = if change * *rim > 0.0 { rim.abs() * top } else { 0.0 };
            *rim += bounded(change, full * if spent < 1.0 { 1.0 - spent } else { 0.0 });
        }
        self.wheels.motion(self.rims)
    }

    /// Rim speeds ordered now.
    #[inline]
    fn wanted(&self, now: u64) -> Wanted {
        if self.dragged.is_some() {
            return self.wanted_by_hand();
        }
        if self.tipped || !self.is_led(now) {
            return Wanted::default();
        }
        if let Drive::Global(Twist { linear, angular }) = self.order.drive {
            let [x, y] = self.to_body(linear);
            return self.moving([x, y, angular]);
        }
        self.wanted
    }

    /// Rim speeds while it is pulled manually.
    fn wanted_by_hand(&self) -> Wanted {
        let Some(drag) = self.dragged else { return Wanted::default() };
        let pull = (drag.to - self.pose.position) * DRAG_RATE;
        let [x, y] = self.to_body(pull.clamped(self.limits.speed));
        let turn = drag.heading.map_or(0.0, |heading| (heading - self.pose.heading).radians());
        self.moving([x, y, turn * DRAG_RATE])
    }

    #[inline]
    fn moving(&self, motion: [f32; 3]) -> Wanted {
        Wanted { rims: self.wheels.rims(motion), motion }
    }

    /// After a small turn of the heading, sine and cosine follow by their series, and exactly at intervals.
    #[inline]
    fn follow(&mut self, turn: f32, now: u64) {
        if now.is_multiple_of(EXACT_EVERY) {
            self.face();
            return;
        }
        let [c, s] = self.facing;
        // At most 15 mrad: the error of the series is below 6e-7 a step.
        let shrink = 1.0 - 0.5 * turn * turn;
        self.facing = [c * shrink - s * turn, s * shrink + c * turn];
    }

    fn face(&mut self) {
        let (s, c) = self.pose.heading.sin_cos();
        self.facing = [c, s];
    }
}

/// `value`, limited to ±`most`.
#[inline]
fn bounded(value: f32, most: f32) -> f32 {
    let value = if value > most { most } else { value };
    if value < -most { -most } else { value }
}

/// The larger one; NaN is not handled, since no order contains it.
#[inline]
fn larger(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// Steps between exact sines: meanwhile a robot's front is off by 10 µrad at most.
const EXACT_EVERY: u64 = 16;
/// Rate at which a manual pull on a robot closes the gap, 1/s.
const DRAG_RATE: f32 = 5.0;
