//! `penalty`: orders of all robots at a penalty, and in the stop before it. Attack frame, m.

use geometry::{Attack, Point};
use protocol::RobotId;
use rules::{Phase, Side};

use super::super::order::{OrderReason, Role};
use super::super::view::ROBOTS_MAX;
use super::super::{defence, restart};
use super::{Coach, Plan};

impl Coach {
    /// Penalty: kicker or keeper, all other robots behind the mark.
    pub(super) fn penalty(&mut self, plan: &mut Plan<'_>, side: Side) {
        let view = plan.view;
        let started = matches!(view.phase, Phase::Penalty(_));
        let ours = side == Side::Ours;
        let spot = restart::penalty_spot(view, ours);
        if ours {
            self.kicker(plan, started, Some(spot));
            plan.keeper_guards();
        } else if plan.take(view.keeper) {
            plan.order(view.keeper, Role::Keeper, defence::keeper_on_goal_line(view), OrderReason::Referee);
        }
        let waiting = plan.free.len();
        let places: heapless::Vec<_, ROBOTS_MAX> =
            (0..waiting).map(|slot| restart::behind_penalty(view, spot, ours, slot, waiting)).collect();
        self.row(plan, &places);
    }

    /// Sends remaining robots to the places of a row, in the order in which they stand along it, so that none
    /// has to pass another one's place. A robot that has a place keeps it while the same robots wait.
    fn row(&mut self, plan: &mut Plan<'_>, places: &[Point<Attack>]) {
        let mut held = self.roles.placed.iter().flatten();
        let same_robots = held.clone().count() == plan.free.len() && held.all(|id| plan.free.contains(id));
        let mut order: heapless::Vec<usize, ROBOTS_MAX> = (0..places.len()).collect();
        if !same_robots {
            let along = |id: &RobotId| plan.view.our(*id).map_or(0.0, |robot| robot.position.y());
            plan.free.sort_unstable_by(|a, b| along(a).total_cmp(&along(b)).then(a.cmp(b)));
            order.sort_unstable_by(|a, b| places[*a].y().total_cmp(&places[*b].y()));
            self.roles.placed = Default::default();
            for (slot, id) in order.iter().zip(&plan.free) {
                if let Some(held) = self.roles.placed.get_mut(*slot) {
                    *held = Some(*id);
                }
            }
        }
        for (slot, id) in self.roles.placed.into_iter().enumerate() {
            if let (Some(id), Some(at)) = (id, places.get(slot))
                && plan.take(id)
            {
                plan.order(id, Role::Support(slot as u8), plan.facing_ball(*at), OrderReason::Referee);
            }
        }
    }
}
