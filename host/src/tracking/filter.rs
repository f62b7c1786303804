//! `filter`: Kalman filters of position and velocity: one for a point of the plane, one for a heading. m,
//! m/s, rad, rad/s, s.
//!
//! Both have two models of motion: steady, and changing. While detections scatter around the prediction the
//! filter smooths; when several in a row lie on one side of it, the body has changed its motion and the
//! filter follows quickly.

use geometry::{Angle, Field, Point, Vector, math};

/// Weight of the newest innovation in the average: about the last three count.
const LAG_SHARE: f32 = 0.3;
/// Squared averages below this are noise: white innovations give 2 · 0.3 / (2 − 0.3) = 0.35 in the mean.
const LAG_STEADY: f32 = 1.2;
/// Squared averages above this are certainly a change (probability exp(−4 / 0.35) by noise).
const LAG_CHANGING: f32 = 4.0;
/// Least variance of a speed, against rounding: (1 mm/s)², in (m/s)².
const SPEED_VARIANCE_MIN: f32 = 1e-6;

/// Process noise of a velocity: white acceleration of this density, m²/s³ (or rad²/s³).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Freedom {
    /// Density while predictions fit.
    pub(super) steady: f32,
    /// Density when predictions lag behind.
    pub(super) changing: f32,
}

impl Freedom {
    fn at(self, lag: f32) -> f32 {
        let share = ((lag - LAG_STEADY) * (1.0 / (LAG_CHANGING - LAG_STEADY))).clamp(0.0, 1.0);
        self.steady + (self.changing - self.steady) * share
    }
}

/// Covariance of position and velocity of one axis.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Spread {
    place: f32,
    both: f32,
    speed: f32,
}

impl Spread {
    fn new(place: f32, speed: f32) -> Self {
        Self { place, both: 0.0, speed }
    }

    fn pass(&mut self, dt: f32, density: f32) {
        self.place += dt * (2.0 * self.both + dt * self.speed) + density * dt * dt * dt * (1.0 / 3.0);
        self.both += dt * self.speed + 0.5 * density * dt * dt;
        self.speed += density * dt;
    }

    /// Takes a measurement of that variance; returns the shares of the innovation for position and velocity.
    fn measure(&mut self, variance: f32) -> (f32, f32) {
        let inverse = 1.0 / (self.place + variance);
        let (k_place, k_speed) = (self.place * inverse, self.both * inverse);
        self.speed = (self.speed - k_speed * self.both).max(SPEED_VARIANCE_MIN);
        self.place = variance * k_place;
        self.both = variance * k_speed;
        (k_place, k_speed)
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Plane {
    /// Estimated place, m.
    pub(super) position: Point<Field>,
    /// Estimated velocity, m/s.
    pub(super) velocity: Vector<Field>,
    spread: Spread,
    /// Innovations in units of their deviation, averaged over the last few.
    lag: Vector<Field>,
}

impl Plane {
    /// First detected there; standard deviation of its speed `speed_sigma`, m/s.
    pub(super) fn new(position: Point<Field>, sigma: f32, speed_sigma: f32) -> Self {
        let spread = Spread::new(sigma * sigma, speed_sigma * speed_sigma);
        Self { position, velocity: Vector::default(), spread, lag: Vector::default() }
    }

    /// The same place with another velocity of standard deviation `speed_sigma`, m/s.
    pub(super) fn sent_off(
        position: Point<Field>,
        velocity: Vector<Field>,
        sigma: f32,
        speed_sigma: f32,
    ) -> Self {
        Self { velocity, ..Self::new(position, sigma, speed_sigma) }
    }

    /// Predicts over `dt`, straight on.
    pub(super) fn pass(&mut self, dt: f32, freedom: Freedom) {
        self.position += self.velocity * dt;
        self.pass_as(dt, self.position, self.velocity, freedom);
    }

    /// Predicts over a step with a motion that the caller computed.
    pub(super) fn pass_as(
        &mut self,
        dt: f32,
        position: Point<Field>,
        velocity: Vector<Field>,
        freedom: Freedom,
    ) {
        (self.position, self.velocity) = (position, velocity);
        self.spread.pass(dt, freedom.at(self.lag.dot(self.lag)));
    }

    /// Distance of a detection from the prediction, and that distance squared in units of its variance.
    pub(super) fn surprise(&self, seen: Point<Field>, sigma: f32) -> (Vector<Field>, f32) {
        let off = seen - self.position;
        (off, off.dot(off) / (self.spread.place + sigma * sigma))
    }

    /// Corrects the estimate by a detection.
    pub(super) fn see(&mut self, seen: Point<Field>, sigma: f32) {
        let off = seen - self.position;
        let deviation = math::sqrt(self.spread.place + sigma * sigma);
        self.lag = self.lag * (1.0 - LAG_SHARE) + off * (LAG_SHARE / deviation);
        let (k_place, k_speed) = self.spread.measure(sigma * sigma);
        self.position += off * k_place;
        self.velocity += off * k_speed;
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Turning {
    pub(super) heading: Angle,
    /// Angular velocity, rad/s, counter-clockwise.
    pub(super) rate: f32,
    spread: Spread,
    lag: f32,
}

impl Turning {
    /// First detected with that heading; standard deviation of its rate `rate_sigma`, rad/s.
    pub(super) fn new(heading: Angle, sigma: f32, rate_sigma: f32) -> Self {
        Self { heading, rate: 0.0, spread: Spread::new(sigma * sigma, rate_sigma * rate_sigma), lag: 0.0 }
    }

    /// Predicts over a time of `dt` s.
    pub(super) fn pass(&mut self, dt: f32, freedom: Freedom) {
        self.heading = self.heading + Angle::new(self.rate * dt);
        self.spread.pass(dt, freedom.at(self.lag * self.lag));
    }

    /// Takes a detection, by the smaller angle.
    pub(super) fn see(&mut self, seen: Angle, sigma: f32) {
        let off = (seen - self.heading).radians();
        let deviation = math::sqrt(self.spread.place + sigma * sigma);
        self.lag = self.lag * (1.0 - LAG_SHARE) + off * (LAG_SHARE / deviation);
        let (k_place, k_speed) = self.spread.measure(sigma * sigma);
        self.heading = self.heading + Angle::new(off * k_place);
        self.rate += off * k_speed;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FREEDOM: Freedom = Freedom { steady: 0.1, changing: 10.0 };

    #[test]
    fn two_exact_glimpses_of_a_free_point_give_its_velocity() {
        let mut plane = Plane::new(Point::new(1.0, 1.0), 1e-4, 10.0);
        plane.pass(0.1, FREEDOM);
        plane.see(Point::new(1.2, 0.9), 1e-4);
        assert!((plane.velocity - Vector::new(2.0, -1.0)).norm() < 1e-3, "{plane:?}");
    }

    #[test]
    fn a_heading_turns_over_the_seam_without_swinging_round() {
        let mut turning = Turning::new(Angle::degrees(170.0), 0.01, 10.0);
        for step in 1..=20 {
            turning.pass(0.01, Freedom { steady: 1.0, changing: 100.0 });
            turning.see(Angle::degrees(170.0 + step as f32 * 2.0), 0.01);
        }
        assert!((turning.rate.to_degrees() - 200.0).abs() < 5.0, "{turning:?}");
        assert!((turning.heading - Angle::degrees(-150.0)).abs() < 0.01);
    }

    #[test]
    fn a_point_that_speeds_up_is_followed_more_freely_than_one_that_does_not() {
        let glimpses = |acceleration: f32| {
            let mut plane = Plane::new(Point::default(), 0.003, 3.0);
            for step in 1..=60 {
                let t = step as f32 / 60.0;
                plane.pass(1.0 / 60.0, FREEDOM);
                plane.see(Point::new(0.5 * acceleration * t * t, 0.0), 0.003);
            }
            (plane.velocity.x() - acceleration).abs()
        };
        assert!(glimpses(0.0) < 1e-4);
        assert!(glimpses(3.0) < 0.15, "lag {} m/s at 3 m/s²", glimpses(3.0));
    }
}
