//! Choice of the intent: the host's directive, this robot's part in a case, or the reactive behaviour.

use protocol::Instant;
use protocol::host::Directive;
use protocol::team::{AbortReason, Closure, Decision, Progress, Status};
use rules::Phase;

use super::Brain;
use crate::action_scene::ActionScene;
use crate::body::Intent;
use crate::config::Approach;
use crate::reactive::Freedom;
use crate::skills::wheels;
use crate::team::reuse::{self, ReuseRequest};
use crate::timer::Timer;

/// Instructions of a case that is carried out, beyond a skill's.
const EFFORT_OF_PLAY: u32 = 2_500;

impl Brain<'_> {
    /// The intent of this step.
    pub(super) fn act(&mut self, now: Instant) -> Intent {
        let intent = self.choose(now);
        if !cfg!(feature = "omni") || self.host.is_none() {
            return intent;
        }
        // Placing a ball is not play: the ball may be held and carried without a limit.
        let intent = if self.belief.game.phase == Phase::Run {
            wheels::let_go_in_time(&mut self.belief, intent)
        } else {
            intent
        };
        let directive = self.host.as_ref().and_then(|host| host.directive(now));
        // A ball that is redirected does not leave along the heading.
        let ordered = matches!(
            directive,
            Some(Directive::Kick { .. } | Directive::Pass { .. } | Directive::Receive { then: Some(_), .. })
        );
        wheels::release(&self.belief, intent, ordered)
    }

    /// The intent of the host's directive, the case or the reactive behaviour.
    fn choose(&mut self, now: Instant) -> Intent {
        if cfg!(feature = "omni")
            && let Some(host) = &self.host
        {
            let Some(directive) = host.directive(now) else { return Intent::Stand { face: None } };
            if let Some(intent) = self.task_state.step(now, &self.belief, directive) {
                self.reactive.rest();
                return intent;
            }
            if !self.was_available {
                // Between gameplays it stays in place, outside of forbidden regions.
                return wheels::go_to(self.belief.pose);
            }
        }
        self.play(now)
    }

    /// The intent of the case, or of the reactive behaviour.
    fn play(&mut self, now: Instant) -> Intent {
        if !self.awake {
            return Intent::Stand { face: None };
        }
        self.actuation.spend(EFFORT_OF_PLAY);
        if self.config.approach == Approach::Reactive {
            return self.default_behaviour(now, Freedom::Full);
        }
        match self.reuse(now) {
            ReuseRequest::Body(intent) => {
                self.reactive.rest();
                return intent;
            }
            ReuseRequest::Abort(reason) => {
                if let Some(state) = self.cycle.aborted(reason) {
                    self.adopt_own(now, &state);
                }
                // This step ends a gameplay, and may begin the next: the robot stands in it.
                self.since.gameplay_changed = false;
                return Intent::Stand { face: None };
            }
            ReuseRequest::Nothing => {}
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
    fn reuse(&mut self, now: Instant) -> ReuseRequest {
        let Some(mut execution) = self.execution.take() else { return ReuseRequest::Nothing };
        let mut progress = self.cycle.progress;
        let mut touched = self.cycle.touched;
        let mut timers = core::mem::take(&mut self.timers);
        let mut monitor = core::mem::take(&mut self.monitor);
        let request = match self.scene(now) {
            None => ReuseRequest::Abort(AbortReason::UnknownCase),
            Some(scene) => {
                touched |= scene.belief.holds_ball
                    || scene.play.robots.iter().any(|&id| {
                        self.teammates
                            .get(now, id)
                            .filter(|teammate| teammate.progress_in(scene.cycle).is_some())
                            .is_some_and(|teammate| teammate.beacon.status.has(Status::HOLDS_BALL))
                    });
                let playing = !matches!(progress, Progress::WaitEnd { .. });
                let doubt = monitor.step(&scene, touched, &self.config.settings).filter(|_| playing);
                if let Some(reason) = doubt {
                    ReuseRequest::Abort(reason)
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
        request
    }

    fn default_behaviour(&mut self, now: Instant, freedom: Freedom) -> Intent {
        let attacked = self.belief.game.defending.opposite();
        self.reactive.step(now, self.config.robot, &self.belief, &self.teammates, attacked, freedom)
    }

    pub(super) fn scene(&self, now: Instant) -> Option<ActionScene<'_>> {
        let state = self.cycle.state()?;
        let play = state.play()?;
        let case = self.base.case(play.case)?;
        Some(ActionScene {
            now,
            belief: &self.belief,
            teammates: &self.teammates,
            cycle: state.id,
            play,
            case,
            base: &self.base,
            body: self.body,
        })
    }
}
