//! Tests: surplus robots leave as the rules and the game controller require, and come back.

use rules::{FieldSpec, League};

use super::super::view::ViewBall;
use super::super::view::tests::view;
use super::*;

const OURS: [(f32, f32); 6] = [(-4.4, 0.0), (-3.0, 0.5), (-3.0, -0.5), (-0.5, 0.0), (0.5, 1.5), (0.5, -1.5)];

/// Division A's field with our robots 0 to 5, four of which are allowed.
fn division_a() -> View {
    View { field: League::DivisionA.field(), ..view((1.0, 0.0), &OURS, &[]).allowing(4) }
}

fn id(number: u8) -> RobotId {
    RobotId::new(number).unwrap()
}

fn places(orders: &[Order]) -> Vec<Point<Attack>> {
    let at = |order: &Order| match order.task {
        Task::GoTo { at, .. } => at,
        other => panic!("{other:?}"),
    };
    orders.iter().map(at).collect()
}

/// Whether the game controller counts a robot as on the field, written from its source: the strip of depth d
/// at the wall behind the own goal, less a radius.
fn controller_counts(field: &FieldSpec, at: Point<Attack>) -> bool {
    let wall = field.length * 0.5 + field.goal_line_margin;
    let edge = wall - field.goal_substitution + 0.09;
    !(-wall..=-edge).contains(&at.x()) || at.y().abs() > field.width * 0.5 + field.margin
}

#[test]
fn in_division_a_they_wait_where_the_controller_does_not_count_them() {
    let view = division_a();
    let mut bench = Bench::default();
    assert_eq!(bench.choose(&view, None).len(), 2);
    let places = places(&bench.orders(&view));
    assert!(places[0].distance(places[1]) > 0.2);
    for at in places {
        assert!(!controller_counts(&view.field, at), "{at:?}");
        // The whole body within the field's walls, 0.3 m or more behind the line, beside the defence area.
        assert!(at.x() - 0.09 > -6.6 && at.x() + 0.09 <= -6.3 && at.y().abs() > 1.9, "{at:?}");
    }
}

#[test]
fn in_division_b_they_wait_in_the_centre_area_on_our_half() {
    let view = view((1.0, 0.0), &OURS, &[]).allowing(4);
    let mut bench = Bench::default();
    bench.choose(&view, None);
    for at in places(&bench.orders(&view)) {
        assert!(at.x() < -0.09 && at.x() > -1.0, "{at:?}");
        assert!(at.y().abs() > 3.0 && at.y().abs() < 3.3 - 0.09, "{at:?}");
    }
    // Where vision sends an area behind the goals, the controller uses it.
    let view = View { field: FieldSpec { goal_substitution: 0.3, ..view.field }, ..view };
    for at in places(&bench.orders(&view)) {
        assert!(!controller_counts(&view.field, at) && at.x() > -4.8 + 0.09, "{at:?}");
    }
}

#[test]
fn neither_keeper_nor_ball_player_is_benched_while_there_are_others() {
    let view = division_a();
    for allowed in 0..6 {
        let view = View { allowed, ..view.clone() };
        let mut bench = Bench::default();
        let off = bench.choose(&view, Some(id(3)));
        assert_eq!(off.len(), (6 - allowed).min(5), "all but the keeper");
        assert!(!off.contains(&view.keeper));
        assert!(off.len() == 5 || !off.contains(&id(3)), "{off:?}");
    }
    // Of equals, the one that is out soonest: those at our own goal's side.
    let mut bench = Bench::default();
    assert_eq!(bench.choose(&View { allowed: 5, ..view }, None), [id(2)]);
}

#[test]
fn a_benched_robot_stays_off_and_returns_a_second_after_the_card() {
    let mut view = division_a();
    let mut bench = Bench::default();
    let off: Vec<_> = bench.choose(&view, None).to_vec();
    // Another robot has a shorter path out now; that changes nothing.
    view.ours[5].position = Point::new(-6.0, 4.0);
    assert_eq!(bench.choose(&view, None), off);
    view.allowed = 5;
    assert_eq!(bench.choose(&view, None), off);
    view.now += Duration::millis(1001);
    assert_eq!(bench.choose(&view, None), &off[..1]);
    // Vision loses a playing robot for half a second: no robot comes back.
    view.ours.remove(3);
    assert_eq!(bench.choose(&view, None), &off[..1]);
    view.now += Duration::millis(500);
    assert_eq!(bench.choose(&view, None), &off[..1]);
}

#[test]
fn a_robot_that_cannot_be_commanded_counts_too() {
    let view = View { uncommanded: 1, ..division_a() };
    assert_eq!(Bench::default().choose(&view, None).len(), 3);
}

#[test]
fn a_robot_that_becomes_keeper_comes_back_at_once_and_another_one_goes() {
    let mut view = division_a();
    let mut bench = Bench::default();
    view.keeper = bench.choose(&view, None)[0];
    let off = bench.choose(&view, None);
    assert!(off.len() == 2 && !off.contains(&view.keeper));
}

#[test]
fn at_a_penalty_they_stand_behind_the_ball_and_in_stop_before_it_they_do_not_count() {
    let mut view = division_a();
    let mut bench = Bench::default();
    bench.choose(&view, None);
    for side in [Side::Ours, Side::Theirs] {
        let back = if side == Side::Ours { -1.0 } else { 1.0 };
        let ball = Point::new(back * (8.0 - 6.0), 0.0);
        view.ball = Some(ViewBall::at_rest(ball));
        view.phase = Phase::PreparePenalty(side);
        for at in places(&bench.orders(&view)) {
            assert!((at.x() - ball.x()) * back > 1.1, "{side:?} {at:?}");
            assert!(at.x().abs() < 6.6 - 0.09 && at.y().abs() < 4.8 - 0.09, "{at:?}");
        }
        (view.phase, view.next) = (Phase::Stop, Some(Phase::PreparePenalty(side)));
        for at in places(&bench.orders(&view)) {
            assert!(!controller_counts(&view.field, at), "{side:?} {at:?}");
        }
    }
}

#[test]
fn benched_robots_keep_off_ball_and_placement_wherever_those_are() {
    let mut view = division_a();
    let mut bench = Bench::default();
    bench.choose(&view, None);
    view.phase = Phase::BallPlacement(Side::Theirs);
    for y in -45..=45 {
        let ball = Point::new(-6.4, 0.1 * y as f32);
        view.ball = Some(ViewBall::at_rest(ball));
        view.placement = Some(Point::new(-5.8, 0.1 * y as f32));
        for at in places(&bench.orders(&view)) {
            assert!(!controller_counts(&view.field, at));
            assert!(at.distance(ball) > 0.5 + 0.09, "{ball:?} {at:?}");
        }
    }
}

#[test]
fn a_team_does_not_leave_the_field_to_robots_that_never_answered() {
    // Six of ours, six allowed, five of our colour without contact: one of those had answered before.
    let view = View { uncommanded: 5, never_answered: 5, ..division_a() }.allowing(6);
    assert!(Bench::default().choose(&view, None).is_empty());
    let view = View { uncommanded: 5, never_answered: 4, ..division_a() }.allowing(6);
    assert_eq!(Bench::default().choose(&view, None).len(), 1);
}
