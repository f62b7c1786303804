//! `ball`: prediction of a kicked ball. It slides, then rolls (two decelerations), in the air it hops
//! ([`chip`]); m, s, m/s, m/s².
//!
//! Kicked with v₀ it slides with a_s until its speed is c·v₀, where it rolls without slipping, then rolls
//! with a_r until it stops. All of a path in closed form: t_s = v₀ (1 − c) / a_s, d_s = v₀² (1 − c²) / (2
//! a_s). Lines and robots on its path are for the caller to find; a path continues until the ball stops.

pub mod chip;

use geometry::{Point, Vector, math};

use crate::rolling::RollingBall;
use crate::trajectory::{Motion, State};

/// Parameters of field surface and ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BallModel {
    /// Deceleration while it slides, m/s², > 0.
    pub slide: f32,
    /// Deceleration while it rolls, m/s², > 0.
    pub roll: f32,
    /// Share of the kick's speed at which sliding becomes rolling, 0 to 1.
    pub switch: f32,
}

impl Default for BallModel {
    /// 3.9 and 0.35 m/s² of ER-Force's simulator, 5/7 of a solid ball that starts to roll (1 / (1 + 2/5)).
    fn default() -> Self {
        Self { slide: 3.9, roll: 0.35, switch: 5.0 / 7.0 }
    }
}

impl BallModel {
    /// From `BallModelStraightTwoPhase` of the league's geometry packets: `acc_slide`, `acc_roll` (m/s²;
    /// simulators send them negative), `k_switch`. `None` where the numbers are not physical.
    pub fn from_wire(acc_slide: f64, acc_roll: f64, k_switch: f64) -> Option<Self> {
        let (slide, roll, switch) = (acc_slide.abs() as f32, acc_roll.abs() as f32, k_switch as f32);
        let deceleration = |a: f32| (DECELERATION_MIN..=DECELERATION_MAX).contains(&a);
        let usable = deceleration(slide) && deceleration(roll) && (0.0..=1.0).contains(&switch);
        usable.then_some(Self { slide, roll, switch })
    }

    /// The path of a ball kicked at `at` with `velocity`: it slides first.
    pub fn kicked<F: Copy>(&self, at: Point<F>, velocity: Vector<F>) -> BallPath<F> {
        self.moving(at, velocity, self.switch * velocity.norm())
    }

    /// The path of a ball that rolls already, such as one whose kick was not observed.
    pub fn rolling<F: Copy>(&self, at: Point<F>, velocity: Vector<F>) -> BallPath<F> {
        self.moving(at, velocity, f32::INFINITY)
    }

    /// The path of a ball that slides until its speed is `switch_speed` (that share of the kick's speed),
    /// then rolls.
    ///
    /// A position that is not a number is replaced by the origin, a velocity by zero.
    pub fn moving<F: Copy>(&self, at: Point<F>, velocity: Vector<F>, switch_speed: f32) -> BallPath<F> {
        let speed = velocity.norm();
        let (along, speed) = match velocity.unit() {
            Some(along) if speed.is_finite() => (along, speed),
            _ => (Vector::new(1.0, 0.0), 0.0),
        };
        let roll_speed = speed.min(switch_speed.max(0.0));
        let (slide, roll) =
            (RollingBall { deceleration: self.slide }, RollingBall { deceleration: self.roll });
        let slide_time = (speed - roll_speed) / self.slide;
        let slide_distance = slide.rest_distance(speed) - slide.rest_distance(roll_speed);
        BallPath {
            from: if at.is_finite() { at } else { Point::default() },
            along,
            speed,
            roll_speed,
            slide,
            roll,
            slide_time,
            slide_distance,
            rest_time: slide_time + roll_speed / self.roll,
            rest_distance: slide_distance + roll.rest_distance(roll_speed),
        }
    }

    /// Speed of the kick with which the ball arrives with `arrival` m/s after `distance` m, m/s.
    pub fn kick_speed(&self, distance: f32, arrival: f32) -> f32 {
        let (d, a) = (distance.max(0.0), arrival.max(0.0));
        let c = self.switch * self.switch;
        let rolls = math::sqrt((a * a + 2.0 * self.roll * d) / (c + (1.0 - c) * self.roll / self.slide));
        if (1.0 - c) * rolls * rolls <= 2.0 * self.slide * d {
            return rolls;
        }
        // It arrives before it rolls.
        math::sqrt(a * a + 2.0 * self.slide * d)
    }
}

/// A ball's path until it stops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BallPath<F> {
    from: Point<F>,
    /// Direction, of length 1.
    along: Vector<F>,
    speed: f32,
    roll_speed: f32,
    slide: RollingBall,
    roll: RollingBall,
    slide_time: f32,
    slide_distance: f32,
    rest_time: f32,
    rest_distance: f32,
}

impl<F: Copy> BallPath<F> {
    /// Start of the path.
    pub fn from(&self) -> Point<F> {
        self.from
    }

    /// The direction it keeps, of length 1.
    pub fn along(&self) -> Vector<F> {
        self.along
    }

    /// Where the ball stops, m.
    pub fn rest(&self) -> Point<F> {
        self.from + self.along * self.rest_distance
    }

    /// Distance until it stops, m.
    pub fn rest_distance(&self) -> f32 {
        self.rest_distance
    }

    /// Distance travelled, m, and speed, m/s, after `time` seconds.
    pub fn progress(&self, time: f32) -> (f32, f32) {
        if time >= self.rest_time {
            return (self.rest_distance, 0.0);
        }
        if time >= self.slide_time {
            let left = self.rest_time - time;
            let speed = self.roll.deceleration * left;
            return (self.rest_distance - 0.5 * speed * left, speed);
        }
        let t = time.max(0.0);
        let speed = self.speed - self.slide.deceleration * t;
        (0.5 * (self.speed + speed) * t, speed)
    }

    /// When it has gone `distance` m, s; `None` where it stops before.
    pub fn time_to(&self, distance: f32) -> Option<f32> {
        if distance <= self.slide_distance {
            return self.slide.travel_time(self.speed, distance);
        }
        let rolled = self.roll.travel_time(self.roll_speed, distance - self.slide_distance)?;
        Some(self.slide_time + rolled)
    }
}

impl<F: Copy> Motion<F> for BallPath<F> {
    fn duration(&self) -> f32 {
        self.rest_time
    }

    fn at(&self, time: f32) -> State<F> {
        let (distance, speed) = self.progress(time);
        let deceleration = if time >= self.rest_time {
            0.0
        } else if time >= self.slide_time {
            self.roll.deceleration
        } else {
            self.slide.deceleration
        };
        State {
            position: self.from + self.along * distance,
            velocity: self.along * speed,
            acceleration: self.along * -deceleration,
        }
    }
}

/// Range of plausible decelerations on a field surface, m/s²: published ones lie between 0.26 (rolling) and
/// 14 (sliding, grSim).
const DECELERATION_MIN: f32 = 0.01;
const DECELERATION_MAX: f32 = 100.0;

#[cfg(test)]
mod tests;
