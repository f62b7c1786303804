//! `directive`: execution of the host's directive: each has its skill, some with a small state.

use geometry::{Field, Point, Pose, Segment, Vector};
use protocol::Instant;
use protocol::host::{Directive, KickOrder};
use protocol::robot_io::OmniKick;

use crate::belief::Belief;
use crate::body::Intent;
use crate::body::omni::Drive;
use crate::skills::Step;
use crate::skills::wheels::{self, Placement};

/// State of the running directive.
#[derive(Clone, Debug, Default)]
pub struct TaskState {
    placement: Placement,
}

impl TaskState {
    /// The intent for `directive`; `None` where the robots choose for themselves.
    pub fn step(&mut self, now: Instant, belief: &Belief, directive: &Directive) -> Option<Intent> {
        if !matches!(directive, Directive::PlaceBall { .. }) {
            self.placement.end();
        }
        if belief.game.double_touch_blocked && touches(directive) {
            return Some(wheels::keep_off(belief));
        }
        Some(match *directive {
            Directive::Stand => Intent::Stand { face: None },
            Directive::GoTo { pose } => wheels::go_to(Pose::from(pose)),
            Directive::GetBall { face } => get_ball(belief, face.map(Point::from)),
            Directive::Kick { at, kick } => wheels::kick(belief, at.into(), order(kick)),
            Directive::Pass { at, kick, ready, .. } => wheels::pass(belief, at.into(), order(kick), ready),
            Directive::Receive { at, then } => wheels::receive(belief, at.into(), then.map(Point::from)),
            Directive::Dribble { pose } => wheels::dribble(belief, Pose::from(pose)),
            Directive::Block { from, to } => wheels::block(belief, Segment::new(from.into(), to.into())),
            Directive::PlaceBall { at } => wheels::place_ball(now, &mut self.placement, belief, at.into()),
            Directive::Gameplay { .. } => return None,
        })
    }
}

/// Takes the ball, and then faces `face`, or the attacked goal.
fn get_ball(belief: &Belief, face: Option<Point<Field>>) -> Intent {
    let face = face.unwrap_or_else(|| belief.league().field().goal_center(belief.game.defending.opposite()));
    let from = belief.ball.map_or(belief.pose.position, |ball| ball.position);
    match wheels::get_ball(belief, Some(from.direction_to(face))) {
        Step::Running(intent) => intent,
        // No body turns with the ball between a wall and itself: first it comes away from there.
        Step::Done if wheels::barrier(belief, belief.dribbler_point()).is_some() => {
            let heading = belief.pose.heading;
            Drive::holding(belief.pose.position - Vector::polar(COMES_AWAY, heading), heading).into()
        }
        Step::Done => wheels::kick_held(belief, face, OmniKick::None),
    }
}

/// Whether its skill may touch the ball.
fn touches(directive: &Directive) -> bool {
    matches!(
        directive,
        Directive::GetBall { .. }
            | Directive::Kick { .. }
            | Directive::Pass { .. }
            | Directive::Receive { .. }
            | Directive::Dribble { .. }
    )
}

/// Converts the wire's cm/s.
fn order(kick: KickOrder) -> OmniKick {
    match kick {
        KickOrder::Flat(speed) => OmniKick::Flat(f32::from(speed) * 0.01),
        KickOrder::Chip(speed) => OmniKick::Chip(f32::from(speed) * 0.01),
    }
}

/// How far a robot aims behind itself when it comes away from a wall or an opponent with the ball, m.
const COMES_AWAY: f32 = 0.3;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::skills::wheels::testing::belief;
    use protocol::quantized::WirePoint;

    const TARGET: WirePoint = WirePoint { x: 1000, y: 0 };

    #[test]
    fn kicker_of_a_restart_avoids_the_ball_until_another_touch() {
        let mut b = belief((0.0, 0.0, 0.0), (0.12, 0.0));
        b.game.double_touch_blocked = true;
        let kick = KickOrder::Flat(400);
        let directives = [
            Directive::GetBall { face: None },
            Directive::Kick { at: TARGET, kick },
            Directive::Pass { at: TARGET, receiver: protocol::RobotId::new(1).unwrap(), kick, ready: true },
            Directive::Receive { at: TARGET, then: None },
        ];
        for directive in directives {
            let Some(Intent::Drive(drive)) = TaskState::default().step(Instant(0), &b, &directive) else {
                panic!()
            };
            assert!(drive.to.x() < -0.2, "{directive:?}: {drive:?}");
        }
    }

    #[test]
    fn gameplay_is_the_robots_own_choice() {
        let b = belief((0.0, 0.0, 0.0), (1.0, 0.0));
        assert_eq!(TaskState::default().step(Instant(0), &b, &Directive::Gameplay { hint: None }), None);
        assert_eq!(order(KickOrder::Chip(350)), OmniKick::Chip(3.5));
    }

    #[test]
    fn a_ball_taken_at_a_board_is_pulled_away_before_it_is_turned() {
        let at = 3.27 - crate::body::omni::BALL_AT;
        let mut b = belief((1.0, at, 90.0), (1.0, 3.27));
        b.holds_ball = true;
        let Intent::Drive(drive) = get_ball(&b, None) else { panic!() };
        assert!(drive.to.y() < at - 0.2 && (drive.face.to_degrees() - 90.0).abs() < 1e-3, "{drive:?}");
    }
}
