//! What is there to count in strategy's decisions? So many of one kind, on scenes of eleven against eleven.
//!
//! `cargo run --release -p host --example strategy_cost -- PART COUNT` does it and prints what came of it; `cargo xtask bench strategy`
//! counts its instructions, for every PART of its table.

use std::process::ExitCode;

use geometry::{Angle, Attack, Point, Vector};
use host::strategy::View;
use host::strategy::pass::{Kicks, PassConstants, SAMPLES, Scene, Search};
use host::strategy::view::{Ball, ROBOTS_MAX, Robot, RobotSet};
use motion::ball::BallModel;
use motion::ball::chip::ChipModel;
use protocol::{Instant, RobotId};
use rand_core::{RngCore, SeedableRng};
use rand_xoshiro::Xoshiro128PlusPlus;
use rules::{League, Phase};

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [part, count] = &words[..] else { return usage() };
    let Ok(count) = count.parse::<u32>() else { return usage() };
    let said = match part.as_str() {
        "pass-location" => pass_locations(League::DivisionA, 11, count),
        "pass-location-six" => pass_locations(League::DivisionB, 6, count),
        "pass-search" => pass_searches(League::DivisionA, 11, count),
        "pass-search-six" => pass_searches(League::DivisionB, 6, count),
        _ => return usage(),
    };
    println!("{count} {part}: {said}");
    ExitCode::SUCCESS
}

fn usage() -> ExitCode {
    eprintln!("usage: strategy_cost pass-location|pass-location-six|pass-search|pass-search-six COUNT");
    ExitCode::from(2)
}

/// Rates `count` places in full, [`PLACES`] a scene (a multiple of them).
fn pass_locations(league: League, robots: u8, count: u32) -> String {
    let kicks = Kicks::new(PassConstants::of(league), BallModel::default(), ChipModel::default());
    let mut random = Random(Xoshiro128PlusPlus::seed_from_u64(1));
    let (mut sum, mut chips) = (0.0_f64, 0);
    // As many scenes however many places are rated: they cost the same for N and 2N.
    let scenes: Vec<View> = (0..SCENES).map(|_| random.view(league, robots)).collect();
    for group in 0..count / PLACES {
        let view = &scenes[(group % SCENES) as usize];
        let (Some(ball), Some(receiver)) = (view.ball, view.ours.get(1)) else { continue };
        let scene = Scene::of(view, &kicks, ball.position, Some(RobotId::ZERO), receiver);
        for _ in 0..PLACES {
            let rating = scene.rate(random.place(view, 1.0));
            sum += f64::from(rating.value());
            chips += u32::from(rating.kick.is_chip());
        }
    }
    format!("mean {:.5}, {chips} chips", sum / f64::from(count))
}

/// Seeks among `count` places, a search of [`SAMPLES`] a scene: what the team does at every moment.
fn pass_searches(league: League, robots: u8, count: u32) -> String {
    let kicks = Kicks::new(PassConstants::of(league), BallModel::default(), ChipModel::default());
    let mut random = Random(Xoshiro128PlusPlus::seed_from_u64(1));
    let scenes: Vec<View> = (0..SCENES).map(|_| random.view(league, robots)).collect();
    let (mut sum, mut search) = (0.0_f64, Search::new(0));
    for group in 0..count / SAMPLES {
        let view = &scenes[(group / MOMENTS % SCENES) as usize];
        let (Some(ball), Some(receiver)) = (view.ball, view.ours.get(1)) else { continue };
        let scene = Scene::of(view, &kicks, ball.position, Some(RobotId::ZERO), receiver);
        if group % MOMENTS == 0 {
            search = Search::new(u64::from(group));
        }
        sum += f64::from(search.step(&scene, SAMPLES).value());
    }
    format!("mean {:.5}", sum / f64::from(count / SAMPLES))
}

struct Random(Xoshiro128PlusPlus);

impl Random {
    fn within(&mut self, range: f32) -> f32 {
        ((self.0.next_u32() >> 8) as f32 / 8_388_608.0 - 1.0) * range
    }

    fn place(&mut self, view: &View, share: f32) -> Point<Attack> {
        let (x, y) = (view.field.length * 0.5 * share, view.field.width * 0.5 * share);
        Point::new(self.within(x), self.within(y))
    }

    /// Everybody somewhere, half of them moving.
    fn view(&mut self, league: League, robots: u8) -> View {
        let mut view = View {
            now: Instant(1_000_000),
            phase: Phase::Run,
            next: None,
            placement: None,
            ball: None,
            ours: heapless::Vec::new(),
            theirs: heapless::Vec::new(),
            keeper: RobotId::ZERO,
            their_keeper: RobotId::ZERO,
            allowed: ROBOTS_MAX,
            in_play: RobotSet::default(),
            field: league.field(),
        };
        let position = self.place(&view, 0.9);
        view.ball = Some(Ball { position, velocity: Vector::default(), rest: position, height: 0.0 });
        for id in RobotId::all().take(usize::from(robots)) {
            let pace = if id.number() % 2 == 0 { 0.0 } else { 1.5 };
            let mut robot = || Robot {
                id,
                position: self.place(&view, 1.0),
                heading: Angle::ZERO,
                velocity: Vector::new(self.within(pace), self.within(pace)),
            };
            let (one, other) = (robot(), robot());
            // At most as many as have numbers.
            let _ = (view.ours.push(one), view.theirs.push(other));
        }
        view
    }
}

/// Moments in a row at which one search goes on.
const MOMENTS: u32 = 8;
/// Different moments.
const SCENES: u32 = 64;
/// Places rated in a row at one moment, as a search does; the moment's own part is in their cost.
const PLACES: u32 = 200;
