//! What is there to count in defending and in planning a free kick? So many of one kind, on scenes of six or eleven against as many.
//!
//! `cargo run --release -p host --example defence_cost -- PART COUNT` does it and prints what came of it. Under callgrind, COUNT and
//! twice as many, the difference is what COUNT of them cost. PART: `defend`, `defend-eleven`, `cap-plan`, `cap-plan-eleven`,
//! `cap-watch`, `cap-attack`.

use std::process::ExitCode;

use geometry::{Angle, Attack, Point, Vector};
use host::strategy::View;
use host::strategy::coerce::tactics::Models;
use host::strategy::coerce::{self, ByPassLocation, Planner, Progress};
use host::strategy::pass::{Kicks, PassConstants};
use host::strategy::threat::{Memory, Settings, defend};
use host::strategy::view::{Ball, ROBOTS_MAX, Robot, RobotSet};
use motion::ball::BallModel;
use motion::ball::chip::ChipModel;
use protocol::{Duration, Instant, RobotId};
use rand_core::{RngCore, SeedableRng};
use rand_xoshiro::Xoshiro128PlusPlus;
use rules::{League, Phase, Side};

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [part, count] = &words[..] else { return usage() };
    let Ok(count) = count.parse::<u32>() else { return usage() };
    let said = match part.as_str() {
        "defend" => defences(League::DivisionB, 6, count),
        "defend-eleven" => defences(League::DivisionA, 11, count),
        "cap-plan" => plans(League::DivisionB, 6, count),
        "cap-plan-eleven" => plans(League::DivisionA, 11, count),
        "cap-watch" => watches(count, false),
        "cap-attack" => watches(count, true),
        _ => return usage(),
    };
    println!("{count} {part}: {said}");
    ExitCode::SUCCESS
}

fn usage() -> ExitCode {
    eprintln!("usage: defence_cost defend|defend-eleven|cap-plan|cap-plan-eleven|cap-watch|cap-attack COUNT");
    ExitCode::from(2)
}

/// The whole defence, over scenes in turn; each is looked at for a while, so that memory has something to hold.
fn defences(league: League, robots: u8, count: u32) -> String {
    let mut random = Random(Xoshiro128PlusPlus::seed_from_u64(1));
    let scenes: Vec<View> = (0..SCENES).map(|_| random.view(league, robots, Phase::Run)).collect();
    let (mut memory, mut given) = (Memory::default(), 0);
    let mut team = RobotSet::default();
    RobotId::all().take(usize::from(robots)).for_each(|id| team.insert(id));
    for i in 0..count {
        let view = &scenes[(i / 8 % SCENES) as usize];
        given += defend(view, team, &mut memory, &Settings::default()).assignments.len();
    }
    format!("{given} assignments")
}

/// Plans of free kicks, half of the opponents at a robot of ours.
fn plans(league: League, robots: u8, count: u32) -> String {
    let kicks = Kicks::new(PassConstants::of(league), BallModel::default(), ChipModel::default());
    let value = ByPassLocation::new(&kicks);
    let mut random = Random(Xoshiro128PlusPlus::seed_from_u64(2));
    let scenes: Vec<View> = (0..SCENES).map(|_| random.free_kick(league, robots)).collect();
    let (mut coercers, mut worth) = (0, 0.0_f64);
    for i in 0..count {
        let view = &scenes[(i % SCENES) as usize];
        let mut planner = Planner::new(coerce::Settings::of(league), Models::default());
        if let Some(plan) = planner.plan(view, &value, TAKER, u64::from(i)) {
            coercers += plan.coerce.coercers.len();
            worth += f64::from(plan.optimistic.worth.value());
        }
    }
    format!("{coercers} coercers, mean value {:.4}", worth / f64::from(count))
}

/// Ticks of a plan being executed; with `attack` each is the one that plans the attack anew, plan included.
fn watches(count: u32, attack: bool) -> String {
    let league = League::DivisionB;
    let kicks = Kicks::new(PassConstants::of(league), BallModel::default(), ChipModel::default());
    let value = ByPassLocation::new(&kicks);
    let mut random = Random(Xoshiro128PlusPlus::seed_from_u64(3));
    let mut view = random.free_kick(league, 6);
    let mut planner = Planner::new(coerce::Settings::of(league), Models::default());
    let (mut attacks, mut planned) = (0, planner.plan(&view, &value, TAKER, 1).is_some());
    for i in 0..count {
        if attack {
            planned &= planner.plan(&view, &value, TAKER, u64::from(i)).is_some();
            planner.watch(&view, &value);
            view.now += Duration::millis(5_000);
        } else {
            // A microsecond: coercing never ends.
            view.now += Duration(1);
        }
        attacks += u32::from(matches!(planner.watch(&view, &value), Progress::Attacking(_)));
    }
    format!("planned {planned}, {attacks} attacks")
}

struct Random(Xoshiro128PlusPlus);

impl Random {
    fn within(&mut self, range: f32) -> f32 {
        ((self.0.next_u32() >> 8) as f32 / 8_388_608.0 - 1.0) * range
    }

    /// Everybody somewhere, the ball rolling.
    fn view(&mut self, league: League, robots: u8, phase: Phase<Side>) -> View {
        let field = league.field();
        let (x, y) = (field.length * 0.5, field.width * 0.5);
        let mut place = |share: f32| Point::<Attack>::new(self.within(x * share), self.within(y * share));
        let position = place(0.9);
        let mut robot =
            |id| Robot { id, position: place(1.0), heading: Angle::ZERO, velocity: Vector::default() };
        let ours = RobotId::all().take(usize::from(robots)).map(&mut robot).collect();
        let theirs = RobotId::all().take(usize::from(robots)).map(&mut robot).collect();
        let velocity = Vector::new(self.within(3.0), self.within(3.0));
        View {
            now: Instant(1_000_000),
            phase,
            next: None,
            placement: None,
            ball: Some(Ball { position, velocity, rest: position, height: 0.0 }),
            ours,
            theirs,
            keeper: RobotId::ZERO,
            their_keeper: RobotId::ZERO,
            allowed: ROBOTS_MAX,
            in_play: RobotSet::default(),
            field,
        }
    }

    /// The same with a ball at rest and every second opponent at one of our robots.
    fn free_kick(&mut self, league: League, robots: u8) -> View {
        let mut view = self.view(league, robots, Phase::FreeKick(Side::Ours));
        if let Some(ball) = &mut view.ball {
            ball.velocity = Vector::default();
        }
        let goal = view.their_goal();
        for i in (2..view.theirs.len()).step_by(2) {
            let at = view.ours[i].position;
            view.theirs[i].position = at + (goal - at).clamped(0.3);
        }
        view
    }
}

/// Takes the free kick.
const TAKER: RobotId = match RobotId::new(1) {
    Some(id) => id,
    None => RobotId::ZERO,
};
/// Different moments.
const SCENES: u32 = 64;
