//! `family`: tests of random worlds and of the nominal one.

use super::*;
use crate::four_legged::trace::TraceHash;
use crate::small_size::Parameters;

const LEAGUES: [League; 3] = [League::Ssl2013, League::DivisionB, League::DivisionA];

fn random(seed: u64) -> WorldModel {
    WorldModel::of(League::DivisionB, &WorldChoice::Random(seed)).unwrap()
}

#[test]
fn every_random_world_is_valid_in_every_league_and_repeatable() {
    for league in LEAGUES {
        for seed in 0..300 {
            let choice = WorldChoice::Random(seed);
            let model = WorldModel::of(league, &choice).unwrap();
            assert_eq!(model.check(), Ok(()), "{league:?} {seed}");
            assert_eq!(WorldModel::of(league, &choice), Some(model.clone()));
            assert_eq!(model.name, format!("random:{seed}"));
        }
    }
    assert_ne!(random(1).parameters, random(2).parameters);
}

#[test]
fn random_worlds_fill_the_ranges_of_their_quantities() {
    let of = |number: fn(&WorldModel) -> f32| {
        let mut values: Vec<f32> = (0..400).map(|seed| number(&random(seed))).collect();
        values.sort_by(f32::total_cmp);
        (values[0], values[200], values[399])
    };
    let near = |(low, middle, high): (f32, f32, f32), by: [f32; 3]| {
        let room = (by[2] - by[0]) * 0.1;
        assert!(low >= by[0] && high <= by[2], "{low} {high}: {by:?}");
        assert!(low < by[0] + room && high > by[2] - room, "{low} {high}: {by:?}");
        assert!((middle - by[1]).abs() < room, "{middle}: {by:?}");
    };
    near(of(|model| model.link.latency_ms as f32), [5.0, 32.0, 60.0]);
    near(of(|model| model.link.loss), [0.0, 0.05, 0.10]);
    near(of(|model| model.parameters.camera.rate), [50.0, 75.0, 100.0]);
    // Log-even: the middle is √(0.2 · 0.8).
    near(of(|model| model.parameters.ball.roll), [0.2, 0.4, 0.8]);
    near(of(|model| model.robots.kick_gain[0]), [0.6, 0.746, 1.1 * 1.0]);
    let (least, _, most) = of(|model| model.parameters.dribbler.pull);
    assert_eq!((least, most), (0.0, PERFECT_PULL), "some have none, some are perfect");
    let stand: Vec<u32> = (0..400).map(|seed| u32::from(random(seed).bystanders)).collect();
    assert!(stand.iter().all(|n| *n == 0 || (5..=11).contains(n)));
    assert!([0, 5, 11].iter().all(|n| stand.contains(n)));
    let none = stand.iter().filter(|n| **n == 0).count();
    // √(400 / 4) = 10; four of them.
    assert!(none.abs_diff(200) <= 40, "{none}");
}

#[test]
fn quantities_are_drawn_independently() {
    let worlds: Vec<WorldModel> = (0..400).map(random).collect();
    let numbers: [fn(&WorldModel) -> f32; 6] = [
        |model| model.parameters.ball.slide,
        |model| model.parameters.bounce.front,
        |model| model.parameters.drive.forward,
        |model| model.parameters.camera.rate,
        |model| model.link.latency_ms as f32,
        |model| model.robots.kick_gain[1],
    ];
    let columns = numbers.map(|number| {
        let values: Vec<f32> = worlds.iter().map(number).collect();
        let mean = values.iter().sum::<f32>() / values.len() as f32;
        let off: Vec<f32> = values.iter().map(|value| value - mean).collect();
        let norm = geometry::math::sqrt(off.iter().map(|x| x * x).sum::<f32>());
        off.iter().map(|x| x / norm).collect::<Vec<f32>>()
    });
    for (i, one) in columns.iter().enumerate() {
        for other in &columns[..i] {
            let correlation: f32 = one.iter().zip(other).map(|(x, y)| x * y).sum();
            // 1/√400 = 0.05; four of them.
            assert!(correlation.abs() < 0.2, "{i}: {correlation}");
        }
    }
}

#[test]
fn the_nominal_world_equals_the_leagues_bit_by_bit() {
    let play = |mut world: World| {
        let mut trace = TraceHash::default();
        for n in 0..6 {
            world.put(yellow(n), Pose::from_mm_deg(300.0 * f32::from(n) - 1000.0, 90.0, 10.0 * f32::from(n)));
        }
        world.put_ball(Ball::rolling(Point::new(0.5, 0.1), Vector::new(-1.0, 0.0)));
        for tick in 0..300 {
            trace.small_size_tick(tick, &world);
            for n in 0..6 {
                let frame = ActuatorFrame::Omni {
                    wheels: [1.0, 0.7, -0.6, f32::from(n) * -0.3],
                    dribbler: 1.0,
                    kick: OmniKick::Flat(3.0),
                };
                world.command(yellow(n), &frame);
            }
            (0..10).for_each(|_| world.step());
        }
        trace.digits()
    };
    let league = League::DivisionB;
    let model = WorldModel::of(league, &WorldChoice::Nominal).unwrap();
    let plain = World::new(league, Parameters::of(league).unwrap(), 5);
    assert_eq!(play(World::of_model(league, &model, 5)), play(plain));
}

#[test]
fn the_documentation_lists_every_quantity_with_bounds_and_distribution() {
    let document = include_str!("../../../../../docs/fields.md");
    for quantity in DRAWS {
        let [low, high] = quantity.bounds;
        let row = format!("| `{}` | {low}–{high} | {} |", quantity.name, quantity.law.label());
        assert!(document.contains(&row), "docs/fields.md lacks: {row}");
    }
    for name in WorldChoice::names() {
        assert!(document.contains(&format!("| `{name}` |")), "docs/fields.md lacks the world {name}");
    }
}
