//! `release`: the last check of a kick in play: a ball that its receiver misses stays in the field. SI, field
//! frame.

use geometry::{Field, Point, Vector};
use motion::ball::BallModel;
use protocol::robot_io::OmniKick;
use rules::{Phase, Side};

use crate::belief::Belief;
use crate::body::Intent;
use crate::body::omni::Drive;

/// Any skill's intent; a kick that the host has not `ordered` is limited to what stays in the field.
pub fn release(belief: &Belief, intent: Intent, ordered: bool) -> Intent {
    let Intent::Drive(drive) = intent else { return intent };
    let OmniKick::Flat(speed) = drive.kick else { return intent };
    if ordered || !drive.armed || belief.game.phase == Phase::BallPlacement(Side::Ours) {
        return intent;
    }
    let most = stays_inside(belief, belief.dribbler_point());
    Drive { kick: OmniKick::Flat(speed.min(most)), ..drive }.into()
}

/// The fastest kick from `from` along the robot's heading that rests within the lines, m/s; none is too fast
/// at the opponents' goal.
fn stays_inside(belief: &Belief, from: Point<Field>) -> f32 {
    let field = belief.league().field();
    let along = Vector::<Field>::polar(1.0, belief.pose.heading);
    let to_line = |at: f32, along: f32, line: f32| {
        if along.abs() < PARALLEL { f32::INFINITY } else { (line * along.signum() - at) / along }
    };
    let to_goal_line = to_line(from.x(), along.x(), 0.5 * field.length);
    let to_touch_line = to_line(from.y(), along.y(), 0.5 * field.width);
    let own = belief.game.defending.sign() as f32;
    let ahead = along.x() * own < 0.0;
    let crosses = from.y() + along.y() * to_goal_line;
    if ahead && crosses.abs() < 0.5 * field.goal_width + BESIDE_POST {
        return f32::INFINITY;
    }
    let room = to_goal_line.min(to_touch_line) - REST_MARGIN_M;
    BallModel::default().kick_speed(room.max(ROLLS_AT_LEAST), 0.0)
}

/// A heading this parallel to a line does not cross it.
const PARALLEL: f32 = 1e-3;
/// Beside a post, m: a shot that misses by less counts as one.
const BESIDE_POST: f32 = 0.1;
/// From the line to where the ball rests, m: more than a ball's radius, and kicks scatter.
const REST_MARGIN_M: f32 = 0.2;
/// A kick rolls at least this far, m: out of the dribbler's reach.
const ROLLS_AT_LEAST: f32 = 0.8;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::omni::BALL_AT;
    use crate::skills::wheels::testing::belief;
    use geometry::GoalEnd;

    const FULL_KICK: OmniKick = OmniKick::Flat(6.0);

    /// The kick of a robot of the team that attacks +x, with the ball.
    fn kicked(me: (f32, f32, f32), kick: OmniKick) -> OmniKick {
        let mut b = belief(me, (me.0, me.1));
        (b.game.phase, b.game.defending, b.holds_ball) = (Phase::Run, GoalEnd::Negative, true);
        let drive = Drive { kick, armed: true, ..Drive::holding(b.pose.position, b.pose.heading) };
        let Intent::Drive(drive) = release(&b, drive.into(), false) else { panic!() };
        drive.kick
    }

    #[test]
    fn a_kick_towards_a_line_rests_before_it_and_a_shot_is_as_fast_as_ever() {
        // From y = 1 m to the touch line at 3 m, less the robot's front and 0.2 m.
        let OmniKick::Flat(speed) = kicked((0.0, 1.0, 90.0), FULL_KICK) else { panic!() };
        let rests =
            BallModel::default().kicked(Point::<Field>::new(0.0, 0.0), Vector::new(speed, 0.0)).rest().x();
        assert!((rests - (2.0 - BALL_AT - REST_MARGIN_M)).abs() < 0.02, "{speed} m/s rests after {rests} m");
        assert_eq!(kicked((2.0, 0.0, 0.0), FULL_KICK), FULL_KICK, "at their goal");
        assert_eq!(kicked((-3.0, 1.0, 0.0), OmniKick::Flat(2.0)), OmniKick::Flat(2.0), "slow enough");
        assert_ne!(kicked((-2.0, 0.0, 180.0), FULL_KICK), FULL_KICK, "at the own goal");
        let mut b = belief((0.0, 1.0, 90.0), (0.0, 1.1));
        b.game.phase = Phase::Run;
        let ordered =
            Drive { kick: FULL_KICK, armed: true, ..Drive::holding(b.pose.position, b.pose.heading) };
        assert_eq!(release(&b, ordered.into(), true), ordered.into(), "the host answers for its speeds");
        let OmniKick::Flat(least) = kicked((0.0, 2.95, 90.0), FULL_KICK) else { panic!() };
        assert!(least > 0.9, "{least}: it leaves the dribbler");
    }
}
