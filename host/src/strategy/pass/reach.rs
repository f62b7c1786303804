//! `reach`: fast estimate of a robot's time to a place. SI units.
//!
//! [`Mover::time_to`] is the time that `CalcMotion2D` gives (paper 2 §2), along the straight line only: exact
//! for a robot at standstill, and for one that moves along that line. [`Mover::time_to_touch`] is the same
//! for a robot that only has to touch a ball there.

use geometry::{Attack, Point, Vector, math};
use motion::trajectory::FreeLimits;

/// m; nearer, directions are undefined.
const SAME_PLACE_WITHIN_M: f32 = 1e-3;

/// A robot with its limits; its acceleration is also used as its braking.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mover {
    /// Position of its centre, attack frame, m.
    pub position: Point<Attack>,
    /// Velocity of its centre, m/s.
    pub velocity: Vector<Attack>,
    /// Speed towards the place, m/s.
    running: f32,
    /// Speed limit, m/s, > 0.
    speed: f32,
    /// m/s², > 0, and 1 over it.
    acceleration: f32,
    per_acceleration: f32,
    /// 1 / speed, s/m.
    per_speed: f32,
}

impl Mover {
    /// A robot at this place and velocity, with these limits.
    pub fn new(position: Point<Attack>, velocity: Vector<Attack>, limits: &FreeLimits) -> Self {
        let FreeLimits { speed, acceleration, .. } = *limits;
        let per_acceleration = 1.0 / acceleration;
        let running = velocity.norm();
        Self { position, velocity, running, speed, acceleration, per_acceleration, per_speed: 1.0 / speed }
    }

    /// Time until it stands at `to`, s. Speed across the line is reduced while it drives, as far as there is
    /// time for it.
    #[inline]
    pub fn time_to(&self, to: Point<Attack>) -> f32 {
        let (distance, closing, across) = self.towards(to);
        // Reducing the speed across takes no extra distance, but a share of the acceleration.
        self.time_along(distance, closing).max(across.abs() * self.per_acceleration)
    }

    /// Time until it touches a ball at `to`, s, where touching means being within `reach` m: at standstill
    /// there, or in passing where it is too fast to stop. 0 where it covers the place already.
    #[inline]
    pub fn time_to_touch(&self, to: Point<Attack>, reach: f32) -> f32 {
        let (distance, closing, _) = self.towards(to);
        let distance = distance - reach;
        if distance <= 0.0 {
            return 0.0;
        }
        let squared = closing * closing - 2.0 * self.acceleration * distance;
        if closing > 0.0 && squared > 0.0 {
            return (closing - math::sqrt(squared)) * self.per_acceleration;
        }
        self.time_along(distance, closing)
    }

    /// Time in which it covers a distance from standstill, without braking, s.
    #[inline]
    pub fn time_from_rest(&self, distance: f32) -> f32 {
        math::sqrt(2.0 * distance.max(0.0) * self.per_acceleration)
    }

    /// Metres by which a path of `distance` from standstill may grow per additional second: the highest speed
    /// on that path, m/s.
    #[inline]
    pub fn pace(&self, distance: f32) -> f32 {
        math::sqrt(self.acceleration * distance.max(0.0)).min(self.speed)
    }

    /// No place farther than this is reached at standstill within `time`, m.
    #[inline]
    pub fn farthest(&self, time: f32) -> f32 {
        let t = time.max(0.0);
        self.running * 0.5 * t + 0.25 * self.acceleration * t * t
    }

    /// No place farther than this is touched within `time`, m: likewise, or in passing.
    #[inline]
    pub fn farthest_touched(&self, time: f32) -> f32 {
        let t = time.max(0.0);
        self.running * t + 0.25 * self.acceleration * t * t
    }

    /// Distance, speed towards the place, speed across.
    #[inline]
    fn towards(&self, to: Point<Attack>) -> (f32, f32, f32) {
        let path = to - self.position;
        let distance = path.norm();
        if distance < SAME_PLACE_WITHIN_M {
            return (0.0, 0.0, self.running);
        }
        let along = path * (1.0 / distance);
        (distance, self.velocity.dot(along), along.cross(self.velocity))
    }

    /// Acceleration, constant speed, braking; before that a return from the wrong direction or from an
    /// overshoot.
    #[inline]
    fn time_along(&self, distance: f32, closing: f32) -> f32 {
        let stop = 0.5 * closing * closing.abs() * self.per_acceleration;
        let (mut ahead, mut distance, mut first) = (closing, distance, 0.0);
        if distance < stop {
            // It overshoots: brake, and return from standstill.
            (first, distance, ahead) = (closing * self.per_acceleration, stop - distance, 0.0);
        } else if ahead < 0.0 {
            (first, distance, ahead) = (-closing * self.per_acceleration, distance - stop, 0.0);
        }
        let squared = self.acceleration * distance + 0.5 * ahead * ahead;
        if squared <= self.speed * self.speed || ahead > self.speed {
            return first + (2.0 * math::sqrt(squared) - ahead) * self.per_acceleration;
        }
        let paths = (self.speed * self.speed - 0.5 * ahead * ahead) * self.per_acceleration;
        first + (2.0 * self.speed - ahead) * self.per_acceleration + (distance - paths) * self.per_speed
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use motion::trajectory::CalcMotion;
    use rand_core::{RngCore, SeedableRng};
    use rand_xoshiro::Xoshiro128PlusPlus;

    fn mover(x: f32, y: f32, vx: f32, vy: f32) -> Mover {
        Mover::new(Point::new(x, y), Vector::new(vx, vy), &FreeLimits::default())
    }

    #[test]
    fn from_rest_to_rest_by_hand() {
        // Triangle over 1 m: 2 √(1 / 3.5) = 1.069045 s. Trapezoid over 4 m: 2 · 3/3.5 + (4 − 9/3.5)/3 =
        // 2.190476 s.
        assert!((mover(0.0, 0.0, 0.0, 0.0).time_to(Point::new(0.6, 0.8)) - 1.069_045).abs() < 1e-5);
        assert!((mover(0.0, 0.0, 0.0, 0.0).time_to(Point::new(0.0, 4.0)) - 2.190_476).abs() < 1e-5);
    }

    #[test]
    fn a_running_start_saves_time_and_a_wrong_direction_costs_it_by_hand() {
        let to = Point::new(1.0, 0.0);
        // Towards it with 1 m/s: peak² = 3.5 + 0.5 = 4, (2 · 2 − 1)/3.5 = 6/7 s.
        assert!((mover(0.0, 0.0, 1.0, 0.0).time_to(to) - 6.0 / 7.0).abs() < 1e-5);
        // Away: 1/3.5 s of braking over 1/7 m, then 8/7 m: 0.285714 + 2 √(1.142857 / 3.5) = 1.428571 s.
        assert!((mover(0.0, 0.0, -1.0, 0.0).time_to(to) - 1.428_571).abs() < 1e-5);
        // Too fast to stop there, 3 m/s 1 m off: stops after 0.857143 s, 0.285714 m beyond: + 2 √(0.285714 /
        // 3.5) = 1.428571 s.
        assert!((mover(0.0, 0.0, 3.0, 0.0).time_to(to) - 1.428_571).abs() < 1e-5);
    }

    #[test]
    fn a_robot_too_fast_to_stop_touches_a_ball_in_passing_by_hand() {
        // 1.1 m less 0.1 m of reach: at standstill there after 1.069045 s as above; with 3 m/s, which stops
        // over 9/7 m, in passing: (3 − √(9 − 7)) / 3.5 = 0.453082 s.
        let at = Point::new(1.1, 0.0);
        assert!((mover(0.0, 0.0, 0.0, 0.0).time_to_touch(at, 0.1) - 1.069_045).abs() < 1e-5);
        assert!((mover(0.0, 0.0, 3.0, 0.0).time_to_touch(at, 0.1) - 0.453_082).abs() < 1e-5);
        assert_eq!(mover(0.0, 0.0, -1.0, 0.0).time_to_touch(Point::new(0.05, 0.05), 0.1), 0.0);
    }

    #[test]
    fn reach_times_equal_the_planners_from_rest_and_are_close_to_them_in_motion() {
        let limits = FreeLimits::default();
        let mut rng = Xoshiro128PlusPlus::seed_from_u64(3);
        let mut within = |range: f32| ((rng.next_u32() >> 8) as f32 / 8_388_608.0 - 1.0) * range;
        let (mut sum, mut worst) = (0.0_f32, 0.0_f32);
        for _ in 0..2_000 {
            let (from, to) = (Point::new(within(4.5), within(3.0)), Point::new(within(4.5), within(3.0)));
            let velocity = Vector::new(within(1.5), within(1.5));
            let still = Mover::new(from, Vector::default(), &limits).time_to(to);
            let planned = limits.time(from, Vector::default(), to);
            assert!((still - planned).abs() < 0.01 * planned + 1e-3, "{still} {planned}");
            let moving = Mover::new(from, velocity, &limits).time_to(to);
            let off = (moving - limits.time(from, velocity, to)).abs();
            (sum, worst) = (sum + off, worst.max(off));
        }
        assert!(sum / 2_000.0 < MEAN_OFF && worst < WORST_OFF, "{} {worst}", sum / 2_000.0);
    }

    /// Mean error and worst error, s, over robots of up to 1.5 m/s along each axis: below the width of a
    /// condition on times.
    const MEAN_OFF: f32 = 0.08;
    const WORST_OFF: f32 = 0.5;

    #[test]
    fn the_bounds_are_never_below_what_is_reached() {
        let mut rng = Xoshiro128PlusPlus::seed_from_u64(4);
        let mut within = |range: f32| ((rng.next_u32() >> 8) as f32 / 8_388_608.0 - 1.0) * range;
        for _ in 0..5_000 {
            let robot = mover(within(4.0), within(3.0), within(2.0), within(2.0));
            let to = Point::new(within(4.0), within(3.0));
            let distance = robot.position.distance(to) - 1e-3;
            assert!(robot.farthest(robot.time_to(to)) >= distance, "{robot:?} {to:?}");
            assert!(
                robot.farthest_touched(robot.time_to_touch(to, 0.1)) >= distance - 0.1,
                "{robot:?} {to:?}"
            );
        }
    }
}
