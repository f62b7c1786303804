//! `cap`: our free kick by the Coerce and Attack Planner. Coercers go and wait to be followed, then the pass
//! ahead (Biswas et al. 2014 §4). Robots that coerce no opponent defend or support as usual until they
//! receive. Attack frame, SI units.

use protocol::RobotId;
use rules::{League, Phase, Side};

use super::super::coerce::tactics::Models;
use super::super::coerce::{
    ByPassLocation, CoercePart, CoerceProgress, CoerceSettings, FinalAttack, Planner,
};
use super::super::order::{OrderReason, Role, Task};
use super::super::pass::{Kicks, PassScene};
use super::super::support::{self, Target};
use super::super::view::{View, ViewBall};
use super::ahead::Ahead;
use super::{Coach, Plan};

/// Free kicks farther back than this are taken as soon as possible, m: no pass from there leads to a shot.
const COERCE_FROM_X_M: f32 = -1.0;

/// The planner, and its settings at this free kick.
#[derive(Clone, Debug)]
pub(super) struct Cap {
    planner: Planner,
    /// The seed of the next plan.
    seed: u64,
    asked: bool,
}

impl Cap {
    pub(super) fn new(league: League) -> Self {
        let planner = Planner::new(CoerceSettings::of(league), Models::default());
        Self { planner, seed: 0, asked: false }
    }

    /// Drops the plan when another phase starts.
    pub(super) fn forget(&mut self) {
        self.asked = false;
    }
}

impl Coach {
    /// Whether another attack is searched in place of one that has become unlikely.
    pub(super) fn reconsider(&mut self, view: &View) -> bool {
        self.restart.cap.planner.reconsider(view.now)
    }

    /// Observes the opponents before our free kick (step 1).
    pub(super) fn observe(&mut self, view: &View) {
        let before = matches!(view.phase, Phase::Stop | Phase::BallPlacement(Side::Ours));
        if self.tactics.coerce
            && before
            && view.next.is_none_or(|next| next == Phase::FreeKick(Side::Ours))
            && let Some(kicker) = self.roles.ball_player
        {
            self.restart.cap.planner.observe(view, kicker);
        }
    }

    /// The kicker's task while others coerce; orders for those. When they have finished, the attack becomes
    /// the pass ahead.
    pub(super) fn coerce(
        &mut self,
        plan: &mut Plan<'_>,
        kicker: RobotId,
        ball: &ViewBall,
    ) -> Option<(Task, OrderReason)> {
        let view = plan.view;
        if !self.tactics.coerce || self.restart.gave_up || view.phase != Phase::FreeKick(Side::Ours) {
            return None;
        }
        let value = ByPassLocation::new(self.passes.kicks());
        if !self.restart.cap.asked {
            self.restart.cap.asked = true;
            self.restart.cap.seed += 1;
            let shot = matches!(support::target(view, kicker, ball.position), Target::Shot { .. });
            self.restart.gave_up = shot
                || ball.position.x() < COERCE_FROM_X_M
                || self.restart.cap.planner.plan(view, &value, kicker, self.restart.cap.seed).is_none();
            if self.restart.gave_up {
                return None;
            }
        }
        let progress = self.restart.cap.planner.watch(view, &value);
        if let CoerceProgress::Attacking(attack) = progress
            && self.restart.ahead.is_none()
        {
            self.restart.ahead = begin(view, self.passes.kicks(), kicker, ball, &attack);
            self.restart.aim = self.restart.ahead.map(|ahead| {
                let (id, at) = (ahead.receiver, ahead.rating.at);
                (view.now, Target::Teammate { id, at, room: view.room_along(ball.position, at) })
            });
            self.restart.gave_up = self.restart.ahead.is_none();
        }
        for posting in self.restart.cap.planner.postings(view) {
            if let CoercePart::Coerces { marker, .. } = posting.part
                && plan.take(posting.robot)
            {
                let at = plan.kept_off(posting.at);
                plan.order(
                    posting.robot,
                    Role::Coercer,
                    plan.facing_ball(at),
                    OrderReason::Coerces { marker },
                );
            }
        }
        let CoerceProgress::Coercing { arrived, of, .. } = progress else { return None };
        let why = OrderReason::Coercing { arrived, of };
        let attack = self.restart.cap.planner.current()?.optimistic;
        Some((
            Task::Pass { at: attack.at, receiver: attack.receiver, kick: attack.worth.kick, ready: false },
            why,
        ))
    }
}

fn begin(
    view: &View,
    kicks: &Kicks,
    kicker: RobotId,
    ball: &ViewBall,
    attack: &FinalAttack,
) -> Option<Ahead> {
    let receiver = view.our(attack.plan.receiver)?;
    let scene = PassScene::of(view, kicks, ball.position, Some(kicker), receiver);
    Some(Ahead::new(receiver.id, scene.rate(attack.plan.at), view.now, Some(attack.reused)))
}
