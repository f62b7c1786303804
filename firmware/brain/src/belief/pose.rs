//! `pose`: own pose of a walking robot: extended Kalman filter on odometry and landmark sights. SI units,
//! field frame.
//!
//! State: x, y, heading, and the sway of the camera in standard deviations, as all bearings of a frame share
//! it over several frames. A sight outside of its gate corrects nothing; when sights are rejected again and
//! again, the pose that two landmarks give together becomes a hypothesis, and one that several pairs support
//! replaces the estimate: a robot that was pushed away or picked up.

use geometry::{Angle, Body, Field, Point, Pose, Twist, Vector, math};
use protocol::robot_io::LandmarkSight;
use rules::LANDMARKS;

use super::model;

/// Number of states: x, y, heading, sway.
const N: usize = 4;

/// Estimate of the own pose.
#[derive(Clone, Debug)]
pub struct PoseFilter {
    pose: Pose<Field>,
    /// Sway in standard deviations of the present gait.
    sway: f32,
    covariance: [[f32; N]; N],
    /// Standard deviation of the sway in this frame, rad.
    amplitude: f32,
    /// Rejected sights, less accepted ones.
    doubts: u8,
    /// The last landmark seen, where it is now in the body's frame.
    last: Option<(usize, Point<Body>)>,
    hypotheses: [Hypothesis; HYPOTHESES],
}

/// A pose from pairs of landmarks, and the number of pairs.
#[derive(Clone, Copy, Debug, Default)]
struct Hypothesis {
    pose: Pose<Field>,
    support: u8,
}

impl Default for PoseFilter {
    /// Nothing known: anywhere on the field.
    fn default() -> Self {
        Self::at(Pose::default(), ANYWHERE, math::PI)
    }
}

impl PoseFilter {
    /// A robot at `pose`, with standard deviations of its place (m) and heading (rad).
    pub fn at(pose: Pose<Field>, place: f32, heading: f32) -> Self {
        let mut covariance = [[0.0; N]; N];
        for (i, sigma) in [place, place, heading, 1.0].into_iter().enumerate() {
            covariance[i][i] = sigma * sigma;
        }
        let hypotheses = [Hypothesis::default(); HYPOTHESES];
        Self { pose, sway: 0.0, covariance, amplitude: model::JOINT, doubts: 0, last: None, hypotheses }
    }

    /// The estimate.
    pub fn pose(&self) -> Pose<Field> {
        self.pose
    }

    /// Covariance of x, y, heading and sway.
    pub fn covariance(&self) -> &[[f32; N]; N] {
        &self.covariance
    }

    /// Variance of the place, m²: the mean of both axes.
    pub fn place_variance(&self) -> f32 {
        0.5 * (self.covariance[0][0] + self.covariance[1][1])
    }

    /// Variance of the heading, rad².
    pub fn heading_variance(&self) -> f32 {
        self.covariance[2][2]
    }

    /// Estimated error of every bearing of this frame, and its variance, rad and rad².
    pub fn bearing_error(&self) -> (f32, f32) {
        (self.amplitude * self.sway, self.amplitude * self.amplitude * self.covariance[3][3])
    }

    /// Moves by the odometry over `dt` s.
    pub fn predict(&mut self, odometry: Twist<Body>, dt: f32) {
        let moved = self.pose.vector_to_field(odometry.linear) * dt;
        let turned = odometry.angular * dt;
        self.pose.position += moved;
        self.pose.heading = self.pose.heading + Angle::new(turned);
        let walks = odometry.linear.norm() > model::STANDSTILL_SPEED
            || odometry.angular.abs() > model::STANDSTILL_SPEED;
        self.amplitude = model::JOINT + if walks { model::SWAY } else { 0.0 };
        let keep = math::exp(-dt / model::SWAY_TIME);
        self.sway *= keep;
        let p = &mut self.covariance;
        // F = 1 but for the heading's effect on the place, and the sway's decay: P ← F P Fᵀ.
        let jacobian = [-moved.y(), moved.x()];
        let turning = p[2];
        for (row, share) in p.iter_mut().zip(jacobian) {
            row.iter_mut().zip(turning).for_each(|(cell, by)| *cell += share * by);
        }
        p[3].iter_mut().for_each(|cell| *cell *= keep);
        for row in p.iter_mut() {
            for (column, share) in jacobian.into_iter().enumerate() {
                row[column] += share * row[2];
            }
            row[3] *= keep;
        }
        let speed = odometry.linear.dot(odometry.linear);
        let place = (model::MOTION * speed + model::PUSHED) * dt;
        p[0][0] += place;
        p[1][1] += place;
        p[2][2] += (model::MOTION * odometry.angular * odometry.angular + model::TURNED) * dt;
        p[3][3] += 1.0 - keep * keep;
        let carried = |point: Point<Body>| {
            let left = Vector::<Body>::new(point.x(), point.y()) - odometry.linear * dt;
            let turned = left.rotated(Angle::new(-turned));
            Point::new(turned.x(), turned.y())
        };
        self.last = self.last.map(|(landmark, at)| (landmark, carried(at)));
        if self.doubts > 0 {
            for hypothesis in &mut self.hypotheses {
                let pose = &mut hypothesis.pose;
                pose.position += pose.vector_to_field(odometry.linear) * dt;
                pose.heading = pose.heading + Angle::new(turned);
            }
        }
    }

    /// Takes in a landmark's sight.
    pub fn see(&mut self, seen: LandmarkSight) {
        let index = usize::from(seen.landmark);
        let Some(&landmark) = LANDMARKS.get(index) else { return };
        let (range, bearing) = (seen.sight.range(), seen.sight.bearing());
        let accepted = self.correct(index, landmark, range, bearing);
        self.doubts =
            if accepted { self.doubts.saturating_sub(1) } else { (self.doubts + 1).min(DOUBTS_MOST) };
        let at = Vector::<Body>::polar(range, bearing);
        let at = Point::new(at.x(), at.y());
        if let Some((other, before)) = self.last.replace((index, at)).filter(|(other, _)| *other != index)
            && self.doubts > 0
            && let Some(&other) = LANDMARKS.get(other)
        {
            self.suppose((landmark, at), (other, before));
        }
    }

    /// Corrects by range and bearing; whether both were within their gates.
    fn correct(&mut self, index: usize, landmark: Point<Field>, range: f32, bearing: Angle) -> bool {
        let to = landmark - self.pose.position;
        let distance = to.norm().max(NEAREST);
        let size = if index < model::MARKERS { model::MARKER_SIZE } else { model::GOAL_SIZE };
        let by_range = [-to.x() / distance, -to.y() / distance, 0.0, 0.0];
        let innovation = range - distance;
        if !self.update(by_range, innovation, model::range_variance(distance, size)) {
            return false;
        }
        let to = landmark - self.pose.position;
        let squared = to.dot(to).max(NEAREST * NEAREST);
        let by_bearing = [to.y() / squared, -to.x() / squared, -1.0, self.amplitude];
        let expected = self.pose.turn_to(landmark) + Angle::new(self.amplitude * self.sway);
        self.update(by_bearing, (bearing - expected).radians(), model::PIXEL * model::PIXEL)
    }

    /// One scalar measurement of Jacobian `h`, innovation and variance; `false` if it is outside of the gate.
    fn update(&mut self, h: [f32; N], innovation: f32, variance: f32) -> bool {
        let p = &mut self.covariance;
        let ph: [f32; N] =
            core::array::from_fn(|i| p[i][0] * h[0] + p[i][1] * h[1] + p[i][2] * h[2] + p[i][3] * h[3]);
        let s = ph[0] * h[0] + ph[1] * h[1] + ph[2] * h[2] + ph[3] * h[3] + variance;
        if innovation.is_nan() || innovation * innovation >= GATE * s {
            return false;
        }
        let gain = 1.0 / s;
        let step = gain * innovation;
        self.pose.position += Vector::new(ph[0] * step, ph[1] * step);
        self.pose.heading = self.pose.heading + Angle::new(ph[2] * step);
        self.sway += ph[3] * step;
        for row in 0..N {
            for column in 0..=row {
                p[row][column] -= ph[row] * ph[column] * gain;
                p[column][row] = p[row][column];
            }
        }
        // Rounding must not make a variance negative.
        for (i, least) in VARIANCE_MIN.into_iter().enumerate() {
            p[i][i] = p[i][i].max(least);
        }
        true
    }

    /// A hypothesis from two landmarks seen at their places in the body's frame; resets to a supported one.
    fn suppose(&mut self, one: (Point<Field>, Point<Body>), other: (Point<Field>, Point<Body>)) {
        let (field, body) = (other.0 - one.0, other.1 - one.1);
        if (field.norm() - body.norm()).abs() > PAIR_WITHIN {
            return;
        }
        let heading = field.angle() - body.angle();
        let middle = Point::<Body>::new(0.5 * (one.1.x() + other.1.x()), 0.5 * (one.1.y() + other.1.y()));
        let place = one.0 + field * 0.5;
        let origin = Pose { position: Point::default(), heading };
        let pose = Pose { position: place - (origin.to_field(middle) - Point::default()), heading };
        let near = |known: &Hypothesis| {
            known.support > 0
                && known.pose.position.distance(pose.position) < SAME_PLACE
                && (known.pose.heading - pose.heading).abs() < SAME_HEADING
        };
        let supported = if let Some(known) = self.hypotheses.iter_mut().find(|known| near(known)) {
            known.support = known.support.saturating_add(1);
            known.pose.position += (pose.position - known.pose.position) * 0.5;
            let turned = 0.5 * (pose.heading - known.pose.heading).radians();
            known.pose.heading = known.pose.heading + Angle::new(turned);
            *known
        } else {
            let known = Hypothesis { pose, support: 1 };
            if let Some(weakest) = self.hypotheses.iter_mut().min_by_key(|known| known.support) {
                *weakest = known;
            }
            known
        };
        if supported.support >= SUPPORT && self.doubts >= DOUBTS {
            *self = Self::at(supported.pose, SAME_PLACE, SAME_HEADING);
        }
    }
}

/// Largest squared innovation in variances: 4 standard deviations, one good sight in 16,000 is rejected.
const GATE: f32 = 16.0;
/// Hypotheses kept.
const HYPOTHESES: usize = 4;
/// Pairs that must support a hypothesis.
const SUPPORT: u8 = 3;
/// Rejected sights, less accepted ones, from which the estimate may be replaced.
const DOUBTS: u8 = 4;
/// And at most counted.
const DOUBTS_MOST: u8 = 12;
/// A pair's distance may be wrong by this, m: three standard deviations of two ranges at 2.5 m.
const PAIR_WITHIN: f32 = 0.5;
/// Hypotheses this near are one, m: also the standard deviation after a reset.
const SAME_PLACE: f32 = 0.4;
/// And rad.
const SAME_HEADING: f32 = 0.35;
/// Standard deviation of an unknown place, m: half the field's length.
const ANYWHERE: f32 = 2.7;
/// A landmark is no nearer, m: a body's radius beside its own.
const NEAREST: f32 = 0.15;
/// Least variances: (1 mm)², (0.06°)², (1 %)².
const VARIANCE_MIN: [f32; N] = [1e-6, 1e-6, 1e-6, 1e-4];

#[cfg(test)]
mod tests;
