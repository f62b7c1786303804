//! `ball`: the ball in the body's frame of a walking robot: interacting models at rest, rolling and held. SI
//! units.
//!
//! The body's frame, carried on by the odometry: an error of the own pose does not make a resting ball move.
//! *At rest*: constant on the field. *Rolling*: slows down evenly until it stops. Both take in every sight
//! and are weighted by how well they predicted it; each starts from their mixture (interacting multiple
//! models). *Held*: known by contact. A release, or a teammate's, starts a ball that may roll. Each axis has
//! the same variance.

use geometry::{Angle, Body, Point, Twist, Vector, math};
use motion::legged::HOLD_DISTANCE;

use super::model;

/// Estimate of the ball.
#[derive(Clone, Copy, Debug)]
pub struct BallFilter {
    rest: Rest,
    roll: Roll,
    /// Probability that it is at rest.
    at_rest: f32,
    /// m/s².
    deceleration: f32,
}

/// A ball at rest.
#[derive(Clone, Copy, Debug)]
struct Rest {
    place: Vector<Body>,
    variance: f32,
}

/// A rolling ball: place and velocity with the covariance of each axis.
#[derive(Clone, Copy, Debug)]
struct Roll {
    place: Vector<Body>,
    velocity: Vector<Body>,
    pp: f32,
    pv: f32,
    vv: f32,
}

impl BallFilter {
    /// A ball seen for the first time, with the variance of that sight.
    pub fn seen(at: Point<Body>, variance: f32, deceleration: f32) -> Self {
        let place = Vector::new(at.x(), at.y());
        let roll = Roll { place, velocity: Vector::default(), pp: variance, pv: 0.0, vv: KICKED };
        Self { rest: Rest { place, variance }, roll, at_rest: 0.5, deceleration }
    }

    /// A ball between the legs.
    pub fn held(deceleration: f32) -> Self {
        let at = Point::new(HOLD_DISTANCE, 0.0);
        Self { at_rest: 1.0, ..Self::seen(at, HELD_BALL_VARIANCE, deceleration) }
    }

    /// A kick, a release or a push is known: it may roll now.
    pub fn released(&mut self) {
        self.mix(1.0 - ROLLS_WHEN_RELEASED, 0.0);
        self.at_rest = self.at_rest.min(1.0 - ROLLS_WHEN_RELEASED);
        self.roll.vv = self.roll.vv.max(KICKED);
    }

    /// Its place in the body's frame.
    pub fn place(&self) -> Point<Body> {
        let place = self.rest.place * self.at_rest + self.roll.place * (1.0 - self.at_rest);
        Point::new(place.x(), place.y())
    }

    /// Its velocity over the field, in the body's axes: none while it is more likely at rest.
    pub fn velocity(&self) -> Vector<Body> {
        if self.at_rest > 0.5 { Vector::default() } else { self.roll.velocity }
    }

    /// Variance of its place, a coordinate, m².
    pub fn variance(&self) -> f32 {
        let (rest, roll) = (self.at_rest, 1.0 - self.at_rest);
        let between = self.rest.place - self.roll.place;
        rest * self.rest.variance + roll * self.roll.pp + 0.5 * rest * roll * between.dot(between)
    }

    /// Probability that it is at rest.
    pub fn at_rest(&self) -> f32 {
        self.at_rest
    }

    /// Carries on over `dt` s in which the body moved by its odometry.
    pub fn predict(&mut self, odometry: Twist<Body>, dt: f32) {
        let stops = if self.roll.velocity.norm() < SLOW_BALL_SPEED { STOP_RATE_SLOW } else { STOP_RATE };
        self.mix(1.0 - STARTS * dt, stops * dt);
        let turn = Angle::new(-odometry.angular * dt);
        let carried = |place: Vector<Body>| (place - odometry.linear * dt).rotated(turn);
        let range = self.rest.place.norm();
        let (walked, turned) = (odometry.linear.dot(odometry.linear), odometry.angular * range);
        let unknown = (model::MOTION * (walked + 0.5 * turned * turned)
            + model::PUSHED
            + 0.5 * model::TURNED * range * range)
            * dt;
        self.rest.place = carried(self.rest.place);
        self.rest.variance += unknown;
        let roll = &mut self.roll;
        let speed = roll.velocity.norm();
        let lost = (self.deceleration * dt).min(speed);
        let share = if speed > 0.0 { 1.0 - lost / speed } else { 0.0 };
        // The mean velocity of the step.
        roll.place = carried(roll.place + roll.velocity * (0.5 * (1.0 + share) * dt));
        roll.velocity = (roll.velocity * share).rotated(turn);
        roll.pp += dt * (2.0 * roll.pv + dt * roll.vv) + unknown;
        roll.pv += dt * roll.vv;
        roll.vv += ROLLING * dt;
    }

    /// Takes in a sight; `variance` is that of the sight, `lasting` what of it many sights in a row share.
    pub fn see(&mut self, at: Point<Body>, variance: f32, lasting: f32) {
        let at = Vector::<Body>::new(at.x(), at.y());
        let (at_rest, rolling) = (at - self.rest.place, at - self.roll.place);
        let (s_rest, s_roll) = (self.rest.variance + variance, self.roll.pp + variance);
        // Ratio of the likelihoods: rolling to resting; two equal axes each.
        let exponent = 0.5 * (at_rest.dot(at_rest) / s_rest - rolling.dot(rolling) / s_roll);
        let ratio = s_rest / s_roll * math::exp(exponent.clamp(-EXPONENT, EXPONENT));
        let odds = (1.0 - self.at_rest) * ratio;
        self.at_rest = (self.at_rest / (self.at_rest + odds)).clamp(PROBABILITY_MIN, 1.0 - PROBABILITY_MIN);
        // Errors that last over sights do not average out: as if each sight were so much worse.
        let gain = self.rest.variance / (self.rest.variance + variance + lasting);
        self.rest.place += at_rest * gain;
        self.rest.variance *= 1.0 - gain;
        let roll = &mut self.roll;
        let (gain, gain_v) = (roll.pp / s_roll, roll.pv / s_roll);
        roll.place += rolling * gain;
        roll.velocity += rolling * gain_v;
        roll.vv -= gain_v * roll.pv;
        roll.pv *= 1.0 - gain;
        roll.pp *= 1.0 - gain;
    }

    /// Each model starts from the mixture of both: `stays` is the probability that a resting ball stays,
    /// `stops` that a rolling one stops.
    fn mix(&mut self, stays: f32, stops: f32) {
        let (rest, roll) = (self.at_rest, 1.0 - self.at_rest);
        let (to_rest, to_roll) = (rest * stays + roll * stops, rest * (1.0 - stays) + roll * (1.0 - stops));
        let from_roll = roll * stops / to_rest.max(PROBABILITY_MIN);
        let from_rest = rest * (1.0 - stays) / to_roll.max(PROBABILITY_MIN);
        let off = self.roll.place - self.rest.place;
        let (apart, velocity) = (0.5 * off.dot(off), self.roll.velocity);
        let (resting, rolling) = (self.rest, self.roll);
        self.rest.place += off * from_roll;
        self.rest.variance =
            blend(resting.variance, rolling.pp, from_roll) + from_roll * (1.0 - from_roll) * apart;
        let spread = from_rest * (1.0 - from_rest);
        self.roll.place += off * -from_rest;
        self.roll.velocity = velocity * (1.0 - from_rest);
        self.roll.pp = blend(rolling.pp, resting.variance, from_rest) + spread * apart;
        self.roll.pv = rolling.pv * (1.0 - from_rest) + 0.5 * spread * off.dot(velocity);
        let speed = 0.5 * velocity.dot(velocity);
        self.roll.vv = blend(rolling.vv, KICKED, from_rest) + spread * speed;
        self.at_rest = to_rest;
    }
}

fn blend(one: f32, other: f32, share: f32) -> f32 {
    one + (other - one) * share
}

/// Variance of a held ball's place, m²: 1 cm.
const HELD_BALL_VARIANCE: f32 = 1e-4;
/// Variance of an axis of the velocity of a ball that was just kicked, m²/s²: 0.7 m/s, a kick of 0.8 m; the
/// hardest leaves with 1.2 m/s.
const KICKED: f32 = 0.5;
/// Probability that a ball rolls that has left the legs.
const ROLLS_WHEN_RELEASED: f32 = 0.8;
/// A resting ball starts to roll, 1/s: once in 5 s a robot kicks it.
const STARTS: f32 = 0.2;
/// A rolling ball stops at once, 1/s: in a robot's legs.
const STOP_RATE: f32 = 0.3;
/// The same below [`SLOW_BALL_SPEED`], 1/s.
const STOP_RATE_SLOW: f32 = 4.0;
/// A ball that slow stops within a third of a second, m/s.
const SLOW_BALL_SPEED: f32 = 0.12;
/// Variance of an axis of the velocity that a rolling ball gains, m²/s³: the field surface's unevenness, 0.1
/// m/s in a second; an estimate.
const ROLLING: f32 = 0.01;
/// No model is ever excluded.
const PROBABILITY_MIN: f32 = 1e-3;
/// Bound of the exponent of a ratio of likelihoods.
const EXPONENT: f32 = 30.0;

#[cfg(test)]
mod tests;
