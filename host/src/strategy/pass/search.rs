//! `search`: search for the best receiving place. Random samples near the previous best, and some anywhere
//! (Biswas et al. 2014 §3.1; D13).
//!
//! The paper searches the neighbourhood of the previous optimum alone, so that the receiver's target does not
//! jump. This search does the same, except for a tenth of its samples, which cover the whole field; the
//! target jumps only for a place that is better by a quarter. One seed, one stream: the same moments give the
//! same places.

use geometry::{Attack, Point, Vector};
use protocol::RobotId;
use rand_core::{RngCore, SeedableRng};
use rand_xoshiro::Xoshiro128PlusPlus;

use super::super::view::{ROBOTS_MAX, View};
use super::kicks::Kicks;
use super::scene::{PassScene, Rating};

/// Places rated at one moment (D13).
pub const SAMPLES: u32 = 200;
/// Standard deviation of samples near the last optimum, m along each axis (D13).
const NEAR_SIGMA_M: f32 = 0.5;
/// √3: four uniform numbers have a variance of 1/3.
const ROOT_OF_3: f32 = 1.732_050_8;
/// One of this number of samples lies anywhere (D13: 10 %).
const GLOBAL_SHARE: u32 = 10;
/// Factor by which a place elsewhere must be better to jump there: a receiver that turns round loses half a
/// second, which costs a fifth of the passes that were likely.
const JUMP_GAIN: f32 = 1.25;

/// A receiver's search, kept between snapshots.
#[derive(Clone, Debug)]
pub struct Search {
    random: Xoshiro128PlusPlus,
    last: Option<Point<Attack>>,
}

impl Search {
    /// A search whose samples are those of this seed.
    pub fn new(seed: u64) -> Self {
        Self { random: Xoshiro128PlusPlus::seed_from_u64(seed), last: None }
    }

    /// The optimum of the last step.
    pub fn last(&self) -> Option<Point<Attack>> {
        self.last
    }

    /// Forgets it: another pass is searched.
    pub fn forget(&mut self) {
        self.last = None;
    }

    /// Rates `samples` places and the last optimum, and returns the best.
    pub fn step(&mut self, scene: &PassScene<'_>, samples: u32) -> Rating {
        let anywhere = match self.last {
            Some(_) => samples / GLOBAL_SHARE,
            None => samples,
        };
        let mut near = self.last.map(|at| scene.rate(at));
        if let Some(last) = self.last {
            for _ in anywhere..samples {
                let at = last + self.bell() * NEAR_SIGMA_M;
                near = Some(better(near, scene, at));
            }
        }
        let mut far: Option<Rating> = None;
        for _ in 0..anywhere.max(u32::from(near.is_none())) {
            let [x, y] = scene.half();
            let at = Point::new(x * self.uniform(), y * self.uniform());
            far = Some(better(far, scene, at));
        }
        let best = match (near, far) {
            (Some(near), Some(far)) if far.value() > near.value() * JUMP_GAIN => far,
            (Some(near), _) => near,
            (None, Some(far)) => far,
            // At least one place was rated.
            (None, None) => scene.rate(scene.from()),
        };
        self.last = Some(best.at);
        best
    }

    /// Uniform in −1 to 1.
    fn uniform(&mut self) -> f32 {
        (self.random.next_u32() >> 8) as f32 * (1.0 / 8_388_608.0) - 1.0
    }

    /// Two independent numbers of a bell curve, mean 0 and standard deviation 1: four uniform ones added up
    /// each, which is a normal distribution except for its tails beyond 3, and takes a tenth of the
    /// instructions of a logarithm and a sine.
    fn bell(&mut self) -> Vector<Attack> {
        let [x, y] = [(); 2].map(|()| {
            let (a, b) = (self.random.next_u32(), self.random.next_u32());
            let sum = (a >> 16) + (a & 0xffff) + (b >> 16) + (b & 0xffff);
            // Each has mean 1/2 and variance 1/12.
            (sum as f32 * (1.0 / 65_536.0) - 2.0) * ROOT_OF_3
        });
        Vector::new(x, y)
    }
}

/// The best so far, or the place `at` where that has a higher value.
fn better(best: Option<Rating>, scene: &PassScene<'_>, at: Point<Attack>) -> Rating {
    match best {
        Some(best) => scene.rate_above(at, best.value()).unwrap_or(best),
        None => scene.rate(at),
    }
}

/// A teammate's best place, and the rating of a pass there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Offer {
    /// Number of the receiving teammate.
    pub receiver: RobotId,
    /// Place of the reception, with the factors.
    pub rating: Rating,
}

/// A team's search for passes with its kicks: each teammate searches its own place, the passer chooses among
/// them (§3).
#[derive(Clone, Debug)]
pub struct PassSearch {
    kicks: Kicks,
    receivers: [Search; ROBOTS_MAX],
}

impl PassSearch {
    /// Every robot has a stream of its own.
    pub fn new(kicks: Kicks, seed: u64) -> Self {
        // 2⁶⁴ / φ apart, as splitmix seeds are.
        let apart = 0x9e37_79b9_7f4a_7c15_u64;
        let search = |i| Search::new(seed.wrapping_add(apart.wrapping_mul(i as u64)));
        Self { kicks, receivers: std::array::from_fn(search) }
    }

    /// The kicks that passes are rated with.
    pub fn kicks(&self) -> &Kicks {
        &self.kicks
    }

    /// Rates passes with these kicks from now on.
    pub fn set_kicks(&mut self, kicks: Kicks) {
        self.kicks = kicks;
    }

    /// The offer of every robot except `passer` and our keeper for a pass from `from`, best first; of equal
    /// ones the lower number; `keeps`: having the ball is worth something without a shot too.
    pub fn offers(
        &mut self,
        view: &View,
        from: Point<Attack>,
        passer: RobotId,
        keeps: bool,
    ) -> heapless::Vec<Offer, ROBOTS_MAX> {
        let mut offers: heapless::Vec<Offer, ROBOTS_MAX> = heapless::Vec::new();
        for teammate in
            view.ours.iter().filter(|teammate| teammate.id != passer && teammate.id != view.keeper)
        {
            let scene = PassScene::of(view, &self.kicks, from, Some(passer), teammate);
            let scene = if keeps { scene.keeping() } else { scene };
            let rating = self.receivers[teammate.id.index()].step(&scene, SAMPLES);
            let worse = |other: &Offer| other.rating.value() < rating.value();
            let place = offers.iter().position(worse).unwrap_or(offers.len());
            // At most one per robot.
            let _ = offers.insert(place, Offer { receiver: teammate.id, rating });
        }
        offers
    }

    /// Forgets all places: for another ball or passer.
    pub fn forget(&mut self) {
        self.receivers.iter_mut().for_each(Search::forget);
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::view::tests::view;
    use super::*;
    use rules::League;

    fn kicks() -> Kicks {
        Kicks::of(League::DivisionB)
    }

    const OURS: [(f32, f32); 4] = [(-4.4, 0.0), (0.4, 0.0), (2.0, 1.5), (1.0, -2.0)];
    const THEIRS: [(f32, f32); 4] = [(4.4, 0.1), (3.3, 0.4), (2.0, 0.2), (2.2, -0.9)];

    #[test]
    fn the_same_seed_finds_the_same_places_and_another_one_similar_worth() {
        let view = view((0.5, 0.0), &OURS, &THEIRS);
        let run = |seed| {
            let mut search = PassSearch::new(kicks(), seed);
            let mut offers = || search.offers(&view, Point::new(0.5, 0.0), view.ours[1].id, false);
            (0..10).map(|_| offers()).last().unwrap()
        };
        let (one, again, other) = (run(1), run(1), run(2));
        assert_eq!(one, again);
        let (a, b) = (one[0].rating.value(), other[0].rating.value());
        assert!((a - b).abs() < 0.1 * a && one[0].receiver == other[0].receiver, "{a} {b}");
        // Keeper and passer are no receivers.
        assert_eq!(one.len(), 2);
    }

    #[test]
    fn it_finds_what_a_fine_grid_finds() {
        let (kicks, view) = (kicks(), view((0.5, 0.0), &OURS, &THEIRS));
        let scene = PassScene::of(&view, &kicks, Point::new(0.5, 0.0), Some(view.ours[1].id), &view.ours[2]);
        let mut best = 0.0_f32;
        for i in 0..180 {
            for j in 0..120 {
                let at = Point::new(-4.475 + 0.05 * i as f32, -2.975 + 0.05 * j as f32);
                best = best.max(scene.rate(at).value());
            }
        }
        let mut search = Search::new(3);
        let found = (0..10).map(|_| search.step(&scene, SAMPLES)).last().unwrap().value();
        assert!(found > 0.97 * best, "{found} of {best}");
    }

    #[test]
    fn the_target_stays_near_while_the_field_changes_little() {
        let kicks = kicks();
        let mut search = Search::new(4);
        let mut last: Option<Point<Attack>> = None;
        let mut moved = 0.0_f32;
        for tick in 0..60 {
            let shift = tick as f32 * 0.002;
            let theirs = THEIRS.map(|(x, y)| (x, y + shift));
            let view = view((0.5, 0.0), &OURS, &theirs);
            let scene = PassScene::of(&view, &kicks, Point::new(0.5, 0.0), None, &view.ours[2]);
            let at = search.step(&scene, 60).at;
            // The first steps still search.
            if let (Some(last), true) = (last, tick > 10) {
                moved = moved.max(at.distance(last));
            }
            last = Some(at);
        }
        assert!(moved < 0.5, "jumped by {moved} m");
    }

    #[test]
    fn samples_near_the_optimum_have_the_spread_of_a_normal_distribution() {
        let mut search = Search::new(6);
        let (mut sum, mut squares, mut within, mut together) = (0.0_f64, 0.0_f64, 0, 0.0_f64);
        for _ in 0..20_000 {
            let at = search.bell();
            let (x, y) = (f64::from(at.x()), f64::from(at.y()));
            (sum, squares, together) = (sum + x, squares + x * x, together + x * y);
            within += u32::from(x.abs() < 1.0);
        }
        let mean = sum / 20_000.0;
        assert!(mean.abs() < 0.03 && (squares / 20_000.0 - 1.0).abs() < 0.03, "{mean} {squares}");
        assert!((together / 20_000.0).abs() < 0.03, "x and y are independent");
        // 68.3 % of a normal distribution lie within one standard deviation.
        assert!((f64::from(within) / 20_000.0 - 0.683).abs() < 0.03, "{within}");
    }

    #[test]
    fn a_search_without_samples_still_answers() {
        let (kicks, view) = (kicks(), view((0.5, 0.0), &OURS, &THEIRS));
        let scene = PassScene::of(&view, &kicks, Point::new(0.5, 0.0), None, &view.ours[2]);
        let mut search = Search::new(5);
        assert!(search.step(&scene, 0).value() >= 0.0);
        assert!(search.last().is_some());
        search.forget();
        assert_eq!(search.last(), None);
    }
}
