//! Tests: restart positions are those of the rules. Worked out by hand, and against a search over a grid.

use super::*;
use crate::keep_out::{Situation, keep_out};
use crate::{League, Phase, RuleRole, Side};

const N: GoalEnd = GoalEnd::Negative;
const P: GoalEnd = GoalEnd::Positive;

fn b() -> (FieldSpec, Limits) {
    (League::DivisionB.field(), League::DivisionB.limits().unwrap())
}

fn near(a: Point<Field>, x: f32, y: f32) {
    assert!(a.distance(Point::new(x, y)) < 2e-3, "{a:?} is not ({x}, {y})");
}

#[test]
fn a_free_kick_is_a_fifth_from_lines_and_a_metre_from_areas() {
    let (field, limits) = b();
    let fault = |x, y| free_kick_fault(&field, &limits, Point::new(x, y));
    assert_eq!(fault(0.0, 2.8), None);
    assert!(matches!(fault(0.0, 2.81), Some(SpotFault::Line { distance }) if (distance - 0.19).abs() < 1e-5));
    assert_eq!(fault(2.5, 0.0), None);
    assert!(
        matches!(fault(2.6, 0.0), Some(SpotFault::Area { goal: P, distance }) if (distance - 0.9).abs() < 1e-5)
    );
    // Off the corner (3.5, 1): 0.8 and 0.6 along the axes are a metre.
    assert_eq!(fault(2.7, 1.6), None);
    assert!(fault(2.75, 1.6).is_some());
}

#[test]
fn the_nearest_valid_spot_is_straight_in_front_beside_or_in_the_notch() {
    let (field, limits) = b();
    let spot = |x, y| nearest_free_kick_spot(&field, &limits, Point::new(x, y));
    near(spot(1.0, 1.0), 1.0, 1.0);
    near(spot(1.0, 3.5), 1.0, 2.8);
    near(spot(-3.0, 0.3), -2.5, 0.3);
    // In the area 0.4 m from its front: straight out, 2.0 → 2.5 from the front edge at 3.5.
    near(spot(3.9, 0.0), 2.5, 0.0);
    // Beside the area, on the goal line: the notch between the line's fifth and the area's metre.
    near(spot(4.5, 1.5), 4.3, 2.0);
    near(spot(-4.5, -1.5), -4.3, -2.0);
    near(spot(9.0, 9.0), 4.3, 2.8);
}

#[test]
fn no_place_on_a_grid_is_nearer_than_the_spot_found() {
    for league in League::ON_WHEELS {
        let (field, limits) = (league.field(), league.limits().unwrap());
        let grid = |step: f32, over: f32| {
            let (x, y) = (field.length * 0.5 + over, field.width * 0.5 + over);
            let (columns, rows) = ((2.0 * x / step) as i32, (2.0 * y / step) as i32);
            (0..=columns).flat_map(move |i| {
                (0..=rows).map(move |j| Point::<Field>::new(-x + step * i as f32, -y + step * j as f32))
            })
        };
        let valid: std::vec::Vec<_> =
            grid(0.05, 0.0).filter(|p| free_kick_fault(&field, &limits, *p).is_none()).collect();
        for wanted in grid(0.37, 0.4) {
            let spot = nearest_free_kick_spot(&field, &limits, wanted);
            assert_eq!(free_kick_fault(&field, &limits, spot), None, "{wanted:?} → {spot:?}");
            let best = valid.iter().map(|p| p.distance(wanted)).fold(f32::INFINITY, f32::min);
            let found = spot.distance(wanted);
            assert!(found <= best + 2e-3, "{wanted:?} → {spot:?}: {found} m, a grid has {best} m");
        }
    }
}

#[test]
fn a_ball_out_comes_back_at_its_throw_in_goal_kick_or_corner() {
    let (field, limits) = b();
    let out = |line, x, y, own| {
        let crossing = Crossing { line, at: Point::new(x, y) };
        let after = after_out(&field, &limits, crossing, own, Some(Point::new(0.5, 0.0)));
        (after.kind, after.spot)
    };
    assert_eq!(
        out(BoundaryLine::Touch { positive: true }, 1.2, 3.0, N),
        (OutKind::ThrowIn, Point::new(1.2, 2.8))
    );
    let (kind, spot) = out(BoundaryLine::Touch { positive: false }, -4.45, -3.0, N);
    assert_eq!(kind, OutKind::ThrowIn);
    near(spot, -4.3, -2.8);
    // Last touched by the team that defends −x, over the goal line at +x: their goal kick; at −x: a corner
    // against them.
    let (kind, spot) = out(BoundaryLine::Goal(P), 4.5, -0.9, N);
    assert_eq!(kind, OutKind::GoalKick);
    near(spot, 3.5, -2.8);
    let (kind, spot) = out(BoundaryLine::Goal(N), -4.5, 2.0, N);
    assert_eq!(kind, OutKind::Corner);
    near(spot, -4.3, 2.8);
}

#[test]
fn a_kick_from_the_own_half_over_their_line_is_aimless_in_division_b_only() {
    let crossing = Crossing { line: BoundaryLine::Goal(P), at: Point::new(4.5, 2.0) };
    let kind = |league: League, from: f32, kickoff: bool| {
        let (field, limits) = (league.field(), league.limits().unwrap());
        after_out(&field, &limits, crossing, N, (!kickoff).then_some(Point::new(from, 1.0)))
    };
    assert_eq!(kind(League::DivisionB, -0.5, false).kind, OutKind::AimlessKick);
    assert_eq!(kind(League::DivisionB, -0.5, false).spot, Point::new(-0.5, 1.0));
    assert_eq!(kind(League::DivisionB, 0.5, false).kind, OutKind::GoalKick);
    assert_eq!(kind(League::DivisionB, -0.01, true).kind, OutKind::GoalKick);
    assert_eq!(kind(League::DivisionA, -0.5, false).kind, OutKind::GoalKick);
    assert_eq!(kind(League::Ssl2013, -0.5, false).kind, OutKind::GoalKick);
}

#[test]
fn a_ball_is_placed_when_near_still_and_left_alone() {
    let target = Point::new(1.0, 1.0);
    let lack = |ball, speed, robot, next| placement_lack(ball, speed, target, [robot], next);
    let (ball, far) = (Point::new(1.14, 1.0), Point::new(3.0, 1.0));
    let next = AfterPlacement::FreeKick;
    assert_eq!(lack(ball, 0.0, far, next), None);
    assert!(matches!(lack(Point::new(1.16, 1.0), 0.0, far, next), Some(PlacementLack::Distance(_))));
    assert_eq!(lack(ball, 0.3, far, next), Some(PlacementLack::Moving(0.3)));
    // 0.13 m from the ball the body of 0.09 m leaves 0.04; 0.15 leaves 0.06.
    assert!(matches!(lack(ball, 0.0, Point::new(1.27, 1.0), next), Some(PlacementLack::Robot(_))));
    assert_eq!(lack(ball, 0.0, Point::new(1.29, 1.0), next), None);
    let next = AfterPlacement::ForceStart;
    assert!(matches!(lack(ball, 0.0, Point::new(1.29, 1.0), next), Some(PlacementLack::Robot(_))));
    assert_eq!(lack(ball, 0.0, Point::new(1.74, 1.0), next), None);
    assert_eq!(placement_lack(ball, 0.0, target, [], next), None);
}

#[test]
fn a_ball_that_lies_well_needs_no_placement() {
    let (field, _) = b();
    let needless = |ball: (f32, f32), speed, target: (f32, f32)| {
        placement_needless(&field, Point::new(ball.0, ball.1), speed, Point::new(target.0, target.1))
    };
    assert!(needless((0.0, 0.0), 0.0, (0.9, 0.0)));
    assert!(!needless((0.0, 0.0), 0.0, (1.0, 0.0)));
    assert!(!needless((0.0, 0.0), 0.2, (0.9, 0.0)));
    assert!(!needless((0.0, 3.1), 0.0, (0.0, 2.8)), "outside the field");
    assert!(!needless((2.9, 0.0), 0.0, (2.5, 0.0)), "0.6 m from the area");
    assert!(needless((2.7, 0.0), 0.0, (2.5, 0.0)));
}

#[test]
fn kick_off_places_are_legal_and_apart() {
    for league in League::ON_WHEELS {
        let field = league.field();
        for own in [N, P] {
            for (ours, side) in [(true, Side::Ours), (false, Side::Theirs)] {
                let places = kickoff_places(&field, own, ours);
                let robots = league.limits().unwrap().robots as usize;
                for (i, place) in places.iter().enumerate().take(robots) {
                    let rule_role = match i {
                        0 => RuleRole::Keeper,
                        1 if ours => RuleRole::Kicker,
                        _ => RuleRole::Player,
                    };
                    let (phase, ball) = (Phase::PrepareKickoff(side), Some(Point::new(0.0, 0.0)));
                    let s = Situation {
                        field: &field,
                        own,
                        phase,
                        rule_role,
                        ball,
                        placement: None,
                        ball_in_play: false,
                    };
                    let offence = keep_out(&s).offence(*place, ROBOT_RADIUS);
                    assert_eq!(offence, None, "{} {i} {place:?}", league.name());
                    for other in &places[..i] {
                        assert!(other.distance(*place) > 3.0 * ROBOT_RADIUS, "{place:?} {other:?}");
                    }
                }
            }
        }
    }
}
