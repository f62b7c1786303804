//! Where does everybody stand while the ball is not in play, and how is our restart taken? (rules 2026: stop, kick-off, free
//! kick, penalty, ball placement). Attack frame, m. The robots' own keep-outs hold the rules to the centimetre; here stands
//! what is sensible within them.

use geometry::{Angle, Attack, Point, Segment, Vector};

use super::order::{Task, Why};
use super::support::{self, Target};
use super::view::{Ball, View};

/// How far everybody stays from a ball that is not in play, m: the rules' 0.5 m, a body, and what robots overshoot by and a ball
/// kicked at them comes nearer before everybody knows that it is in play (6 m/s for 20 ms).
pub const OFF_BALL: f32 = 0.78;
/// How far behind the ball our taker waits, m.
const TAKER_WAITS: f32 = 0.7;
/// How far behind the ball everybody but taker and keeper is at a penalty, m: the rules' 1 m, a body and a margin.
const BEHIND_PENALTY: f32 = 1.3;
/// Steps by which the way out is turned, degrees: 24 of them are once around.
const TURN_STEP_DEG: f32 = 15.0;
/// How far from the halfway line field players stand at kick-off, m: as far from an opponent as lets them take a pass.
const KICKOFF_BACK: f32 = 0.9;

/// Where our taker waits for its restart from `ball`: behind it, as seen from their goal.
pub fn taker_waits(view: &View, ball: Point<Attack>) -> Point<Attack> {
    let back = (ball - view.their_goal()).unit().unwrap_or(Vector::new(-1.0, 0.0));
    view.clamp(ball + back * TAKER_WAITS, -0.1)
}

/// What our taker does with the target it has; nothing yet: it waits behind the ball for its mates to take their places.
pub fn take(view: &View, ball: &Ball, target: Option<Target>) -> (Task, Why) {
    let distance = |at: Point<Attack>| at.distance(ball.position);
    match target {
        None => {
            let at = taker_waits(view, ball.position);
            (Task::GoTo { at, face: at.direction_to(ball.position) }, Why::Referee)
        }
        Some(Target::Shot { at, room }) => (Task::Kick { at, kick: support::SHOT }, Why::BestTarget { room }),
        Some(Target::Ahead { at, room }) => {
            (Task::Kick { at, kick: support::push_kick(distance(at)) }, Why::BestTarget { room })
        }
        Some(Target::Mate { id, at, room }) => {
            let kick = support::pass_kick(distance(at));
            (Task::Pass { at, receiver: id, kick, ready: true }, Why::BestTarget { room })
        }
    }
}

/// Places of field players at our kick-off: on our half, where the taker can pass to.
pub fn kickoff_places(view: &View) -> [Point<Attack>; 6] {
    let (x, wing) = (-KICKOFF_BACK, view.field.width * 0.5);
    [
        Point::new(x, wing * 0.55),
        Point::new(x, -wing * 0.55),
        Point::new(x - 0.8, 0.0),
        Point::new(x - 0.3, wing * 0.8),
        Point::new(x - 0.3, -wing * 0.8),
        Point::new(x - 1.4, wing * 0.4),
    ]
}

/// Where the wall stands at their restart: in the way from the ball to our goal.
pub fn wall(view: &View, ball: &Ball) -> Point<Attack> {
    let home = (view.our_goal() - ball.position).unit().unwrap_or(Vector::new(-1.0, 0.0));
    ball.position + home * OFF_BALL
}

/// Everybody but taker and keeper at a penalty towards `goal_x`: in a row behind the ball, on the other side of the field.
pub fn behind_penalty(view: &View, ball: &Ball, ours: bool, slot: usize) -> Point<Attack> {
    let back = if ours { -1.0 } else { 1.0 };
    let x = ball.position.x() + back * (BEHIND_PENALTY + 0.4 * (slot / 4) as f32);
    let y = ((slot % 4) as f32 - 1.5) * 0.8;
    view.clamp(Point::new(x, y), 0.2)
}

/// `at`, moved out of the circle that nobody may be in around the ball, and out of the way of a ball being placed.
pub fn kept_off(view: &View, at: Point<Attack>) -> Point<Attack> {
    let Some(ball) = view.ball else { return at };
    let spine = Segment::new(ball.position, view.placement.unwrap_or(ball.position));
    let closest = spine.closest_to(at);
    let away = at - closest;
    if away.norm() >= OFF_BALL {
        return at;
    }
    let home = view.our_goal() - closest;
    let along = spine.vector().unit();
    let out = match (away.unit(), along) {
        // Beside the way of the ball the shortest way out; on it, to the side that lies nearer the field's middle.
        (Some(out), _) => out,
        (None, Some(along)) => {
            let left = Vector::new(-along.y(), along.x());
            if left.y() * closest.y() > 0.0 { -left } else { left }
        }
        (None, None) => home.unit().unwrap_or(Vector::new(-1.0, 0.0)),
    };
    // Straight out where that is on the carpet, else turned by as little as brings it there.
    let turned = |i: i16| {
        let steps = if i % 2 == 0 { i / 2 } else { -(i / 2) - 1 };
        closest + out.rotated(Angle::degrees(TURN_STEP_DEG * f32::from(steps))) * OFF_BALL
    };
    let fits = |at: &Point<Attack>| {
        view.clamp(*at, -0.05).distance(*at) == 0.0 && spine.distance_to(*at) >= OFF_BALL - 0.01
    };
    (0..24).map(turned).find(fits).unwrap_or(closest - out * OFF_BALL)
}

#[cfg(test)]
mod tests {
    use super::super::view::tests::view;
    use super::*;

    #[test]
    fn nobody_is_sent_into_the_circle_around_the_ball_nor_over_the_line_for_it() {
        let view = view((4.3, 2.8), &[(0.0, 0.0)], &[]);
        for place in [(4.3, 2.8), (4.2, 2.9), (4.0, 2.5), (4.45, 2.95)] {
            let at = kept_off(&view, Point::new(place.0, place.1));
            assert!(at.distance(Point::new(4.3, 2.8)) > 0.64, "{place:?} → {at:?}");
            assert!(at.x().abs() < 4.6 && at.y().abs() < 3.1, "{place:?} → {at:?}");
        }
        let free = Point::new(1.0, 1.0);
        assert_eq!(kept_off(&view, free), free);
    }

    #[test]
    fn the_way_of_a_ball_being_placed_is_kept_free() {
        let mut view = view((0.0, 0.0), &[], &[]);
        view.placement = Some(Point::new(3.0, 0.0));
        let spine = Segment::new(Point::new(0.0, 0.0), Point::new(3.0, 0.0));
        for place in [(1.5, 0.0), (1.5, 0.2), (3.3, 0.0), (-0.3, 0.0)] {
            assert!(spine.distance_to(kept_off(&view, Point::new(place.0, place.1))) > 0.64, "{place:?}");
        }
    }

    #[test]
    fn at_kick_off_everybody_stands_on_the_own_half_outside_the_circle() {
        let view = view((0.0, 0.0), &[], &[]);
        for place in kickoff_places(&view) {
            assert!(place.x() < -0.1 && place.distance(Point::new(0.0, 0.0)) > 0.6, "{place:?}");
        }
    }

    #[test]
    fn at_a_penalty_everybody_else_is_a_metre_behind_the_ball() {
        let view = view((-1.5, 0.0), &[], &[]);
        let ball = view.ball.unwrap();
        for slot in 0..9 {
            assert!(behind_penalty(&view, &ball, false, slot).x() > ball.position.x() + 1.1);
            assert!(behind_penalty(&view, &ball, true, slot).x() < ball.position.x() - 1.1);
        }
    }
}
