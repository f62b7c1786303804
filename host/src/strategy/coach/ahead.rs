//! `ahead`: our free kick: pass location and pass-ahead (Biswas et al. 2014 §3). Attack frame, SI units.

use geometry::{Attack, Point};
use protocol::{Instant, RobotId};
use rules::{Phase, Side};

use super::super::counters::Sent;
use super::super::order::{OrderReason, Task};
use super::super::pass::ahead::{PassAhead, PasserMove, Places, Times};
use super::super::pass::{PassScene, Rating};
use super::super::restart;
use super::super::support::{self, Target};
use super::super::view::{View, ViewBall, ViewRobot};
use super::Coach;
use super::pass_state::RunningPass;

/// A pass with a smaller P(receive) is not tried.
const RESTART_PASS_P_MIN: f32 = 0.3;
/// A pass whose P(receive) falls below this share of its first value is given up.
const KEPT_PASS_P_SHARE: f32 = 0.5;
/// A planned pass does not leave with a smaller P(receive): of 137 that left with more 85 % arrived (62 of 69
/// against ours, 54 of 68 against the zone, seed 100), of 59 that left with less than 0.5, 37 %.
const PLANNED_PASS_P_MIN: f32 = 0.6;
/// This near to x_p a passer waits for its receiver, m: the 0.04 m between the robot and the ball, and its
/// position error.
const WAITING_WITHIN_M: f32 = 0.09;
/// Looks at x* this exactly, rad: the robot itself corrects the remaining angle before it kicks.
const AIMED_WITHIN_RAD: f32 = 0.15;

/// A pass being coordinated.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ahead {
    pub(super) receiver: RobotId,
    pub(super) rating: Rating,
    steps: PassAhead,
    /// Whether the receiver coerced before, if it is the attack of the Coerce and Attack Planner.
    planned: Option<bool>,
}

impl Ahead {
    /// A pass that starts at `now`.
    pub(super) fn new(receiver: RobotId, rating: Rating, now: Instant, planned: Option<bool>) -> Self {
        Self { receiver, rating, steps: PassAhead::new(now), planned }
    }

    /// Whether its receiver has started.
    pub(super) fn receiver_goes(&self) -> bool {
        self.steps.receiver_started().is_some()
    }

    /// Task of the pass's receiver.
    pub(super) fn reception(&self) -> Task {
        let shot = self.rating.shot;
        Task::Receive { at: self.rating.at, then: shot.one_touch.then_some(shot.aim) }
    }

    /// Reason of the order: the probabilities of the pass.
    pub(super) fn why(&self) -> OrderReason {
        OrderReason::Chances { receive: self.rating.receive(), goal: self.rating.goal() }
    }
}

impl Coach {
    /// Target of our restart: a shot with room, else the likeliest pass ahead, else the best remaining
    /// target.
    pub(super) fn target(&mut self, view: &View, kicker: RobotId, ball: &ViewBall) -> Target {
        let usual = support::target(view, kicker, ball.position);
        let free_kick = view.phase == Phase::FreeKick(Side::Ours);
        if !self.tactics.pass_ahead
            || !free_kick
            || self.restart.gave_up
            || matches!(usual, Target::Shot { .. })
        {
            return usual;
        }
        self.passes.forget();
        let offers = self.passes.offers(view, ball.position, kicker, false);
        let likely = offers.iter().find(|offer| offer.rating.receive() > RESTART_PASS_P_MIN);
        let Some(best) = likely else { return usual };
        self.restart.ahead = Some(Ahead::new(best.receiver, best.rating, view.now, None));
        let at = best.rating.at;
        Target::Teammate { id: best.receiver, at, room: view.room_along(ball.position, at) }
    }

    /// The kicker's task for its pass ahead, if it has one.
    pub(super) fn pass_ahead(
        &mut self,
        view: &View,
        kicker: RobotId,
        ball: &ViewBall,
    ) -> Option<(Task, OrderReason)> {
        let mut ahead = self.restart.ahead?;
        let passer = view.our(kicker)?;
        let Some(receiver) = view.our(ahead.receiver) else { return self.give_up(view) };
        let now = PassScene::of(view, self.passes.kicks(), ball.position, Some(kicker), receiver)
            .rate(ahead.rating.at);
        let planned = ahead.planned.is_some();
        let least = if planned { PLANNED_PASS_P_MIN } else { ahead.rating.receive() * KEPT_PASS_P_SHARE };
        if ahead.steps.shot().is_none() && now.receive() < least {
            return self.give_up(view);
        }
        let times = times(ball, passer, receiver, &ahead.rating, &self.passes.kicks().constants().receiver);
        let moves = ahead.steps.step(view.now, &times);
        self.restart.ahead = Some(ahead);
        let task = match moves.passer {
            PasserMove::GivesUp { .. } => return self.give_up(view),
            PasserMove::Waits if !planned => {
                let at = restart::kicker_waits(view, ball.position);
                Task::GoTo { at, face: at.direction_to(ball.position) }
            }
            PasserMove::Waits | PasserMove::Goes | PasserMove::Shoots => Task::Pass {
                at: ahead.rating.at,
                receiver: ahead.receiver,
                kick: ahead.rating.kick.order(),
                ready: moves.passer == PasserMove::Shoots,
            },
        };
        Some((task, ahead.why()))
    }

    /// The pass of our restart that has just been taken; it is reported too.
    pub(super) fn restart_pass(&mut self, view: &View) -> Option<RunningPass> {
        if let Some((_, Target::Teammate { id, at, .. })) = self.restart.aim {
            self.pass.sent = self.sent(view, id, at);
            let rating = self.restart.ahead.as_ref().map(|ahead| &ahead.rating);
            return Some(RunningPass::new(id, at, rating, view.now));
        }
        self.passing().map(|pass| self.leaves(view, pass))
    }

    fn sent(&self, view: &View, receiver: RobotId, to: Point<Attack>) -> Option<Sent> {
        let (passer, from) = (self.roles.ball_player?, self.restart.ball_from?);
        let rated =
            |teammate| PassScene::of(view, self.passes.kicks(), from, Some(passer), teammate).rate(to);
        let rating =
            self.restart.ahead.map(|ahead| ahead.rating).or_else(|| view.our(receiver).map(rated))?;
        Some(Sent {
            passer,
            receiver,
            from,
            to,
            flight: rating.ball_time,
            chip: self.restart.ahead.is_some() && rating.kick.is_chip(),
            conditions: rating.receive_factors,
            pressed: view.theirs_within(from),
            planned: self.restart.ahead.and_then(|ahead| ahead.planned),
        })
    }

    fn give_up(&mut self, view: &View) -> Option<(Task, OrderReason)> {
        let planned = self.restart.ahead.is_some_and(|ahead| ahead.planned.is_some());
        let again = planned && self.reconsider(view);
        (self.restart.ahead, self.restart.aim, self.restart.gave_up) = (None, None, !again);
        None
    }
}

/// The times of Algorithm 1; the passer waits a short distance behind x_p, so that it does not touch the ball
/// before.
fn times(
    ball: &ViewBall,
    passer: &ViewRobot,
    receiver: &ViewRobot,
    rating: &Rating,
    limits: &motion::trajectory::FreeLimits,
) -> Times {
    let places = Places::of(ball.position, rating);
    let times = Times::of(&places, passer, receiver, rating.ball_time, limits);
    let (at, facing) = places.passer;
    let waits =
        passer.position.distance(at) < WAITING_WITHIN_M && (passer.heading - facing).abs() < AIMED_WITHIN_RAD;
    Times { at_ball: waits, passer: if waits { 0.0 } else { times.passer }, ..times }
}
