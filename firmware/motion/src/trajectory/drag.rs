//! Near-time-optimal motion of a robot whose motors weaken with speed (Kalmár-Nagy, D'Andrea, Ganguly 2004).
//!
//! In units of `speed`, `speed` / `acceleration` (time) and `speed²` / `acceleration` (distance): z″ + z′ =
//! u, |u| ≤ 1. Each axis pushes with one size of u, first in one direction, then in the other; z + z′ grows
//! by u a time unit, and that gives both times in closed form. The share of u between the axes is searched
//! for, as without drag.

use geometry::{Point, Vector, math};
use rules::RobotSpec;

use super::balance::{Balance, balance};
use super::{CalcMotion, Motion, State, Utmost, out_of_reach, somewhere, usable};

/// Limits of a robot with drag. Braking is stronger than speeding up, as drag helps: `acceleration` · (1 + v
/// / `speed`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DragLimits {
    /// Speed at which push and drag are equal: approached, never reached, m/s, > 0.
    pub speed: f32,
    /// Acceleration from standstill, m/s², > 0.
    pub acceleration: f32,
}

impl Default for DragLimits {
    /// As [`super::FreeLimits`].
    fn default() -> Self {
        let drive = RobotSpec::OURS.assumed.pass;
        Self { speed: drive.speed, acceleration: drive.acceleration }
    }
}

impl DragLimits {
    fn are_usable(self) -> bool {
        let positive = |x: f32| (LIMIT_MIN..=LIMIT_MAX).contains(&x);
        positive(self.speed) && positive(self.acceleration)
    }

    /// Unit of time, s.
    fn time_unit(self) -> f32 {
        self.speed / self.acceleration
    }

    fn shares<F>(self, offset: Vector<F>, velocity: Vector<F>, within: f32) -> Balance {
        let (v, d) =
            (velocity * (1.0 / self.speed), offset * (self.acceleration / (self.speed * self.speed)));
        // Distance from where coasting would stop: approximately the work of each axis.
        let (x, y) = ((d.x() - v.x()).abs(), (d.y() - v.y()).abs());
        let sum = x + y;
        let first = if sum > 0.0 { y / sum } else { 0.5 };
        balance(first, ROUNDS, TOLERANCE, within / self.time_unit(), |x, y| {
            (Pushes::new(d.x(), v.x(), x).duration(), Pushes::new(d.y(), v.y(), y).duration())
        })
    }
}

impl CalcMotion for DragLimits {
    type Motion<F: Copy> = DragMotion<F>;

    fn plan<F: Copy>(&self, from: Point<F>, velocity: Vector<F>, to: Point<F>) -> DragMotion<F> {
        if !self.are_usable() || !usable(from, velocity, to) {
            let at = somewhere(from);
            return DragMotion { limits: Self::default(), from: at, to: at, axes: [Axis::default(); 2] };
        }
        let offset = to - from;
        let shares = self.shares(offset, velocity, f32::INFINITY);
        let path = self.acceleration / (self.speed * self.speed);
        let axis = |d: f32, v: f32, share: f32| {
            let (d, v) = (d * path, v / self.speed);
            Axis { end: d, start: v, pushes: Pushes::new(d, v, share) }
        };
        let x = axis(offset.x(), velocity.x(), shares.x);
        let y = axis(offset.y(), velocity.y(), shares.y);
        DragMotion { limits: *self, from, to, axes: [x, y] }
    }

    fn time<F: Copy>(&self, from: Point<F>, velocity: Vector<F>, to: Point<F>) -> f32 {
        if !self.are_usable() || !usable(from, velocity, to) {
            return 0.0;
        }
        self.shares(to - from, velocity, f32::INFINITY).time * self.time_unit()
    }

    fn time_within<F: Copy>(
        &self,
        from: Point<F>,
        velocity: Vector<F>,
        to: Point<F>,
        within: f32,
    ) -> Option<f32> {
        let time = if self.are_usable() && usable(from, velocity, to) {
            self.shares(to - from, velocity, within).time * self.time_unit()
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
        // Push and drag together; on each axis it is never faster than it starts and than `speed`.
        let speed = math::sqrt(self.speed * self.speed + velocity.dot(velocity));
        let utmost = Utmost { acceleration: self.acceleration * (1.0 + speed / self.speed), speed };
        out_of_reach(to - from, velocity, radius, within, utmost)
    }
}

/// A planned motion with drag.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DragMotion<F> {
    limits: DragLimits,
    from: Point<F>,
    to: Point<F>,
    axes: [Axis; 2],
}

impl<F: Copy> Motion<F> for DragMotion<F> {
    fn duration(&self) -> f32 {
        let [x, y] = self.axes.map(|axis| axis.pushes.duration());
        x.max(y) * self.limits.time_unit()
    }

    fn at(&self, time: f32) -> State<F> {
        if time >= self.duration() {
            return State::at_rest(self.to);
        }
        let DragLimits { speed, acceleration } = self.limits;
        let [(x, vx, ax), (y, vy, ay)] = self.axes.map(|axis| axis.at(time * acceleration / speed));
        State {
            position: self.from + Vector::new(x, y) * (speed * speed / acceleration),
            velocity: Vector::new(vx, vy) * speed,
            acceleration: Vector::new(ax, ay) * acceleration,
        }
    }
}

/// One axis, in the units without dimension.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
struct Axis {
    end: f32,
    start: f32,
    pushes: Pushes,
}

impl Axis {
    /// Place, speed and acceleration; the second push is computed from the end backwards, so that it arrives.
    fn at(&self, time: f32) -> (f32, f32, f32) {
        let Pushes { push, first, second } = self.pushes;
        let left = first + second - time;
        if left <= 0.0 {
            return (self.end, 0.0, 0.0);
        }
        if time >= first {
            let grown = math::exp(left) - 1.0;
            return (self.end - push * (grown - left), push * grown, -push * (1.0 + grown));
        }
        let t = time.max(0.0);
        let lost = math::exp(-t);
        let speed = push + (self.start - push) * lost;
        (push * t + (self.start - push) * (1.0 - lost), speed, push - speed)
    }
}

/// u and its duration, then −u and its duration.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
struct Pushes {
    push: f32,
    first: f32,
    second: f32,
}

impl Pushes {
    /// Pushes to standstill at `distance`, moving with `speed`, pushing with `size` > 0.
    #[inline]
    fn new(distance: f32, speed: f32, size: f32) -> Self {
        if distance == 0.0 && speed == 0.0 {
            return Self::default();
        }
        // z + z′ relative to the end; coasting would stop this far beyond it.
        let beyond = speed - distance;
        let per_size = 1.0 / size;
        let sign = if beyond < 0.0 { -1.0 } else { 1.0 };
        let (x, v) = (beyond.abs() * per_size, sign * speed * per_size);
        // e^x may be infinite; then its inverse is 0 and the result is still right.
        let grown = math::exp(x);
        // Towards the end, against `beyond`; or with it, where one already moves away from `beyond` too fast.
        let (push, run, root) = if v - (grown - 1.0) > 0.0 {
            (sign * size, x, 1.0 + grown * (v - 1.0))
        } else {
            (-sign * size, -x, 1.0 + (-v - 1.0) / grown)
        };
        let second = math::ln(1.0 + math::sqrt(root.max(0.0)));
        Self { push, first: (second - run).max(0.0), second }
    }

    #[inline]
    fn duration(&self) -> f32 {
        self.first + self.second
    }
}

const LIMIT_MIN: f32 = 1e-3;
const LIMIT_MAX: f32 = 1e3;
/// Most evaluations of the axes' times, as without drag or slightly more.
const ROUNDS: u32 = 8;
const TOLERANCE: f32 = 0.005;
