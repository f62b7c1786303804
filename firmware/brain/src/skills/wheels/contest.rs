//! `contest`: contact first, the turn after, where an opponent has a ball or comes for one that a robot would
//! go round. SI, field frame.

use geometry::{Angle, math};
use protocol::host::RuleRole;
use protocol::robot_io::OmniKick;
use rules::Side;

use crate::belief::{Belief, BelievedBall};
use crate::body::Intent;
use crate::body::omni::{BALL_AT, Drive};

/// Straight to a ball that shall be touched at once, and there this kick, if the robot looks along `face`;
/// none where there is time to line up for it first.
// Called from two places; a copy in each takes flash.
#[inline(never)]
pub(super) fn contest(belief: &Belief, ball: &BelievedBall, face: Angle, kick: OmniKick) -> Option<Intent> {
    if !takes_first(belief, ball, face) {
        return None;
    }
    let aimed = (face - belief.pose.heading).abs() < AIM_CLEARS;
    Some(take(belief, ball, if aimed { kick } else { OmniKick::None }).into())
}

/// Whether a ball nearby shall be touched at once: an opponent has it or could be there before this robot is
/// behind it, or the robot is the keeper.
fn takes_first(belief: &Belief, ball: &BelievedBall, face: Angle) -> bool {
    let me = belief.pose.position;
    let round = (me.direction_to(ball.position) - face).abs();
    let opponent = belief.nearest_opponent(ball.position).map_or(f32::INFINITY, |(_, distance)| distance);
    let wanted = opponent < HAS_BALL
        || belief.game.rule_role == RuleRole::Keeper
        || round > GOES_ROUND && is_pressed(belief, ball);
    // Not at the own goal line, nor towards it where that is near: a ball that is pushed there is in, or out.
    let field = belief.league().field();
    let line = field.goal_center(belief.game.defending).x();
    let pushes_back = (ball.position.x() - me.x()) * line > 0.0;
    let off_line = if pushes_back { PUSHED_BACK_OFF_LINE } else { OFF_LINE };
    let at_line = (line - ball.position.x()).abs() < off_line;
    let within = if opponent < HAS_BALL { TACKLED_WITHIN } else { TAKEN_WITHIN };
    wanted && me.distance(ball.position) < within && !at_line
}

/// Whether an opponent is close to the ball, or comes for it.
fn is_pressed(belief: &Belief, ball: &BelievedBall) -> bool {
    belief.others.iter().filter(|other| other.side == Side::Theirs).any(|other| {
        let off = ball.position - other.pose.position;
        let distance = off.norm();
        distance < CLOSE_WITHIN_M || distance < PRESSED && other.velocity.dot(off) > COMES_AT * distance
    })
}

/// Straight to the ball, and slow at it while the roller does not face it.
fn take(belief: &Belief, ball: &BelievedBall, kick: OmniKick) -> Drive {
    let me = belief.pose.position;
    let lead = TAKE_LEAD + LEADS_FARTHER * me.distance(ball.position);
    let to_ball = ball.position + ball.velocity * lead - me;
    let face = to_ball.angle();
    let gap = to_ball.norm() - BALL_AT;
    let to = me + to_ball.unit().unwrap_or_default() * (gap + GOES_THROUGH);
    let speed =
        TAKES + ball.velocity.norm() + math::sqrt(2.0 * belief.limits_without_ball().braking * gap.max(0.0));
    Drive { speed, dribbler: 1.0, kick, acceleration_share: TAKES_HARDER, ..Drive::bold(to, face) }
}

/// An opponent this near that moves towards the ball comes for it, m: it is there in the time of half a
/// circle around the ball.
const PRESSED: f32 = 1.3;
/// Speed towards the ball from which on it comes, m/s; nearer than this, m, it need not move.
const COMES_AT: f32 = 0.3;
const CLOSE_WITHIN_M: f32 = 0.6;
/// One this near has it, m.
const HAS_BALL: f32 = 0.2;
/// A ball that is taken at once is kicked within this of its direction, rad: it is cleared.
const AIM_CLEARS: f32 = 0.2;
/// A robot this much beside its kick goes round or turns, rad.
const GOES_ROUND: f32 = 0.5;
/// So near to the ball it takes it first, m.
const TAKEN_WITHIN: f32 = 0.4;
/// The same at an opponent, m.
const TACKLED_WITHIN: f32 = 0.8;
/// Nearer to the own goal line than this, m, a ball is not taken at once; and not towards it.
const OFF_LINE: f32 = 0.15;
const PUSHED_BACK_OFF_LINE: f32 = 0.5;
/// Speed at the first touch, m/s; how far beyond the touch it aims, m, so that it does not brake to stand
/// there.
const TAKES: f32 = 0.5;
/// It speeds up so much harder than planned, as the wheels hold ahead: 3.9 of 4.5 m/s² for a few decimetres.
const TAKES_HARDER: f32 = 1.3;
const GOES_THROUGH: f32 = 0.15;
/// Time by which its place is led, s: a ball that rolls goes on meanwhile.
const TAKE_LEAD: f32 = 0.05;
/// And by this for each metre to go, s/m.
const LEADS_FARTHER: f32 = 0.4;

#[cfg(test)]
mod tests {
    use geometry::{Pose, Vector};
    use protocol::RobotId;
    use rules::Phase;

    use super::*;
    use crate::belief::Other;
    use crate::body::Intent;
    use crate::body::omni::DriveMode;
    use crate::skills::Step;
    use crate::skills::wheels::get_ball::get_ball;
    use crate::skills::wheels::testing::belief;

    /// A robot 0.3 m before a ball that it would go round, and an opponent beyond it with this velocity, m/s.
    fn meets(opponent: f32, velocity: f32) -> Belief {
        let mut b = belief((-0.3, 0.0, 0.0), (0.0, 0.0));
        b.game.phase = Phase::Run;
        let pose = Pose::from_mm_deg(opponent * 1000.0, 0.0, 180.0);
        let velocity = Vector::new(velocity, 0.0);
        let _ = b.opponents.push(pose.position);
        let _ = b.others.push(Other { side: Side::Theirs, id: RobotId::ZERO, pose, velocity });
        b
    }

    #[test]
    fn a_ball_that_an_opponent_comes_for_is_taken_straight() {
        for (opponent, velocity, at_once) in
            [(0.9, -1.0, true), (0.9, 0.0, false), (0.5, 0.0, true), (1.6, -2.0, false)]
        {
            let b = meets(opponent, velocity);
            assert_eq!(takes_first(&b, &b.ball.unwrap(), Angle::HALF_TURN), at_once, "{opponent} {velocity}");
            let Step::Running(Intent::Drive(drive)) = get_ball(&b, Some(Angle::HALF_TURN)) else { panic!() };
            assert_eq!(drive.mode == DriveMode::Bold, at_once, "{drive:?}");
        }
    }
}
