//! `coercing`: positions that draw followers away (Biswas et al. 2014 §4.3: the coerce plan). Attack frame,
//! m, s.
//!
//! For every opponent that follows robots, the robot of ours that it follows is sent to a cell. In every cell
//! of the grid: the opponent is expected at its usual distance from our robot there, and the *interference
//! likelihood* is the probability that it then intercepts the pass or the shot of the optimistic attack. The
//! cell with the least is taken, one robot after the other, each time with the opponents of earlier ones at
//! their expected places.

use geometry::{Attack, Point, Segment};
use motion::trajectory::CalcMotion;
use protocol::RobotId;

use super::super::view::{ROBOTS_MAX, View, ViewRobot};
use super::attack::{AttackPlan, PassValue};
use super::detect::Detected;
use super::grid::{CELLS, Cell};
use super::{CoerceSettings, tactics};

/// Likelihoods are compared in hundredths.
const LIKELIHOOD_STEPS: f32 = 100.0;

/// One robot of ours, the opponent that it draws, and its place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coercer {
    /// Our robot, which draws the opponent.
    pub robot: RobotId,
    /// The opponent that follows it.
    pub marker: RobotId,
    /// Cell of the grid to which it goes.
    pub cell: Cell,
    /// The middle of that cell.
    pub at: Point<Attack>,
    /// Expected place of the opponent then, m.
    pub expected: Point<Attack>,
    /// The interference likelihood of that opponent there …
    pub interference: f32,
    /// Probability that it interferes from where it is now.
    pub interference_now: f32,
    /// When our robot is there, s.
    pub time: f32,
}

/// The coerce plan, and the interference likelihood of every cell for the first robot of it (1 where no robot
/// is sent), for figures.
#[derive(Clone, Debug, PartialEq)]
pub struct CoercePlan {
    /// The coercers with their places.
    pub coercers: heapless::Vec<Coercer, ROBOTS_MAX>,
    /// Interference likelihood of each cell, by [`Cell::index`].
    pub first: [f32; CELLS],
}

/// An opponent that follows robots, and the robot of ours that draws it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// The opponent that follows robots.
    pub marker: Detected,
    /// Our robot, which draws it.
    pub robot: RobotId,
}

/// Pairs each opponent with the robot of ours that it follows, else the nearest that draws no opponent yet.
pub fn pairs(
    view: &View,
    detected: &[Detected],
    field_players: &[RobotId],
) -> heapless::Vec<Pair, ROBOTS_MAX> {
    let mut pairs: heapless::Vec<Pair, ROBOTS_MAX> = heapless::Vec::new();
    let markers = || detected.iter().filter(|opponent| opponent.follows_robots());
    for marker in markers() {
        if let Some(robot) = marker.follows.filter(|robot| field_players.contains(robot))
            && pairs.iter().all(|pair| pair.robot != robot)
        {
            // At most one per robot.
            let _ = pairs.push(Pair { marker: *marker, robot });
        }
    }
    for marker in markers() {
        if pairs.iter().any(|pair| pair.marker.opponent == marker.opponent) {
            continue;
        }
        let free = view.ours.iter().filter(|robot| {
            field_players.contains(&robot.id) && pairs.iter().all(|pair| pair.robot != robot.id)
        });
        if let Some((robot, _)) = super::super::view::nearest(free, marker.at) {
            let _ = pairs.push(Pair { marker: *marker, robot: robot.id });
        }
    }
    pairs
}

/// Probability that an opponent standing at `at` intercepts the pass, or the shot after it.
pub fn interference(
    value: &dyn PassValue,
    opponent: &ViewRobot,
    at: Point<Attack>,
    from: Point<Attack>,
    attack: &AttackPlan,
) -> f32 {
    let standing = ViewRobot { position: at, velocity: geometry::Vector::default(), ..*opponent };
    let pass = value.meets_pass(&standing, from, attack.at);
    let shot = value.meets_shot(&standing, attack.at, attack.worth.aim);
    1.0 - (1.0 - pass) * (1.0 - shot)
}

/// The coerce plan for an optimistic attack.
pub fn coerce(
    value: &dyn PassValue,
    situation: &tactics::CoerceSituation<'_>,
    pairs: &[Pair],
    attack: &AttackPlan,
    settings: &CoerceSettings,
) -> CoercePlan {
    let view = situation.view;
    let mut plan = CoercePlan { coercers: heapless::Vec::new(), first: [1.0; CELLS] };
    let Some(ball) = view.ball else { return plan };
    let from = ball.position;
    let body = |id: RobotId| view.theirs.iter().find(|robot| robot.id == id);
    let likely = |marker: &Detected, at| {
        body(marker.opponent).map_or(0.0, |robot| interference(value, robot, at, from, attack))
    };
    // The opponent that interferes most is drawn first: it has the choice of cells.
    let mut order: heapless::Vec<(Pair, f32), ROBOTS_MAX> =
        pairs.iter().map(|pair| (*pair, likely(&pair.marker, pair.marker.at))).collect();
    order.sort_unstable_by(|a, b| b.1.total_cmp(&a.1).then(a.0.marker.opponent.cmp(&b.0.marker.opponent)));
    for (i, (pair, now)) in order.iter().enumerate() {
        let Some(robot) = view.our(pair.robot) else { continue };
        let mut best: Option<(u32, f32, Coercer)> = None;
        for cell in Cell::all() {
            let at = cell.middle(&view.field);
            let time = settings.robot.time(robot.position, robot.velocity, at);
            let taken = cell == attack.cell || plan.coercers.iter().any(|other| other.cell == cell);
            if taken || time > settings.coerce_time || !may_go(view, attack, from, at, settings) {
                continue;
            }
            let expected = response(situation, &pair.marker, at);
            let interference = likely(&pair.marker, expected);
            if i == 0 {
                plan.first[cell.index()] = interference;
            }
            // Likelihoods that differ by less than a hundredth are equal: then the shorter path.
            let step = (interference * LIKELIHOOD_STEPS) as u32;
            if best.is_none_or(|(least, shortest, _)| (step, time) < (least, shortest)) {
                let (robot, marker, interference_now) = (robot.id, pair.marker.opponent, *now);
                let coercer =
                    Coercer { robot, marker, cell, at, expected, interference, interference_now, time };
                best = Some((step, time, coercer));
            }
        }
        if let Some((_, _, coercer)) = best {
            // At most one per robot.
            let _ = plan.coercers.push(coercer);
        }
    }
    plan
}

/// Place to which an opponent that follows robots drives when the one it follows is at `at`: to its distance
/// from it, on the side that it keeps to.
pub fn response(
    situation: &tactics::CoerceSituation<'_>,
    marker: &Detected,
    at: Point<Attack>,
) -> Point<Attack> {
    let [goal_side, ball_side] = situation.mark_places(at, marker.stand_off);
    if marker.ball_side { ball_side } else { goal_side }
}

/// Whether a robot of ours may be sent to a place: the rules allow it, and it is off the ball, the pass and
/// the shot.
fn may_go(
    view: &View,
    attack: &AttackPlan,
    from: Point<Attack>,
    at: Point<Attack>,
    settings: &CoerceSettings,
) -> bool {
    let areas = view.in_our_area(at, settings.off_areas) || view.in_their_area(at, settings.off_areas);
    let pass = Segment::new(from, attack.at).distance_to(at);
    let shot = Segment::new(attack.at, attack.worth.aim).distance_to(at);
    !areas && pass.min(shot) >= settings.off_ways && at.distance(from) >= settings.off_ball
}
