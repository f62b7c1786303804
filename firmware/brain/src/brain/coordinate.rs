//! Coordination of the team: being present, proposing, deciding, closing and aborting cycles (paper §4;
//! docs/architecture.md §5).

use casebase::{CaseRobot, Problem};
use protocol::decision::Grounds;
use protocol::team::{AbortReason, Closure, CycleState, Decision, PRESENCE_LEASE, Play, Progress, Status};
use protocol::{Duration, Instant, RobotId};

use super::{Brain, EFFORT_OF_GAMEPLAY, INPUTS_OF_PLAN_MAX, explained::Explained};
use crate::action_scene::ActionScene;
use crate::config::Approach;
use crate::estimate;
use crate::execution::Execution;
use crate::team::cycle::CycleEvent;
use crate::team::{election, hybrid, retrieval};
use crate::timer::Timer;
use protocol::host::{Directive, Hint};
use rules::Phase;

impl Brain<'_> {
    /// Adopts a newer state that this robot made, and sets its own part accordingly.
    pub(super) fn adopt_own(&mut self, now: Instant, state: &CycleState) {
        // Nothing is decided, proposed or aborted before the robot is awake.
        self.adopt(now, state, true);
    }

    /// Adopts a newer state; `from_start`: its cycle began in this boot epoch of this robot.
    pub(super) fn adopt(&mut self, now: Instant, state: &CycleState, from_start: bool) {
        let changed = self.cycle.adopt(state, from_start);
        if changed == CycleEvent::Known {
            return;
        }
        self.beacon_due = true;
        for timer in [Timer::NoDecision, Timer::Retry, Timer::Pause] {
            self.timers.clear(timer);
        }
        match &state.decision {
            Decision::Undecided => self.timers.set(Timer::NoDecision, now + DECISION_PATIENCE),
            Decision::NoCase => self.timers.set(Timer::Retry, now + RETRY_AFTER),
            // Without a case no gameplay was run that robots would pause after.
            Decision::Closed(closure)
                if *closure != Closure::NoCase && self.config.pause_after_cycle > Duration(0) =>
            {
                self.timers.set(Timer::Pause, now + self.config.pause_after_cycle);
            }
            Decision::Play(_) | Decision::Closed(_) => {}
        }
        if changed == CycleEvent::Gameplay {
            self.since.gameplay_changed = true;
            self.since.effort += EFFORT_OF_GAMEPLAY;
            self.begin_part(now);
        }
    }

    /// A gameplay has started or ended: drops the old part, prepares the new one.
    fn begin_part(&mut self, now: Instant) {
        self.execution = None;
        self.monitor.reset();
        for timer in [Timer::Reuse, Timer::Action, Timer::PassPatience, Timer::OpponentHolds] {
            self.timers.clear(timer);
        }
        let Some(play) = self.cycle.play() else { return };
        let part = play.part_of(self.config.robot).and_then(CaseRobot::new);
        self.execution = part.map(Execution::new);
        let expected = self.scene(now).map_or(0.0, |scene| estimate::gameplay(&scene));
        self.timers.set(Timer::Reuse, now + estimate::limit(expected));
    }

    /// Coordination of the team: being present, proposing, deciding, closing, aborting. Not inlined: what it
    /// keeps on the stack shall not lie under the steps that plan a path.
    #[inline(never)]
    pub(super) fn coordinate(&mut self, now: Instant) {
        if !self.awake {
            if !self.timers.has_fired(Timer::Boot) {
                return;
            }
            self.awake = true;
            self.beacon_due = true;
            self.timers.set(Timer::Settle, now + SETTLE_FOR);
        }
        let available = self.is_available(now);
        if self.was_available && !available && self.takes_part() {
            // Teammates must not wait for this robot.
            if let Some(state) = self.cycle.aborted(self.reason_to_leave(now)) {
                self.adopt_own(now, &state);
            }
        }
        self.beacon_due |= self.was_available != available;
        self.was_available = available;
        if self.config.approach == Approach::Reactive || !available {
            return;
        }
        if let Some(reason) = self.reason_to_stop(now) {
            // A robot that takes part aborts; an elector that does not supersedes.
            let next = if self.takes_part() { self.cycle.aborted(reason) } else { self.propose(now) };
            if let Some(state) = next {
                self.adopt_own(now, &state);
            }
        }
        if let Some(state) = self.next_state(now) {
            self.adopt_own(now, &state);
            // A cycle of its own is decided at once.
            if let Some(state) = self.next_state(now) {
                self.adopt_own(now, &state);
            }
        }
    }

    /// Present for election and retrieval: without a host always, else under `Gameplay` while the ball is in
    /// play, and under any order once its part in a running case is done.
    fn is_available(&self, now: Instant) -> bool {
        self.host.as_ref().is_none_or(|host| {
            let directive = host.directive(now);
            let done = directive.is_some() && self.cycle.progress == Progress::WaitEnd { finished: true };
            let plays = matches!(directive, Some(Directive::Gameplay { .. })) || done;
            plays && host.phase() == Some(Phase::Run) && !self.belief.game.double_touch_blocked
        })
    }

    /// Why it is not available: what the host, or the silence of the host, has changed.
    fn reason_to_leave(&self, now: Instant) -> AbortReason {
        let Some(host) = self.host.as_ref() else { return AbortReason::RobotLost };
        match host.directive(now) {
            None => AbortReason::RobotLost,
            Some(_) if host.phase() != Some(Phase::Run) => AbortReason::GameStopped,
            Some(_) => AbortReason::Reassigned,
        }
    }

    /// Proposal, decision or end of the cycle, where it is this robot's to announce.
    fn next_state(&mut self, now: Instant) -> Option<CycleState> {
        let me = self.config.robot;
        let elects = election::elector(now, me, &self.teammates) == me;
        match self.cycle.state().map(|s| &s.decision) {
            None | Some(Decision::Closed(_)) => {
                let paused = !self.timers.is_idle(Timer::Pause) && !self.timers.has_fired(Timer::Pause);
                let settled = self.timers.has_fired(Timer::Settle);
                let reported = self.cycle.closure().is_none() || self.reported_end_of == self.cycle.id();
                if elects && settled && reported && !paused { self.propose(now) } else { None }
            }
            Some(Decision::Undecided) if self.cycle.is_mine_to_decide() => {
                if let Some((cycle, decision)) = self.retrieved.take()
                    && Some(cycle) == self.cycle.id()
                {
                    return self.cycle.decided(decision);
                }
                if self.has_short_steps() && self.since.effort > INPUTS_OF_PLAN_MAX {
                    return None;
                }
                self.since.retrieved = true;
                let holder = self.holder(now);
                let problem = self.problem(now);
                let (decision, grounds) = (problem.as_ref())
                    .map_or((Decision::NoCase, Grounds::NoBall), |problem| self.decide(now, problem, holder));
                self.explained = (self.cycle.id())
                    .map(|cycle| Explained::new(cycle, &decision, grounds, problem.as_ref()));
                if self.has_short_steps() {
                    // Retrieval and the start of a gameplay do not fit into one step.
                    self.retrieved = self.cycle.id().map(|cycle| (cycle, decision));
                    return None;
                }
                self.cycle.decided(decision)
            }
            Some(Decision::Undecided) => None,
            Some(Decision::NoCase) => {
                let over = self.cycle.is_mine_to_decide() && self.timers.has_fired(Timer::Retry);
                if over { self.cycle.closed(Closure::NoCase) } else { None }
            }
            Some(Decision::Play(_)) => {
                let over = self.cycle.is_mine_to_decide() && self.all_have_finished(now);
                if over { self.cycle.closed(Closure::Finished) } else { None }
            }
        }
    }

    /// What is to be played, and what that rests on.
    fn decide(&self, now: Instant, problem: &Problem, holder: Option<RobotId>) -> (Decision, Grounds) {
        let proposed = (self.hint(now))
            .and_then(|hint| retrieval::accept(&self.base, problem, hint, holder, &self.belief));
        let (decision, grounds) = match proposed {
            Some(decision) => (decision, Grounds::Proposed),
            None if self.ball_is_nobodys(holder) => (Decision::NoCase, Grounds::BallRolls),
            None => retrieval::decide(&self.base, problem, &self.config.settings, holder),
        };
        match decision {
            Decision::Play(play) if self.shoots_sooner_without(now, &play) => {
                (Decision::NoCase, Grounds::ShootsSooner)
            }
            other => (other, grounds),
        }
    }

    /// The host's proposal, while it is fresh.
    fn hint(&self, now: Instant) -> Option<&Hint> {
        match self.host.as_ref()?.directive(now)? {
            Directive::Gameplay { hint } => hint.as_ref(),
            _ => None,
        }
    }

    /// Whether both approaches are active, and the reactive behaviour is expected to shoot sooner than this
    /// gameplay.
    fn shoots_sooner_without(&self, now: Instant, play: &Play) -> bool {
        if self.config.approach != Approach::Hybrid {
            return false;
        }
        let (Some(cycle), Some(case)) = (self.cycle.id(), self.base.case(play.case)) else { return false };
        let (belief, teammates, base) = (&self.belief, &self.teammates, &self.base);
        let scene = ActionScene { now, belief, teammates, cycle, play, case, base, body: self.body };
        hybrid::reactive_shoots_sooner(&scene)
    }

    /// The robot of ours that holds the ball, as far as this one knows.
    fn holder(&self, now: Instant) -> Option<RobotId> {
        if self.belief.holds_ball {
            return Some(self.config.robot);
        }
        self.teammates
            .present(now)
            .find(|(_, teammate)| teammate.beacon.status.has(Status::HOLDS_BALL))
            .map(|(id, _)| id)
    }

    /// On wheels: the ball rolls and a robot will intercept it before it stops, so that no case can be
    /// retrieved by its stop position.
    fn ball_is_nobodys(&self, holder: Option<RobotId>) -> bool {
        self.host.is_some()
            && holder.is_none()
            && self.belief.ball.is_some_and(|ball| ball.velocity.norm() > ON_ITS_WAY)
    }

    fn propose(&mut self, now: Instant) -> Option<CycleState> {
        let me = self.config.robot;
        let coordinator = election::coordinator(now, me, &self.beacon(now), &self.teammates)?;
        Some(election::proposal(self.cycle.id(), me, coordinator, self.config.epoch))
    }

    /// Involved in the running case, or its coordinator.
    fn takes_part(&self) -> bool {
        let me = self.config.robot;
        self.cycle.state().is_some_and(|state| {
            state.coordinator == me || state.play().is_some_and(|play| play.part_of(me).is_some())
        })
    }

    /// Why the open cycle cannot go on, as far as presence, time and the case base show; called by robots
    /// that may stop it.
    fn reason_to_stop(&self, now: Instant) -> Option<AbortReason> {
        let me = self.config.robot;
        let state = self.cycle.state().filter(|_| self.cycle.closure().is_none())?;
        let elects = election::elector(now, me, &self.teammates) == me;
        let takes_part = self.takes_part();
        if !(elects || takes_part) {
            return None;
        }
        // Restarted since: this boot epoch does not know what the earlier one did.
        let lost = |id: RobotId| {
            if id == me { self.cycle.is_of_an_earlier_epoch() } else { self.teammates.get(now, id).is_none() }
        };
        let players = state.play().map_or(&[][..], |play| &play.robots[..]);
        if lost(state.coordinator) || players.iter().any(|&id| lost(id)) {
            return Some(AbortReason::RobotLost);
        }
        if elects && self.timers.has_fired(Timer::NoDecision) {
            return Some(AbortReason::NoDecision);
        }
        if takes_part && self.timers.has_fired(Timer::Reuse) {
            return Some(AbortReason::Timeout);
        }
        let play = state.play().filter(|play| play.part_of(me).is_some())?;
        let theirs =
            self.teammates.get(now, state.coordinator).map_or(self.base.hash(), |m| m.beacon.case_base);
        let unknown = theirs != self.base.hash() || self.base.case(play.case).is_none();
        unknown.then_some(AbortReason::UnknownCase)
    }

    fn all_have_finished(&self, now: Instant) -> bool {
        let Some(state) = self.cycle.state() else { return false };
        let Some(play) = state.play() else { return false };
        play.robots.iter().all(|&id| {
            let progress = if id == self.config.robot {
                Some(self.cycle.progress)
            } else {
                self.teammates.get(now, id).and_then(|teammate| teammate.progress_in(state.id))
            };
            progress == Some(Progress::WaitEnd { finished: true })
        })
    }
}

/// Between being present and proposing: three steps of a walking robot, in which robots that booted at the
/// same moment receive each other's beacons.
const SETTLE_FOR: Duration = Duration::millis(120);
/// Maximum delay of the coordinator's decision: one lease.
const DECISION_PATIENCE: Duration = PRESENCE_LEASE;
/// Delay before the coordinator tries again after "no case": six steps of a walking robot.
const RETRY_AFTER: Duration = Duration::millis(240);
/// A faster ball is intercepted before it stops, m/s: it rolls 1.4 m and 2.9 s (v²/0.7, v/0.35).
const ON_ITS_WAY: f32 = 1.0;
