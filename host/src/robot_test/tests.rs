//! `tests`: tests: who does what while a kicker is tested, by the phase of the game and by what the ball
//! does.

use protocol::Instant;
use rules::Side;

use super::*;
use crate::strategy::view::{ViewBall, tests::view};

fn id(number: u8) -> RobotId {
    RobotId::new(number).unwrap()
}

fn begun() -> RobotTest {
    RobotTest::of(TestOrder::from_json(br#"{"kick":{"robot":2,"kicks":5}}"#).unwrap(), Instant(0)).unwrap()
}

fn field() -> View {
    View { phase: Phase::Run, ..view((1.0, 0.5), &[(-4.0, 0.0), (-1.0, 1.0), (0.0, 0.0)], &[(3.0, 0.5)]) }
}

fn usual(view: &View) -> Orders {
    let order = |robot: RobotId| Order {
        robot,
        role: Role::Player,
        task: Task::Gameplay,
        why: OrderReason::OpenPlay,
    };
    view.ours.iter().map(|robot| order(robot.id)).collect()
}

fn planned(test: &mut RobotTest, view: &View) -> Vec<Task> {
    test.plan(view, usual(view)).iter().map(|order| order.task).collect()
}

#[test]
fn the_kicker_kicks_inside_the_field_past_everybody_and_all_others_stand() {
    let (mut test, view) = (begun(), field());
    let orders = test.plan(&view, usual(&view));
    assert_eq!(orders.len(), 3);
    for order in &orders {
        assert_eq!(order.why, OrderReason::Test);
        let Task::Kick { at, kick } = order.task else {
            assert!(order.robot != id(2) && order.task == Task::Stand, "{order:?}");
            continue;
        };
        assert_eq!((order.robot, kick), (id(2), KickOrder::Flat(320)));
        assert!(at.x().abs() < view.field.length * 0.5 && at.y().abs() < view.field.width * 0.5, "{at:?}");
        let ball = view.ball.unwrap().position;
        let line = geometry::Segment::new(ball, at);
        for other in view.ours.iter().filter(|robot| robot.id != id(2)).chain(&view.theirs) {
            assert!(line.distance_to(other.position) > 0.25, "{at:?} past {other:?}");
        }
        assert!(ball.distance(at) > 3.0, "{at:?}");
    }
    assert_eq!(test.report().unwrap().state, TestState::Kicks);
    // A ball that is pushed a little keeps its target.
    let before = planned(&mut test, &view);
    let pushed = View { ball: Some(ViewBall::at_rest(Point::new(1.1, 0.6))), ..view.clone() };
    assert_eq!(planned(&mut test, &pushed), before);
}

#[test]
fn a_rolling_ball_is_waited_for_and_the_next_kick_has_another_speed() {
    let (mut test, view) = (begun(), field());
    let ball = |speed: f32| {
        let velocity = geometry::Vector::new(speed, 0.0);
        View { ball: Some(ViewBall { velocity, ..view.ball.unwrap() }), ..view.clone() }
    };
    planned(&mut test, &view);
    for speed in [3.0, 1.0, 0.4] {
        assert!(planned(&mut test, &ball(speed)).iter().all(|task| *task == Task::Stand), "{speed}");
        assert_eq!(test.report().unwrap().state, TestState::Rolls);
    }
    let tasks = planned(&mut test, &ball(0.1));
    let kicks = tasks.iter().filter_map(|task| match task {
        Task::Kick { kick, .. } => Some(*kick),
        _ => None,
    });
    assert_eq!(kicks.collect::<Vec<_>>(), [KickOrder::Flat(260)]);
}

#[test]
fn a_ball_that_the_robot_may_not_fetch_is_asked_for_while_all_stand() {
    let (mut test, view) = (begun(), field());
    let [half_length, half_width] = [view.field.length * 0.5, view.field.width * 0.5];
    let away = [[half_length + 0.2, 2.0], [0.5, -half_width - 0.1], [0.2 - half_length, 0.3]];
    for [x, y] in away {
        let ball = Some(ViewBall::at_rest(Point::new(x, y)));
        let tasks = planned(&mut test, &View { ball, ..view.clone() });
        assert!(tasks.iter().all(|task| *task == Task::Stand), "{x} {y}");
        assert_eq!(test.report().unwrap().state, TestState::OutOfReach);
    }
    planned(&mut test, &view);
    assert_eq!(test.report().unwrap().state, TestState::Kicks, "it is back");
}

#[test]
fn a_kick_test_keeps_the_rules_and_names_what_it_waits_for() {
    let state = |view: &View| {
        let mut test = begun();
        let orders = test.plan(view, usual(view));
        (test.report().unwrap().state, orders == usual(view))
    };
    for phase in [Phase::Halt, Phase::Stop, Phase::FreeKick(Side::Ours), Phase::Kickoff(Side::Theirs)] {
        let view = View { phase, ..field() };
        assert_eq!(state(&view), (TestState::WaitsForGame, true), "{phase:?}");
    }
    assert_eq!(state(&View { ball: None, ..field() }), (TestState::NoBall, false));
    assert_eq!(state(&field().without(&[id(2)])), (TestState::NoRobot, false));
    let mut all_stand = RobotTest::of(TestOrder::Stand, Instant(0)).unwrap();
    assert!(planned(&mut all_stand, &field()).iter().all(|task| *task == Task::Stand));
    assert_eq!(all_stand.report(), None);
    assert!(RobotTest::of(TestOrder::End, Instant(0)).is_none());
}

#[test]
fn orders_are_read_as_they_are_written_and_others_are_refused_with_the_reason() {
    let drive = TestOrder::Drive { robot: 2, velocity: [-2.0, 0.5, 6.0], dribbler: true, kick: Some(4.5) };
    let orders = [TestOrder::Kick { robot: 15, kicks: 15 }, drive, TestOrder::Stand, TestOrder::End];
    for order in orders {
        assert_eq!(TestOrder::from_json(order.to_json().as_bytes()), Ok(order));
    }
    for (json, refused) in [
        (r#"{"kick":{"robot":16,"kicks":5}}"#, TestRefused::NoSuchRobot(16)),
        (r#"{"kick":{"robot":1,"kicks":4}}"#, TestRefused::Kicks(4)),
        (r#"{"kick":{"robot":1,"kicks":16}}"#, TestRefused::Kicks(16)),
        (r#"{"drive":{"robot":16,"velocity":[0,0,0],"dribbler":false}}"#, TestRefused::NoSuchRobot(16)),
        (r#"{"drive":{"robot":1,"velocity":[0,2.1,0],"dribbler":false}}"#, TestRefused::Speed),
        (r#"{"drive":{"robot":1,"velocity":[0,0,-7],"dribbler":false}}"#, TestRefused::Speed),
        (r#"{"drive":{"robot":1,"velocity":[0,0,0],"dribbler":false,"kick":9}}"#, TestRefused::KickSpeed),
    ] {
        assert_eq!(TestOrder::from_json(json.as_bytes()), Err(refused), "{json}");
    }
    for json in ["", "[]", r#"{"kick":{"robot":1}}"#, r#"{"fly":{}}"#] {
        assert!(matches!(TestOrder::from_json(json.as_bytes()), Err(TestRefused::Malformed(_))), "{json}");
    }
    let told = [TestRefused::NoSuchRobot(16), TestRefused::Kicks(4), TestRefused::External];
    assert!(told.iter().all(|refused| refused.to_string().len() > 10));
}

#[test]
fn a_host_begins_a_test_keeps_it_when_another_is_refused_and_ends_it() {
    let settings = crate::HostSettings::new(Colour::Blue, rules::League::DivisionB, 1);
    let mut host = crate::Host::new(settings, Instant(0));
    let ask =
        |host: &mut crate::Host, json: &str| host.handle(Instant(0), crate::Input::Test(json.as_bytes()));
    assert_eq!(ask(&mut host, r#"{"kick":{"robot":2,"kicks":5}}"#), crate::InputVerdict::Test);
    let refused = ask(&mut host, r#"{"kick":{"robot":2,"kicks":50}}"#);
    assert_eq!(refused, crate::InputVerdict::NoTest(TestRefused::Kicks(50)));
    assert_eq!(host.kick_test().map(|report| (report.robot, report.wanted)), Some((id(2), 5)));
    assert_eq!(ask(&mut host, r#""end""#), crate::InputVerdict::Test);
    assert_eq!(host.kick_test(), None);
    let external = crate::HostSettings { external: true, ..host.settings().clone() };
    let mut host = crate::Host::new(external, Instant(0));
    let refused = ask(&mut host, r#"{"kick":{"robot":2,"kicks":5}}"#);
    assert_eq!(refused, crate::InputVerdict::NoTest(TestRefused::External));
}

/// Robot 2, at (0, 0), driven by hand from 0 s on.
fn driven(velocity: [f32; 3], dribbler: bool, kick: Option<f32>) -> RobotTest {
    RobotTest::of(TestOrder::Drive { robot: 2, velocity, dribbler, kick }, Instant(0)).unwrap()
}

fn task_of_driven(test: &mut RobotTest, view: &View) -> Task {
    let orders = test.plan(view, usual(view));
    assert!(orders.iter().all(|order| order.robot == id(2) || order.task == Task::Stand), "{orders:?}");
    orders.iter().find(|order| order.robot == id(2)).unwrap().task
}

#[test]
fn a_driven_robot_s_target_is_as_far_as_it_needs_to_brake_and_turns_with_it() {
    let mut view = View { now: Instant(0), ..field() };
    view.ours[2].heading = geometry::Angle::degrees(90.0);
    let target = |velocity| match task_of_driven(&mut driven(velocity, false, None), &view) {
        Task::GoTo { at, face } => (at.x(), at.y(), face.to_degrees()),
        other => panic!("{other:?}"),
    };
    let braking = |speed: f32| speed * speed / (2.0 * rules::RobotSpec::OURS.plan.braking);
    let (x, y, _) = target([1.0, 0.0, 0.0]);
    assert!(x.abs() < 1e-3 && y > braking(1.0) && y < braking(1.0) + 0.06, "{x} {y}: ahead is +y");
    let (x, ..) = target([0.0, 0.5, 0.0]);
    assert!(x < -braking(0.5), "{x}: its left is -x");
    let (x, y, _) = target([2.0, 2.0, 0.0]);
    assert!(x.hypot(y) < braking(2.0) + 0.1, "{x} {y}: both together are no faster than 2 m/s");
    let (x, y, face) = target([0.0, 0.0, 3.0]);
    assert!(x.hypot(y) < 1e-3 && face > 95.0 && face < 120.0, "{x} {y} {face}");
}

#[test]
fn a_drive_by_hand_ends_after_100_ms_and_in_every_phase_but_open_play() {
    let mut test = driven([1.0, 0.0, 0.0], false, None);
    let at = |us: u64| View { now: Instant(us), ..field() };
    assert!(matches!(task_of_driven(&mut test, &at(99_000)), Task::GoTo { .. }));
    assert_eq!(task_of_driven(&mut test, &at(100_000)), Task::Stand);
    assert_eq!(test.until(), Some(Instant(100_000)));
    assert!(!test.expire(Instant(99_999)) && test.expire(Instant(100_000)));
    assert!(!test.expire(Instant(200_000)) && test.until().is_none(), "once");
    assert_eq!(driven([0.0; 3], false, None).until(), None, "a released pad has ended at once");
    for phase in [Phase::Halt, Phase::Stop, Phase::FreeKick(Side::Ours)] {
        let view = View { phase, ..field() };
        let orders = driven([1.0, 0.0, 0.0], true, Some(3.0)).plan(&view, usual(&view));
        assert_eq!(orders, usual(&view), "{phase:?}");
    }
}

#[test]
fn a_driven_robot_takes_and_kicks_a_ball_only_before_its_dribbler() {
    let at = |x: f32| Some(ViewBall::at_rest(Point::new(x, 0.0)));
    let ball = |x: f32| View { now: Instant(0), ball: at(x), ..field() };
    let front = rules::RobotSpec::OURS.hull.ball_at();
    let task =
        |dribbler, kick, view: &View| task_of_driven(&mut driven([0.5, 0.0, 0.0], dribbler, kick), view);
    assert!(matches!(task(true, None, &ball(front + 0.2)), Task::GetBall { .. }));
    assert!(matches!(task(true, None, &ball(1.0)), Task::GoTo { .. }));
    assert!(matches!(task(false, Some(3.0), &ball(front + 0.2)), Task::GoTo { .. }));
    let Task::Kick { at, kick } = task(false, Some(3.5), &ball(front)) else { panic!("no kick") };
    assert_eq!((at.y(), kick), (0.0, KickOrder::Flat(350)));
    let mut held = ball(front);
    held.contact.insert(id(2));
    assert!(matches!(task(true, None, &held), Task::Dribble { .. }));
}

#[test]
fn a_host_wakes_up_for_the_end_of_a_drive_and_refuses_one_beside_another_program() {
    let settings = crate::HostSettings::new(Colour::Blue, rules::League::DivisionB, 1);
    let mut host = crate::Host::new(settings, Instant(0));
    let drive = |host: &mut crate::Host, at: u64, speed: f32| {
        let json =
            format!(r#"{{"drive":{{"robot":2,"velocity":[{speed},0,0],"dribbler":false,"kick":null}}}}"#);
        host.handle(Instant(at), crate::Input::Test(json.as_bytes()))
    };
    assert_eq!(drive(&mut host, 0, 1.0), crate::InputVerdict::Test);
    assert_eq!((host.driven(), host.poll_timeout()), (Some(id(2)), Some(Instant(100_000))));
    assert_eq!(drive(&mut host, 50_000, 1.0), crate::InputVerdict::Test);
    assert_eq!(host.poll_timeout(), Some(Instant(150_000)), "each order lasts 100 ms");
    host.handle(Instant(150_000), crate::Input::Timeout);
    assert!(host.radio().transmitted() == Some(Instant(150_000)), "the stop goes out at once");
    drive(&mut host, 200_000, 1.0);
    drive(&mut host, 201_000, 0.0);
    assert_eq!(host.radio().transmitted(), Some(Instant(201_000)), "a release too");
    let external = crate::HostSettings { external: true, ..host.settings().clone() };
    let mut host = crate::Host::new(external, Instant(0));
    assert_eq!(drive(&mut host, 0, 1.0), crate::InputVerdict::NoTest(TestRefused::External));
}
