//! `pass_state`: memory of the ball that we kicked: the pass that rolls, and the robot that must not touch
//! the ball again. Attack frame, SI units.

use geometry::{Attack, Point};
use protocol::{Duration, Instant, RobotId};
use rules::{Phase, Side, contact};

use super::super::counters::Sent;
use super::super::pass::Rating;
use super::super::view::{View, ViewBall, ViewRobot, nearest};

/// A robot's centre this near the ball touches it, m.
const TOUCHES_WITHIN_M: f32 = contact::COACH_TOUCHES_WITHIN;
/// The opponent this near the ball takes their free kick, m.
const TAKES_WITHIN_M: f32 = 0.6;
/// Longest time for which a pass is waited for: 5 m take 2.5 s.
const PASS_LASTS_MAX: Duration = Duration::millis(3000);
/// Before this age of a pass its speed is not used: the ball is known to have moved, but not yet how fast.
const PASS_SPEED_KNOWN_AFTER: Duration = Duration::millis(300);
/// A ball slower than this counts as stopped, m/s.
const PASS_STOPPED_BELOW_M_S: f32 = 0.3;

/// A pass whose ball is moving.
#[derive(Clone, Copy, Debug)]
pub(super) struct RunningPass {
    pub(super) receiver: RobotId,
    pub(super) at: Point<Attack>,
    /// Target of the receiver's shot at first touch.
    pub(super) then: Option<Point<Attack>>,
    since: Instant,
}

impl RunningPass {
    /// A pass to `at` that leaves at `now`; with the shot of its rating, if that is at first touch.
    pub(super) fn new(receiver: RobotId, at: Point<Attack>, rating: Option<&Rating>, now: Instant) -> Self {
        let shot = rating.map(|rating| rating.shot).filter(|shot| shot.one_touch);
        Self { receiver, at, then: shot.map(|shot| shot.aim), since: now }
    }

    /// Whether it has ended: received, intercepted, stopped, or too old.
    fn is_over(&self, view: &View, ball: &ViewBall) -> bool {
        let age = view.now.since(self.since);
        age > PASS_LASTS_MAX
            || (age > PASS_SPEED_KNOWN_AFTER && ball.velocity.norm() < PASS_STOPPED_BELOW_M_S)
            || is_touched(view.theirs.iter(), ball)
            || is_touched(view.our(self.receiver).into_iter(), ball)
    }
}

/// Memory of the ball that we kicked.
#[derive(Clone, Debug, Default)]
pub(super) struct PassState {
    /// The pass that is running.
    pub(super) running: Option<RunningPass>,
    /// A pass that has just left, until the caller takes it.
    pub(super) sent: Option<Sent>,
    /// The robot that took our restart, until another robot touches the ball.
    pub(super) double_touch_blocked: Option<RobotId>,
    /// The opponent that takes or took their restart, until another robot touches the ball: it is no threat.
    pub(super) their_kicker: Option<RobotId>,
}

impl PassState {
    /// Ends the running pass and the block of a double touch where the view shows their end.
    pub(super) fn update(&mut self, view: &View) {
        let Some(ball) = view.ball else { return };
        if self.running.is_some_and(|pass| pass.is_over(view, &ball)) {
            self.running = None;
        }
        if view.phase == Phase::FreeKick(Side::Theirs) {
            let kicker = nearest(view.theirs.iter(), ball.position);
            self.their_kicker = kicker.filter(|(_, off)| *off < TAKES_WITHIN_M).map(|(robot, _)| robot.id);
        } else if let Some(kicker) = self.their_kicker {
            let others = view.theirs.iter().filter(|robot| robot.id != kicker).chain(view.ours.iter());
            if view.phase != Phase::Run || is_touched(others, &ball) {
                self.their_kicker = None;
            }
        }
        if let Some(blocked) = self.double_touch_blocked {
            let others = view.ours.iter().filter(|robot| robot.id != blocked).chain(view.theirs.iter());
            if is_touched(others, &ball) {
                self.double_touch_blocked = None;
            }
        }
    }
}

/// Whether one of these robots touches the ball.
fn is_touched<'r>(robots: impl Iterator<Item = &'r ViewRobot>, ball: &ViewBall) -> bool {
    nearest(robots, ball.position).is_some_and(|(_, distance)| distance < TOUCHES_WITHIN_M)
}
