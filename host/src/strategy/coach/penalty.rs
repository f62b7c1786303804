//! Where is everybody at a penalty?

use rules::{Phase, Side};

use super::super::order::{Role, Why};
use super::super::view::ROBOTS_MAX;
use super::super::{defence, restart};
use super::{Coach, Plan};

impl Coach {
    /// Penalty: taker or keeper, everybody else behind the ball.
    pub(super) fn penalty(&mut self, plan: &mut Plan<'_>, side: Side) {
        let view = plan.view;
        let started = matches!(view.phase, Phase::Penalty(_));
        if side == Side::Ours {
            self.taker(plan, started, true);
            plan.keeper_guards();
        } else if plan.take(view.keeper) {
            plan.order(view.keeper, Role::Keeper, defence::keeper_on_goal_line(view), Why::Referee);
        }
        let Some(ball) = view.ball else { return };
        let places: heapless::Vec<_, ROBOTS_MAX> = (0..plan.free.len())
            .map(|slot| restart::behind_penalty(view, &ball, side == Side::Ours, slot))
            .collect();
        self.fill(plan, &places, |i| (Role::Support(i as u8), Why::Referee));
    }
}
