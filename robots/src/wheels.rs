//! `wheels`: the wheels of a description, and how evenly they drive a body in every direction.

/// A wheel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wheel {
    /// Where it stands, degrees counter-clockwise from ahead.
    pub place: f32,
    /// From the robot's centre, m.
    pub distance: f32,
    /// By how much its drive is turned from its tangent, degrees counter-clockwise.
    pub skew: f32,
    /// The board's motor output that drives it, 1 to 4.
    pub output: u8,
}

impl Wheel {
    /// Place of the tangential wheel that drives in this one's direction, degrees.
    pub fn drive(&self) -> f32 {
        self.place + self.skew
    }

    /// Speed of the rim for a turn of 1 rad/s, m/s.
    pub fn lever(&self) -> f32 {
        if self.skew == 0.0 { self.distance } else { self.distance * self.skew.to_radians().cos() }
    }
}

/// The wheels as robot and simulator have them: four places, of which a robot of three leaves the last empty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WheelSlots {
    /// Number of wheels.
    pub count: u8,
    /// [`Wheel::drive`] of each.
    pub degrees: [f32; 4],
    /// [`Wheel::lever`] of each.
    pub levers: [f32; 4],
    /// The greatest distance, m.
    pub distance: f32,
    /// Motor output of each, from 0; an empty place has the output that is left.
    pub outputs: [u8; 4],
}

/// These wheels in their places.
pub fn wheel_slots(wheels: &[Wheel]) -> WheelSlots {
    let (mut degrees, mut levers, mut outputs) = ([0.0; 4], [0.0; 4], [0; 4]);
    let free = (1..=4).filter(|output| wheels.iter().all(|wheel| wheel.output != *output));
    let used = wheels.iter().map(|wheel| wheel.output);
    for (place, output) in outputs.iter_mut().zip(used.chain(free)) {
        *place = output.saturating_sub(1);
    }
    for ((degrees, lever), wheel) in degrees.iter_mut().zip(&mut levers).zip(wheels) {
        (*degrees, *lever) = (wheel.drive(), wheel.lever());
    }
    let distance = wheels.iter().map(|wheel| wheel.distance).fold(0.0, f32::max);
    WheelSlots { count: wheels.len().min(4) as u8, degrees, levers, distance, outputs }
}

/// Condition number of the matrix that gives the rims' speeds for a motion (ahead, to the left, turning, each
/// as a speed at the wheels' mean circle): most over least that the rims turn for motions of the same size. 1
/// is even; infinite where a motion turns no wheel.
pub fn condition(wheels: &[Wheel]) -> f64 {
    let mean = wheels.iter().map(|wheel| f64::from(wheel.distance)).sum::<f64>() / wheels.len() as f64;
    // JᵀJ of rows (−sin α, cos α, lever).
    let mut m = [[0.0_f64; 3]; 3];
    for wheel in wheels {
        let (sin, cos) = f64::from(wheel.drive()).to_radians().sin_cos();
        let row = [-sin, cos, f64::from(wheel.lever()) / mean];
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

    fn condition_of(places: &[f32], skew: f32) -> f64 {
        let wheel = |place: &f32| Wheel { place: *place, distance: 0.08, skew, output: 1 };
        condition(&places.iter().map(wheel).collect::<Vec<_>>())
    }

    #[test]
    fn a_skewed_wheel_keeps_the_cosine_of_its_lever_and_three_leave_a_place_empty() {
        let wheel = |place, output| Wheel { place, distance: 0.08, skew: 60.0, output };
        let slots = wheel_slots(&[wheel(-60.0, 3), wheel(180.0, 1), wheel(60.0, 4)]);
        assert_eq!((slots.count, slots.degrees, slots.outputs), (3, [0.0, 240.0, 120.0, 0.0], [2, 0, 3, 1]));
        assert!((slots.levers[0] - 0.04).abs() < 1e-6 && slots.levers[3] == 0.0 && slots.distance == 0.08);
        // Rows of three thirds of a circle: JᵀJ is the diagonal 1.5, 1.5, 3.
        assert!((condition_of(&[-60.0, 180.0, 60.0], 0.0) - 2.0_f64.sqrt()).abs() < 1e-6);
    }

    #[test]
    fn four_wheels_across_are_even_up_to_the_turn() {
        // Rows of (∓√½, ±√½, 1): JᵀJ is the diagonal 2, 2, 4.
        assert!((condition_of(&[-45.0, -135.0, 135.0, 45.0], 0.0) - 2.0_f64.sqrt()).abs() < 1e-9);
    }

    #[test]
    fn our_wheel_angles_agree_with_a_calculation_by_hand() {
        // Σ sin² = 1.5 + 1, Σ cos² = 0.5 + 1, Σ cos = 1 − √2, Σ sin and Σ sin·cos 0: the block of side and
        // turn has the trace 5.5 and the determinant 6 − (1 − √2)².
        let determinant = 6.0 - (1.0 - 2.0_f64.sqrt()).powi(2);
        let root = (5.5_f64 * 5.5 - 4.0 * determinant).sqrt();
        let (least, most) = ((5.5 - root) / 2.0, f64::midpoint(5.5, root));
        let by_hand = (most / least.min(2.5)).sqrt();
        assert!((condition_of(&[-60.0, -135.0, 135.0, 60.0], 0.0) - by_hand).abs() < 1e-9);
    }

    #[test]
    fn wheels_that_leave_a_direction_out_have_no_finite_condition() {
        assert_eq!(condition_of(&[-90.0, -90.0, 90.0, 90.0], 0.0), f64::INFINITY);
        assert_eq!(condition_of(&[0.0; 4], 0.0), f64::INFINITY);
    }
}
