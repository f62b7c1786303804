//! `defence`: instruction count of the defence and of free-kick planning. Whole decisions of a tick.

use host::strategy::View;
use host::strategy::coerce::tactics::Models;
use host::strategy::coerce::{self, ByPassLocation, CoerceProgress, Planner};
use host::strategy::pass::Kicks;
use host::strategy::threat::{Memory, ThreatSettings, defend};
use host::strategy::view::RobotSet;
use protocol::{Duration, RobotId};
use rules::League;

use crate::scenes::{Random, SCENES};

/// The whole defence over all scenes in turn; each scene is planned for several steps, so that the state kept
/// between steps matters.
pub(crate) fn defences(league: League, robots: u8, count: u32) -> String {
    let mut random = Random::new(1);
    let scenes: Vec<View> = (0..SCENES).map(|_| random.rolling(league, robots)).collect();
    let (mut memory, mut given) = (Memory::default(), 0);
    let mut team = RobotSet::default();
    RobotId::all().take(usize::from(robots)).for_each(|id| team.insert(id));
    for i in 0..count {
        let view = &scenes[(i / 8 % SCENES) as usize];
        given += defend(view, team, &mut memory, &ThreatSettings::default()).assignments.len();
    }
    format!("{given} assignments")
}

/// Plans of free kicks, with half of the opponents at one of our robots each.
pub(crate) fn plans(league: League, robots: u8, count: u32) -> String {
    let kicks = Kicks::of(league);
    let value = ByPassLocation::new(&kicks);
    let mut random = Random::new(2);
    let scenes: Vec<View> = (0..SCENES).map(|_| random.free_kick(league, robots)).collect();
    let (mut coercers, mut worth) = (0, 0.0_f64);
    for i in 0..count {
        let view = &scenes[(i % SCENES) as usize];
        let mut planner = Planner::new(coerce::CoerceSettings::of(league), Models::default());
        if let Some(plan) = planner.plan(view, &value, KICKER, u64::from(i)) {
            coercers += plan.coerce.coercers.len();
            worth += f64::from(plan.optimistic.worth.value());
        }
    }
    format!("{coercers} coercers, mean value {:.4}", worth / f64::from(count))
}

/// Ticks of a plan being executed; with `attack` each is the tick that replans the attack, planning included.
pub(crate) fn watches(count: u32, attack: bool) -> String {
    let league = League::DivisionB;
    let kicks = Kicks::of(league);
    let value = ByPassLocation::new(&kicks);
    let mut random = Random::new(3);
    // A free kick for which coercing is worth it; for most it is not.
    let (mut view, mut planner) = loop {
        let view = random.free_kick(league, 6);
        let mut planner = Planner::new(coerce::CoerceSettings::of(league), Models::default());
        if planner.plan(&view, &value, KICKER, 1).is_some() {
            break (view, planner);
        }
    };
    let (mut attacks, mut planned, mut coercing) = (0, 1, 0);
    for i in 0..count {
        if attack {
            planned += u32::from(planner.plan(&view, &value, KICKER, u64::from(i)).is_some());
            planner.watch(&view, &value);
            view.now += Duration::millis(5_000);
        } else {
            // A microsecond: coercing never ends.
            view.now += Duration(1);
        }
        match planner.watch(&view, &value) {
            CoerceProgress::Attacking(_) => attacks += 1,
            CoerceProgress::Coercing { .. } => coercing += 1,
            _ => {}
        }
    }
    format!("{planned} plans, {attacks} attacks, {coercing} ticks of coercing")
}

/// Number of the robot that takes the free kick.
const KICKER: RobotId = match RobotId::new(1) {
    Some(id) => id,
    None => RobotId::ZERO,
};
