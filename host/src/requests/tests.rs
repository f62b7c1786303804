//! Tests: requests to the controller, and their rate.

use geometry::Point;
use protocol::RobotId;
use rules::{FieldSpec, League};

use super::*;
use crate::strategy::view::tests::view;

const OURS: [(f32, f32); 4] = [(-4.4, 0.0), (-3.0, 0.5), (-1.0, 0.5), (0.5, 1.5)];
const THEIRS: [(f32, f32); 4] = [(4.4, 0.0), (2.0, 1.0), (1.0, -1.0), (4.65, 2.0)];

/// Division B's field, with an area behind the goals as vision may send.
fn stopped() -> View {
    let mut view = view((1.0, 0.0), &OURS, &THEIRS);
    view.field = FieldSpec { goal_substitution: 0.3, ..League::DivisionB.field() };
    view.phase = Phase::Stop;
    view
}

/// The requests in `seconds` of the same moment, checked every 0.1 s.
fn asked(requests: &mut Requests, view: &mut View, seconds: f32) -> Vec<TeamPortRequest> {
    let mut asked = Vec::new();
    for _ in 0..(seconds * 10.0) as u32 {
        view.now += Duration::millis(100);
        requests.look(view, Some(5));
        asked.extend(std::iter::from_fn(|| requests.poll()));
    }
    asked
}

#[test]
fn a_missing_keeper_is_replaced_by_the_robot_nearest_to_our_goal_out_of_play() {
    let mut view = stopped();
    let mut requests = Requests::default();
    assert_eq!(asked(&mut requests, &mut view, 60.0), [], "it is there");
    view.keeper = RobotId::new(7).unwrap();
    view.phase = Phase::Run;
    assert_eq!(asked(&mut requests, &mut view, 10.0), [], "refused while play runs");
    view.phase = Phase::Stop;
    let keeper = TeamPortRequest::Keeper(RobotId::ZERO);
    assert_eq!(asked(&mut requests, &mut view, 1.0), [keeper]);
    assert_eq!(asked(&mut requests, &mut view, 2.0), []);
    assert_eq!(asked(&mut requests, &mut view, 3.0), [keeper], "not granted: again");
    view.keeper = RobotId::ZERO;
    assert_eq!(asked(&mut requests, &mut view, 10.0), []);
}

#[test]
fn a_surplus_robot_that_stays_needs_a_substitution_and_one_that_leaves_does_not() {
    let mut view = stopped().allowing(3);
    let mut requests = Requests::default();
    assert_eq!(asked(&mut requests, &mut view, 11.0), []);
    assert_eq!(asked(&mut requests, &mut view, 2.0), [TeamPortRequest::Substitute(true)]);
    assert_eq!(asked(&mut requests, &mut view, 20.0), [], "once");
    // It is behind our goal line now, and does not count.
    view.ours[3].position = Point::new(-4.65, 1.5);
    assert_eq!(asked(&mut requests, &mut view, 1.0), [TeamPortRequest::Substitute(false)]);
    // In play the controller gives us 10 s by itself.
    view.ours[3].position = Point::new(0.0, 1.5);
    view.phase = Phase::Run;
    assert_eq!(asked(&mut requests, &mut view, 60.0), []);
}

#[test]
fn an_ignored_substitution_is_requested_once_and_never_where_it_is_a_foul() {
    let mut view = stopped().allowing(3);
    let mut requests = Requests::default();
    assert_eq!(asked(&mut requests, &mut view, 13.0), [TeamPortRequest::Substitute(true)]);
    for _ in 0..5 {
        // Halted for it, and stopped again with the robot where it was.
        view.phase = Phase::Halt;
        assert_eq!(asked(&mut requests, &mut view, 20.0), []);
        view.phase = Phase::Stop;
        assert_eq!(asked(&mut requests, &mut view, 60.0), []);
    }
    let mut requests = Requests::default();
    for _ in 0..600 {
        view.now += Duration::millis(100);
        requests.look(&view, Some(0));
    }
    assert_eq!(requests.poll(), None);
}

#[test]
fn the_advantage_is_taken_while_they_are_too_many_and_we_attack() {
    let mut view = stopped();
    let mut requests = Requests::default();
    let go_on = |go_on| [TeamPortRequest::Advantage { go_on }];
    view.phase = Phase::PreparePenalty(Side::Ours);
    // Three count: the fourth is behind their goal line.
    let mut three = view.clone().allowing_them(3);
    assert_eq!(asked(&mut requests, &mut three, 1.0), []);
    let mut view = view.allowing_them(2);
    assert_eq!(asked(&mut requests, &mut view, 1.0), go_on(true));
    view.phase = Phase::Penalty(Side::Ours);
    assert_eq!(asked(&mut requests, &mut view, 1.0), []);
    view.phase = Phase::Penalty(Side::Theirs);
    assert_eq!(asked(&mut requests, &mut view, 1.0), go_on(false));
    view.phase = Phase::Run;
    assert_eq!(asked(&mut requests, &mut view, 1.0), go_on(true), "the ball is in their half");
}
