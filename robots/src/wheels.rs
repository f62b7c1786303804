//! `wheels`: how evenly four wheels drive a body in every direction.

/// Condition number of the matrix that gives the rims' speeds for a motion (ahead, to the left, turning, each
/// as a speed at the wheels' circle): most over least that the rims turn for motions of the same size. 1 is
/// even; infinite where a motion turns no wheel. `degrees` are the wheels' places, counter-clockwise from
/// ahead.
pub fn condition(degrees: [f32; 4]) -> f64 {
    // JᵀJ of rows (−sin α, cos α, 1).
    let mut m = [[0.0_f64; 3]; 3];
    for angle in degrees {
        let (sin, cos) = f64::from(angle).to_radians().sin_cos();
        let row = [-sin, cos, 1.0];
        for (line, a) in m.iter_mut().zip(row) {
            for (cell, b) in line.iter_mut().zip(row) {
                *cell += a * b;
            }
        }
    }
    let [least, most] = extreme_eigenvalues(m);
    if least <= 1e-9 * most { f64::INFINITY } else { (most / least).sqrt() }
}

/// Smallest and largest eigenvalue of a symmetric matrix: Jacobi's rotations.
fn extreme_eigenvalues(mut m: [[f64; 3]; 3]) -> [f64; 2] {
    for _ in 0..SWEEPS {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            if m[p][q].abs() < f64::MIN_POSITIVE {
                continue;
            }
            let angle = 0.5 * (2.0 * m[p][q]).atan2(m[q][q] - m[p][p]);
            let (s, c) = angle.sin_cos();
            let before = m;
            for k in 0..3 {
                m[p][k] = c * before[p][k] - s * before[q][k];
                m[q][k] = s * before[p][k] + c * before[q][k];
            }
            let before = m;
            for (line, had) in m.iter_mut().zip(before) {
                line[p] = c * had[p] - s * had[q];
                line[q] = s * had[p] + c * had[q];
            }
        }
    }
    let of = [m[0][0], m[1][1], m[2][2]];
    [of.into_iter().fold(f64::INFINITY, f64::min), of.into_iter().fold(0.0, f64::max)]
}

/// Sweeps over a matrix of three rows; five leave rounding only.
const SWEEPS: usize = 8;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn four_wheels_across_are_even_up_to_the_turn() {
        // Rows of (∓√½, ±√½, 1): JᵀJ is the diagonal 2, 2, 4.
        assert!((condition([-45.0, -135.0, 135.0, 45.0]) - 2.0_f64.sqrt()).abs() < 1e-9);
    }

    #[test]
    fn our_wheel_angles_agree_with_a_calculation_by_hand() {
        // Σ sin² = 1.5 + 1, Σ cos² = 0.5 + 1, Σ cos = 1 − √2, Σ sin and Σ sin·cos 0: the block of side and
        // turn has the trace 5.5 and the determinant 6 − (1 − √2)².
        let determinant = 6.0 - (1.0 - 2.0_f64.sqrt()).powi(2);
        let root = (5.5_f64 * 5.5 - 4.0 * determinant).sqrt();
        let (least, most) = ((5.5 - root) / 2.0, f64::midpoint(5.5, root));
        let by_hand = (most / least.min(2.5)).sqrt();
        assert!((condition([-60.0, -135.0, 135.0, 60.0]) - by_hand).abs() < 1e-9);
    }

    #[test]
    fn wheels_that_leave_a_direction_out_have_no_finite_condition() {
        assert_eq!(condition([-90.0, -90.0, 90.0, 90.0]), f64::INFINITY);
        assert_eq!(condition([0.0; 4]), f64::INFINITY);
    }
}
