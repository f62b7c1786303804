//! `challenge`: an opponent that has the ball, or clearly will have it first, is challenged: one robot stands
//! in the way of its shot or takes the ball, a second one comes from the other side. Attack frame, SI units.

use geometry::{Attack, Point, Vector};
use motion::trajectory::CalcMotion;
use protocol::{Duration, Instant, RobotId};

use super::super::order::{OrderReason, Role, Task};
use super::super::possession::arrival;
use super::super::view::{HAS_BALL_WITHIN_M, View, ViewBall, ViewRobot};
use super::super::{roles, support, threat};
use super::{Coach, Plan};

/// A defender at our area's edge leaves it for an opponent with the ball only where it is sooner there than
/// any other robot by this, s.
const WALL_LEAVES_FOR_S: f32 = 0.4;
/// A carrier is met where it will be after this time, s.
const CARRIED_FOR_S: f32 = 0.3;
/// Distance from the ball to the centre of the robot that stands in its way, m: robots keep 0.35 m off the
/// centre of one that moves (`brain`'s surroundings).
const BLOCKS_AT_M: f32 = 0.28;
/// This near the ball, m, a challenger takes it; with the carrier's body not before it: beside its way, by
/// the cosine, or farther off than the ball by this, m.
const TACKLES_WITHIN_M: f32 = 0.7;
const OPEN_COS: f32 = 0.9;
const OPEN_BY_M: f32 = 0.03;
/// A robot in the way of a shot, by the cosine; from nearer to our goal than this an opponent shoots, m.
const STANDS_COS: f32 = 0.85;
const SHOOTS_WITHIN_M: f32 = 2.5;
/// A carrier that may shoot faces our goal, by the cosine: within 45°.
const FACES_COS: f32 = 0.7;
/// A ball won from an opponent is pushed on by this, m.
const CLEARED_M: f32 = 2.0;
/// A second robot comes where the opponent has had the ball for this time, and it is there within this, s.
const SECOND_AFTER: Duration = Duration::millis(300);
const SECOND_WITHIN_S: f32 = 1.5;
/// A robot this near another opponent marks it, m.
const MARKS_WITHIN_M: f32 = 0.5;

impl Coach {
    /// The opponent that will have the ball, and where, if it is clearly sooner at it than ours. Keeps
    /// whether there is one: the next decision has hysteresis.
    pub(super) fn opponent_first_at_ball(
        &mut self,
        view: &View,
        ball: &ViewBall,
        ours: f32,
    ) -> Option<(RobotId, Point<Attack>)> {
        let limits = &self.passes.kicks().constants().opponent;
        let of = |robot: &ViewRobot| {
            arrival(robot, (ball, view), self.passes.kicks().ground(), limits, view.our_goal())
        };
        // Who took their restart may not touch it again.
        let may_touch = view.theirs.iter().filter(|robot| self.pass.their_kicker != Some(robot.id));
        let theirs = roles::choose(may_touch, None, 0.0, |robot| of(robot).seconds);
        let worth = if self.open_play.attacked { -roles::WORTH } else { roles::WORTH };
        let sooner = theirs.filter(|(_, seconds)| {
            self.open_play.rated.possession.owner().is_none() && seconds + worth < ours
        });
        self.open_play.attacked = sooner.is_some();
        let robot = view.theirs.iter().find(|robot| sooner.is_some_and(|(id, _)| id == robot.id))?;
        Some((robot.id, of(robot).ball))
    }

    /// One robot takes the ball off `opponent`, or stands before it on its way to our goal; where it shields
    /// the ball a second one comes from the other side. The others defend.
    pub(super) fn challenge(
        &mut self,
        plan: &mut Plan<'_>,
        ball: &ViewBall,
        (opponent, has_at): (RobotId, Point<Attack>),
        since: Instant,
    ) {
        let view = plan.view;
        self.open_play.attacked = true;
        self.open_play.rated.chosen = None;
        if let Some(carrier) = view.theirs.iter().find(|robot| robot.id == opponent) {
            let at = blocks_carrier(view, has_at, carrier);
            let first = self.challenger(plan, at, self.roles.ball_player);
            self.roles.ball_player = first.map(|robot| robot.id);
            if let Some(robot) = first {
                Self::order_challenge(plan, ball, carrier, (robot, at, false));
                let ahead = (ball.position - robot.position).unit().unwrap_or_default();
                let behind = threat::legal(
                    view,
                    ball.position + ahead * BLOCKS_AT_M,
                    &threat::ThreatSettings::default(),
                );
                let second = self.challenger(plan, behind, self.open_play.rated.second);
                let second = second.filter(|robot| {
                    let idle = view.theirs.iter().all(|other| {
                        other.id == opponent || other.position.distance(robot.position) > MARKS_WITHIN_M
                    });
                    let limits = &self.passes.kicks().constants().receiver;
                    let near = limits.time(robot.position, robot.velocity, behind) < SECOND_WITHIN_S;
                    let wall = self.roles.defenders.contains(&Some(robot.id));
                    idle && near && !wall && view.now.since(since) > SECOND_AFTER
                });
                self.open_play.rated.second = second.map(|robot| robot.id);
                if let Some(robot) = second {
                    Self::order_challenge(plan, ball, carrier, (robot, behind, true));
                }
            }
        }
        self.defend(plan, true);
        self.support_pass(plan, ball.position, None);
    }

    /// The free field player that is at `at` first; the wall is not thinned for a little time.
    fn challenger<'v>(
        &self,
        plan: &Plan<'v>,
        at: Point<Attack>,
        held: Option<RobotId>,
    ) -> Option<&'v ViewRobot> {
        let view = plan.view;
        let limits = self.passes.kicks().constants().receiver;
        let free = view.ours.iter().filter(|robot| plan.free.contains(&robot.id) && robot.id != view.keeper);
        let (id, _) = roles::choose(free, held, roles::WORTH, |robot| {
            limits.time(robot.position, robot.velocity, at) + self.wall_stays(robot.id)
        })?;
        view.our(id)
    }

    /// Time by which a robot of the wall counts as later at a ball, s.
    pub(super) fn wall_stays(&self, id: RobotId) -> f32 {
        if self.roles.defenders.contains(&Some(id)) { WALL_LEAVES_FOR_S } else { 0.0 }
    }

    /// Orders a challenger to its place, or, near the ball, to take that and clear it; `blocked`: another one
    /// stands in the way of the carrier's shot.
    fn order_challenge(
        plan: &mut Plan<'_>,
        ball: &ViewBall,
        carrier: &ViewRobot,
        (robot, at, blocked): (&ViewRobot, Point<Attack>, bool),
    ) {
        let view = plan.view;
        if !plan.take(robot.id) {
            return;
        }
        let off = ball.position - robot.position;
        let to_carrier = carrier.position - robot.position;
        // The carrier's body is not between.
        let open = off.dot(to_carrier) < OPEN_COS * off.norm() * to_carrier.norm()
            || off.norm() < to_carrier.norm() - OPEN_BY_M;
        // Near our goal its shot is blocked first.
        let to_goal = view.our_goal() - ball.position;
        let stands = -off.dot(to_goal) > STANDS_COS * off.norm() * to_goal.norm();
        let heading = Vector::polar(1.0, carrier.heading);
        let shoots = to_goal.norm() < SHOOTS_WITHIN_M && heading.dot(to_goal) > FACES_COS * to_goal.norm();
        let open = open && (stands || !shoots || blocked);
        let task = if off.norm() < TACKLES_WITHIN_M && open {
            let kick = support::push_kick(CLEARED_M);
            // Never towards our own goal line.
            let ray = Vector::new(off.x().abs(), off.y()).unit().unwrap_or_default();
            Task::Kick { at: ball.position + ray * CLEARED_M, kick }
        } else {
            Task::GoTo { at, face: at.direction_to(ball.position) }
        };
        plan.order(robot.id, Role::Player, task, OrderReason::Challenges { opponent: carrier.id });
    }
}

/// Place of a body before a carrier, on the line to our goal from where it will be soon.
fn blocks_carrier(view: &View, has_at: Point<Attack>, carrier: &ViewRobot) -> Point<Attack> {
    let carried = carrier.position.distance(has_at) < HAS_BALL_WITHIN_M;
    let there = if carried { has_at + carrier.velocity * CARRIED_FOR_S } else { has_at };
    let home = (view.our_goal() - there).unit().unwrap_or_default();
    threat::legal(view, there + home * BLOCKS_AT_M, &threat::ThreatSettings::default())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::strategy::Team;
    use crate::strategy::coach::Orders;
    use crate::strategy::tactics::Tactics;
    use crate::strategy::view::tests::view;
    use rules::League;

    const OURS: [(f32, f32); 6] =
        [(-4.4, 0.0), (-3.3, 0.3), (-3.3, -0.3), (-2.6, 1.1), (0.5, 1.5), (0.5, -1.5)];

    /// Orders against an opponent at `carrier` that faces our goal with the ball before it.
    fn against(carrier: (f32, f32)) -> (View, Orders) {
        let at = Point::new(carrier.0, carrier.1);
        let mut view = view(carrier, &OURS, &[(4.4, 0.0), carrier, (1.0, -1.0)]);
        let home = (view.our_goal() - at).unit().unwrap();
        view.theirs[1].heading = home.angle();
        view.ball = Some(ViewBall::at_rest(at + home * 0.1));
        let orders = Coach::new(Team::Ours, Tactics::default(), League::DivisionB).decide(&view);
        (view, orders)
    }

    #[test]
    fn a_carrier_near_our_goal_is_blocked_by_a_robot_outside_the_wall() {
        let (view, orders) = against((-2.4, 0.8));
        let challengers: Vec<_> =
            orders.iter().filter(|order| matches!(order.why, OrderReason::Challenges { .. })).collect();
        let [challenger] = challengers[..] else { panic!("{orders:?}") };
        assert_eq!(challenger.robot.number(), 3);
        let Task::GoTo { at, .. } = challenger.task else { panic!("{challenger:?}") };
        let ball = view.ball.unwrap().position;
        let line = geometry::Segment::new(ball, view.our_goal());
        assert!(line.distance_to(at) < 0.02 && at.distance(ball) < 0.35, "{at:?}");
        assert!(orders.iter().all(|order| !matches!(order.task, Task::Pass { .. })), "{orders:?}");
    }

    #[test]
    fn a_robot_that_blocks_a_carrier_takes_the_ball_and_the_wall_stays() {
        let (mut view, _) = against((-2.4, 0.8));
        let ball = view.ball.unwrap().position;
        view.ours[3].position = ball + (view.our_goal() - ball).unit().unwrap() * 0.25;
        let orders = Coach::new(Team::Ours, Tactics::default(), League::DivisionB).decide(&view);
        assert!(matches!(orders[3].task, Task::Kick { .. }), "{:?}", orders[3]);
        for wall in [1, 2] {
            assert!(matches!(orders[wall].role, Role::Defender(_)), "{:?}", orders[wall]);
        }
    }
}
