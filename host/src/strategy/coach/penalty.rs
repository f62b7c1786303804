//! `penalty`: orders of everybody at a penalty, and in the stop before it. Attack frame, m.

use rules::{Phase, Side};

use super::super::order::{Role, Why};
use super::super::view::ROBOTS_MAX;
use super::super::{defence, restart};
use super::{Coach, Plan};

impl Coach {
    /// Penalty: taker or keeper, everybody else behind the mark.
    pub(super) fn penalty(&mut self, plan: &mut Plan<'_>, side: Side) {
        let view = plan.view;
        let started = matches!(view.phase, Phase::Penalty(_));
        let ours = side == Side::Ours;
        let spot = restart::penalty_spot(view, ours);
        if ours {
            self.taker(plan, started, Some(spot));
            plan.keeper_guards();
        } else if plan.take(view.keeper) {
            plan.order(view.keeper, Role::Keeper, defence::keeper_on_goal_line(view), Why::Referee);
        }
        let places: heapless::Vec<_, ROBOTS_MAX> =
            (0..plan.free.len()).map(|slot| restart::behind_penalty(view, spot, ours, slot)).collect();
        self.fill(plan, &places, |i| (Role::Support(i as u8), Why::Referee));
    }
}
