//! `defence`: defence of our goal: keeper and two defenders on the ball's line; by threats, if the team plays
//! them (Biswas et al. 2014 §5).

use geometry::{Angle, Attack, Point, Segment, Vector};
use protocol::{Duration, Instant, RobotId};
use rules::limits::ROBOT_RADIUS;
use rules::{Phase, Side, contact};

use super::super::order::{OrderReason, Role, Task};
use super::super::pass::Kicks;
use super::super::threat::{self, receiving::comes_at_goal};
use super::super::view::{RobotSet, View, ViewBall, ViewRobot};
use super::super::{clear, defence, roles};
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
/// Two robots side by side, m.
const BODIES_APART_M: f32 = 0.2;
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

/// The keeper takes a rebound this near to it at up to this speed, m, m/s.
const REBOUND_WITHIN_M: f32 = 0.5;
const REBOUND_SPEED_MAX_M_S: f32 = 1.2;
/// From the ball to the centre of a robot that lines up behind it, m (`brain`'s get_ball).
const BEHIND_BALL_M: f32 = 0.165;
/// Number of sides from which it may be taken.
const TAKEN_FROM: i16 = 24;
/// Between a body and the goal's walls, m; how far behind its line a centre may be in the goal.
const OFF_WALLS_M: f32 = 0.02;
const IN_GOAL_MAX_M: f32 = 0.05;
/// Another clearance is better by this, P(goal).
const CLEARED_BETTER_BY: f32 = 0.02;
/// The keeper leaves its area for a ball at which it is sooner than any opponent by this, s.
const KEEPER_OUT_SOONER_S: f32 = 0.4;

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

    /// The task of a field player that is first at a ball before our area: its clearance, by the list. Where
    /// it has no room behind the ball it comes from the field, and turns it.
    pub(super) fn clears_before_our_area(
        &mut self,
        view: &View,
        kicks: &Kicks,
        who: RobotId,
        ball: &ViewBall,
    ) -> Option<(Task, OrderReason)> {
        let robot = view.our(who).filter(|_| self.keepers_ball == Some(false))?;
        let straight = ball.position - robot.position;
        Some(self.clears(
            view,
            kicks,
            (robot, ball),
            |ray| {
                let at = ball.position - ray * BEHIND_BALL_M;
                let mut mates = view.ours.iter().filter(|mate| mate.id != who && mate.id != view.keeper);
                !view.in_our_area(at, OFF_OUR_AREA_M)
                    && mates.all(|mate| mate.position.distance(at) > BODIES_APART_M)
            },
            ball.position + straight,
        ))
    }

    /// The keeper at its place; it clears a ball in our area, and intercepts a shot on its line.
    fn keeper(
        &mut self,
        view: &View,
        kicks: Option<&Kicks>,
        at: Point<Attack>,
        why: OrderReason,
    ) -> (Task, OrderReason) {
        if let (Some(kicks), Some(ball), Some(keeper)) = (kicks, view.ball, view.our(view.keeper))
            && self.keeper_plays(view, keeper, &ball)
        {
            return self.keeper_clears(view, kicks, keeper, &ball);
        }
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

    /// Whether the keeper plays the ball: a slow one in its area or at its goal line, or before the area
    /// where it is first.
    fn keeper_plays(&self, view: &View, keeper: &ViewRobot, ball: &ViewBall) -> bool {
        let speed = ball.velocity.norm();
        let near = keeper.position.distance(ball.position) < REBOUND_WITHIN_M;
        let slow = speed < if near { REBOUND_SPEED_MAX_M_S } else { defence::LYING_SPEED_MAX_M_S };
        let shot = speed > SHOT_SPEED_MIN_M_S && comes_at_goal(view, ball.position, ball.velocity);
        let before = self.keepers_ball == Some(true) && lies_before_our_area(view, ball);
        view.phase == Phase::Run
            && slow
            && !shot
            && ball.height < defence::GROUND_HEIGHT_MAX_M
            && (before || view.in_our_area(ball.position, 0.0))
    }

    /// The keeper's clearance. Where no body fits behind the ball it is taken from a side on which one does,
    /// and turned.
    fn keeper_clears(
        &mut self,
        view: &View,
        kicks: &Kicks,
        keeper: &ViewRobot,
        ball: &ViewBall,
    ) -> (Task, OrderReason) {
        let from = ball.position;
        let straight = from - keeper.position;
        let rays = (0..TAKEN_FROM)
            .map(|step| Vector::polar(1.0, Angle::degrees(360.0 / f32::from(TAKEN_FROM) * f32::from(step))));
        let ray = rays
            .filter(|ray| has_room(view, from - *ray * contact::TOUCHES_WITHIN))
            .max_by(|a, b| a.dot(straight).total_cmp(&b.dot(straight)));
        self.clears(
            view,
            kicks,
            (keeper, ball),
            |ray| {
                let places = [BEHIND_BALL_M, contact::TOUCHES_WITHIN].map(|off| from - ray * off);
                places.iter().all(|at| has_room(view, *at))
            },
            from + ray.unwrap_or(straight),
        )
    }

    /// A clearance by the same list as everyone's, in a direction that `fits` or with a ball at the robot's
    /// front, looked at again until the ball leaves; without one the ball is taken towards `face`.
    fn clears(
        &mut self,
        view: &View,
        kicks: &Kicks,
        (robot, ball): (&ViewRobot, &ViewBall),
        fits: impl Fn(Vector<Attack>) -> bool,
        face: Point<Attack>,
    ) -> (Task, OrderReason) {
        let from = ball.position;
        let has = has_at_front(robot, ball) || view.contact.has(robot.id);
        let fits = |ray| has || fits(ray);
        let room = |at| {
            let room = view.room_along(from, at);
            let keeper = robot.id == view.keeper;
            if keeper { OrderReason::ClearsArea { room } } else { OrderReason::BestTarget { room } }
        };
        let Some(best) = clear::clearance(view, kicks, robot, from, fits) else {
            return (Task::GetBall { face }, room(face));
        };
        let kept = self.clearance.filter(|kept| {
            kept.who == robot.id
                && kept.from.distance(from) < BALL_MOVED_M
                && view.now.since(kept.since) < CLEARANCE_KEPT
        });
        if let Some(kept) = kept
            && let Task::Kick { at, kick } = kept.task
            && (at - from).unit().is_some_and(fits)
            && clear::worth_again(view, kicks, robot, from, (at, kick)) > best.worth - CLEARED_BETTER_BY
        {
            return (kept.task, room(at));
        }
        let (task, why) = (Task::Kick { at: best.at, kick: best.kick }, room(best.at));
        self.clearance = Some(Clearance { who: robot.id, since: view.now, from, task, why });
        (task, why)
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
        // Who took their restart may not touch the ball again.
        let kicker = self.pass.their_kicker;
        let threats = kicker.map(|kicker| {
            let mut threats = view.clone();
            threats.theirs.retain(|robot| robot.id != kicker);
            threats
        });
        let defence = threat::defend(
            threats.as_ref().unwrap_or(view),
            team,
            &mut self.defence.threats,
            &threat::ThreatSettings::default(),
        );
        self.roles.defenders = self.defence.threats.primaries();
        for (i, assignment) in defence.assignments.iter().enumerate() {
            let (id, why) = (assignment.robot, OrderReason::Threat(assignment.guards));
            if !plan.take(id) {
                continue;
            }
            if id == view.keeper {
                let kicks = self.tactics.rated.then(|| self.passes.kicks());
                let (task, why) = self.defence.keeper(view, kicks, assignment.at, why);
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
        let own = roles::time_to(keeper, ball.position);
        // With the goal empty behind it, it must not meet an opponent there.
        let theirs = view
            .theirs
            .iter()
            .map(|robot| roles::time_to(robot, ball.position))
            .fold(f32::INFINITY, f32::min);
        let alone = !self.tactics.rated || own + KEEPER_OUT_SOONER_S < theirs + worth;
        let is = own < soonest + worth && alone;
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

/// Whether the ball lies at the robot's front.
fn has_at_front(robot: &ViewRobot, ball: &ViewBall) -> bool {
    let to_ball = ball.position - robot.position;
    to_ball.norm() < FRONT_WITHIN_M && (to_ball.angle() - robot.heading).abs() < FRONT_WITHIN_RAD
}

/// Whether a body has room there beside our goal's walls, and on the field surface behind its line.
fn has_room(view: &View, at: Point<Attack>) -> bool {
    let (goal, field) = (view.our_goal(), &view.field);
    let off_walls = [0.5, -0.5].into_iter().all(|side| {
        let post = Point::new(goal.x(), side * field.goal_width);
        let back = Point::new(goal.x() - field.goal_depth, side * field.goal_width);
        Segment::new(post, back).distance_to(at) > ROBOT_RADIUS + OFF_WALLS_M
    });
    let in_goal = at.y().abs() < 0.5 * field.goal_width;
    let behind = if in_goal { IN_GOAL_MAX_M } else { field.goal_line_margin - ROBOT_RADIUS };
    off_walls && at.x() > goal.x() - behind
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
