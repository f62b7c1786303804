//! Near-time-optimal motion with limits of speed, acceleration and braking that do not depend on each other;
//! SI.

use geometry::{Point, Vector, math};
use rules::{DriveSpec, RobotSpec};

use super::axis::{AxisLimits, Phases};
use super::balance::{Balance, balance};
use super::{CalcMotion, Motion, State, Utmost, out_of_reach, somewhere, usable};

/// Limits of a robot without drag.
///
/// During the motion acceleration never exceeds `acceleration`, or `braking` where an axis brakes; speed
/// never exceeds √(`speed`² + |v₀|²), and `speed` itself where it starts at standstill or along its path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeLimits {
    /// Speed, m/s, > 0.
    pub speed: f32,
    /// Acceleration, m/s², > 0.
    pub acceleration: f32,
    /// Braking, m/s², > 0.
    pub braking: f32,
}

impl Default for FreeLimits {
    /// What is assumed of any robot of the league (`RobotSpec::OURS.assumed.pass`).
    fn default() -> Self {
        Self::of(&RobotSpec::OURS.assumed.pass)
    }
}

impl FreeLimits {
    /// The limits of a robot's drive.
    pub const fn of(drive: &DriveSpec) -> Self {
        Self { speed: drive.speed, acceleration: drive.acceleration, braking: drive.braking }
    }

    /// The same robot, no faster than `speed`, m/s.
    pub fn slowed_to(self, speed: f32) -> Self {
        Self { speed: math::min(self.speed, speed), ..self }
    }

    /// The same robot, accelerating no harder than `acceleration`, m/s²; it brakes as before.
    pub fn softened_to(self, acceleration: f32) -> Self {
        Self { acceleration: math::min(self.acceleration, acceleration), ..self }
    }

    /// All three are positive numbers.
    pub(crate) fn are_usable(&self) -> bool {
        let positive = |x: f32| x > LIMIT_MIN && x.is_finite();
        positive(self.speed) && positive(self.acceleration) && positive(self.braking)
    }
}

impl CalcMotion for FreeLimits {
    type Motion<F: Copy> = FreeMotion<F>;

    fn plan<F: Copy>(&self, from: Point<F>, velocity: Vector<F>, to: Point<F>) -> FreeMotion<F> {
        if !self.are_usable() || !usable(from, velocity, to) {
            return FreeMotion::resting(somewhere(from));
        }
        let limits = AxisLimits::new(self);
        let offset = to - from;
        let shares = shares(&limits, offset, velocity, f32::INFINITY);
        let x = limits.phases(offset.x(), velocity.x(), shares.x);
        let y = limits.phases(offset.y(), velocity.y(), shares.y);
        FreeMotion { from, to, x, y }
    }

    fn time<F: Copy>(&self, from: Point<F>, velocity: Vector<F>, to: Point<F>) -> f32 {
        if !self.are_usable() || !usable(from, velocity, to) {
            return 0.0;
        }
        shares(&AxisLimits::new(self), to - from, velocity, f32::INFINITY).time
    }

    fn time_within<F: Copy>(
        &self,
        from: Point<F>,
        velocity: Vector<F>,
        to: Point<F>,
        within: f32,
    ) -> Option<f32> {
        let time = if self.are_usable() && usable(from, velocity, to) {
            shares(&AxisLimits::new(self), to - from, velocity, within).time
        } else {
            0.0
        };
        (time <= within).then_some(time)
    }

    fn is_surely_longer<F: Copy>(
        &self,
        from: Point<F>,
        velocity: Vector<F>,
        to: Point<F>,
        radius: f32,
        within: f32,
    ) -> bool {
        let speed = math::sqrt(self.speed * self.speed + velocity.dot(velocity));
        let utmost = Utmost { acceleration: math::max(self.acceleration, self.braking), speed };
        out_of_reach(to - from, velocity, radius, within, utmost)
    }
}

fn shares<F>(limits: &AxisLimits, offset: Vector<F>, velocity: Vector<F>, within: f32) -> Balance {
    let (dx, dy, vx, vy) = (offset.x(), offset.y(), velocity.x(), velocity.y());
    let (x, y) = (limits.effort(dx, vx), limits.effort(dy, vy));
    let sum = x + y;
    let first = if sum > 0.0 { y / sum } else { 0.5 };
    balance(first, ROUNDS, TOLERANCE, within, |x, y| {
        let (px, py) = (1.0 / x, 1.0 / y);
        (limits.time(dx * px, vx * px), limits.time(dy * py, vy * py))
    })
}

/// A planned motion without drag.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeMotion<F> {
    from: Point<F>,
    to: Point<F>,
    x: Phases,
    y: Phases,
}

impl<F> FreeMotion<F> {
    fn resting(at: Point<F>) -> Self {
        let at: [f32; 2] = at.into();
        Self { from: at.into(), to: at.into(), x: Phases::default(), y: Phases::default() }
    }
}

impl<F: Copy> FreeMotion<F> {
    /// Its end, at standstill.
    pub fn to(&self) -> Point<F> {
        self.to
    }
}

impl<F: Copy> Motion<F> for FreeMotion<F> {
    fn duration(&self) -> f32 {
        math::max(self.x.duration, self.y.duration)
    }

    fn at(&self, time: f32) -> State<F> {
        if time >= self.duration() {
            return State::at_rest(self.to);
        }
        let (x, vx, ax) = self.x.at(time);
        let (y, vy, ay) = self.y.at(time);
        State {
            position: self.from + Vector::new(x, y),
            velocity: Vector::new(vx, vy),
            acceleration: Vector::new(ax, ay),
        }
    }
}

/// The smallest valid limit: slower than a micrometre a second counts as standing.
const LIMIT_MIN: f32 = 1e-6;
/// Most evaluations of the axes' times; firmware/motion/README.md has the gain of more.
const ROUNDS: u32 = 5;
/// Relative tolerance: times that differ by less than 2 × this share are equal.
const TOLERANCE: f32 = 0.005;
