//! `omni`: kinematics of three or four omnidirectional wheels; body frame, m/s at the rim, rad/s.
//!
//! Order as on the league's wire: front right, back right, back left, front left. A wheel stands at the angle
//! α from the robot's heading, counter-clockwise, at the distance R from its centre, and drives along its
//! tangent: its rim runs at −sin α · v_x + cos α · v_y + R · ω. One whose drive is turned by β from the
//! tangent is as a tangential one at α + β with the lever R · cos β. Positive rims turn the robot
//! counter-clockwise.

use geometry::{Angle, Body, Twist, Vector};
use rules::{RobotSpec, WheelSpec};

/// Rim speeds in the order of the wire, m/s.
pub type Rims = [f32; 4];

/// Arrangement of the wheels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wheels {
    /// Angles from the robot's heading, counter-clockwise, in the order of the wire.
    pub angles: [Angle; 4],
    /// Rim speed of each for a turn of 1 rad/s, m/s: a tangential wheel's distance from the centre, m.
    pub levers: [f32; 4],
    /// Whether there is such a wheel, and it drives.
    pub driven: [bool; 4],
}

impl Wheels {
    /// The wheels of this robot.
    pub fn of(spec: &WheelSpec) -> Self {
        let driven = core::array::from_fn(|wheel| wheel < usize::from(spec.count));
        Self { angles: spec.degrees.map(Angle::degrees), levers: spec.levers, driven }
    }
}

impl Default for Wheels {
    /// Our robots' (`RobotSpec::OURS.wheels`).
    fn default() -> Self {
        Self::of(&RobotSpec::OURS.wheels)
    }
}

/// Error of a wheel arrangement that cannot drive a robot in every direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WheelsError;

impl core::fmt::Display for WheelsError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(
            "the wheels do not drive in every direction; give them angles that differ, and distances > 0",
        )
    }
}

impl core::error::Error for WheelsError {}

/// The kinematics of a set of wheels, solved once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Omni {
    /// Rim speed of a wheel for v_x, v_y and ω of 1.
    rows: [[f32; 3]; 4],
    /// v_x, v_y and ω for a rim speed of 1 of each wheel: the least squares' inverse.
    inverse: [[f32; 4]; 3],
}

impl Default for Omni {
    fn default() -> Self {
        Self::new(&Wheels::default()).unwrap_or(Self { rows: [[0.0; 3]; 4], inverse: [[0.0; 4]; 3] })
    }
}

impl Omni {
    /// Kinematics of these wheels.
    pub fn new(wheels: &Wheels) -> Result<Self, WheelsError> {
        let mut rows = [[0.0; 3]; 4];
        for (((row, angle), lever), driven) in
            rows.iter_mut().zip(wheels.angles).zip(wheels.levers).zip(wheels.driven)
        {
            if driven {
                let (s, c) = angle.sin_cos();
                *row = [-s, c, lever];
            }
        }
        // Normal equations: (JᵀJ)⁻¹ Jᵀ, three by three, by cofactors.
        let mut m = [[0.0_f32; 3]; 3];
        for row in &rows {
            for (line, a) in m.iter_mut().zip(row) {
                for (cell, b) in line.iter_mut().zip(row) {
                    *cell += a * b;
                }
            }
        }
        let [[a, b, c], [_, d, e], [_, _, f]] = m;
        let cofactors = [
            [d * f - e * e, c * e - b * f, b * e - c * d],
            [c * e - b * f, a * f - c * c, b * c - a * e],
            [b * e - c * d, b * c - a * e, a * d - b * b],
        ];
        let [[first, second, third], ..] = cofactors;
        let determinant = a * first + b * second + c * third;
        // Against the product of the diagonal, which it equals where the three motions do not mix.
        let regular = determinant > SINGULAR * a * d * f;
        if !regular {
            return Err(WheelsError);
        }
        let per_determinant = 1.0 / determinant;
        let inverse =
            cofactors.map(|[x, y, z]| rows.map(|[p, q, r]| (x * p + y * q + z * r) * per_determinant));
        Ok(Self { rows, inverse })
    }

    /// The rim speeds that move the body like this.
    pub fn rims(&self, twist: Twist<Body>) -> Rims {
        let Twist { linear, angular } = twist;
        self.rows.map(|[x, y, turn]| x * linear.x() + y * linear.y() + turn * angular)
    }

    /// Motion of the body at these rim speeds: least-squares fit.
    pub fn twist(&self, rims: Rims) -> Twist<Body> {
        let [x, y, angular] = self.inverse.map(|row| {
            let [a, b, c, d] = row;
            let [p, q, r, s] = rims;
            a * p + b * q + c * r + d * s
        });
        Twist { linear: Vector::new(x, y), angular }
    }

    /// Force ahead and to the left, and torque, of wheels that each push with this force along their roll.
    pub fn forces(&self, pushes: Rims) -> [f32; 3] {
        let mut sum = [0.0; 3];
        for (row, push) in self.rows.iter().zip(pushes) {
            for (sum, part) in sum.iter_mut().zip(row) {
                *sum += part * push;
            }
        }
        sum
    }

    /// The fastest wheel's part in these rim speeds that no motion of the body explains: above some cm/s a
    /// wheel slips, m/s.
    pub fn slip(&self, rims: Rims) -> f32 {
        let explained = self.rims(self.twist(rims));
        rims.iter().zip(explained).map(|(rim, explained)| (rim - explained).abs()).fold(0.0, f32::max)
    }

    /// The motion, slowed as a whole until no rim is faster than `rim_max` m/s: direction and curve stay.
    /// Also returns the factor, 1 where no slowing was needed.
    pub fn saturated(&self, twist: Twist<Body>, rim_max: f32) -> (Twist<Body>, f32) {
        let fastest = self.rims(twist).into_iter().map(f32::abs).fold(0.0, f32::max);
        if fastest <= rim_max || fastest.is_nan() {
            return (twist, 1.0);
        }
        let factor = rim_max.max(0.0) / fastest;
        (Twist { linear: twist.linear * factor, angular: twist.angular * factor }, factor)
    }

    /// Largest speed of the body in this direction while it turns with `angular` rad/s and no rim exceeds
    /// `rim_max`, m/s; 0 where turning alone takes more.
    pub fn speed_limit(&self, direction: Angle, angular: f32, rim_max: f32) -> f32 {
        let (s, c) = direction.sin_cos();
        let mut limit = f32::INFINITY;
        for [x, y, turn] in self.rows {
            let (along, turning) = (x * c + y * s, turn * angular);
            // |v·along + turning| ≤ rim_max, v ≥ 0.
            let room = if along > 0.0 { rim_max - turning } else { rim_max + turning };
            if rim_max < turning.abs() {
                return 0.0;
            }
            if along.abs() > ALONG_MIN {
                limit = limit.min(room / along.abs());
            }
        }
        limit
    }
}

/// Share of the diagonal's product below which the determinant is only rounding.
const SINGULAR: f32 = 1e-4;
/// A wheel across the direction does not limit it.
const ALONG_MIN: f32 = 1e-4;

#[cfg(test)]
mod tests {
    use super::*;

    fn twist(x: f32, y: f32, angular: f32) -> Twist<Body> {
        Twist { linear: Vector::new(x, y), angular }
    }

    #[test]
    fn straight_ahead_the_right_wheels_turn_one_way_and_the_left_ones_the_other() {
        let [front_right, back_right, back_left, front_left] = Omni::default().rims(twist(1.0, 0.0, 0.0));
        // sin 60° and sin 45°.
        assert!(
            (front_right - 0.866_025).abs() < 1e-5
                && (back_right - core::f32::consts::FRAC_1_SQRT_2).abs() < 1e-5
        );
        assert!(
            (front_left + 0.866_025).abs() < 1e-5
                && (back_left + core::f32::consts::FRAC_1_SQRT_2).abs() < 1e-5
        );
    }

    #[test]
    fn turning_left_runs_every_rim_at_omega_r() {
        for rim in Omni::default().rims(twist(0.0, 0.0, 2.0)) {
            assert!((rim - 0.162).abs() < 1e-6);
        }
    }

    #[test]
    fn rims_and_twist_are_inverse_and_do_not_slip() {
        let omni = Omni::default();
        for (x, y, turn) in [(1.0, 0.0, 0.0), (0.3, -2.0, 5.0), (-1.5, 0.7, -3.0)] {
            let wanted = twist(x, y, turn);
            let rims = omni.rims(wanted);
            let got = omni.twist(rims);
            assert!((got.linear - wanted.linear).norm() < 1e-5 && (got.angular - turn).abs() < 1e-4);
            assert!(omni.slip(rims) < 1e-5);
        }
    }

    #[test]
    fn the_twist_of_arbitrary_rims_leaves_the_least_squares() {
        // No small change of the answer fits better: the definition, checked in all six directions.
        let omni = Omni::default();
        let rims = [1.0, -0.4, 0.2, 0.9];
        let error =
            |t: Twist<Body>| omni.rims(t).iter().zip(rims).map(|(a, b)| (a - b) * (a - b)).sum::<f32>();
        let best = omni.twist(rims);
        for (dx, dy, turn) in [(0.01, 0.0, 0.0), (0.0, 0.01, 0.0), (0.0, 0.0, 0.1)] {
            for sign in [-1.0, 1.0] {
                let off = twist(
                    best.linear.x() + sign * dx,
                    best.linear.y() + sign * dy,
                    best.angular + sign * turn,
                );
                assert!(error(off) > error(best));
            }
        }
        assert!(omni.slip(rims) > 0.05);
    }

    #[test]
    fn three_wheels_and_skewed_ones_drive_as_their_contact_points_move() {
        // Place, distance, skew; the fourth wheel of the last is missing.
        let robots = [
            ([[-60.0, 0.08, 15.0], [-135.0, 0.07, -20.0], [135.0, 0.07, 20.0], [60.0, 0.08, -15.0]], 4),
            ([[-60.0, 0.08, 0.0], [180.0, 0.06, 30.0], [60.0, 0.08, 0.0], [0.0; 3]], 3),
        ];
        for (wheels, count) in robots {
            let lever = |[_, distance, skew]: [f32; 3]| distance * Angle::degrees(skew).sin_cos().1;
            let degrees = wheels.map(|[place, _, skew]| place + skew);
            let spec = WheelSpec { count, degrees, levers: wheels.map(lever), ..RobotSpec::OURS.wheels };
            let omni = Omni::new(&Wheels::of(&spec)).unwrap();
            let moved = twist(0.7, -1.1, 3.0);
            let rims = omni.rims(moved);
            for (wheel, rim) in wheels.iter().zip(rims).take(usize::from(count)) {
                let [place, distance, skew] = *wheel;
                let arm: Vector<Body> = Vector::polar(distance, Angle::degrees(place));
                let point = moved.linear + Vector::new(-arm.y(), arm.x()) * moved.angular;
                let drive: Vector<Body> = Vector::polar(1.0, Angle::degrees(place + 90.0 + skew));
                assert!((point.dot(drive) - rim).abs() < 1e-5, "{wheel:?}: {rim}");
            }
            let back = omni.twist(rims);
            assert!((back.linear - moved.linear).norm() < 1e-5 && (back.angular - 3.0).abs() < 1e-4);
            assert_eq!(rims[3] == 0.0, count == 3);
        }
    }

    #[test]
    fn saturation_keeps_the_direction_and_the_curve() {
        let omni = Omni::default();
        let wanted = twist(3.0, 4.0, 10.0);
        let (slowed, factor) = omni.saturated(wanted, 2.0);
        let fastest = omni.rims(slowed).into_iter().map(f32::abs).fold(0.0, f32::max);
        assert!((fastest - 2.0).abs() < 1e-5 && factor < 1.0);
        assert!(slowed.linear.cross(wanted.linear).abs() < 1e-4);
        assert!((slowed.angular / slowed.linear.x() - 10.0 / 3.0).abs() < 1e-4);
        assert_eq!(omni.saturated(twist(0.1, 0.0, 0.0), 2.0), (twist(0.1, 0.0, 0.0), 1.0));
    }

    #[test]
    fn the_limit_of_a_direction_is_where_a_rim_saturates() {
        let omni = Omni::default();
        for degrees in (-180..180).step_by(7) {
            for angular in [-4.0, 0.0, 4.0] {
                let direction = Angle::degrees(degrees as f32);
                let limit = omni.speed_limit(direction, angular, 3.0);
                let at_limit = Twist { linear: Vector::polar(limit, direction), angular };
                let fastest = omni.rims(at_limit).into_iter().map(f32::abs).fold(0.0, f32::max);
                assert!((fastest - 3.0).abs() < 1e-3, "{degrees}°, {angular}: {fastest}");
            }
        }
        // Straight ahead the front wheels, at sin 60°, reach their limit first.
        assert!((omni.speed_limit(Angle::ZERO, 0.0, 3.0) - 3.0 / 0.866_025).abs() < 1e-4);
        assert_eq!(omni.speed_limit(Angle::ZERO, 40.0, 3.0), 0.0);
    }

    #[test]
    fn wheels_that_cannot_drive_everywhere_are_refused() {
        let parallel = Wheels { angles: [90.0, 90.0, -90.0, -90.0].map(Angle::degrees), ..Wheels::default() };
        assert_eq!(Omni::new(&parallel), Err(WheelsError));
        for lever in [0.0, f32::NAN] {
            assert_eq!(Omni::new(&Wheels { levers: [lever; 4], ..Wheels::default() }), Err(WheelsError));
        }
        let two = Wheels { driven: [true, false, true, false], ..Wheels::default() };
        assert_eq!(Omni::new(&two), Err(WheelsError));
        assert!(Omni::new(&Wheels::default()).is_ok());
    }
}
