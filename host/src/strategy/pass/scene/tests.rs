//! Tests: a place is rated by the paper's formulas. Compared with numbers of a separate program in Python
//! (double precision; the ball's path is searched in 100,000 steps, the goal by 400,000 rays), and with
//! properties of every place.

use rand_core::{RngCore, SeedableRng};
use rand_xoshiro::Xoshiro128PlusPlus;
use rules::League;

use super::super::super::view::tests::view;
use super::*;

fn kicks(league: League) -> Kicks {
    Kicks::of(league)
}

/// Ours: 0 passes, 1 receives, the others are teammates.
fn rated(from: (f32, f32), at: (f32, f32), ours: &[(f32, f32)], theirs: &[(f32, f32)]) -> Rating {
    let (kicks, view) = (kicks(League::DivisionB), view(from, ours, theirs));
    let from = Point::new(from.0, from.1);
    PassScene::of(&view, &kicks, from, Some(view.ours[0].id), &view.ours[1]).rate(Point::new(at.0, at.1))
}

fn all_close(are: &[f32], by_hand: &[f64]) {
    for (i, (is, by_hand)) in are.iter().zip(by_hand).enumerate() {
        assert!((f64::from(*is) - by_hand).abs() < 2e-3, "{i}: {is}, by hand {by_hand}");
    }
}

#[test]
fn a_pass_beside_an_opponent_and_a_teammate_by_hand() {
    let ours = [(-0.1, 0.0), (2.5, -2.0), (3.5, -1.5)];
    let rating = rated((0.0, 0.0), (2.9, -1.5), &ours, &[(4.3, -0.1), (2.0, 0.5)]);
    // The ball leaves with 3.367840 m/s and is there after 1.405585 s; the receiver drives 0.640312 m: 2
    // √(0.640312 / 3.5) = 0.855445 s.
    let PassKick::Flat { speed } = rating.kick else { panic!("{rating:?}") };
    all_close(&[speed, rating.ball_time, rating.receiver_time], &[3.367_840, 1.405_585, 0.855_445]);
    // No opponent is there within 0.6 s more (likely(6) = 0.997527); number 0, their keeper, is 0.155686 s
    // late for the ball.
    assert_eq!(rating.model, None);
    let interceptor = rating.interceptor.unwrap();
    assert_eq!(interceptor.id.number(), 0);
    all_close(&[interceptor.margin], &[0.155_686]);
    // The teammate is 0.6 m off: 0.1 m more than its margin.
    assert_eq!(rating.spoiler.0, Spoiler::Teammate);
    all_close(&rating.receive_factors, &[0.997_527, 0.825_902, 0.999_984, 0.999_991, 0.660_756]);
    // The gap beside the keeper: 9.216°, its middle 0.274680 m below the goal's; 2.015 m at 6.24 m/s take
    // 0.364477 s.
    all_close(
        &[rating.shot.angle, rating.shot.aim.y(), rating.shot.time],
        &[0.160_849, -0.274_680, 0.364_477],
    );
    assert!(!rating.shot.one_touch, "the pass would have to be turned by 115°");
    all_close(&rating.goal_factors, &[0.587_884, 0.929_435, 0.4, 0.7]);
    all_close(&[rating.value()], &[0.083_282]);
}

#[test]
fn a_cross_that_is_shot_at_one_touch_by_hand() {
    let ours = [(3.0, -2.1), (2.7, 1.8)];
    let rating = rated((3.0, -2.0), (2.9, 1.4), &ours, &[(4.3, 0.1), (1.4, 0.6)]);
    all_close(&rating.receive_factors, &[0.997527, 0.469733, 0.999991, 0.999976, 0.969941]);
    assert!(rating.shot.one_touch);
    all_close(&rating.goal_factors, &[0.618352, 0.963449, 1.0, 0.7]);
}

#[test]
fn an_opponent_under_the_arch_makes_it_a_chip_and_a_free_path_never_does() {
    let ours = [(-0.1, 0.0), (3.0, 0.1)];
    let blocked = rated((0.0, 0.0), (3.0, 0.0), &ours, &[(0.8, 0.0)]);
    assert!(blocked.kick.is_chip() && !blocked.shot.one_touch, "{blocked:?}");
    let c = PassConstants::of(League::DivisionB);
    let margin = blocked.interceptor.map_or(SAFE, |found| found.margin);
    assert_eq!(blocked.receive_factors[1], 0.5 * given::likely(margin, c.time_width));
    let free = rated((0.0, 0.0), (3.0, 0.0), &ours, &[(0.8, 2.5)]);
    assert!(!free.kick.is_chip() && free.value() > blocked.value());
}

#[test]
fn the_opponents_area_is_worthless_today_and_the_best_place_in_2013() {
    let rate = |league: League| {
        let kicks = kicks(league);
        let mut view = view((1.5, -1.2), &[(1.4, -1.3), (2.2, 0.3)], &[(0.0, 0.0)]);
        view.field = league.field();
        let scene = PassScene::of(&view, &kicks, Point::new(1.5, -1.2), Some(view.ours[0].id), &view.ours[1]);
        // 0.5 m before the goal line.
        scene.rate(Point::new(league.field().length * 0.5 - 0.5, 0.0))
    };
    let today = rate(League::DivisionB);
    // 0.5 m inside: −0.5 − 0.2 = −0.7 m of margin, 1/(1 + exp(0.7/0.15)) = 0.009315.
    assert_eq!(today.spoiler.0, Spoiler::TheirArea);
    all_close(&[today.receive_factors[4], today.goal_factors[3]], &[0.009_315, 0.7]);
    let paper = rate(League::Ssl2013);
    assert_eq!((paper.spoiler.0, paper.goal_factors[3]), (Spoiler::Line, 1.0));
    // 0.5 − 0.3 = 0.2 m off the goal line: 1/(1 + exp(−0.2/0.15)) = 0.791392.
    all_close(&[paper.receive_factors[4]], &[0.791_392]);
}

#[test]
fn our_area_is_worthless_in_every_league() {
    let ours = [(-0.1, 0.0), (-3.5, 0.5)];
    let rating = rated((0.0, 0.0), (-4.0, 0.0), &ours, &[]);
    assert!(rating.spoiler.0 == Spoiler::OurArea && rating.value() < 0.01, "{rating:?}");
}

#[test]
fn every_factor_is_a_probability_wherever_everyone_stands() {
    let kicks = kicks(League::DivisionB);
    let mut rng = Xoshiro128PlusPlus::seed_from_u64(8);
    let mut within = |range: f32| ((rng.next_u32() >> 8) as f32 / 8_388_608.0 - 1.0) * range;
    let mut chips = 0;
    for _ in 0..300 {
        let places = |n: usize, within: &mut dyn FnMut(f32) -> f32| {
            (0..n).map(|_| (within(4.7), within(3.2))).collect::<Vec<_>>()
        };
        let (ours, theirs) = (places(6, &mut within), places(6, &mut within));
        let view = view((within(4.5), within(3.0)), &ours, &theirs);
        let from = view.ball.unwrap().position;
        let scene = PassScene::of(&view, &kicks, from, None, &view.ours[1]);
        for at in (0..20).map(|_| Point::new(within(5.0), within(3.5))).chain([from, view.theirs[0].position])
        {
            let rating = scene.rate(at);
            let factors = rating.receive_factors.iter().chain(&rating.goal_factors);
            assert!(factors.clone().all(|p| (0.0..=1.0).contains(p)), "{rating:?}");
            chips += u32::from(rating.kick.is_chip());
            // A floor above the value gives nothing, a floor below it the same rating.
            let value = rating.value();
            assert_eq!(scene.rate_above(at, value), None);
            if value > 1e-30 {
                assert_eq!(scene.rate_above(at, value * 0.999), Some(rating), "{value}");
            }
        }
    }
    assert!(chips > 30, "{chips}");
}

/// A pass from the middle to `at`.
pub(crate) fn rating_for_tests(at: (f32, f32), one_touch: bool) -> Rating {
    let mut rating = rated((0.0, 0.0), at, &[(-0.1, 0.0), at], &[]);
    rating.shot.one_touch = one_touch;
    rating
}
