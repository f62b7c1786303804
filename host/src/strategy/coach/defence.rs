//! `defence`: defence of our goal: keeper and two defenders on the ball's line; by threats, if the team plays
//! them (Biswas et al. 2014 §5).

use geometry::{Attack, Point};
use protocol::{Duration, Instant, RobotId};
use rules::limits::ROBOT_RADIUS;
use rules::{Phase, Side, contact};

use super::super::order::{OrderReason, Role, Task};
use super::super::threat::{self, receiving::comes_at_goal};
use super::super::view::{RobotSet, View, ViewBall};
use super::super::{defence, roles};
use super::{Coach, Plan};

/// The ball is in the other half once it is this far beyond the halfway line, m.
const HALFWAY_MARGIN_M: f32 = 0.3;
/// Outside our area, but nearer to it than this, the ball is cleared, m, by the keeper if it is there first:
/// a field player's centre is 0.11 m behind the ball it kicks and 0.17 m when it lines up, and there is no
/// room to go around it on the goal's side.
const KEEPERS_BALL_WITHIN_M: f32 = 0.3;
/// Where a field player lines up for such a ball its centre is this far off our area, m: a body, and the
/// distance robots keep (`brain`'s surroundings: 0.01 m off the line's middle of 0.01 m).
const OFF_OUR_AREA_M: f32 = 0.115;
/// Nearer than this to our area no field player gets behind the ball or beside it, m: a body.
const BEHIND_BALL_ROOM_M: f32 = ROBOT_RADIUS;
/// A ball this near a robot's centre, m, and this far from its heading, rad, is at its front.
const FRONT_WITHIN_M: f32 = contact::TOUCHES_WITHIN;
const FRONT_WITHIN_RAD: f32 = 0.4;
/// From such a ball to the nearest robot that only defends, m: a robot that lines up is 0.17 m behind it, and
/// two bodies are 0.18 m.
const CLEARANCE_ROOM_M: f32 = 0.4;
/// Cost of moving around a ball, s: half a circle of 0.2 m radius at moderate speed (estimate).
const AROUND_BALL_COST_S: f32 = 0.4;
/// Time for which a clearance is kept: to move around the ball, aim and kick.
const CLEARANCE_KEPT: Duration = Duration::millis(2500);
/// A clearance is kept while the ball is within this of where it lay, m.
const BALL_MOVED_M: f32 = 0.3;
/// A ball that comes at our goal faster than this is intercepted on its path, m/s: slower ones leave time to
/// approach.
const SHOT_SPEED_MIN_M_S: f32 = 0.5;

/// A running clearance: its robot, start and place.
#[derive(Clone, Copy, Debug)]
struct Clearance {
    who: RobotId,
    since: Instant,
    from: Point<Attack>,
    task: Task,
    why: OrderReason,
}

/// Memory of our defence.
#[derive(Clone, Debug, Default)]
pub(super) struct DefenceState {
    threats: threat::Memory,
    /// A primary defender has joined the attack.
    attacks: bool,
    /// The ball before our area is left to the keeper, or not; `None` while it lies elsewhere.
    keepers_ball: Option<bool>,
    /// The clearance of a ball in our area or before it.
    clearance: Option<Clearance>,
}

impl DefenceState {
    /// The place, moved where a field player clears the ball before our area: the others leave it room to get
    /// behind the ball.
    fn clear_of_clearance(&self, view: &View, id: RobotId, at: Point<Attack>) -> Point<Attack> {
        let (Some(ball), Some(robot)) = (view.ball, view.our(id)) else { return at };
        if self.keepers_ball != Some(false) || at.distance(ball.position) >= CLEARANCE_ROOM_M {
            return at;
        }
        let away =
            (robot.position - ball.position).unit().or_else(|| (ball.position - view.our_goal()).unit());
        let at = ball.position + away.unwrap_or_default() * CLEARANCE_ROOM_M;
        threat::legal(view, at, &threat::ThreatSettings::default())
    }

    /// The task of a field player that is first at a ball before our area.
    pub(super) fn clears_before_our_area(
        &mut self,
        view: &View,
        who: RobotId,
        ball: &ViewBall,
    ) -> Option<(Task, OrderReason)> {
        let robot = view.our(who).filter(|_| self.keepers_ball == Some(false))?;
        if !view.in_our_area(ball.position, BEHIND_BALL_ROOM_M) {
            return Some(self.kept_clearance(view, who, ball, |view| {
                let (at, kick, room) = defence::clearance_beside(view, robot, ball, OFF_OUR_AREA_M);
                (Task::Kick { at, kick }, OrderReason::BestTarget { room })
            }));
        }
        // There is no room behind it: it is approached from the field, and turned.
        let to_ball = ball.position - robot.position;
        let has =
            to_ball.norm() < FRONT_WITHIN_M && (to_ball.angle() - robot.heading).abs() < FRONT_WITHIN_RAD;
        if !has {
            let room = defence::room_along(view, robot.position, ball.position);
            return Some((Task::GetBall { face: ball.position + to_ball }, OrderReason::BestTarget { room }));
        }
        Some(self.kept_clearance(view, who, ball, |view| {
            let (at, kick, room) = defence::clearance_outwards(view, ball);
            (Task::Kick { at, kick }, OrderReason::BestTarget { room })
        }))
    }

    /// The keeper at its place; it clears a ball in our area, and intercepts a shot on its line.
    fn keeper(&mut self, view: &View, at: Point<Attack>, why: OrderReason) -> (Task, OrderReason) {
        let (task, usual) =
            if view.phase == Phase::Run { defence::keeper(view) } else { (defence::keeper_line(view), why) };
        let Some(ball) = view.ball else { return (task, why) };
        if matches!(usual, OrderReason::ClearsArea { .. }) {
            return self.kept_clearance(view, view.keeper, &ball, |_| (task, usual));
        }
        if self.keepers_ball == Some(true) && lies_before_our_area(view, &ball) {
            return self.kept_clearance(view, view.keeper, &ball, |view| {
                let (at, kick, room) = defence::clearance_outwards(view, &ball);
                (Task::Kick { at, kick }, OrderReason::ClearsArea { room })
            });
        }
        if ball.velocity.norm() > SHOT_SPEED_MIN_M_S && comes_at_goal(view, ball.position, ball.velocity) {
            return (task, why);
        }
        (Task::GoTo { at, face: at.direction_to(ball.position) }, why)
    }

    /// The earlier choice for a ball that still lies there: opponents that follow the robot's turns do not
    /// turn it back.
    fn kept_clearance(
        &mut self,
        view: &View,
        who: RobotId,
        ball: &ViewBall,
        choose: impl Fn(&View) -> (Task, OrderReason),
    ) -> (Task, OrderReason) {
        if let Some(kept) = &self.clearance
            && kept.who == who
            && kept.from.distance(ball.position) < BALL_MOVED_M
            && view.now.since(kept.since) < CLEARANCE_KEPT
        {
            return (kept.task, kept.why);
        }
        let (task, why) = choose(view);
        self.clearance = Some(Clearance { who, since: view.now, from: ball.position, task, why });
        (task, why)
    }
}

impl Coach {
    /// Keeper and defenders; while `attacked`, all free robots too if second-level threats are played.
    pub(super) fn defend(&mut self, plan: &mut Plan<'_>, attacked: bool) {
        if self.tactics.threats {
            return self.against_threats(plan, attacked && self.tactics.second_level);
        }
        if plan.view.phase == Phase::Run {
            plan.keeper();
        } else {
            plan.keeper_guards();
        }
        let (places, why) = defence::defenders(plan.view);
        let places = places.map(|at| plan.kept_off(at));
        self.roles.defenders = roles::assign(plan.view, &mut plan.free, &places, &self.roles.defenders);
        for (i, id) in self.roles.defenders.into_iter().enumerate() {
            if let Some(id) = id {
                plan.order(id, Role::Defender(i as u8), plan.facing_ball(places[i]), why);
            }
        }
    }

    fn against_threats(&mut self, plan: &mut Plan<'_>, all_robots: bool) {
        let view = plan.view;
        let mut team = self.primaries(plan);
        if all_robots {
            plan.free.iter().for_each(|id| team.insert(*id));
        }
        let defence =
            threat::defend(view, team, &mut self.defence.threats, &threat::ThreatSettings::default());
        self.roles.defenders = self.defence.threats.primaries();
        for (i, assignment) in defence.assignments.iter().enumerate() {
            let (id, why) = (assignment.robot, OrderReason::Threat(assignment.guards));
            if !plan.take(id) {
                continue;
            }
            if id == view.keeper {
                let (task, why) = self.defence.keeper(view, assignment.at, why);
                plan.order(id, Role::Keeper, task, why);
                continue;
            }
            // A primary defender keeps the role where it blocks a second-level shot from the edge.
            let primary = self.roles.defenders.iter().position(|defender| *defender == Some(id));
            let role = primary.map_or(Role::Marker(i as u8), |slot| Role::Defender(slot as u8));
            let at = self.defence.clear_of_clearance(view, id, plan.kept_off(assignment.at));
            plan.order(id, role, plan.facing_ball(at), why);
        }
    }

    /// Whether the ball before our area is left to our keeper: it is there first. Held until another robot is
    /// clearly sooner there.
    pub(super) fn is_keepers(&mut self, view: &View, ball: &ViewBall) -> bool {
        let keeper =
            view.our(view.keeper).filter(|_| self.tactics.threats && lies_before_our_area(view, ball));
        let Some(keeper) = keeper else {
            self.defence.keepers_ball = None;
            return false;
        };
        let home = ball.position.distance(view.our_goal());
        let players = view
            .ours
            .iter()
            .filter(|robot| robot.id != keeper.id && Some(robot.id) != self.pass.double_touch_blocked);
        let soonest = players
            .map(|robot| {
                // A robot that comes from the field drives around the ball first, or turns with it.
                let around =
                    if robot.position.distance(view.our_goal()) > home { AROUND_BALL_COST_S } else { 0.0 };
                roles::time_to(robot, ball.position) + around
            })
            .fold(f32::INFINITY, f32::min);
        let worth = match self.defence.keepers_ball {
            Some(true) => roles::WORTH,
            Some(false) => -roles::WORTH,
            None => 0.0,
        };
        let is = roles::time_to(keeper, ball.position) < soonest + worth;
        self.defence.keepers_ball = Some(is);
        is
    }

    /// Number of primary defenders: one where we attack in their half.
    fn stay_back(&mut self, view: &View) -> usize {
        let ours = match view.phase {
            Phase::Run => !self.open_play.attacked,
            Phase::FreeKick(side) => side == Side::Ours,
            _ => false,
        };
        let limit = if self.defence.attacks { -HALFWAY_MARGIN_M } else { HALFWAY_MARGIN_M };
        self.defence.attacks =
            self.tactics.rated && ours && view.ball.is_some_and(|ball| ball.position.x() > limit);
        if self.defence.attacks { 1 } else { 2 }
    }

    /// The two robots nearest to the defenders' places; a robot that was one stays one.
    pub(super) fn primaries(&mut self, plan: &Plan<'_>) -> RobotSet {
        let view = plan.view;
        let mut free = plan.free.clone();
        free.retain(|id| *id != view.keeper);
        let (places, _) = defence::defenders(view);
        let mut team = RobotSet::default();
        let stay = self.stay_back(view);
        for id in
            roles::assign(view, &mut free, &places, &self.roles.defenders).into_iter().flatten().take(stay)
        {
            team.insert(id);
        }
        team
    }
}

/// The ball is so near to our area that there is hardly room behind it, and slow enough to be kicked as it
/// lies.
fn lies_before_our_area(view: &View, ball: &ViewBall) -> bool {
    let inside = ball.position.x() > view.our_goal().x();
    view.phase == Phase::Run
        && inside
        && ball.velocity.norm() < defence::LYING_SPEED_MAX_M_S
        && view.in_our_area(ball.position, KEEPERS_BALL_WITHIN_M)
}
