//! `uncover`: a robot at a ball that no camera sees and that it does not have makes way. Attack frame, SI
//! units.
//!
//! A ball that lies between robots may be hidden from all cameras. Each robot then stands before the place
//! where it believes the ball, which is not at its dribbler, and neither moves: the game stops for no
//! progress. A robot that steps back shows the ball to the cameras, or leaves it to the other.

use geometry::{Attack, Point};
use protocol::{Duration, Instant, RobotId};

use super::super::order::{OrderReason, Role};
use super::super::view::{ViewBall, nearest};
use super::{Coach, Plan};

/// A ball unseen for longer is hidden, not missed by the cameras: they miss at most some frames in a row.
const HIDDEN_AFTER: Duration = Duration::millis(1000);
/// A slower ball lies, m/s: one that a robot carries is faster.
const RESTING_SPEED_MAX_M_S: f32 = 0.1;
/// A robot's centre this near a ball hides it, m: its diameter.
const HIDES_WITHIN_M: f32 = 2.0 * rules::limits::ROBOT_RADIUS;
/// Distance from the ball to which a robot steps back, m: two diameters show what lay beside one.
const STEP_BACK_TO_M: f32 = 2.0 * HIDES_WITHIN_M;
/// Time for stepping back: 0.2 m from rest at 3 m/s², the radio, and five frames of vision.
const STEP_BACK_TIME: Duration = Duration::millis(800);
/// Least time between two steps back: between, the robot tries to get the ball.
const STEP_BACK_EVERY: Duration = Duration::millis(2500);

/// A robot that steps back.
#[derive(Clone, Copy, Debug)]
pub(super) struct Uncovering {
    who: RobotId,
    to: Point<Attack>,
    since: Instant,
}

impl Coach {
    /// Orders the robot at a hidden ball that it does not have to step back, for a while or until the ball is
    /// seen.
    pub(super) fn order_uncovering(&mut self, plan: &mut Plan<'_>, ball: &ViewBall) {
        let view = plan.view;
        let running =
            self.open_play.uncovering.filter(|uncovering| view.now.since(uncovering.since) < STEP_BACK_EVERY);
        self.open_play.uncovering = running.or_else(|| {
            let rests = ball.velocity.norm() < RESTING_SPEED_MAX_M_S;
            let fields = view.ours.iter().filter(|robot| robot.id != view.keeper);
            let (robot, apart) = nearest(fields, ball.position)?;
            let stuck =
                ball.unseen > HIDDEN_AFTER && rests && apart < HIDES_WITHIN_M && !view.contact.has(robot.id);
            let robot = stuck.then_some(robot)?;
            let to = ball.position + (robot.position - ball.position).unit()? * STEP_BACK_TO_M;
            Some(Uncovering { who: robot.id, to, since: view.now })
        });
        if let Some(Uncovering { who, to, since }) = self.open_play.uncovering
            && ball.unseen > HIDDEN_AFTER
            && view.now.since(since) < STEP_BACK_TIME
            && plan.take(who)
        {
            let to = plan.kept_off(to);
            plan.order(who, Role::Player, plan.facing_ball(to), OrderReason::Uncovers);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::strategy::Team;
    use crate::strategy::order::Task;
    use crate::strategy::tactics::Tactics;
    use crate::strategy::view::tests::view;
    use crate::strategy::view::{RobotSet, View};
    use rules::{League, Phase};

    /// One of ours 0.12 m beside a ball in open play, hidden for `unseen`.
    fn beside(unseen: u64) -> View {
        let mut view = view((0.0, 0.0), &[(-4.4, 0.0), (-0.12, 0.0)], &[(0.12, 0.0)]);
        (view.phase, view.now) = (Phase::Run, Instant(10_000_000));
        view.ball =
            Some(ViewBall { unseen: Duration::millis(unseen), ..ViewBall::at_rest(Point::new(0.0, 0.0)) });
        view
    }

    /// Where it steps back to, if it does.
    fn steps_back(coach: &mut Coach, view: &View) -> Option<Point<Attack>> {
        let orders = coach.decide(view);
        let order = orders.iter().find(|order| matches!(order.why, OrderReason::Uncovers))?;
        match order.task {
            Task::GoTo { at, .. } => Some(at),
            _ => None,
        }
    }

    fn coach() -> Coach {
        Coach::new(Team::Ours, Tactics::default(), League::DivisionB)
    }

    #[test]
    fn a_robot_at_a_hidden_ball_that_it_does_not_have_steps_back() {
        let at = steps_back(&mut coach(), &beside(1500)).unwrap();
        assert!(at.distance(Point::new(-STEP_BACK_TO_M, 0.0)) < 0.01, "{at:?}");
        assert_eq!(steps_back(&mut coach(), &beside(500)), None, "cameras may have missed it");
        let mut had = beside(1500);
        had.contact = RobotSet::default();
        had.contact.insert(had.ours[1].id);
        assert_eq!(steps_back(&mut coach(), &had), None, "it has the ball");
        let mut far = beside(1500);
        far.ours[1].position = Point::new(-0.3, 0.0);
        assert_eq!(steps_back(&mut coach(), &far), None, "it hides nothing");
    }

    #[test]
    fn it_steps_back_for_a_while_and_then_tries_to_get_the_ball() {
        let (mut coach, mut view) = (coach(), beside(1500));
        let start = view.now;
        assert!(steps_back(&mut coach, &view).is_some());
        view.now = start + Duration::millis(500);
        view.ours[1].position = Point::new(-0.3, 0.0);
        assert!(steps_back(&mut coach, &view).is_some(), "on its way");
        view.ball.as_mut().unwrap().unseen = Duration(0);
        assert_eq!(steps_back(&mut coach, &view), None, "the ball is seen");
        view.ball.as_mut().unwrap().unseen = Duration::millis(2000);
        view.ours[1].position = Point::new(-0.12, 0.0);
        view.now = start + Duration::millis(1000);
        assert_eq!(steps_back(&mut coach, &view), None, "it tries again");
        view.now = start + Duration::millis(3000);
        assert!(steps_back(&mut coach, &view).is_some());
    }
}
