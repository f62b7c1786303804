//! `bench`: which of our robots leave the field while there are more than allowed, and where they wait.
//! Attack frame, m.
//!
//! Rules of 2026, chapter on substitution, and the league's game controller, which counts every robot outside
//! the goal substitution area ([`rules::FieldSpec::goal_substitution_area`]). Where the field has that area
//! (division A, and every field for which vision sends one) a robot drives there and does not count any more;
//! it needs no robot handler, and comes back by itself. Where there is none (division B) it waits in the
//! centre substitution area for its robot handler, who may take it out while the game runs.

use geometry::{Angle, Attack, GoalEnd, Point};
use protocol::{Duration, Instant, RobotId};
use rules::{Phase, Side, limits};

use super::order::{Order, OrderReason, Role, Task};
use super::view::{ROBOTS_MAX, View, ViewRobot};
use super::{off_ball, restart};

/// Fewer robots of ours must have been allowed on the field for this time before one comes back: a robot that
/// vision lost for a moment calls none back.
const RETURN_AFTER: Duration = Duration::millis(1000);
/// Places on both sides together, at most.
const PLACES_MAX: usize = 32;
/// From one waiting robot's centre to the next one's, m: two radii and room for a robot handler's hand.
const SPACING_M: f32 = 0.25;
/// Places on each side at a penalty.
const PENALTY_PLACES_BESIDE: usize = 4;
/// From the goal's wall or the defence area to the first place, m: room for defenders.
const BESIDE_AREA_M: f32 = 0.35;
/// From the field's wall to a robot's side, m: the accuracy with which robots stop.
const FROM_WALL_M: f32 = 0.05;
/// From the halfway line, m: the controller counts a robot nearer than its radius as in the other half.
const FROM_HALFWAY_LINE_M: f32 = 0.3;
/// Behind the ball at a penalty, m: the rules' 1 m, a body and a margin.
const BEHIND_PENALTY_M: f32 = 1.3;
/// Cost of replacing the robot that goes for the ball, in m of path.
const BALL_PLAYER_COST_M: f32 = 20.0;
/// The same for a robot that plays a case.
const CASE_PLAYER_COST_M: f32 = 5.0;
/// Longer than every path out of the field, m: twice division A's diagonal.
const PATH_MAX_M: f32 = 30.0;

/// The robots that have left, or are leaving.
#[derive(Clone, Debug, Default)]
pub(super) struct Bench {
    off: heapless::Vec<RobotId, ROBOTS_MAX>,
    /// Since when fewer need to be off than are.
    fewer_since: Option<Instant>,
}

impl Bench {
    /// Chooses robots that must not play now; `first` goes for the ball or takes our restart, and is sent
    /// only where no other robot can be.
    ///
    /// The keeper is never sent. A robot that is off stays off, so that a card costs one drive out and one
    /// back.
    pub(super) fn choose(&mut self, view: &View, first: Option<RobotId>) -> &[RobotId] {
        self.off.retain(|id| *id != view.keeper && view.our(*id).is_some());
        // Robots that never answered cannot leave, and sending others in their place does not help: staff
        // placed them there and must remove them.
        let silent = view.uncommanded.saturating_sub(view.never_answered);
        let surplus = (view.ours.len() + silent).saturating_sub(view.allowed);
        while self.off.len() < surplus {
            let Some(id) = self.next(view, first) else { break };
            // Never full: as many places as robots.
            let _ = self.off.push(id);
        }
        if self.off.len() <= surplus {
            self.fewer_since = None;
        } else if view.now.since(*self.fewer_since.get_or_insert(view.now)) >= RETURN_AFTER {
            self.off.truncate(surplus);
            self.fewer_since = None;
        }
        &self.off
    }

    /// The orders of those that are off: each waits at a place of its own.
    pub(super) fn orders(&self, view: &View) -> heapless::Vec<Order, ROBOTS_MAX> {
        let mut free = waiting_places(view);
        let mut orders = heapless::Vec::new();
        for robot in self.off.iter().filter_map(|id| view.our(*id)) {
            let nearest = (0..free.len()).min_by(|a, b| {
                free[*a].distance(robot.position).total_cmp(&free[*b].distance(robot.position))
            });
            let at = nearest.map_or(robot.position, |i| free.swap_remove(i));
            let face = view.ball.map_or(Angle::ZERO, |ball| at.direction_to(ball.position));
            let why = OrderReason::TooMany { allowed: view.allowed };
            let _ = orders.push(Order {
                robot: robot.id,
                role: Role::Leaving,
                task: Task::GoTo { at, face },
                why,
            });
        }
        orders
    }

    /// The next robot to leave: the one that can be out soonest, and is not needed at the ball or in a case.
    fn next(&self, view: &View, first: Option<RobotId>) -> Option<RobotId> {
        let places = waiting_places(view);
        let cost = |robot: &ViewRobot| leaving_cost(view, robot, first, &places);
        let may = |robot: &&ViewRobot| robot.id != view.keeper && !self.off.contains(&robot.id);
        view.ours
            .iter()
            .filter(may)
            .min_by(|a, b| cost(a).total_cmp(&cost(b)).then(b.id.cmp(&a.id)))
            .map(|robot| robot.id)
    }
}

/// Cost of sending a robot off, m: its path to the nearest waiting place, and what it is doing.
fn leaving_cost(view: &View, robot: &ViewRobot, first: Option<RobotId>, places: &[Point<Attack>]) -> f32 {
    let out = places.iter().map(|at| at.distance(robot.position)).fold(f32::INFINITY, f32::min);
    let busy = if first == Some(robot.id) { BALL_PLAYER_COST_M } else { 0.0 };
    let plays = if view.in_play.has(robot.id) { CASE_PLAYER_COST_M } else { 0.0 };
    out.min(PATH_MAX_M) + busy + plays
}

/// Places where robots may wait now, off the ball and clear of a placement.
fn waiting_places(view: &View) -> heapless::Vec<Point<Attack>, PLACES_MAX> {
    let (half_length, touch) = (view.field.length * 0.5, view.field.width * 0.5);
    let penalty = match view.phase {
        Phase::PreparePenalty(side) | Phase::Penalty(side) => Some(side),
        _ => None,
    };
    let area = view.field.goal_substitution_area(GoalEnd::Negative).is_some();
    let (from, to) = match penalty {
        // At a penalty the controller requires every robot 1 m behind the ball, with no other condition: in
        // the margin they obstruct no robot.
        Some(side) if side == Side::Theirs || !area => {
            let back = if side == Side::Ours { -1.0 } else { 1.0 };
            // Where the ball will lie: the present place of a ball that still moves there has no meaning.
            let x = restart::penalty_spot(view, side == Side::Ours).x() + back * BEHIND_PENALTY_M;
            let y = touch + view.field.margin * 0.5;
            (Point::new(x, y), Point::new(x + back * SPACING_M * PENALTY_PLACES_BESIDE as f32, y))
        }
        // In the middle of where the whole body is in the area, and beside goal and defence area.
        _ if area => {
            let x = half_length + view.field.goal_line_margin - view.field.goal_substitution * 0.5;
            let from = (view.field.goal_width * 0.5 + view.field.goal_wall + limits::ROBOT_RADIUS)
                .max(view.field.penalty_width * 0.5)
                + BESIDE_AREA_M;
            let to = touch + view.field.margin - limits::ROBOT_RADIUS - FROM_WALL_M;
            (Point::new(-x, from), Point::new(-x, to.max(from)))
        }
        // In the margin, on our half, so that a kick-off does not wait for them.
        _ => {
            let y = touch + view.field.margin * 0.5;
            let reach = limits::SUBSTITUTION_REACH - limits::ROBOT_RADIUS;
            (Point::new(-FROM_HALFWAY_LINE_M, y), Point::new(-reach, y))
        }
    };
    let count = ((from.distance(to) / SPACING_M) as usize + 1).min(PLACES_MAX / 2);
    let step = (to - from).unit().unwrap_or_default() * SPACING_M;
    let along = (0..count).map(|i| from + step * i as f32);
    let both = along.flat_map(|at| [at, Point::new(at.x(), -at.y())]);
    let clear = |at: &Point<Attack>| off_ball::kept_off(view, *at) == *at;
    both.filter(clear).collect()
}

#[cfg(test)]
mod tests;
