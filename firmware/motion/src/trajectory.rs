//! `trajectory`: time-optimal motion of a robot to standstill at a place (paper 2 §2: `CalcMotion2D`).
//!
//! `CalcMotion2D(x_s, v_s, x_f) → (t*, V*)` is [`CalcMotion::plan`]: `t*` is [`Motion::duration`], `V*` is
//! [`Motion::at`]. The motion always ends at standstill. Two robot models implement it:
//!
//! - [`FreeLimits`], without drag: speed, acceleration and braking have limits of their own; each axis gets a
//!   trapezoid or triangle, and one angle shares the limits out between the axes. The default for a robot
//!   that was not measured.
//! - [`DragLimits`], with a motor's falling torque: the faster, the less it can still speed up (Kalmár-Nagy,
//!   D'Andrea, Ganguly 2004; z″ + z′ = u, |u| ≤ 1 in units of `speed` and `acceleration`).
//!
//! Both are near-time-optimal: the axes are parallel to the frame's, and the share between them is sought
//! until both arrive at nearly the same time. `cargo xtask bench motion` measures how near, and what it costs
//! (firmware/motion/README.md).
//!
//! Units: m, s, m/s, m/s². **Any input is answered**: where a coordinate is NaN, infinite or over
//! [`COORDINATE_MAX`], or a limit is not a positive number, the answer is to stay in place
//! ([`Motion::duration`] 0).

mod axis;
mod balance;
mod drag;
mod free;
mod turn;

pub use drag::{DragLimits, DragMotion};
pub use free::{FreeLimits, FreeMotion};
pub use turn::{Turn, TurnLimits};

use geometry::{Point, Vector, math};

/// Largest coordinate (m) and speed (m/s) that is accepted: 1 km, above any field and below where squares of
/// `f32` lose their last use.
pub const COORDINATE_MAX: f32 = 1_000.0;

/// Position and velocity of a robot at one time of a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State<F> {
    /// Position of the robot's centre, m.
    pub position: Point<F>,
    /// Velocity of the robot's centre, m/s.
    pub velocity: Vector<F>,
    /// Acceleration, m/s²; at a jump, the value after it.
    pub acceleration: Vector<F>,
}

impl<F> State<F> {
    /// Standing at `position` (m), without velocity or acceleration.
    pub fn at_rest(position: Point<F>) -> Self {
        Self { position, velocity: Vector::default(), acceleration: Vector::default() }
    }
}

/// A motion from a start to standstill.
pub trait Motion<F> {
    /// `t*`: time from the start until it stands, s.
    fn duration(&self) -> f32;

    /// The state `time` seconds after the start: before 0 the start, after the duration standstill at the
    /// end.
    fn at(&self, time: f32) -> State<F>;
}

/// Motion model of a robot from place to place.
pub trait CalcMotion {
    /// Type of the planned motion.
    type Motion<F: Copy>: Motion<F>;

    /// Plans from `from`, moving with `velocity`, to standstill at `to`.
    fn plan<F: Copy>(&self, from: Point<F>, velocity: Vector<F>, to: Point<F>) -> Self::Motion<F>;

    /// `t*` alone, s: the duration of [`Self::plan`].
    fn time<F: Copy>(&self, from: Point<F>, velocity: Vector<F>, to: Point<F>) -> f32;

    /// [`Self::time`], if it is `within` seconds at most; finding out that it is not is cheaper.
    fn time_within<F: Copy>(
        &self,
        from: Point<F>,
        velocity: Vector<F>,
        to: Point<F>,
        within: f32,
    ) -> Option<f32>;

    /// Whether it is certain, without planning, that [`Self::time`] to every place within `radius` m of `to`
    /// is over `within` seconds. A bound from the largest acceleration and speed; `false` is inconclusive.
    fn is_surely_longer<F: Copy>(
        &self,
        from: Point<F>,
        velocity: Vector<F>,
        to: Point<F>,
        radius: f32,
        within: f32,
    ) -> bool;
}

/// Whether all coordinates and speeds are within the accepted range.
pub(crate) fn usable<F>(from: Point<F>, velocity: Vector<F>, to: Point<F>) -> bool {
    // False for NaN.
    let small = |x: f32| x.abs() <= COORDINATE_MAX;
    small(from.x())
        && small(from.y())
        && small(velocity.x())
        && small(velocity.y())
        && small(to.x())
        && small(to.y())
}

/// A place to stand for a robot whose position is unknown.
fn somewhere<F>(from: Point<F>) -> Point<F> {
    if from.x().abs() <= COORDINATE_MAX && from.y().abs() <= COORDINATE_MAX { from } else { Point::default() }
}

/// Largest acceleration and speed of a robot within a bound.
#[derive(Clone, Copy)]
struct Utmost {
    /// Acceleration, m/s².
    acceleration: f32,
    /// Speed, m/s.
    speed: f32,
}

/// No motion within `utmost` brings about an offset within `radius` of `offset` and ends at standstill,
/// within `time`: it would move by v·t/2 and at most a·t²/4 more.
#[inline]
fn out_of_reach<F>(offset: Vector<F>, velocity: Vector<F>, radius: f32, time: f32, utmost: Utmost) -> bool {
    if time < 0.0 {
        return true;
    }
    let far = offset - velocity * (0.5 * time);
    let reach = (0.25 * utmost.acceleration * time * time + radius) * BOUND_SLACK;
    if far.dot(far) > reach * reach {
        return true;
    }
    // On the straight line: lower bounds of speeding up and braking, and the speed.
    let length = offset.norm();
    let Utmost { acceleration, speed } = utmost;
    let distance = length - radius;
    if distance <= 0.0 {
        return false;
    }
    let per_acceleration = 1.0 / acceleration;
    let (mut ahead, mut distance, mut least) = (velocity.dot(offset) / length, distance, 0.0);
    if ahead < 0.0 {
        least = -ahead * per_acceleration;
        distance -= 0.5 * ahead * least;
        ahead = 0.0;
    } else if 0.5 * ahead * ahead * per_acceleration > distance {
        // It overshoots; farther is not longer then.
        return false;
    }
    let squared = acceleration * distance + 0.5 * ahead * ahead;
    least += if squared <= speed * speed {
        (2.0 * math::sqrt(squared) - ahead) * per_acceleration
    } else {
        let ramps = (speed * speed - 0.5 * ahead * ahead) * per_acceleration;
        (2.0 * speed - ahead) * per_acceleration + (distance - ramps) / speed
    };
    least > time * BOUND_SLACK
}

/// Allowance for rounding in a bound: 10⁻⁴, a thousand times the error of `f32`.
const BOUND_SLACK: f32 = 1.0001;

#[cfg(test)]
mod tests;
