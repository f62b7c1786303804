//! The brain as a value: what comes in, what goes out, and in which order it thinks (DESIGN §3).
//!
//! One mutation, then drain: after every `handle_…` call `poll_message` until `None`, then `poll_actuators`, then ask
//! `poll_timeout` when to come back.

use casebase::{CaseBase, CaseRobot, Problem};
use protocol::quantized::length_to_mm;
use protocol::robot_io::{ActuatorFrame, SensorFrame};
use protocol::team::{
    AbortReason, BallReport, Beacon, Closure, CycleState, Decision, Play, Progress, Role, Status, TeamMessage,
};
use protocol::{CycleId, Duration, Instant, RobotId};

use crate::belief::Belief;
use crate::body::{self, Body, Intent, legged};
use crate::config::{Approach, BrainConfig};
use crate::estimate;
use crate::execution::{Execution, Scene};
use crate::mates::{Mates, PRESENCE_LEASE};
use crate::reactive::{Freedom, Reactive};
use crate::team::cycle::News;
use crate::team::monitor::Monitor;
use crate::team::reuse::{self, Wish};
use crate::team::{Cycle, election, hybrid, retrieval};
use crate::timer::{Timer, TimerTable};

/// A robot's brain.
pub struct Brain<'a> {
    config: BrainConfig,
    body: &'static dyn Body,
    base: CaseBase<'a>,
    belief: Belief,
    mates: Mates,
    cycle: Cycle,
    execution: Option<Execution>,
    monitor: Monitor,
    reactive: Reactive,
    timers: TimerTable,
    awake: bool,
    /// How far the first proposal of this life jumps ahead.
    skip: u32,
    /// The closed cycle whose end this robot has told its mates.
    told_end_of: Option<CycleId>,
    actuators: Option<ActuatorFrame>,
    beacon_due: bool,
}

impl<'a> Brain<'a> {
    /// A robot that boots at `now`; it listens for one lease before it is present.
    pub fn new(now: Instant, config: &BrainConfig, base: CaseBase<'a>) -> Self {
        let mut timers = TimerTable::default();
        timers.set(Timer::Boot, now + PRESENCE_LEASE);
        Self {
            config: config.clone(),
            body: body::of(config.league),
            base,
            belief: Belief::new(config.league),
            mates: Mates::default(),
            cycle: Cycle::new(config.robot),
            execution: None,
            monitor: Monitor::default(),
            reactive: Reactive::of(config.league),
            timers,
            awake: false,
            skip: config.epoch.saturating_sub(1) % BOOT_SKIP,
            told_end_of: None,
            actuators: None,
            beacon_due: false,
        }
    }

    /// A teammate's beacon.
    pub fn handle_team_message(&mut self, now: Instant, from: RobotId, message: &TeamMessage) {
        // What mates tell the host of themselves is not for us.
        let TeamMessage::Beacon(beacon) = message else { return };
        self.timers.advance(now);
        self.mates.hear(now, from, beacon);
        if self.config.approach != Approach::Reactive
            && let Some(state) = &beacon.cycle
        {
            self.adopt(now, state);
        }
    }

    /// The body's senses: one whole step of thought.
    pub fn handle_sensors(&mut self, now: Instant, sensors: &SensorFrame) {
        self.timers.advance(now);
        self.mates.forget_the_silent(now);
        self.belief.update(now, self.config.robot, sensors, &self.mates);
        self.coordinate(now);
        let intent = self.act(now);
        self.actuators = Some(legged::actuate(now, &self.belief, &self.mates, intent));
        self.beacon_due = true;
    }

    /// A deadline has come.
    pub fn handle_timeout(&mut self, now: Instant) {
        self.timers.advance(now);
        self.mates.forget_the_silent(now);
        self.coordinate(now);
    }

    /// The next message to teammates.
    pub fn poll_message(&mut self, now: Instant) -> Option<TeamMessage> {
        if !core::mem::take(&mut self.beacon_due) {
            return None;
        }
        let beacon = self.beacon();
        if self.cycle.closure().is_some() && self.told_end_of != self.cycle.id() {
            // The end is told before the next cycle begins: who hears only the beginning would not know why.
            self.told_end_of = self.cycle.id();
            self.coordinate(now);
        }
        Some(TeamMessage::Beacon(beacon))
    }

    /// What the body shall do, once per step.
    pub fn poll_actuators(&mut self, _now: Instant) -> Option<ActuatorFrame> {
        self.actuators.take()
    }

    /// When [`Brain::handle_timeout`] wants to be called.
    pub fn poll_timeout(&self) -> Option<Instant> {
        self.timers.next()
    }

    /// What it believes.
    pub fn belief(&self) -> &Belief {
        &self.belief
    }

    /// What it knows of the running cycle.
    pub fn cycle(&self) -> &Cycle {
        &self.cycle
    }

    /// The problem it would retrieve for, if it had to decide now.
    pub fn problem(&self, now: Instant) -> Option<Problem> {
        let Self { config, base, belief, mates, .. } = self;
        retrieval::problem(now, config.robot, base, config.defending, belief, mates)
    }

    fn beacon(&self) -> Beacon {
        let mut status = Status::default();
        if self.awake {
            status = status.with(Status::AVAILABLE);
        }
        if self.config.retriever {
            status = status.with(Status::RETRIEVER);
        }
        if self.belief.holds_ball {
            status = status.with(Status::HOLDS_BALL);
        }
        Beacon {
            pose: self.belief.pose.into(),
            ball: self.belief.ball.map(|ball| BallReport {
                at: ball.position.into(),
                distance: length_to_mm(ball.position.distance(self.belief.pose.position)),
            }),
            status,
            case_base: self.base.hash(),
            cycle: self.cycle.state().cloned(),
            progress: self.cycle.progress,
            role: if self.execution.is_some() { Role::None } else { self.reactive.role() },
        }
    }

    /// Takes over what is newer, and sets this robot's own part accordingly.
    fn adopt(&mut self, now: Instant, state: &CycleState) {
        let news = self.cycle.adopt(state, self.awake);
        if news == News::Known {
            return;
        }
        self.beacon_due = true;
        for timer in [Timer::NoDecision, Timer::Retry, Timer::Pause] {
            self.timers.clear(timer);
        }
        match &state.decision {
            Decision::Undecided => self.timers.set(Timer::NoDecision, now + DECISION_PATIENCE),
            Decision::NoCase => self.timers.set(Timer::Retry, now + RETRY_AFTER),
            // Where no case was found nothing was played that there is to stop after.
            Decision::Closed(closure)
                if *closure != Closure::NoCase && self.config.pause_after_cycle > Duration(0) =>
            {
                self.timers.set(Timer::Pause, now + self.config.pause_after_cycle);
            }
            Decision::Play(_) | Decision::Closed(_) => {}
        }
        if news == News::Gameplay {
            self.begin_part(now);
        }
    }

    /// A gameplay has begun or ended: forget the old part, prepare the new one.
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

    /// Everything that concerns the team: being present, proposing, deciding, closing, aborting.
    fn coordinate(&mut self, now: Instant) {
        if !self.awake {
            if !self.timers.has_fired(Timer::Boot) {
                return;
            }
            self.awake = true;
            self.beacon_due = true;
            self.timers.set(Timer::Settle, now + SETTLE_FOR);
        }
        if self.config.approach == Approach::Reactive {
            return;
        }
        if let Some(reason) = self.reason_to_stop(now) {
            // Whoever takes part aborts; an elector that does not, supersedes.
            let next = if self.takes_part() { self.cycle.aborted(reason) } else { self.propose(now) };
            if let Some(state) = next {
                self.adopt(now, &state);
            }
        }
        if let Some(state) = self.next_state(now) {
            self.adopt(now, &state);
            // A cycle of one's own is decided at once.
            if let Some(state) = self.next_state(now) {
                self.adopt(now, &state);
            }
        }
    }

    /// Proposal, decision or end of the cycle, where it is this robot's to say.
    fn next_state(&mut self, now: Instant) -> Option<CycleState> {
        let me = self.config.robot;
        let elects = election::elector(now, me, &self.mates) == me;
        match self.cycle.state().map(|s| &s.decision) {
            None | Some(Decision::Closed(_)) => {
                let paused = !self.timers.is_idle(Timer::Pause) && !self.timers.has_fired(Timer::Pause);
                let settled = self.timers.has_fired(Timer::Settle);
                let told = self.cycle.closure().is_none() || self.told_end_of == self.cycle.id();
                if elects && settled && told && !paused { self.propose(now) } else { None }
            }
            Some(Decision::Undecided) if self.cycle.is_mine_to_decide() => {
                let holder = self.holder(now);
                let decision = self.problem(now).map_or(Decision::NoCase, |problem| {
                    retrieval::decide(&self.base, &problem, &self.config.settings, holder)
                });
                let decision = match decision {
                    Decision::Play(play) if self.shoots_sooner_without(now, &play) => Decision::NoCase,
                    other => other,
                };
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

    /// Led by both, and the reactive behaviour is expected to shoot sooner than this gameplay.
    fn shoots_sooner_without(&self, now: Instant, play: &Play) -> bool {
        if self.config.approach != Approach::Hybrid {
            return false;
        }
        let (Some(cycle), Some(case)) = (self.cycle.id(), self.base.case(play.case)) else { return false };
        let (belief, mates, base) = (&self.belief, &self.mates, &self.base);
        let scene = Scene { now, belief, mates, cycle, play, case, base, body: self.body };
        hybrid::reactive_shoots_sooner(&scene)
    }

    /// The robot of ours that has the ball in its grip, as far as this one knows.
    fn holder(&self, now: Instant) -> Option<RobotId> {
        if self.belief.holds_ball {
            return Some(self.config.robot);
        }
        let holds = |beacon: &Beacon| beacon.status.has(Status::HOLDS_BALL);
        self.mates.present(now).find(|(_, mate)| holds(&mate.beacon)).map(|(id, _)| id)
    }

    fn propose(&mut self, now: Instant) -> Option<CycleState> {
        let me = self.config.robot;
        let coordinator = election::coordinator(now, me, &self.beacon(), &self.mates)?;
        let skip = core::mem::take(&mut self.skip);
        Some(election::proposal(self.cycle.id(), me, coordinator, skip))
    }

    /// Involved in the running case, or its coordinator.
    fn takes_part(&self) -> bool {
        let me = self.config.robot;
        self.cycle.state().is_some_and(|state| {
            state.coordinator == me || state.play().is_some_and(|play| play.part_of(me).is_some())
        })
    }

    /// Why the open cycle cannot go on, as far as presence, time and the case base tell; asked by those who may stop it.
    fn reason_to_stop(&self, now: Instant) -> Option<AbortReason> {
        let me = self.config.robot;
        let state = self.cycle.state().filter(|_| self.cycle.closure().is_none())?;
        let elects = election::elector(now, me, &self.mates) == me;
        let takes_part = self.takes_part();
        if !(elects || takes_part) {
            return None;
        }
        // Reborn since: this life does not know what the earlier one did.
        let lost = |id: RobotId| {
            if id == me { self.cycle.is_of_an_earlier_life() } else { self.mates.get(now, id).is_none() }
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
        let theirs = self.mates.get(now, state.coordinator).map_or(self.base.hash(), |m| m.beacon.case_base);
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
                self.mates.get(now, id).and_then(|mate| mate.progress_in(state.id))
            };
            progress == Some(Progress::WaitEnd { finished: true })
        })
    }

    /// What the body shall do in this step.
    fn act(&mut self, now: Instant) -> Intent {
        if !self.awake {
            return Intent::Stand { face: None };
        }
        if self.config.approach == Approach::Reactive {
            return self.default_behaviour(now, Freedom::Full);
        }
        match self.reuse(now) {
            Wish::Body(intent) => {
                self.reactive.rest();
                return intent;
            }
            Wish::Abort(reason) => {
                if let Some(state) = self.cycle.aborted(reason) {
                    self.adopt(now, &state);
                }
            }
            Wish::Nothing => {}
        }
        if !self.timers.is_idle(Timer::Pause) && !self.timers.has_fired(Timer::Pause) {
            return Intent::Stand { face: None };
        }
        let freedom = match self.cycle.state().map(|s| &s.decision) {
            Some(Decision::NoCase | Decision::Closed(Closure::NoCase)) => Freedom::Full,
            Some(Decision::Play(_)) => Freedom::KeepNear,
            None | Some(Decision::Undecided | Decision::Closed(_)) => Freedom::Approach,
        };
        self.default_behaviour(now, freedom)
    }

    /// This robot's part in the running case, if it has one.
    fn reuse(&mut self, now: Instant) -> Wish {
        let Some(mut execution) = self.execution.take() else { return Wish::Nothing };
        let mut progress = self.cycle.progress;
        let mut touched = self.cycle.touched;
        let mut timers = core::mem::take(&mut self.timers);
        let mut monitor = core::mem::take(&mut self.monitor);
        let wish = match self.scene(now) {
            None => Wish::Abort(AbortReason::UnknownCase),
            Some(scene) => {
                touched |= scene.belief.holds_ball
                    || scene.play.robots.iter().any(|&id| {
                        self.mates
                            .get(now, id)
                            .filter(|mate| mate.progress_in(scene.cycle).is_some())
                            .is_some_and(|mate| mate.beacon.status.has(Status::HOLDS_BALL))
                    });
                let playing = !matches!(progress, Progress::WaitEnd { .. });
                let doubt = monitor.step(&scene, touched, &self.config.settings).filter(|_| playing);
                if let Some(reason) = doubt {
                    Wish::Abort(reason)
                } else {
                    let how = self.config.positioning;
                    reuse::step(&scene, how, &mut execution, &mut progress, &mut timers)
                }
            }
        };
        self.timers = timers;
        self.monitor = monitor;
        self.cycle.touched = touched;
        self.cycle.progress = progress;
        self.execution = Some(execution);
        wish
    }

    fn default_behaviour(&mut self, now: Instant, freedom: Freedom) -> Intent {
        let attacked = self.config.defending.opposite();
        self.reactive.step(now, self.config.robot, &self.belief, &self.mates, attacked, freedom)
    }

    fn scene(&self, now: Instant) -> Option<Scene<'_>> {
        let state = self.cycle.state()?;
        let play = state.play()?;
        let case = self.base.case(play.case)?;
        Some(Scene {
            now,
            belief: &self.belief,
            mates: &self.mates,
            cycle: state.id,
            play,
            case,
            base: &self.base,
            body: self.body,
        })
    }
}

/// Between being present and proposing: three steps of a walking robot, in which those who booted at the same moment
/// hear of each other.
const SETTLE_FOR: Duration = Duration::millis(120);
/// How long the coordinator may keep its decision to itself: one lease.
const DECISION_PATIENCE: Duration = PRESENCE_LEASE;
/// How soon the coordinator tries again after "no case": six steps of a walking robot.
const RETRY_AFTER: Duration = Duration::millis(240);
/// Lives of a robot jump ahead by their number modulo this.
const BOOT_SKIP: u32 = 64;
