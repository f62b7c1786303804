//! Tests: the predicates agree with the rules. Each by numbers worked out by hand.

use super::*;
use crate::League;

const N: GoalEnd = GoalEnd::Negative;
const P: GoalEnd = GoalEnd::Positive;

fn b() -> FieldSpec {
    League::DivisionB.field()
}

fn p(x: f32, y: f32) -> Point<Field> {
    Point::new(x, y)
}

#[test]
fn a_ball_is_out_when_all_of_it_is_over_the_whole_line() {
    // The line's outer edge is at 3.005, the ball's radius 0.0215: out from 3.0265.
    assert!(!ball_is_out(&b(), p(0.0, 3.026)));
    assert!(ball_is_out(&b(), p(0.0, 3.027)));
    assert!(ball_is_out(&b(), p(-4.527, 0.0)));
    assert!(!ball_is_out(&b(), p(4.526, 3.0)));
}

#[test]
fn the_crossing_is_on_the_line_that_was_crossed_first() {
    let field = b();
    assert_eq!(crossing(&field, p(1.0, 2.9), p(1.0, 3.02)), None);
    let got = crossing(&field, p(1.0, 2.9), p(1.2, 3.1)).unwrap();
    assert_eq!(got.line, BoundaryLine::Touch { positive: true });
    assert!(got.at.distance(p(1.1, 3.0)) < 1e-5);
    // Past the corner: from (4.4, 2.8) to (4.6, 3.1) x reaches 4.5 at half, y reaches 3 at two thirds.
    let got = crossing(&field, p(4.4, 2.8), p(4.6, 3.1)).unwrap();
    assert_eq!(got.line, BoundaryLine::Goal(P));
    assert!(got.at.distance(p(4.5, 2.95)) < 1e-5);
    let got = crossing(&field, p(-4.4, 0.2), p(-4.6, 0.3)).unwrap();
    assert_eq!(got.line, BoundaryLine::GoalOpening(N));
    assert!(got.at.distance(p(-4.5, 0.25)) < 1e-5);
    // First observed outside: straight over the nearest line.
    let got = crossing(&field, p(9.0, -3.2), p(2.0, -3.2)).unwrap();
    assert_eq!((got.line, got.at), (BoundaryLine::Touch { positive: false }, p(2.0, -3.0)));
}

#[test]
fn a_goal_does_not_count_with_too_many_robots_from_high_or_after_a_foul() {
    assert_eq!(no_goal(6, 6, 0.14, Some(2.1)), None);
    assert_eq!(no_goal(6, 5, 0.0, None), Some(NoGoal::TooManyRobots));
    assert_eq!(no_goal(6, 6, 0.16, None), Some(NoGoal::Height(0.16)));
    assert_eq!(no_goal(6, 6, 0.0, Some(1.9)), Some(NoGoal::Foul));
}

#[test]
fn a_robot_is_out_of_an_area_partly_in_it_or_all_in_it() {
    let field = b();
    let is = |x, y| in_area(&field, P, p(x, y));
    // The front line's outer edge is at 3.495.
    assert_eq!((is(3.40, 0.0), is(3.41, 0.0)), (InArea::Out, InArea::Partly));
    assert_eq!((is(3.58, 0.0), is(3.59, 0.0)), (InArea::Partly, InArea::Entirely));
    assert_eq!((is(4.0, 1.10), is(4.0, 1.09), is(4.0, 0.91)), {
        (InArea::Out, InArea::Partly, InArea::Entirely)
    });
    // Over the goal line, in its middle: what is on the field is inside.
    assert_eq!((is(4.48, 0.0), is(4.48, 1.0), is(4.60, 0.0)), {
        (InArea::Entirely, InArea::Partly, InArea::Out)
    });
    assert_eq!(is(-4.0, 0.0), InArea::Out);
}

#[test]
fn distances_count_from_a_robots_side() {
    assert!(too_close_to_ball(p(0.58, 0.0), p(0.0, 0.0)));
    assert!(!too_close_to_ball(p(0.60, 0.0), p(0.0, 0.0)));
    assert!(too_close_to_area(&b(), P, p(3.22, 0.0)));
    assert!(!too_close_to_area(&b(), P, p(3.20, 0.0)));
    assert!(!too_close_to_area(&b(), N, p(3.22, 0.0)));
    assert!(interferes(p(1.0, 0.58), p(0.0, 0.0), p(2.0, 0.0)));
    assert!(!interferes(p(1.0, 0.60), p(0.0, 0.0), p(2.0, 0.0)));
}

#[test]
fn speeds_and_ways_have_their_limits() {
    assert!(too_fast_in_stop(Vector::new(1.2, 1.0))); // 1.562 m/s
    assert!(!too_fast_in_stop(Vector::new(1.2, 0.9))); // 1.5 m/s
    let [old, new] = [League::Ssl2013, League::DivisionB].map(|league| league.limits().unwrap());
    assert!(kicked_too_fast(&new, 6.51) && !kicked_too_fast(&new, 6.49));
    assert!(kicked_too_fast(&old, 8.01) && !kicked_too_fast(&old, 7.99));
    assert!(
        dribbled_too_far(&new, p(0.0, 0.0), p(0.8, 0.61))
            && !dribbled_too_far(&new, p(0.0, 0.0), p(0.8, 0.59))
    );
    assert!(dribbled_too_far(&old, p(0.0, 0.0), p(0.51, 0.0)));
}

#[test]
fn a_kicker_may_bump_the_ball_within_5_cm() {
    assert!(!double_touch(p(0.0, 0.0), p(0.04, 0.0), false));
    assert!(double_touch(p(0.0, 0.0), p(0.06, 0.0), false));
    assert!(!double_touch(p(0.0, 0.0), p(2.0, 0.0), true));
}

#[test]
fn the_faster_robot_of_a_crash_is_to_blame_and_both_if_about_equal() {
    let hit = |a: (f32, f32), b: (f32, f32)| {
        crash((p(0.0, 0.0), Vector::new(a.0, a.1)), (p(0.18, 0.0), Vector::new(b.0, b.1)))
    };
    assert_eq!(hit((1.4, 0.0), (0.0, 0.0)), None);
    assert_eq!(hit((1.6, 0.0), (0.0, 0.0)).unwrap().blame, Blame::First);
    assert_eq!(hit((0.0, 0.0), (-1.6, 0.0)).unwrap().blame, Blame::Second);
    let both = hit((1.0, 0.0), (-0.8, 0.0)).unwrap();
    assert_eq!(both.blame, Blame::Both);
    assert!((both.speed - 1.8).abs() < 1e-6 && (both.difference - 0.2).abs() < 1e-6);
    assert_eq!(hit((1.0, 0.0), (-0.6, 0.0)).unwrap().blame, Blame::First);
    // Fast, but past each other: no speed along the line between them.
    assert_eq!(hit((0.0, 3.0), (0.0, -3.0)), None);
}

#[test]
fn a_penalty_ends_when_the_keeper_turns_the_ball_by_90_degrees() {
    assert!(turned_back(Vector::new(4.0, 0.0), Vector::new(-1.0, 0.5)));
    assert!(turned_back(Vector::new(4.0, 0.0), Vector::new(0.0, 2.0)));
    assert!(!turned_back(Vector::new(4.0, 0.0), Vector::new(0.1, 2.0)));
}
