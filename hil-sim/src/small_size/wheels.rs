//! `wheels`: kinematics of three or four wheels. m/s at the rim, rad/s, body frame.
//!
//! A wheel at the angle α drives along its tangent: its rim runs at −sin α · v_x + cos α · v_y + R · ω. With
//! four rims and three degrees of freedom the body follows the least squares. Written independently of
//! `motion`'s kinematics, which robots use.

use geometry::Angle;
use serde::{Deserialize, Serialize};

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Wheels {
    /// For v_x, v_y, ω of 1 each: the rim speeds of the four wheels.
    rims: [[f32; 4]; 3],
    /// For a rim speed of 1 of each wheel: v_x, v_y, ω, and 0, so that four numbers go through one
    /// instruction.
    motions: [[f32; 4]; 4],
}

impl Wheels {
    /// The first `count` wheels at these angles, degrees from ahead, with these levers, m; `None` where they
    /// cannot drive in every direction.
    pub(super) fn new(wheels_deg: [f32; 4], levers: [f32; 4], count: u8) -> Option<Self> {
        let mut rows = [[0.0; 3]; 4];
        for (wheel, row) in rows.iter_mut().enumerate().take(usize::from(count)) {
            let (s, c) = Angle::degrees(wheels_deg[wheel]).sin_cos();
            *row = [-s, c, levers[wheel]];
        }
        // Gauss–Jordan on (JᵀJ | Jᵀ); once per body.
        let mut system = [[0.0_f32; 7]; 3];
        for (i, line) in system.iter_mut().enumerate() {
            for (j, cell) in line.iter_mut().enumerate() {
                *cell = if j < 3 { rows.iter().map(|row| row[i] * row[j]).sum() } else { rows[j - 3][i] };
            }
        }
        for pivot in 0..3 {
            let largest = (pivot..3).fold(pivot, |best, i| {
                if system[i][pivot].abs() > system[best][pivot].abs() { i } else { best }
            });
            system.swap(pivot, largest);
            let value = system[pivot][pivot];
            // 1e-5 of a wheel at 10 mm: rounding errors of a singular matrix stay far below.
            if value.abs() < 1e-5 * levers.into_iter().fold(0.0, f32::max) {
                return None;
            }
            let line = system[pivot].map(|cell| cell / value);
            system[pivot] = line;
            for (_, other) in system.iter_mut().enumerate().filter(|(i, _)| *i != pivot) {
                let factor = other[pivot];
                for (cell, by) in other.iter_mut().zip(line) {
                    *cell -= factor * by;
                }
            }
        }
        let [x, y, turn] = system;
        Some(Self {
            rims: [0, 1, 2].map(|axis| rows.map(|row| row[axis])),
            motions: [3, 4, 5, 6].map(|wheel| [x[wheel], y[wheel], turn[wheel], 0.0]),
        })
    }

    /// Rim speeds that give the body this motion.
    #[inline]
    pub(super) fn rims(&self, [x, y, turn]: [f32; 3]) -> [f32; 4] {
        let mut rims = [0.0; 4];
        for (lane, rim) in rims.iter_mut().enumerate() {
            *rim = self.rims[0][lane] * x + self.rims[1][lane] * y + self.rims[2][lane] * turn;
        }
        rims
    }

    /// Motion of the body at these rim speeds.
    #[inline]
    pub(super) fn motion(&self, [p, q, r, s]: [f32; 4]) -> [f32; 3] {
        let [a, b, c, d] = &self.motions;
        let mut rolled = [0.0; 4];
        for (lane, axis) in rolled.iter_mut().enumerate() {
            *axis = a[lane] * p + b[lane] * q + c[lane] * r + d[lane] * s;
        }
        [rolled[0], rolled[1], rolled[2]]
    }
}

#[cfg(test)]
mod tests {
    use rules::League;

    use super::*;
    use crate::small_size::Parameters;

    fn wheels() -> Wheels {
        let body = Parameters::of(League::DivisionB).unwrap().robot;
        body.wheels().unwrap()
    }

    #[test]
    fn straight_ahead_right_rims_turn_forward_and_left_ones_back_by_their_sines() {
        let rims = wheels().rims([1.0, 0.0, 0.0]);
        // sin 60° and sin 135°.
        let (front, back) = (0.866_025, core::f32::consts::FRAC_1_SQRT_2);
        for (rim, by_hand) in rims.into_iter().zip([front, back, -back, -front]) {
            assert!((rim - by_hand).abs() < 1e-4, "{rims:?}");
        }
    }

    #[test]
    fn a_turn_on_the_spot_turns_all_rims_alike() {
        let rims = wheels().rims([0.0, 0.0, 2.0]);
        assert_eq!(rims, [0.162; 4]);
    }

    #[test]
    fn rims_and_motion_are_inverse_and_parallel_wheels_are_refused() {
        let wheels = wheels();
        let wanted = [0.7, -1.3, 4.0];
        for (value, by) in wheels.motion(wheels.rims(wanted)).into_iter().zip(wanted) {
            assert!((value - by).abs() < 1e-5);
        }
        let levers = [0.08; 4];
        assert!(Wheels::new([90.0, -90.0, 90.0, -90.0], levers, 4).is_none());
        assert!(Wheels::new([-60.0, 180.0, 60.0, 0.0], levers, 3).is_some());
    }
}
