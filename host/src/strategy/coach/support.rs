//! `support`: places of the robots that support the one at the ball, held for a while. Attack frame, SI
//! units.

use geometry::{Attack, Point};
use protocol::{Duration, Instant, RobotId};
use rules::Phase;

use super::super::order::{OrderReason, Role};
use super::super::view::ROBOTS_MAX;
use super::super::{roles, support};
use super::{Coach, Plan};

/// Places are held while the ball, or where it is placed, is within this of where it was, m.
const HELD_WITHIN_M: f32 = 0.5;
/// Longest time for which places are held while the ball is not in play: to cross half of division A's field
/// and stop.
const HELD_IN_STOP: Duration = Duration::millis(6000);
/// Interval at which places are searched again in open play.
const HELD_IN_PLAY: Duration = Duration::millis(200);

/// Places to which supporters are sent, and for which ball.
#[derive(Clone, Debug)]
struct HeldPlaces {
    /// Place of the ball, now or later, that they were chosen for.
    ball: Point<Attack>,
    since: Instant,
    /// The places with their values, 0–1.
    places: heapless::Vec<(Point<Attack>, f32), ROBOTS_MAX>,
}

/// The places of our supporters.
#[derive(Clone, Debug, Default)]
pub(super) struct SupportState {
    held: Option<HeldPlaces>,
    /// Places where supporters stood last in open play.
    stood: heapless::Vec<Point<Attack>, ROBOTS_MAX>,
}

impl SupportState {
    /// Takes the held places if they are enough and still valid for a ball at `ball`, for at most `lasts`.
    fn take(&mut self, plan: &Plan<'_>, ball: Point<Attack>, lasts: Duration) -> Option<HeldPlaces> {
        self.held.take().filter(|held| {
            held.places.len() >= plan.free.len()
                && held.ball.distance(ball) < HELD_WITHIN_M
                && plan.view.now.since(held.since) < lasts
        })
    }
}

impl Coach {
    /// Sends all remaining robots to places where a pass can come; off the ball while it is not in play.
    pub(super) fn spread(&mut self, plan: &mut Plan<'_>) {
        let view = plan.view;
        let from = view.placement.or(view.ball.map(|ball| ball.position)).unwrap_or_default();
        self.support(plan, from);
    }

    /// Sends all remaining robots to the best places for a pass from `from`. While the ball is not in play
    /// they are held for a while: the opponents stand where our robots are, and ours go where they are not,
    /// so that both would move for the whole stop.
    pub(super) fn support(&mut self, plan: &mut Plan<'_>, from: Point<Attack>) {
        let view = plan.view;
        let held = self.support.take(plan, from, HELD_IN_STOP).filter(|_| view.phase != Phase::Run);
        let held = held.unwrap_or_else(|| HeldPlaces {
            ball: from,
            since: view.now,
            places: support::places(view, from, plan.free.len()),
        });
        self.fill_support(plan, held);
    }

    /// Sends all remaining robots to where a pass from `from` by `passer` would be worth most.
    pub(super) fn support_pass(&mut self, plan: &mut Plan<'_>, from: Point<Attack>, passer: Option<RobotId>) {
        let (view, wanted) = (plan.view, plan.free.len());
        if wanted == 0 {
            return;
        }
        let held = self.support.take(plan, from, HELD_IN_PLAY).unwrap_or_else(|| {
            let others = view.without(&plan.free);
            let kicks = self.passes.kicks();
            let mut places = support::pass_places(&others, kicks, from, passer, &self.support.stood);
            places.truncate(wanted);
            self.support.stood = places.iter().map(|(at, _)| *at).collect();
            HeldPlaces { ball: from, since: view.now, places }
        });
        self.fill_support(plan, held);
    }

    /// Sends remaining robots to these places as supporters, and holds the places.
    fn fill_support(&mut self, plan: &mut Plan<'_>, held: HeldPlaces) {
        let rated = held.places.clone();
        self.support.held = Some(held);
        let places: heapless::Vec<_, ROBOTS_MAX> = rated.iter().map(|(at, _)| *at).collect();
        self.fill(plan, &places, |i| {
            let worth = rated.get(i).map_or(0.0, |(_, worth)| *worth);
            (Role::Support(i as u8), OrderReason::FreePlace { worth })
        });
    }

    /// Sends remaining robots to places in order; a robot that had a place keeps it.
    pub(super) fn fill(
        &mut self,
        plan: &mut Plan<'_>,
        places: &[Point<Attack>],
        what: impl Fn(usize) -> (Role, OrderReason),
    ) {
        let places: heapless::Vec<_, ROBOTS_MAX> = places.iter().map(|at| plan.kept_off(*at)).collect();
        let wanted = places.len().min(plan.free.len());
        self.roles.placed = roles::assign(plan.view, &mut plan.free, &places[..wanted], &self.roles.placed);
        for (i, id) in self.roles.placed.into_iter().enumerate() {
            if let (Some(id), Some(at)) = (id, places.get(i)) {
                let (role, why) = what(i);
                plan.order(id, role, plan.facing_ball(*at), why);
            }
        }
    }
}
