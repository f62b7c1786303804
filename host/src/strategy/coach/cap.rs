//! `cap`: our free kick by the Coerce and Attack Planner. Coercers go and wait to be followed, then the pass
//! ahead (Biswas et al. 2014 §4). Robots that coerce no opponent defend or support as usual until they
//! receive. Attack frame, SI units.

use protocol::RobotId;
use rules::{League, Phase, Side};

use super::super::coerce::tactics::Models;
use super::super::coerce::{
    ByPassLocation, CoercePart, CoerceProgress, CoerceSettings, FinalAttack, Planner,
};
use super::super::defence;
use super::super::order::{OrderReason, Role, Task};
use super::super::pass::{Kicks, PassScene};
use super::super::support::{self, Target};
use super::super::view::{View, ViewBall};
use super::{Ahead, Coach, Plan};

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
        self.cap.planner.reconsider(view.now)
    }

    /// Observes the opponents before our free kick (step 1).
    pub(super) fn observe(&mut self, view: &View) {
        let before = matches!(view.phase, Phase::Stop | Phase::BallPlacement(Side::Ours));
        if self.tactics.coerce
            && before
            && view.next.is_none_or(|next| next == Phase::FreeKick(Side::Ours))
            && let Some(kicker) = self.first
        {
            self.cap.planner.observe(view, kicker);
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
        if !self.tactics.coerce || self.gave_up || view.phase != Phase::FreeKick(Side::Ours) {
            return None;
        }
        let value = ByPassLocation::new(&self.kicks);
        if !self.cap.asked {
            self.cap.asked = true;
            self.cap.seed += 1;
            let shot = matches!(support::target(view, kicker, ball.position), Target::Shot { .. });
            self.gave_up = shot
                || ball.position.x() < FROM
                || self.cap.planner.plan(view, &value, kicker, self.cap.seed).is_none();
            if self.gave_up {
                return None;
            }
        }
        let progress = self.cap.planner.watch(view, &value);
        if let CoerceProgress::Attacking(attack) = progress
            && self.ahead.is_none()
        {
            self.ahead = begin(view, &self.kicks, kicker, ball, &attack);
            self.aim = self.ahead.map(|ahead| {
                let (id, at) = (ahead.receiver, ahead.rating.at);
                (view.now, Target::Teammate { id, at, room: defence::room_along(view, ball.position, at) })
            });
            self.gave_up = self.ahead.is_none();
        }
        for posting in self.cap.planner.postings(view) {
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
        let attack = self.cap.planner.current()?.optimistic;
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

/// Free kicks farther back than this are taken as soon as possible, m: no pass from there leads to a shot.
const FROM: f32 = -1.0;
