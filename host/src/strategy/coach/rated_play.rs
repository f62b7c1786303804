//! `rated_play`: open play by possession and one rated list of actions: the robot that has the ball, or is
//! first behind it, takes the best action, and keeps it until another is clearly better. Attack frame, SI
//! units.

use casebase::CaseBase;
use geometry::{Attack, Point};
use protocol::{Duration, Instant, RobotId};
use rules::{Phase, contact};

use super::super::case_candidate;
use super::super::order::{OrderReason, Role, Task};
use super::super::pass::reach::Mover;
use super::super::possession::{Arrival, Possession, arrival};
use super::super::rated::{self, Action, OfCases, Rated, RatedList};
use super::super::view::{View, ViewBall, ViewRobot};
use super::super::{restart, roles};
use super::playable::is_left_to_the_keeper;
use super::{Coach, Plan};

/// A robot that plays a case counts as this much nearer to the ball, s: a change of robots would end the
/// case.
const CASE_PLAYER_BONUS_S: f32 = 0.5;
/// No pass is received nearer to our area, m: the ball that is missed there is a shot.
const PASS_OFF_OUR_AREA_M: f32 = 0.5;
/// Interval at which the list is rated.
const RATED_EVERY: Duration = Duration::millis(50);
/// A ball that moved by more than this is a new situation, m.
const BALL_MOVED_M: f32 = 0.3;
/// Another action is better by at least this: a robot that turns round loses half a second.
const BETTER_BY_MIN: f32 = 0.02;
/// A pass of a restart with a smaller P(receive) waits for a better one, for as long of the 5 s (A) that the
/// rules give.
const POOR_PASS_P: f32 = 0.4;
const WAITS_FOR_BETTER: Duration = Duration::millis(1500);
/// At a restart by this, more with every second of it, and by this share of it where what was chosen is poor.
const RESTART_BETTER_BY: f32 = 0.05;
const POOR_SHARE: f32 = 0.4;
/// And by this share of what it is worth: places of equal worth do not alternate.
const BETTER_BY_SHARE: f32 = 0.25;
/// This soon before it touches the ball, s, a robot keeps its action until that is worth this much less than
/// when it was chosen, and half of it.
const LOCKED_WITHIN_S: f32 = 0.35;
const FALLS_BY_MIN: f32 = 0.06;
/// An action must be better than a running case by at least this, P(goal): its partners have gone to their
/// places for it. 40 matches each with 0.02, 0.06 and 0.1: 38, 33 and 29 % of the cases were reassigned, and
/// no difference in goals was seen (docs/strategy.md).
const CASE_MARGIN: f32 = 0.1;

/// The action that was chosen, and for which ball.
#[derive(Clone, Copy, Debug)]
pub(super) struct Chosen {
    pub(super) who: RobotId,
    /// When the list was rated last.
    rated: Instant,
    pub(super) from: Point<Attack>,
    pub(super) action: Action,
    /// What it was worth when it was chosen.
    worth: f32,
}

/// Memory of open play by the rated list.
#[derive(Clone, Debug)]
pub(super) struct RatedPlay {
    /// The case base that cases are retrieved from.
    pub(super) cases: CaseBase<'static>,
    /// Robot that has the ball.
    pub(super) possession: Possession,
    /// The action chosen from the list.
    pub(super) chosen: Option<Chosen>,
    /// The list that it was chosen from.
    list: RatedList,
    /// The second robot at an opponent that has the ball.
    pub(super) second: Option<RobotId>,
}

impl RatedPlay {
    /// Memory without a choice.
    pub(super) fn new(cases: CaseBase<'static>) -> Self {
        Self { cases, possession: Possession::Free, chosen: None, list: RatedList::new(), second: None }
    }

    /// Drops choice and possession when another phase starts.
    pub(super) fn reset(&mut self) {
        (self.chosen, self.possession) = (None, Possession::Free);
    }
}

impl Coach {
    /// The robot whose actions were rated, and all of them, best first; none while no list is played by.
    pub fn rated(&self) -> Option<(RobotId, &[Rated])> {
        self.open_play.rated.chosen.map(|chosen| (chosen.who, self.open_play.rated.list.as_slice()))
    }

    /// Open play: the keeper, the robot that plays the ball, its receiver, two defenders, supporters.
    pub(super) fn rated_play(&mut self, plan: &mut Plan<'_>) {
        let view = plan.view;
        let Some(ball) = view.ball else { return self.defend(plan, false) };
        self.open_play.rated.possession = self.open_play.rated.possession.next(view, view.contact);
        self.order_double_touch_blocked(plan, &ball);
        self.order_uncovering(plan, &ball);
        self.see_pass_leave(view);
        if let Possession::Theirs(opponent, since) = self.open_play.rated.possession
            && !is_left_to_the_keeper(view, &ball)
        {
            return self.challenge(plan, &ball, (opponent, ball.position), since);
        }
        let keepers = self.is_keepers(view, &ball);
        if let Some(at) = self.order_receiver(plan, &ball) {
            self.defend(plan, false);
            return self.support_pass(plan, at, None);
        }
        if keepers || is_left_to_the_keeper(view, &ball) {
            self.roles.ball_player = None;
            self.defend(plan, self.open_play.attacked || keepers);
            return self.support_pass(plan, ball.position, None);
        }
        let first = self.first_at(view, plan, &ball);
        self.roles.ball_player = first.map(|(id, _)| id);
        let first_seconds = first.map_or(f32::INFINITY, |(_, arrival)| arrival.seconds);
        if let Some((opponent, at)) = self.opponent_first_at_ball(view, &ball, first_seconds) {
            return self.challenge(plan, &ball, (opponent, at), view.now);
        }
        if let Some((id, arrival)) = first
            && plan.take(id)
        {
            let clears = self.defence.clears_before_our_area(view, self.passes.kicks(), id, &ball);
            if let Some((task, why)) = clears.or_else(|| self.act(plan, id, &ball, &arrival)) {
                plan.order(id, Role::Player, task, why);
                self.defend(plan, self.open_play.attacked);
                return self.support_pass(plan, arrival.ball, Some(id));
            }
            let why = OrderReason::SoonestAtBall { seconds: arrival.seconds };
            plan.order(id, Role::Player, Task::Gameplay, why);
            // Left free, the others would wait for a case that was not worth it, and play it.
            Self::go_on_with_cases(plan);
            self.defend(plan, self.open_play.attacked);
            return self.support_pass(plan, arrival.ball, Some(id));
        }
        self.play_cases(plan);
    }

    /// The robot that plays the ball: who has it, else who is first behind it.
    fn first_at(&self, view: &View, plan: &Plan<'_>, ball: &ViewBall) -> Option<(RobotId, Arrival)> {
        // A keeper that left its goal for a ball could be passed by it.
        let may = |robot: &&ViewRobot| plan.free.contains(&robot.id) && robot.id != view.keeper;
        if let Some(owner) =
            self.open_play.rated.possession.owner().and_then(|id| view.our(id)).filter(|r| may(r))
        {
            return Some((owner.id, Arrival { seconds: 0.0, ball: ball.position }));
        }
        let limits = &self.passes.kicks().constants().receiver;
        let of = |robot: &ViewRobot| {
            arrival(robot, (ball, view), self.passes.kicks().ground(), limits, view.their_goal())
        };
        let bound = |robot: &ViewRobot| if view.in_play.has(robot.id) { CASE_PLAYER_BONUS_S } else { 0.0 };
        let soonest =
            roles::choose(view.ours.iter().filter(may), self.roles.ball_player, roles::WORTH, |robot| {
                of(robot).seconds - bound(robot) + self.wall_stays(robot.id)
            });
        soonest.and_then(|(id, _)| view.our(id)).map(|robot| (robot.id, of(robot)))
    }

    /// The task of the best action; `None`: it plays on.
    fn act(
        &mut self,
        plan: &mut Plan<'_>,
        who: RobotId,
        ball: &ViewBall,
        arrival: &Arrival,
    ) -> Option<(Task, OrderReason)> {
        let from =
            if self.open_play.rated.possession.owner() == Some(who) { ball.position } else { arrival.ball };
        let action = self.choose(plan, who, from, true);
        self.order_action(plan, &action)
    }

    /// The kicker's task at our kick-off or free kick, by the same list; `None` where it has neither pass nor
    /// shot. What is not likely to reach a mate waits while the seconds run, and mates move on.
    pub(super) fn rated_restart(
        &mut self,
        plan: &mut Plan<'_>,
        who: RobotId,
        ball: &ViewBall,
    ) -> Option<(Task, OrderReason)> {
        let action = self.choose(plan, who, ball.position, false);
        let waits = matches!(plan.view.phase, Phase::FreeKick(_))
            && is_poor(&action)
            && self.age(plan.view) < WAITS_FOR_BETTER;
        let (task, why) = self.order_action(plan, &action)?;
        Some(match task {
            Task::Pass { at, receiver, kick, .. } if waits => {
                (Task::Pass { at, receiver, kick, ready: false }, why)
            }
            Task::Kick { .. } if waits => restart::take(plan.view, ball, None),
            _ => (task, why),
        })
    }

    /// The earlier choice, unless another action is clearly better now; whether it `may_play_on`: a ball that
    /// is not in play is passed or shot.
    fn choose(&mut self, plan: &Plan<'_>, who: RobotId, from: Point<Attack>, may_play_on: bool) -> Action {
        let view = plan.view;
        let kept = self.open_play.rated.chosen.filter(|chosen| chosen.who == who);
        if let Some(chosen) = kept
            && view.now.since(chosen.rated) < RATED_EVERY
        {
            return chosen.action;
        }
        // A ball that moved is played from where it is; what was chosen for it is still compared.
        let there = kept.map(|chosen| chosen.from).filter(|there| there.distance(from) < BALL_MOVED_M);
        if there.is_none() {
            self.passes.forget();
        }
        let plays_case = may_play_on && view.in_play.has(who);
        let again = match kept.map(|chosen| chosen.action) {
            // A case is adapted to where the ball is now; a robot that came to the ball in one plays it on.
            Some(action @ (Action::Case(_) | Action::PlayOn)) => Some((action, from)),
            Some(action) => Some((action, there.unwrap_or(from))),
            None => plays_case.then_some((Action::PlayOn, from)),
        };
        let again = again.and_then(|(action, at)| {
            let kicks = self.passes.kicks();
            let mut again = rated::rate_again(view, kicks, who, at, &action)?;
            if plays_case
                && action == Action::PlayOn
                && let Some(next) = rated::next_worth(view, kicks, who, at)
            {
                again.worth = again.worth.max(next);
            }
            // Kick and volley stay as ordered while the ball is where it was.
            Some(if there.is_some() { again.kicked_as(&action) } else { again })
        });
        let defenders = self.roles.defenders;
        let receives = |id| !defenders.contains(&Some(id));
        let pass = view.proposed_pass(who).filter(|_| self.tactics.bridge);
        let may = |id| id == who || plan.free.contains(&id) && id != view.keeper && receives(id);
        let retrieved = (self.tactics.bridge && !view.in_play.has(who))
            .then(|| case_candidate::retrieve(view, &self.open_play.rated.cases, who, from, may))
            .flatten();
        // Robots play cases only while the ball is in play: at a restart the host orders the first pass.
        let of_cases = if may_play_on {
            OfCases { pass, retrieved }
        } else {
            OfCases { pass: retrieved.and_then(|cast| cast.first_pass(who)), retrieved: None }
        };
        let mut list = rated::rate(view, &mut self.passes, who, from, of_cases);
        list.retain(|rated| match rated.action {
            Action::Pass { receiver, rating } => {
                receives(receiver) && !view.in_our_area(rating.at, PASS_OFF_OUR_AREA_M)
            }
            Action::PlayOn => may_play_on,
            _ => true,
        });
        let best = list.first().map_or((Action::PlayOn, 0.0), |best| (best.action, best.worth));
        // Among equals a case: its robots know their parts before the ball leaves.
        let case = list.iter().find(|rated| matches!(rated.action, Action::Case(_)));
        let best = case
            .filter(|case| best.1 < case.worth + BETTER_BY_MIN)
            .map_or(best, |case| (case.action, case.worth));
        let is_of_case = |action| matches!(action, Action::Case(_) | Action::PlayOn);
        let better = match again {
            Some(again) if plays_case && is_of_case(again.action) => CASE_MARGIN,
            // A kicker that turns round gives a marker beside the ball the time to follow.
            Some(again) if view.phase != Phase::Run => {
                let poor = if is_poor(&again.action) { POOR_SHARE } else { 1.0 };
                RESTART_BETTER_BY * poor * (1.0 + self.age(view).as_secs_f32())
            }
            _ => BETTER_BY_MIN.max(BETTER_BY_SHARE * best.1.abs()),
        };
        // At the ball it is only given up for a reason of its own.
        let falls_to =
            kept.map_or(f32::INFINITY, |chosen| chosen.worth - FALLS_BY_MIN.max(0.5 * chosen.worth.abs()));
        let locked = view.our(who).is_some_and(|robot| {
            let mover = Mover::new(robot.position, robot.velocity, &self.passes.kicks().constants().receiver);
            mover.time_to_touch(from, contact::TOUCHES_WITHIN) < LOCKED_WITHIN_S
        });
        let kept_action =
            again.filter(|again| best.1 < again.worth + better || locked && again.worth >= falls_to);
        let (action, from, worth) = match kept_action {
            Some(again) => {
                let worth = kept.map_or(again.worth, |chosen| chosen.worth.max(again.worth));
                (again.action, there.unwrap_or(from), worth)
            }
            None => (best.0, from, best.1),
        };
        self.open_play.rated.chosen = Some(Chosen { who, rated: view.now, from, action, worth });
        self.open_play.rated.list = list;
        action
    }
}

/// A clearance, or a pass that is hardly received.
fn is_poor(action: &Action) -> bool {
    match action {
        Action::Clear { .. } => true,
        _ => action.pass().is_some_and(|(_, rating)| rating.receive() < POOR_PASS_P),
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::order::Order;
    use super::super::super::tactics::Tactics;
    use super::super::super::view::tests::view;
    use super::*;
    use crate::strategy::Team;
    use geometry::Vector;
    use motion::ball::BallModel;
    use rand_core::{RngCore, SeedableRng};
    use rand_xoshiro::Xoshiro128PlusPlus;
    use rules::League;

    /// A robot to which the ball comes within a case: what it is ordered, over situations drawn at random.
    #[test]
    fn a_running_case_is_broken_off_only_for_a_clearly_better_action() {
        let mut rng = Xoshiro128PlusPlus::seed_from_u64(7);
        let (mut kept, mut broken) = (0, 0);
        for situation in 0..200 {
            let mut within =
                |from: f32, to: f32| from + (rng.next_u32() >> 8) as f32 / 16_777_216.0 * (to - from);
            let mut place = |x: [f32; 2]| (within(x[0], x[1]), within(-2.5, 2.5));
            let ball = place([0.5, 4.0]);
            let ours = [(-4.4, 0.0), (ball.0 - 0.12, ball.1), place([-1.0, 3.0]), place([0.0, 3.5])];
            let theirs = [(4.4, 0.0), place([1.0, 3.5]), place([0.0, 3.5]), place([-1.0, 3.0])];
            let tactics = Tactics { bridge: true, rated: true, ..Tactics::ROUND_1 };
            let mut coach = Coach::new(Team::Ours, tactics, League::DivisionB);
            let mut seen = view(ball, &ours, &theirs);
            for robot in &seen.ours {
                seen.in_play.insert(robot.id);
            }
            let orders = coach.decide(&seen);
            let Some((who, list)) = coach.rated() else { continue };
            let plays_on = list.iter().find(|rated| rated.action == Action::PlayOn).expect("always listed");
            let better = list[0].worth - plays_on.worth;
            let task = orders.iter().find(|order| order.robot == who).map(|order| order.task);
            let keeps = task == Some(Task::Gameplay);
            assert_eq!(keeps, better < CASE_MARGIN, "situation {situation}: {task:?}, {better} better");
            kept += u32::from(keeps && better > BETTER_BY_MIN);
            broken += u32::from(!keeps);
        }
        assert!(kept > 10 && broken > 10, "{kept} kept for a little, {broken} broken off");
    }

    /// What the robots are ordered while a ball of 5 m/s crosses the field, tracked with errors of 0.1 m/s:
    /// without robots it would rest 35 m away, give or take a metre.
    #[test]
    fn while_a_fast_ball_rolls_orders_are_kept() {
        let ours = [(-4.4, 0.0), (-3.2, 0.4), (-3.2, -0.4), (-1.0, -2.0), (0.5, 2.0), (1.0, -1.5)];
        let theirs = [(4.4, 0.0), (2.5, 0.6), (2.5, -0.6), (0.8, 0.2), (-1.0, 1.5), (1.5, 1.8)];
        let tactics = Tactics { bridge: true, rated: true, ..Tactics::ROUND_1 };
        let mut coach = Coach::new(Team::Ours, tactics, League::DivisionB);
        let mut seen = view((2.0, -1.0), &ours, &theirs);
        let (begun, mut last, mut changes) = (seen.now, None, 0);
        for tick in 0..30_u64 {
            let error = 0.1 * (tick % 3) as f32 - 0.1;
            let velocity = Vector::new(-4.8 + error, -1.4 - error);
            let position = Point::new(2.0, -1.0) + Vector::new(-4.8, -1.4) * (0.016 * tick as f32);
            let rest = BallModel::default().rolling(position, velocity).rest();
            seen.ball = Some(ViewBall { velocity, rest, ..ViewBall::at_rest(position) });
            seen.now = Instant(begun.0 + 16_000 * tick);
            let player = |order: &&Order| order.role == Role::Player;
            let kind = coach.decide(&seen).iter().find(player).map(|order| {
                let receiver = match order.task {
                    Task::Pass { receiver, .. } => Some(receiver),
                    _ => None,
                };
                (order.robot, std::mem::discriminant(&order.task), receiver)
            });
            changes += u32::from(last.replace(kind).is_some_and(|before| before != kind));
        }
        assert!(changes <= 3, "{changes} in 30 ticks");
    }

    /// Free kicks in situations drawn at random: robots would not kick in a case before the ball is in play.
    #[test]
    fn at_a_free_kick_a_case_is_a_pass_that_the_host_orders() {
        let mut rng = Xoshiro128PlusPlus::seed_from_u64(9);
        let mut of_cases = 0;
        for situation in 0..200 {
            let mut within =
                |from: f32, to: f32| from + (rng.next_u32() >> 8) as f32 / 16_777_216.0 * (to - from);
            let mut place = |x: [f32; 2]| (within(x[0], x[1]), within(-2.5, 2.5));
            let ball = place([0.5, 4.0]);
            let ours = [(-4.4, 0.0), (ball.0 - 0.3, ball.1), place([-1.0, 3.0]), place([0.0, 3.5])];
            let theirs = [(4.4, 0.0), place([1.0, 3.5]), place([0.0, 3.5]), place([-1.0, 3.0])];
            let mut coach = Coach::new(Team::Ours, Tactics::default(), League::DivisionB);
            let mut seen = view(ball, &ours, &theirs);
            seen.phase = Phase::FreeKick(rules::Side::Ours);
            for robot in &seen.ours {
                seen.knows_cases.insert(robot.id);
            }
            coach.decide(&seen);
            seen.now += Duration::millis(300);
            let orders = coach.decide(&seen);
            let by_themselves = |order: &&Order| matches!(order.task, Task::Case(_) | Task::Gameplay);
            assert_eq!(orders.iter().find(by_themselves), None, "situation {situation}");
            of_cases += u32::from(orders.iter().any(|o| matches!(o.why, OrderReason::OfCase { .. })));
        }
        assert!(of_cases > 5, "{of_cases} of 200 are the pass of a case");
    }
}
