//! Shoot: at the widest gap between the posts. Clear: away from the own goal, to the freer side.
//!
//! A gap's value is how far every opponent stays from the ball's path, less how far it can move until the
//! ball passes, and how far the path stays from the posts. SI, field frame.

use geometry::{Field, GoalEnd, Point, math};
use motion::ball::BallModel;
use protocol::robot_io::OmniKick;
use rules::{RobotSpec, contact};

use crate::belief::Belief;
use crate::body::Intent;
use crate::body::omni::SHOT;
use crate::skills::wheels::kick::kick_held;

/// With the ball held: shoots as soon as a gap is wide enough, or time is up.
pub fn shoot(belief: &Belief, attacked: GoalEnd, patient: bool) -> Intent {
    let (at, room) = target(belief, belief.dribbler_point(), attacked);
    let open = room > GAP || !patient;
    kick_held(belief, at, if open { OmniKick::Flat(SHOT) } else { OmniKick::None })
}

/// Target of a shot from `from`, and the free distance beside the ball's path, of opponents and posts, m.
pub fn target(belief: &Belief, from: Point<Field>, attacked: GoalEnd) -> (Point<Field>, f32) {
    let field = belief.league().field();
    let center = field.goal_center(attacked);
    let half = 0.5 * field.goal_width - INSIDE_POST;
    // Seen from aside, the path comes nearer to a post than the aim is.
    let away = center - from;
    let aslant = away.x().abs() / away.norm().max(f32::MIN_POSITIVE);
    let aims = (0..AIMS).map(|index| {
        let y = half * (2.0 * index as f32 / (AIMS - 1) as f32 - 1.0);
        let at = Point::new(center.x(), y);
        let post = aslant * (0.5 * field.goal_width - y.abs());
        (at, room(belief, from, at).min(post))
    });
    aims.reduce(|best, next| if next.1 > best.1 { next } else { best }).unwrap_or((center, 0.0))
}

/// The kick with a held ball without a better option: at their goal from near, else up the freer wing.
pub fn clear_or_shoot(belief: &Belief, attacked: GoalEnd) -> Intent {
    let field = belief.league().field();
    let me = belief.pose.position;
    let goal = field.goal_center(attacked);
    if me.distance(goal) < SHOOTS_FROM {
        return shoot(belief, attacked, false);
    }
    let sign = attacked.sign() as f32;
    let ahead = [1.0_f32, -1.0].map(|side| {
        let x = (sign * me.x() + CLEARS_AHEAD).min(0.5 * field.length - CLEARING_MARGIN_M) * sign;
        let at = Point::new(x, side * (0.5 * field.width - WING_INSIDE));
        (at, room(belief, me, at))
    });
    let [left, right] = ahead;
    let (at, _) = if left.1 >= right.1 { left } else { right };
    // It stops there: a ball that rolls on leaves the field, and is theirs.
    let speed = BallModel::default().kick_speed(me.distance(at), RESTS).min(CLEARS_WITH);
    kick_held(belief, at, OmniKick::Flat(speed))
}

/// Distance that opponents leave free beside a ball's path, m; what no opponent can reach counts as
/// [`ROOM_ENOUGH`].
fn room(belief: &Belief, from: Point<Field>, to: Point<Field>) -> f32 {
    let path = to - from;
    let length = path.norm();
    let along = path * (1.0 / length.max(f32::MIN_POSITIVE));
    let mut room = ROOM_ENOUGH;
    for &opponent in &belief.opponents {
        let off = opponent - from;
        let ahead = off.dot(along);
        // Behind the ball, or behind its target.
        if ahead <= 0.0 || ahead > length + BODY {
            continue;
        }
        let time = math::max(ahead * (1.0 / FAIR_SPEED) - REACTION, 0.0);
        let reach = BODY + 0.5 * OPPONENT_ACCELERATION * time * time;
        room = math::min(room, along.cross(off).abs() - reach);
    }
    room
}

/// Number of aims tried between the posts.
const AIMS: usize = 9;
/// A shot keeps this far from a post, m: ball, half a line, and 1° from 3 m.
const INSIDE_POST: f32 = 0.08;
/// A gap this wide is used for a shot, m beyond the reach of bodies.
const GAP: f32 = 0.02;
/// Distance up to which the robot shoots at the goal, m.
const SHOOTS_FROM: f32 = 4.0;
/// Distance of a clearance, m: no aimless kick over the half (division B).
const CLEARS_AHEAD: f32 = 2.5;
/// Largest speed of a clearance, m/s: it stays in the field.
const CLEARS_WITH: f32 = 4.0;
/// As good as stationary, m/s.
const RESTS: f32 = 0.2;
/// Distance of a clearing target from the goal line, m.
const CLEARING_MARGIN_M: f32 = 1.2;
/// Distance of a clearing target from the side line, m.
const WING_INSIDE: f32 = 1.1;
/// More room than this has no benefit, m.
const ROOM_ENOUGH: f32 = 0.5;
/// Radii of a robot and a ball, m.
const BODY: f32 = contact::CENTERS;
/// How fast a shot is on average, m/s.
const FAIR_SPEED: f32 = 5.0;
/// Reaction time of an opponent, s.
const REACTION: f32 = 0.15;
/// How fast it speeds up, m/s².
const OPPONENT_ACCELERATION: f32 = RobotSpec::OURS.assumed.blocker_acceleration;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::skills::wheels::testing::belief;

    #[test]
    fn the_shot_goes_where_the_keeper_is_not() {
        let mut b = belief((2.5, 0.0, 0.0), (2.6, 0.0));
        let _ = b.opponents.push(Point::new(4.3, 0.2));
        let (at, room) = target(&b, b.dribbler_point(), GoalEnd::Positive);
        assert!(at.y() < -0.2 && room > 0.1, "{at:?} {room}");
    }

    #[test]
    fn who_stands_behind_the_ball_is_in_nobodys_way() {
        let mut b = belief((2.5, 0.0, 0.0), (2.6, 0.0));
        let _ = b.opponents.push(Point::new(2.3, 0.0));
        let (at, room) = target(&b, b.dribbler_point(), GoalEnd::Positive);
        assert!(at.y() == 0.0 && room > 0.49, "{at:?} {room}");
    }

    #[test]
    fn an_open_goal_is_shot_at_in_its_middle_from_any_side() {
        for (x, y) in [(2.5, 0.0), (3.5, 1.5), (3.5, -1.5), (0.0, 2.0)] {
            let b = belief((x, y, 0.0), (x + 0.1, y));
            let (at, room) = target(&b, b.dribbler_point(), GoalEnd::Positive);
            assert!(at.y() == 0.0 && room > 0.2, "{at:?} {room}");
        }
    }
}
