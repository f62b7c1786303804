//! `self_blocking`: share of an opponent's scope that blocks the case's own ball path. There the opponent
//! fulfils a condition of the case and forbids it at the same time.

use casebase::{Case, CaseBase, PointMm, RetrievalSettings, Scope, blocked_leg};

/// The share of the scope about `at`, by the weight that the scope gives to places, in which an opponent
/// blocks the case with the ball at its own place: 0 to 1.
pub fn share(stored: &Case<'_>, base: &CaseBase<'_>, at: PointMm, scope: Scope) -> f32 {
    let settings = RetrievalSettings::default();
    let (mut blocked, mut all) = (0.0_f32, 0.0_f32);
    for (x, y) in grid() {
        let weight = (-(x * x + y * y)).exp();
        let offset = PointMm::new((x * scope.x as f32).round() as i32, (y * scope.y as f32).round() as i32);
        all += weight;
        if blocked_leg(stored, base, stored.ball(), &[at.plus(offset)], &settings).is_some() {
            blocked += weight;
        }
    }
    blocked / all
}

/// Places in the unit circle, in a square grid; the scope ends there.
fn grid() -> impl Iterator<Item = (f32, f32)> {
    let place = |i: i32| i as f32 / PLACES_PER_RADIUS as f32;
    (-PLACES_PER_RADIUS..=PLACES_PER_RADIUS)
        .flat_map(move |i| (-PLACES_PER_RADIUS..=PLACES_PER_RADIUS).map(move |j| (place(i), place(j))))
        .filter(|(x, y)| x * x + y * y <= 1.0)
}

/// Places from the centre to the border: 193 places a scope, which find a share to about a hundredth.
const PLACES_PER_RADIUS: i32 = 8;
/// A larger share is a warning.
pub const WARNS_ABOVE: f32 = 0.1;

#[cfg(test)]
mod tests {
    use super::grid;

    #[test]
    fn the_grid_covers_the_circle_evenly() {
        let places: Vec<_> = grid().collect();
        assert_eq!(places.len(), 197);
        let sum = places.iter().fold((0.0, 0.0), |sum, place| (sum.0 + place.0, sum.1 + place.1));
        assert!(sum.0.abs() < 1e-4 && sum.1.abs() < 1e-4);
    }
}
