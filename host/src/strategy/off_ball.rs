//! `off_ball`: places outside the circle around a ball that is not in play, and off the path of a ball being
//! placed (rules 2026). Attack frame, m.

use geometry::{Angle, Attack, Point, Segment, Vector};
use rules::Phase;

use super::view::View;

/// Distance of robots from a ball that is not in play, m: the rules' 0.5 m, a body, the overshoot of robots,
/// and the path of a ball kicked at them before all know that it is in play (6 m/s for 20 ms).
pub(super) const OFF_BALL: f32 = 0.78;
/// Step by which the direction off the ball is turned, degrees: 24 of them are a full turn.
const TURN_STEP_DEG: f32 = 15.0;

/// `at`, moved out of the circle around the ball that no robot may enter, and off the path of a ball being
/// placed.
pub(super) fn kept_off(view: &View, at: Point<Attack>) -> Point<Attack> {
    let Some(ball) = view.ball else { return at };
    // In the stop before a penalty no robot rolls the ball to its mark: the referee's staff places it.
    let penalty = matches!(view.next, Some(Phase::PreparePenalty(_) | Phase::Penalty(_)));
    let by_hand = view.phase == Phase::Stop && penalty;
    // The place of a rolling ball is left before it arrives.
    let target = view.placement.filter(|_| !by_hand).unwrap_or(ball.rest);
    let spine = Segment::new(ball.position, target);
    let closest = spine.closest_to(at);
    let away = at - closest;
    if away.norm() >= OFF_BALL {
        return at;
    }
    let home = view.our_goal() - closest;
    let along = spine.vector().unit();
    let out = match (away.unit(), along) {
        // Beside the path of the ball the shortest direction out; on it, to the side nearer to the field's
        // middle.
        (Some(out), _) => out,
        (None, Some(along)) => {
            let left = Vector::new(-along.y(), along.x());
            if left.y() * closest.y() > 0.0 { -left } else { left }
        }
        (None, None) => home.unit().unwrap_or(Vector::new(-1.0, 0.0)),
    };
    // Straight out where that is on the field surface, else turned by the smallest angle that is.
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
    fn no_robot_is_sent_into_the_circle_around_the_ball_nor_over_the_line_for_it() {
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
    fn the_path_of_a_ball_being_placed_is_kept_free() {
        let mut view = view((0.0, 0.0), &[], &[]);
        view.placement = Some(Point::new(3.0, 0.0));
        let spine = Segment::new(Point::new(0.0, 0.0), Point::new(3.0, 0.0));
        for place in [(1.5, 0.0), (1.5, 0.2), (3.3, 0.0), (-0.3, 0.0)] {
            assert!(spine.distance_to(kept_off(&view, Point::new(place.0, place.1))) > 0.64, "{place:?}");
        }
    }
}
