//! `attack`: choice between shot and pass in open play: the one that is likelier to end in a goal (Biswas et
//! al. 2014 §3); where neither is worth it, it gives no order and the robots play a case. Attack frame, SI
//! units.
//!
//! Opponents are at the ball in open play, so waiting for a better start does not help: passer and receiver
//! start at once, and the ball leaves as soon as the receiver would be at x* with it (the last line of
//! Algorithm 1).

use geometry::{Attack, Point};
use motion::trajectory::CalcMotion;
use protocol::{Duration, Instant, RobotId};

use super::super::counters::Sent;
use super::super::order::{OrderReason, Role, Task};
use super::super::pass::bridge::{RADIUS, refine};
use super::super::pass::shot::shot;
use super::super::pass::{PassScene, Rating};
use super::super::rated::Action;
use super::super::support;
use super::super::view::{View, ViewBall};
use super::pass_state::RunningPass;
use super::rated_play::Chosen;
use super::{Coach, Plan};

/// Least P(goal) of a shot or a pass for which a case is broken off. Chosen over 8 matches against chasers of
/// the ball: 14.8 scoring chances a match for and 10.9 against; with cases alone 8.6 and 12.8.
const GOAL_P_MIN: f32 = 0.05;
/// Least P(receive) of a pass in open play; a pass lost there finds teammates out of position.
const OPEN_PLAY_PASS_P_MIN: f32 = 0.5;
/// A chosen pass is given up below this share of its first P(receive).
const KEPT_PASS_P_SHARE: f32 = 0.5;
/// Time for which a choice is held: to move around the ball and aim.
const CHOICE_HELD: Duration = Duration::millis(800);
/// A case's pass is held for longer, until its passer is at the ball: a robot that has left the case for it
/// does not propose it again. Scopes of the cases' robots are less than two seconds' drive.
const CASE_PASS_HELD: Duration = Duration::millis(2000);
/// Interval at which a better choice than a case is searched: as often as the field changes by a robot's
/// body.
const PLAY_ON_HELD: Duration = Duration::millis(200);
/// A ball that moved by more than this is a new situation, m.
const BALL_MOVED_M: f32 = 0.3;
/// The receiver may arrive this much later than the ball, s: as in pass-ahead at restarts.
const RECEIVER_LATE_MAX_S: f32 = 0.1;
/// A pass has left when the ball is this far from the passer's centre, m (touching it is 0.11 m off).
const DEPARTED_DISTANCE_M: f32 = 0.15;
/// A pass leaves a robot that was at the ball within this time.
const DEPARTED_WITHIN: Duration = Duration::millis(300);
/// A pass leaves with at least this share of the speed ordered: a chip keeps 0.7 of it along the ground.
const DEPARTED_SPEED_SHARE_MIN: f32 = 0.5;
/// A pass leaves in the direction ordered, by the cosine: within 26°.
const DEPARTED_COS_MIN: f32 = 0.9;

/// The shot, pass or case chosen in open play, its robot, and since when.
#[derive(Clone, Copy, Debug)]
pub(super) struct Intent {
    who: RobotId,
    since: Instant,
    /// Place of the ball when it was chosen.
    from: Point<Attack>,
    action: Action,
}

/// A pass that is ordered: passer, place of the ball, receiver, rating.
type Passing = (RobotId, Point<Attack>, RobotId, Rating);

impl Coach {
    /// The task of `who`, first at the ball, with an order for the receiver too; `None` where it plays a
    /// case.
    pub(super) fn attack(
        &mut self,
        plan: &mut Plan<'_>,
        who: RobotId,
        ball: &ViewBall,
    ) -> Option<(Task, OrderReason)> {
        if !self.tactics.attack {
            return None;
        }
        let action = self.intends(plan.view, who, ball);
        self.order_action(plan, &action)
    }

    /// The task of an action, with an order for the receiver too; `None` to play on.
    pub(super) fn order_action(&self, plan: &mut Plan<'_>, action: &Action) -> Option<(Task, OrderReason)> {
        match *action {
            Action::PlayOn => None,
            Action::Clear { at, kick } => {
                let room = plan.view.ball.map_or(0.0, |ball| plan.view.room_along(ball.position, at));
                Some((Task::Kick { at, kick }, OrderReason::BestTarget { room }))
            }
            Action::Shot { at, goal } => {
                Some((Task::Kick { at, kick: support::SHOT }, OrderReason::Chances { receive: 1.0, goal }))
            }
            Action::Pass { receiver, rating } => {
                let why = OrderReason::Chances { receive: rating.receive(), goal: rating.goal() };
                Some((self.pass_to(plan, receiver, &rating, why)?, why))
            }
            Action::Case(cast) => {
                let why = OrderReason::PlaysCase { case: cast.case };
                for robot in cast.robots.iter().flatten().copied() {
                    if plan.take(robot) {
                        plan.order(robot, Role::Player, Task::Case(cast), why);
                    }
                }
                Some((Task::Case(cast), why))
            }
            Action::OfCase { pass, rating, moved } => {
                let (receive, goal) = (rating.receive(), rating.goal());
                let why = |part| OrderReason::OfCase { case: pass.case, part, moved, receive, goal };
                let (receiver, part) = pass.receiver;
                Some((self.pass_to(plan, receiver, &rating, why(part))?, why(pass.passer.1)))
            }
        }
    }

    /// The passer's task, with an order for the receiver too; `None` where there is no receiver any more.
    fn pass_to(
        &self,
        plan: &mut Plan<'_>,
        receiver: RobotId,
        rating: &Rating,
        why: OrderReason,
    ) -> Option<Task> {
        let teammate = plan.view.our(receiver)?;
        if plan.take(receiver) {
            let then = rating.shot.one_touch.then_some(rating.shot.aim);
            plan.order(receiver, Role::Receiver, Task::Receive { at: rating.at, then }, why);
        }
        let limits = &self.passes.kicks().constants().receiver;
        let ready = limits.time(teammate.position, teammate.velocity, rating.at)
            <= rating.ball_time + RECEIVER_LATE_MAX_S;
        Some(Task::Pass { at: rating.at, receiver, kick: rating.kick.order(), ready })
    }

    /// The pass that is chosen.
    pub(super) fn passing(&self) -> Option<Passing> {
        if let Some(Chosen { who, from, action, .. }) = self.open_play.rated.chosen {
            let (receiver, rating) = action.pass()?;
            return Some((who, from, receiver, rating));
        }
        let Intent { who, from, action, .. } = self.open_play.intent?;
        let (receiver, rating) = action.pass()?;
        Some((who, from, receiver, rating))
    }

    /// Detects that the pass of open play leaves: from then on its receiver is ordered to receive it.
    pub(super) fn see_pass_leave(&mut self, view: &View) {
        let (Some(pass), Some(ball), None) = (self.passing(), view.ball, self.pass.running) else { return };
        let (who, from, _, rating) = pass;
        let Some(passer) = view.our(who) else { return };
        if ball.position.distance(passer.position) < DEPARTED_DISTANCE_M {
            self.open_play.at_ball = Some((who, view.now));
            return;
        }
        // A ball that rolls by, or that opponents kicked, is no pass.
        let had =
            self.open_play.at_ball.is_some_and(|(id, at)| id == who && view.now.since(at) < DEPARTED_WITHIN);
        let speed = ball.velocity.norm();
        let along = (rating.at - from).unit().map_or(0.0, |direction| ball.velocity.dot(direction));
        if !had || speed < DEPARTED_SPEED_SHARE_MIN * rating.kick.speed() || along < speed * DEPARTED_COS_MIN
        {
            return;
        }
        self.pass.running = Some(self.leaves(view, pass));
        (self.open_play.intent, self.open_play.rated.chosen) = (None, None);
    }

    /// The pass that has just left; it is reported too.
    pub(super) fn leaves(&mut self, view: &View, (passer, from, receiver, rating): Passing) -> RunningPass {
        self.pass.sent = Some(Sent {
            passer,
            receiver,
            from,
            to: rating.at,
            flight: rating.ball_time,
            chip: rating.kick.is_chip(),
            conditions: rating.receive_factors,
            pressed: view.theirs_within(from),
            planned: None,
        });
        RunningPass::new(receiver, rating.at, Some(&rating), view.now)
    }

    /// The earlier choice where it is still valid, so that a robot that moves around the ball does not turn
    /// back.
    fn intends(&mut self, view: &View, who: RobotId, ball: &ViewBall) -> Action {
        if let Some(intent) = self.open_play.intent
            && intent.who == who
            && intent.from.distance(ball.position) < BALL_MOVED_M
            && self.is_still_valid(view, &intent, ball)
        {
            return intent.action;
        }
        let action = self.likeliest(view, who, ball);
        self.open_play.intent = Some(Intent { who, since: view.now, from: ball.position, action });
        action
    }

    /// Whether an earlier choice is neither too old nor a pass that has become unlikely.
    fn is_still_valid(&self, view: &View, intent: &Intent, ball: &ViewBall) -> bool {
        let held = match intent.action {
            Action::PlayOn | Action::Case(_) => PLAY_ON_HELD,
            Action::Shot { .. } | Action::Pass { .. } | Action::Clear { .. } => CHOICE_HELD,
            Action::OfCase { .. } => CASE_PASS_HELD,
        };
        if view.now.since(intent.since) >= held {
            return false;
        }
        let Some((receiver, rating)) = intent.action.pass() else { return true };
        let receive = view.our(receiver).map_or(0.0, |teammate| {
            let scene = PassScene::of(view, self.passes.kicks(), ball.position, Some(intent.who), teammate);
            scene.rate(rating.at).receive()
        });
        receive > rating.receive() * KEPT_PASS_P_SHARE
    }

    fn likeliest(&mut self, view: &View, who: RobotId, ball: &ViewBall) -> Action {
        let shot = shot(view, self.passes.kicks(), ball.position);
        self.passes.forget();
        let offers = self.passes.offers(view, ball.position, who, false);
        // Defenders are not receivers.
        let pass = offers.iter().find(|offer| {
            !self.roles.defenders.contains(&Some(offer.receiver))
                && offer.rating.receive() > OPEN_PLAY_PASS_P_MIN
        });
        let goal = shot.value();
        match pass.map(|pass| (pass, pass.rating.value())) {
            Some((pass, value)) if value > goal.max(GOAL_P_MIN) => {
                Action::Pass { receiver: pass.receiver, rating: pass.rating }
            }
            _ if goal > GOAL_P_MIN => Action::Shot { at: shot.aim, goal },
            _ => self.of_the_case(view, who, ball).unwrap_or(Action::PlayOn),
        }
    }

    /// The next pass of the case that `who` plays, refined near the case's place for it, if it is then likely
    /// to arrive.
    fn of_the_case(&self, view: &View, who: RobotId, ball: &ViewBall) -> Option<Action> {
        let pass = view.proposed_pass(who).filter(|_| self.tactics.bridge)?;
        let receiver = pass.receiver.0;
        let teammate = view.our(receiver).filter(|_| !self.roles.defenders.contains(&Some(receiver)))?;
        let scene = PassScene::of(view, self.passes.kicks(), ball.position, Some(who), teammate);
        let refined = refine(&scene, pass.at, RADIUS);
        let rating = refined.best;
        (rating.receive() > OPEN_PLAY_PASS_P_MIN).then_some(Action::OfCase {
            pass,
            rating,
            moved: refined.moved(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::tactics::Tactics;
    use super::super::Orders;
    use super::super::tests::attack;
    use super::*;

    /// A pass from (2, 0) to our 4 that leaves with this speed, m/s, from our 3 that was at the ball, or was
    /// not; the orders then, and where it was to go.
    fn pass_leaves(speed: f32, was_at_it: bool) -> (Coach, View, Orders, Point<Attack>) {
        let wall = [(4.4, 0.0), (2.4, 0.0), (2.45, 0.2), (2.45, -0.2)];
        let (mut coach, mut view, orders) = attack([(3.0, 1.8), (-2.0, -2.0)], &wall, Tactics::default());
        let Task::Pass { at, .. } = orders[3].task else { panic!("{:?}", orders[3]) };
        assert_eq!(coach.take_sent(), None);
        if was_at_it {
            view.ours[3].position = Point::new(1.89, 0.0);
            coach.decide(&view);
        }
        let offset = (at - Point::new(2.0, 0.0)).unit().unwrap();
        let position = Point::new(2.0, 0.0) + offset * 0.2;
        view.ball =
            Some(ViewBall { velocity: offset * speed, rest: at + offset, ..ViewBall::at_rest(position) });
        view.now = Instant(view.now.0 + 50_000);
        let orders = coach.decide(&view);
        (coach, view, orders, at)
    }

    #[test]
    fn a_pass_of_open_play_that_left_is_its_receivers_and_is_counted_once() {
        let (mut coach, view, orders, at) = pass_leaves(3.0, true);
        assert!(matches!(orders[4].task, Task::Receive { at: there, .. } if there == at), "{:?}", orders[4]);
        let sent = coach.take_sent().unwrap();
        assert_eq!((sent.passer.number(), sent.receiver.number(), sent.to, sent.planned), (3, 4, at, None));
        assert!(sent.conditions.iter().product::<f32>() > 0.5);
        coach.decide(&view);
        assert_eq!(coach.take_sent(), None);
    }

    #[test]
    fn a_ball_that_rolls_by_or_is_pushed_away_is_no_pass() {
        for (speed, was_at_it) in [(3.0, false), (1.2, true)] {
            let (mut coach, ..) = pass_leaves(speed, was_at_it);
            assert_eq!(coach.take_sent(), None, "{speed} m/s, at it before: {was_at_it}");
        }
    }
}
