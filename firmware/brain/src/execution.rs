//! `execution`: execution of a robot's part of a case. Preconditions start actions, no clock does (paper
//! §2.2; docs/case-format.md §4).
//!
//! The place in the action list is the only state that teammates receive: `done` counts finished actions, is
//! repeated in every beacon, and *is* the event `PassDone` (`done` has passed the pass). Points of the case
//! are adapted by the ball the coordinator used. Field frame, SI.

use casebase::{Action, CaseRobot, KickAim, TurnTarget};
use geometry::{Angle, Field, Point, math};
use protocol::Duration;
use protocol::team::{AbortReason, Progress, ShotRule};

use crate::action_scene::ActionScene;
use crate::belief::Belief;
use crate::body::Intent;
use crate::estimate;
use crate::skills::{Reception, Step};
use crate::timer::{Timer, TimerTable};

/// Result of one step of execution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ActionOutcome {
    /// It continues with this intent.
    Running(Intent),
    /// All actions are done.
    Finished,
    /// The part cannot be finished.
    Failed(AbortReason),
}

/// One robot's progress through its actions.
#[derive(Clone, Debug)]
pub struct Execution {
    part: CaseRobot,
    done: usize,
    place: Option<Point<Field>>,
    held: bool,
    kicked: bool,
    started: bool,
    /// The ball leaves by a shot instead of the action.
    shot_pressed: bool,
    /// The rule of the last shot, made or prepared.
    shot_rule: ShotRule,
    /// The hand-overs of the actions looked up last, by their number: finding one walks the whole case.
    partners: [Option<(usize, Partner)>; 2],
}

/// The other end of an action's hand-over, if it has one.
type Partner = Option<(CaseRobot, usize)>;

impl Execution {
    /// At the beginning of `part`.
    pub fn new(part: CaseRobot) -> Self {
        Self {
            part,
            done: 0,
            place: None,
            held: false,
            kicked: false,
            started: false,
            shot_pressed: false,
            shot_rule: ShotRule::NoShot,
            partners: [None; 2],
        }
    }

    /// The case robot it plays.
    pub fn part(&self) -> CaseRobot {
        self.part
    }

    /// The rule that chose the last shot, made or prepared.
    pub fn shot_rule(&self) -> ShotRule {
        self.shot_rule
    }

    /// Number of actions done.
    pub fn done(&self) -> u8 {
        self.done.min(usize::from(u8::MAX)) as u8
    }

    /// One step: runs the current action, and continues with the next ones as they start and end.
    pub fn step(&mut self, scene: &ActionScene<'_>, timers: &mut TimerTable) -> ActionOutcome {
        for _ in 0..ACTIONS_A_STEP {
            let Some(action) = scene.case.action(self.part, self.done) else {
                return ActionOutcome::Finished;
            };
            if let Some(outcome) = self.shoot_if_pressed(scene, action) {
                return outcome;
            }
            if !self.started {
                if !self.may_start(scene, timers, self.done) {
                    return ActionOutcome::Running(self.hold(scene));
                }
                self.started = true;
                // Waiting has no limit of its own (docs/case-format.md §4): the gameplay's is enough.
                if action != Action::Wait {
                    let after = estimate::limit(self.expected(scene));
                    timers.set(Timer::Action, scene.now + after);
                }
            }
            match self.run(scene, timers, action) {
                Verdict::Running(intent) => {
                    return if timers.has_fired(Timer::Action) {
                        ActionOutcome::Failed(AbortReason::Timeout)
                    } else {
                        ActionOutcome::Running(intent)
                    };
                }
                Verdict::Failed(reason) => return ActionOutcome::Failed(reason),
                Verdict::Done => self.advance(scene, timers, action),
            }
        }
        ActionOutcome::Running(self.hold(scene))
    }

    /// Carrying the ball or waiting with it for a receiver, while an opponent comes for it: a shot, where
    /// that is worth more. It ends the case.
    fn shoot_if_pressed(&mut self, scene: &ActionScene<'_>, action: Action) -> Option<ActionOutcome> {
        let (belief, spec) = (scene.belief, scene.body.spec());
        if !belief.holds_ball {
            return self.shot_pressed.then_some(ActionOutcome::Failed(AbortReason::OpponentOnBall));
        }
        if belief.busy {
            return self.shot_pressed.then_some(ActionOutcome::Running(Intent::Stand { face: None }));
        }
        let time = match action {
            Action::DribbleTo(point) => {
                let (at, to) = (belief.pose.position, scene.adapt(point));
                let turn = (at.direction_to(to) - belief.pose.heading).abs();
                at.distance(to) / spec.carry_speed + turn * spec.turn / math::FRAC_PI_2
            }
            Action::PassBall(_) => PASS_PATIENCE.as_secs_f32() + spec.kick,
            _ => return None,
        };
        let attacked = scene.case.defending().opposite();
        let intent = scene.body.pressed_shot(belief, attacked, time)?;
        self.shot_pressed = intent.lets_go();
        self.shot_rule = ShotRule::Pressed;
        Some(ActionOutcome::Running(intent))
    }

    fn advance(&mut self, scene: &ActionScene<'_>, timers: &mut TimerTable, action: Action) {
        if matches!(
            action,
            Action::GoToPoint(_) | Action::DribbleTo(_) | Action::GetBall | Action::ReceiveBall(_)
        ) {
            self.place = Some(scene.belief.pose.position);
        }
        self.done += 1;
        self.held = scene.belief.holds_ball;
        (self.kicked, self.started, self.shot_pressed) = (false, false, false);
        for timer in [Timer::Action, Timer::PassPatience, Timer::OpponentHolds] {
            timers.clear(timer);
        }
    }

    /// Expected seconds of the current action.
    fn expected(&mut self, scene: &ActionScene<'_>) -> f32 {
        let (part, index) = (self.part, self.done);
        estimate::action_with(scene, part, index, || self.partner_of(scene, index))
    }

    /// The other end of the hand-over of action number `index`; looked up once.
    fn partner_of(&mut self, scene: &ActionScene<'_>, index: usize) -> Partner {
        // The current action and the next are looked up in turn: two places are enough.
        let slot = &mut self.partners[index % 2];
        if let Some((of, partner)) = *slot
            && of == index
        {
            return partner;
        }
        let partner = scene.case.partner_of(self.part, index);
        *slot = Some((index, partner));
        partner
    }

    /// Whether action number `index` may start.
    fn may_start(&mut self, scene: &ActionScene<'_>, timers: &mut TimerTable, index: usize) -> bool {
        match scene.case.action(self.part, index) {
            None | Some(Action::Wait | Action::GoToPoint(_) | Action::Turn(_)) => true,
            Some(Action::GetBall) if index == 0 => true,
            Some(Action::GetBall | Action::ReceiveBall(_)) => self.ball_is_handed_over(scene, index),
            Some(Action::DribbleTo(_) | Action::Kick(_)) => scene.belief.holds_ball || self.held,
            Some(Action::PassBall(to)) => {
                if !(scene.belief.holds_ball || self.held) {
                    return false;
                }
                timers.set_if_idle(Timer::PassPatience, scene.now, PASS_PATIENCE);
                timers.has_fired(Timer::PassPatience) || self.receiver_is_ready(scene, index, to)
            }
        }
    }

    /// The kick or pass that gives us the ball is done, or the ball is seen coming.
    fn ball_is_handed_over(&mut self, scene: &ActionScene<'_>, index: usize) -> bool {
        let Some((from, their_action)) = self.partner_of(scene, index) else { return true };
        let done = if from == self.part {
            self.done > their_action
        } else {
            match scene.progress_of(from) {
                Some(Progress::Execute { done }) => usize::from(done) > their_action,
                Some(Progress::WaitEnd { finished }) => finished,
                _ => false,
            }
        };
        let receiving = matches!(scene.case.action(self.part, index), Some(Action::ReceiveBall(_)));
        let coming = receiving
            && scene
                .belief
                .ball
                .is_some_and(|ball| ball.rolls_towards(scene.belief.pose.position, COMING_WITHIN))
            && !scene.teammates.anyone_holds_ball();
        let taken = !receiving && scene.teammates.anyone_holds_ball();
        (done && !taken) || coming
    }

    /// The receiver has come to its `receive_ball` (a wait before it counts as waiting for it) and to its
    /// place.
    fn receiver_is_ready(&mut self, scene: &ActionScene<'_>, index: usize, to: CaseRobot) -> bool {
        let Some((_, receive)) = self.partner_of(scene, index) else { return true };
        let Some(Progress::Execute { done }) = scene.progress_of(to) else { return false };
        let waits = |i| matches!(scene.case.action(to, i), Some(Action::Wait));
        let at_receive = (usize::from(done)..receive).all(waits);
        let Some((place, _)) = scene.leg_of(self.part, index) else { return at_receive };
        // It arrives before the ball: it walks while the ball rolls.
        let rolls_for = estimate::roll(scene, scene.belief.pose.position.distance(place));
        let spec = scene.body.spec();
        let near = (rolls_for * spec.speed * spec.receiver_haste).max(spec.receiver_near);
        let teammate = scene.player(to).and_then(|id| scene.teammates.get(scene.now, id));
        at_receive && teammate.is_some_and(|teammate| teammate.pose().position.distance(place) < near)
    }

    fn run(&mut self, scene: &ActionScene<'_>, timers: &mut TimerTable, action: Action) -> Verdict {
        let belief = scene.belief;
        match action {
            Action::Wait => {
                let next = self.done + 1;
                let last = scene.case.action(self.part, next).is_none();
                if last || self.may_start(scene, timers, next) {
                    Verdict::Done
                } else {
                    Verdict::Running(self.hold(scene))
                }
            }
            Action::GoToPoint(point) => {
                let to = scene.adapt(point);
                if belief.pose.position.distance(to) <= scene.body.spec().arrived_within {
                    return Verdict::Done;
                }
                let face = face_ball(belief, to);
                Verdict::Running(Intent::Walk { to, face, avoid_ball: true })
            }
            Action::Turn(target) => {
                let heading = match target {
                    TurnTarget::HeadingDeg(degrees) => {
                        attack_direction(scene) + Angle::degrees(degrees as f32)
                    }
                    TurnTarget::Face(point) => belief.pose.position.direction_to(scene.adapt(point)),
                };
                if (heading - belief.pose.heading).abs() <= TURNED_WITHIN {
                    return Verdict::Done;
                }
                Verdict::Running(Intent::Turn { heading })
            }
            Action::GetBall => {
                Self::take(scene, timers, scene.body.get_ball(belief, self.exit_heading(scene)))
            }
            Action::ReceiveBall(_) => match scene.body.receive(belief, self.exit_heading(scene)) {
                Reception::Going(step) => Self::take(scene, timers, step),
                Reception::Missed => Verdict::Failed(AbortReason::ActionFailed),
            },
            Action::DribbleTo(point) => {
                if !belief.holds_ball {
                    return Verdict::Failed(AbortReason::ActionFailed);
                }
                Verdict::from(scene.body.carry_to(belief, scene.adapt(point)))
            }
            Action::PassBall(_) => {
                let Some((place, _)) = scene.leg_of(self.part, self.done) else {
                    return Verdict::Failed(AbortReason::ActionFailed);
                };
                self.release(belief, scene.body.pass(belief, place))
            }
            Action::Kick(id) => {
                let leg = scene.leg_of(self.part, self.done);
                let (Some(kick), Some((end, along))) = (scene.base.kick(id), leg) else {
                    return Verdict::Failed(AbortReason::ActionFailed);
                };
                match kick.aim {
                    // The leg is kicked that was checked, unless the moment has made another better.
                    KickAim::Goal { .. } => {
                        timers.set_if_idle(Timer::PassPatience, scene.now, scene.body.spec().shot_patience);
                        let patient = !timers.has_fired(Timer::PassPatience);
                        let attacked = scene.case.defending().opposite();
                        match scene.body.shoot_leg(belief, attacked, (&kick, end), patient) {
                            Some((intent, rule)) => {
                                // The order that let it go stays the reason while the ball leaves.
                                if !self.kicked && belief.holds_ball && !belief.busy {
                                    self.shot_rule = rule;
                                }
                                self.release(belief, intent)
                            }
                            None if self.kicked || belief.busy => {
                                self.release(belief, Intent::Stand { face: None })
                            }
                            None => Verdict::Failed(AbortReason::Timeout),
                        }
                    }
                    KickAim::Heading { .. } => {
                        self.release(belief, scene.body.kick(belief, &kick, along, end))
                    }
                }
            }
        }
    }

    /// Getting the ball fails when an opponent has had it for too long.
    fn take(scene: &ActionScene<'_>, timers: &mut TimerTable, step: Step) -> Verdict {
        if scene.belief.opponent_on_ball(scene.now, scene.teammates) {
            timers.set_if_idle(Timer::OpponentHolds, scene.now, OPPONENT_PATIENCE);
        } else {
            timers.clear(Timer::OpponentHolds);
        }
        if timers.has_fired(Timer::OpponentHolds) {
            return Verdict::Failed(AbortReason::OpponentOnBall);
        }
        Verdict::from(step)
    }

    /// Aims and kicks as `intent` orders; done when the ball has left, failed when it was lost before.
    fn release(&mut self, belief: &Belief, intent: Intent) -> Verdict {
        if self.kicked && !belief.holds_ball {
            return Verdict::Done;
        }
        if !belief.holds_ball {
            return Verdict::Failed(AbortReason::ActionFailed);
        }
        if belief.busy {
            return Verdict::Running(Intent::Stand { face: None });
        }
        // A kick takes its time to leave: it counts though the order for it has ended.
        self.kicked |= intent.lets_go();
        Verdict::Running(intent)
    }

    /// Holding its place, facing the ball: what a robot does before its next action may start.
    fn hold(&self, scene: &ActionScene<'_>) -> Intent {
        if scene.belief.holds_ball {
            return self.aim_ahead(scene).unwrap_or(Intent::Stand { face: None });
        }
        let to = self.place.unwrap_or_else(|| scene.place_of(self.part));
        Intent::Walk { to, face: face_ball(scene.belief, to), avoid_ball: true }
    }

    /// Turning for the pass that waits for its receiver.
    fn aim_ahead(&self, scene: &ActionScene<'_>) -> Option<Intent> {
        let Some(Action::PassBall(_)) = scene.case.action(self.part, self.done) else { return None };
        let (place, _) = scene.leg_of(self.part, self.done)?;
        Some(scene.body.pass(scene.belief, place)).filter(|intent| matches!(intent, Intent::Turn { .. }))
    }

    /// Heading that the action after getting the ball needs.
    fn exit_heading(&self, scene: &ActionScene<'_>) -> Option<Angle> {
        let next = self.done + 1;
        match scene.case.action(self.part, next)? {
            Action::PassBall(_) => scene.leg_of(self.part, next).map(|(_, along)| along),
            Action::Kick(id) => {
                let kick = scene.base.kick(id)?;
                let (_, along) = scene.leg_of(self.part, next)?;
                Some(scene.body.heading_for(&kick, along))
            }
            Action::DribbleTo(point) => Some(scene.belief.pose.position.direction_to(scene.adapt(point))),
            _ => None,
        }
    }
}

enum Verdict {
    Running(Intent),
    Done,
    Failed(AbortReason),
}

impl From<Step> for Verdict {
    fn from(step: Step) -> Self {
        match step {
            Step::Running(intent) => Self::Running(intent),
            Step::Done => Self::Done,
        }
    }
}

/// The heading from `at` to the ball, or the present one while no ball is known.
pub(crate) fn face_ball(belief: &Belief, at: Point<Field>) -> Angle {
    belief.ball.map_or(belief.pose.heading, |ball| at.direction_to(ball.position))
}

fn attack_direction(scene: &ActionScene<'_>) -> Angle {
    if scene.case.defending().attack_sign() > 0 { Angle::ZERO } else { Angle::HALF_TURN }
}

/// Actions that may end and start within one step; the table's byte limits a list to as many.
const ACTIONS_A_STEP: usize = 8;
/// A robot has turned within 10° (docs/case-format.md §4).
const TURNED_WITHIN: f32 = 0.175;
/// Time for which the passer waits for its receiver (docs/case-format.md §4).
const PASS_PATIENCE: Duration = Duration::millis(1000);
/// Time for which an opponent may hold the ball before `get_ball` gives up (docs/case-format.md §4).
const OPPONENT_PATIENCE: Duration = Duration::millis(1000);
/// A ball rolling within this distance of a receiver comes to it, m.
const COMING_WITHIN: f32 = 0.4;
