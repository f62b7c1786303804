//! `bridge`: refinement of a retrieved case's pass point by P(receive) · P(goal) near its adapted position
//! (docs/papers.md §8: the case gives the intent, the evaluator its parameters). Attack frame, m.

use geometry::{Angle, Attack, Point, Vector, math};

use super::scene::{PassScene, Rating};

/// Largest distance of the point from the adapted position, m: less than the least scope of the cases'
/// robots, so that it stays the case's play.
pub const RADIUS: f32 = 0.6;
/// The case's own place is kept unless another one is better by a twentieth: below, it would follow noise.
pub const WORTH_MOVING: f32 = 1.05;
/// Places of the sunflower: 0.15 m apart at a radius of 0.6 m.
const SUNFLOWER_PLACES: u32 = 48;
/// rad: π (3 − √5).
const GOLDEN_ANGLE_RAD: f32 = 2.399_963_2;
/// Rounding must not place the outermost ones outside.
const RADIUS_SHARE: f32 = 0.999;
/// Circles around the best place: radius of the first as a share, their number, and places on each.
const FIRST_STEP: f32 = 0.125;
const ROUNDS: u32 = 4;
const DIRECTIONS: u32 = 8;

/// A case's pass point, refined.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Refined {
    /// At the place that the case adapted.
    pub proposed: Rating,
    /// At the best place within the radius; the proposed one where no place near it is better by
    /// [`WORTH_MOVING`].
    pub best: Rating,
}

impl Refined {
    /// Gain of P(goal) by the refinement.
    pub fn gain(&self) -> f32 {
        self.best.value() - self.proposed.value()
    }

    /// Distance by which the point moves, m.
    pub fn moved(&self) -> f32 {
        self.best.at.distance(self.proposed.at)
    }
}

/// Refines the pass to `place` within `radius` m of it: a sunflower of places, then ever smaller circles
/// around the best of them. Nothing is random: the same scene gives the same point.
pub fn refine(scene: &PassScene<'_>, place: Point<Attack>, radius: f32) -> Refined {
    let proposed = scene.rate(place);
    let mut best = proposed;
    let look = |best: &mut Rating, at: Point<Attack>| {
        if at.distance(place) <= radius
            && let Some(better) = scene.rate_above(at, best.value())
        {
            *best = better;
        }
    };
    for i in 1..=SUNFLOWER_PLACES {
        // Even in area: √ of the share; the golden angle apart.
        let path = radius * math::sqrt(i as f32 * (1.0 / SUNFLOWER_PLACES as f32)) * RADIUS_SHARE;
        look(&mut best, place + Vector::polar(path, Angle::new(i as f32 * GOLDEN_ANGLE_RAD)));
    }
    let mut step = radius * FIRST_STEP;
    for _ in 0..ROUNDS {
        let around = best.at;
        for i in 0..DIRECTIONS {
            let direction = Angle::new(i as f32 * (math::TAU / DIRECTIONS as f32));
            look(&mut best, around + Vector::polar(step, direction));
        }
        step *= 0.5;
    }
    if best.value() < proposed.value() * WORTH_MOVING {
        best = proposed;
    }
    Refined { proposed, best }
}

#[cfg(test)]
mod tests {
    use super::super::super::view::tests::view;
    use super::super::kicks::Kicks;
    use super::*;
    use rules::League;

    const OURS: [(f32, f32); 2] = [(0.3, 0.0), (2.4, 1.0)];

    fn refined(theirs: &[(f32, f32)], radius: f32) -> (Refined, f32) {
        let kicks = Kicks::of(League::DivisionB);
        let view = view((0.4, 0.0), &OURS, theirs);
        let scene = PassScene::of(&view, &kicks, Point::new(0.4, 0.0), Some(view.ours[0].id), &view.ours[1]);
        let place = Point::new(2.4, 1.0);
        // Every 2 cm within the radius.
        let mut best = 0.0_f32;
        for i in -40..=40 {
            for j in -40..=40 {
                let at = place + Vector::new(i as f32 * 0.02, j as f32 * 0.02);
                if at.distance(place) <= radius {
                    best = best.max(scene.rate(at).value());
                }
            }
        }
        (refine(&scene, place, radius), best)
    }

    #[test]
    fn the_point_moves_out_of_an_opponents_reach_and_no_farther_than_the_radius() {
        let (refined, best) = refined(&[(4.4, 0.0), (1.9, -0.2)], RADIUS);
        assert!(refined.gain() > 0.0 && refined.moved() > 0.1 && refined.moved() <= RADIUS, "{refined:?}");
        assert!(refined.best.value() > 0.97 * best, "{} of {best}", refined.best.value());
        assert!(refined.best.value() > WORTH_MOVING * refined.proposed.value());
    }

    #[test]
    fn a_place_that_is_as_good_as_any_near_it_stands() {
        let (still, _) = refined(&[(4.4, 0.0), (1.9, -0.2)], 0.0);
        assert_eq!((still.gain(), still.moved()), (0.0, 0.0));
        let (again, _) = refined(&[(4.4, 0.0), (1.9, -0.2)], RADIUS);
        assert_eq!(again, refined(&[(4.4, 0.0), (1.9, -0.2)], RADIUS).0, "nothing is random");
    }
}
