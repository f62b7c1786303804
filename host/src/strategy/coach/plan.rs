//! `plan`: the orders that the coach is building. Attack frame, m.

use geometry::{Angle, Attack, Point};
use protocol::RobotId;
use rules::{Phase, RuleRole};

use super::super::order::{Order, OrderReason, Role, Task};
use super::super::view::{ROBOTS_MAX, View, ViewRobot};
use super::super::{defence, off_ball, threat};
use super::{Free, Orders};

/// Orders so far, and the robots that have none yet.
pub(super) struct Plan<'v> {
    pub(super) view: &'v View,
    pub(super) orders: Orders,
    pub(super) free: Free,
}

impl<'v> Plan<'v> {
    /// A plan without orders.
    pub(super) fn new(view: &'v View) -> Self {
        Self { view, orders: Orders::new(), free: view.ours.iter().map(|r| r.id).collect() }
    }

    /// Sets the robot's order. While the ball is not in play no robot is sent to where the rules do not let
    /// it stand, nor to another robot's place: it would not get there.
    pub(super) fn order(&mut self, robot: RobotId, role: Role, task: Task, why: OrderReason) {
        let rule_role = match role {
            Role::Kicker => RuleRole::Kicker,
            _ if robot == self.view.keeper => RuleRole::Keeper,
            _ => RuleRole::Player,
        };
        let task = match task {
            Task::GoTo { at, face } if self.view.phase != Phase::Run => {
                let taken = self.places();
                let settings = threat::ThreatSettings::default();
                Task::GoTo { at: threat::legal_for(self.view, rule_role, at, &taken, &settings), face }
            }
            other => other,
        };
        // At most one order per robot, and as many places as robots.
        let _ = self.orders.push(Order { robot, role, task, why });
    }

    /// The places that are taken.
    fn places(&self) -> heapless::Vec<Point<Attack>, ROBOTS_MAX> {
        let tasks = self.orders.iter().map(|order| order.task);
        tasks.filter_map(|task| if let Task::GoTo { at, .. } = task { Some(at) } else { None }).collect()
    }

    /// Removes a robot from those without an order; false if it is not among them.
    pub(super) fn take(&mut self, id: RobotId) -> bool {
        let before = self.free.len();
        self.free.retain(|other| *other != id);
        self.free.len() < before
    }

    pub(super) fn keeper(&mut self) {
        if self.take(self.view.keeper) {
            let (task, why) = defence::keeper(self.view);
            self.order(self.view.keeper, Role::Keeper, task, why);
        }
    }

    pub(super) fn keeper_guards(&mut self) {
        if self.take(self.view.keeper) {
            self.order(self.view.keeper, Role::Keeper, defence::keeper_line(self.view), OrderReason::Referee);
        }
    }

    pub(super) fn all_robots(&mut self, role: Role, task: Task, why: OrderReason) {
        for id in core::mem::take(&mut self.free) {
            self.order(id, role, task, why);
        }
    }

    /// Orders the remaining robots to stay; while the ball is not in play by going to their present place, so
    /// that they leave forbidden areas.
    pub(super) fn stay_legal(&mut self) {
        let view = self.view;
        if view.phase == Phase::Run {
            return self.all_robots(Role::Player, Task::Stand, OrderReason::NoBall);
        }
        for id in core::mem::take(&mut self.free) {
            let here = |robot: &ViewRobot| Task::GoTo { at: robot.position, face: robot.heading };
            let task = view.our(id).map_or(Task::Stand, here);
            self.order(id, Role::Player, task, OrderReason::NoBall);
        }
    }

    pub(super) fn facing_ball(&self, at: Point<Attack>) -> Task {
        let face = self.view.ball.map_or(Angle::ZERO, |ball| at.direction_to(ball.position));
        Task::GoTo { at, face }
    }

    /// The place moved off the ball unless that is in play.
    pub(super) fn kept_off(&self, at: Point<Attack>) -> Point<Attack> {
        if self.view.phase == Phase::Run { at } else { off_ball::kept_off(self.view, at) }
    }
}
