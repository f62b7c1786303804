//! `open_play`: assignment while the ball is in play: player, defenders, robots free for cases.

use casebase::CaseBase;
use geometry::{Attack, Point};
use protocol::{Instant, RobotId};

use super::super::order::{OrderReason, Role, Task};
use super::super::view::{View, ViewBall};
use super::super::{roles, support};
use super::attack::Intent;
use super::playable::is_left_to_the_keeper;
use super::rated_play::RatedPlay;
use super::uncover::Uncovering;
use super::{Coach, Plan};

/// A robot that plays a case counts as this much nearer to the ball, s: a change of robots would end the
/// case.
const CASE_PLAYER_BONUS_S: f32 = 1.0;

/// Memory of open play.
#[derive(Clone, Debug)]
pub(super) struct OpenPlayState {
    /// Opponents have the ball.
    pub(super) attacked: bool,
    /// The shot, pass or case chosen by thresholds.
    pub(super) intent: Option<Intent>,
    /// The passer that was at the ball last, and when.
    pub(super) at_ball: Option<(RobotId, Instant)>,
    /// The robot that makes way so that cameras see the ball.
    pub(super) uncovering: Option<Uncovering>,
    pub(super) rated: RatedPlay,
}

impl OpenPlayState {
    /// Memory without a ball, retrieving from `cases`.
    pub(super) fn new(cases: CaseBase<'static>) -> Self {
        let rated = RatedPlay::new(cases);
        Self { attacked: false, intent: None, at_ball: None, uncovering: None, rated }
    }

    /// Drops what was chosen when another phase starts.
    pub(super) fn reset(&mut self) {
        self.intent = None;
        self.rated.reset();
    }
}

impl Coach {
    /// Open play: keeper, the robot first at the ball, two defenders, the others.
    pub(super) fn open_play(&mut self, plan: &mut Plan<'_>) {
        let view = plan.view;
        let Some(ball) = view.ball else { return self.defend(plan, false) };
        self.order_double_touch_blocked(plan, &ball);
        self.order_uncovering(plan, &ball);
        self.see_pass_leave(view);
        let keepers = self.is_keepers(view, &ball);
        if self.order_receiver(plan, &ball).is_some() {
            self.defend(plan, false);
            return plan.all_robots(Role::Player, Task::Gameplay, OrderReason::OpenPlay);
        }
        if keepers || is_left_to_the_keeper(view, &ball) {
            self.roles.ball_player = None;
            self.defend(plan, self.open_play.attacked || keepers);
            return self.support(plan, ball.position);
        }
        // A keeper that left its goal for a ball could be passed by it.
        let candidates =
            view.ours.iter().filter(|robot| plan.free.contains(&robot.id) && robot.id != view.keeper);
        let soonest = roles::choose(candidates, self.roles.ball_player, roles::WORTH, |robot| {
            let bound = if view.in_play.has(robot.id) { CASE_PLAYER_BONUS_S } else { 0.0 };
            roles::time_to(robot, ball.rest) - bound
        });
        self.roles.ball_player = soonest.map(|(id, _)| id);
        self.see_whose_ball(view, soonest.map_or(f32::INFINITY, |(_, seconds)| seconds));
        if let Some((id, seconds)) = soonest
            && plan.take(id)
        {
            let clears = self.defence.clears_before_our_area(view, self.passes.kicks(), id, &ball);
            if let Some((task, why)) = clears.or_else(|| self.attack(plan, id, &ball)) {
                plan.order(id, Role::Player, task, why);
                self.defend(plan, self.open_play.attacked);
                return self.support(plan, ball.position);
            }
            plan.order(
                id,
                Role::Player,
                Task::Gameplay,
                OrderReason::SoonestAtBall { seconds: seconds.max(0.0) },
            );
        }
        self.play_cases(plan);
    }

    /// Orders all remaining robots to defend or to play cases; a robot that plays a case plays it to its end.
    pub(super) fn play_cases(&mut self, plan: &mut Plan<'_>) {
        Self::go_on_with_cases(plan);
        self.defend(plan, self.open_play.attacked);
        plan.all_robots(Role::Player, Task::Gameplay, OrderReason::OpenPlay);
    }

    /// Orders robots that play a case to go on, but for two that defend.
    pub(super) fn go_on_with_cases(plan: &mut Plan<'_>) {
        let view = plan.view;
        for robot in view.ours.iter().filter(|robot| view.in_play.has(robot.id)) {
            if plan.free.len() > 2 && plan.take(robot.id) {
                plan.order(robot.id, Role::Player, Task::Gameplay, OrderReason::OpenPlay);
            }
        }
    }

    /// The robot that must not touch the ball twice goes where a pass can come.
    pub(super) fn order_double_touch_blocked(&self, plan: &mut Plan<'_>, ball: &ViewBall) {
        if let Some(blocked) = self.pass.double_touch_blocked
            && plan.take(blocked)
        {
            let (at, worth) = best_place(plan.view, ball.position);
            let why = OrderReason::FreePlace { worth };
            plan.order(blocked, Role::DoubleTouchBlocked, plan.facing_ball(at), why);
        }
    }

    /// The receiver of a pass that is on its way is first at the ball; the place of the reception.
    pub(super) fn order_receiver(&mut self, plan: &mut Plan<'_>, ball: &ViewBall) -> Option<Point<Attack>> {
        let pass = self.pass.running.filter(|pass| plan.take(pass.receiver))?;
        self.roles.ball_player = Some(pass.receiver);
        let why = OrderReason::BestTarget { room: support::worth(plan.view, ball.position, pass.at) };
        plan.order(pass.receiver, Role::Receiver, Task::Receive { at: pass.at, then: pass.then }, why);
        Some(pass.at)
    }

    /// Updates whether the ball is theirs: one of them is clearly sooner at it than ours, `ours` s from now.
    fn see_whose_ball(&mut self, view: &View, ours: f32) {
        let Some(ball) = view.ball else { return };
        let theirs =
            view.theirs.iter().map(|robot| roles::time_to(robot, ball.rest)).fold(f32::INFINITY, f32::min);
        let worth = if self.open_play.attacked { -roles::WORTH } else { roles::WORTH };
        self.open_play.attacked = theirs + worth < ours;
    }
}

fn best_place(view: &View, ball: Point<Attack>) -> (Point<Attack>, f32) {
    support::places(view, ball, 1).first().copied().unwrap_or((Point::new(0.0, 0.0), 0.0))
}
