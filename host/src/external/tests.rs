//! Tests: what a strategy in another program is told, and what its answers order.

use geometry::{Attack, Point};
use protocol::host::KickOrder;
use protocol::{Duration, Instant, RobotId};
use rules::{League, Phase, Side};

use super::*;

fn id(number: u8) -> RobotId {
    RobotId::new(number).unwrap()
}

fn view(phase: Phase<Side>) -> View {
    let places = |places: &[(f32, f32)]| -> Vec<Point<Attack>> {
        places.iter().map(|&(x, y)| Point::new(x, y)).collect()
    };
    let ours = places(&[(-4.3, 0.0), (-1.0, 0.5), (0.5, -1.0)]);
    let theirs = places(&[(4.3, 0.0), (1.0, 0.3)]);
    let mut view = View::still(League::DivisionB.field(), Point::new(-0.8, 0.5), ours, theirs);
    (view.now, view.phase, view.keeper) = (Instant(2_000_000), phase, view.ours[0].id);
    view
}

/// What our coach would order: each robot goes to its own place.
fn usual(view: &View) -> Orders {
    let order = |robot: &crate::strategy::view::ViewRobot| Order {
        robot: robot.id,
        role: Role::Player,
        task: Task::GoTo { at: robot.position, face: robot.heading },
        why: OrderReason::OpenPlay,
    };
    view.ours.iter().map(order).collect()
}

fn tasks(orders: &Orders) -> Vec<(u8, Task)> {
    orders.iter().map(|order| (order.robot.number(), order.task)).collect()
}

const KICK: &[u8] = br#"{"orders":[{"robot":1,"task":{"kick":{"at":[4.5,0.2],"speed":6.0}}}]}"#;

#[test]
fn each_view_goes_to_the_strategy_once_with_the_coachs_orders() {
    let view = view(Phase::FreeKick(Side::Theirs));
    let mut external = External::new(League::DivisionB);
    external.plan(&view, usual(&view));
    let line = external.poll().unwrap();
    assert_eq!(external.poll(), None);
    let told: StrategyView = serde_json::from_str(&line).unwrap();
    assert_eq!((told.version, &*told.league, told.time), (1, "division-b", 2.0));
    assert_eq!(told.phase, StrategyPhase { name: "free-kick".to_owned(), ours: Some(false) });
    assert_eq!(told.ball.unwrap().at, [-0.8, 0.5]);
    assert_eq!(told.ours.iter().map(|robot| robot.robot).collect::<Vec<_>>(), [0, 1, 2]);
    assert_eq!((told.theirs[1].robot, told.theirs[1].at), (1, [1.0, 0.3]));
    assert_eq!((told.field.length, told.field.area_depth), (9.0, 1.0));
    assert_eq!(told.usual[1].robot, 1);
    assert!(matches!(told.usual[1].task, StrategyTask::GoTo { at: [-1.0, 0.5], .. }));
    // Our own planners take the same line.
    let snapshot = told.snapshot(League::DivisionB.field());
    assert_eq!((snapshot.ours.len(), snapshot.theirs.len(), snapshot.keeper), (3, 2, view.keeper));
    assert_eq!(snapshot.ball.unwrap().position, view.ball.unwrap().position);
}

#[test]
fn orders_replace_the_coach_s_robot_by_robot_and_every_reason_says_so() {
    let view = view(Phase::Run);
    let mut external = External::new(League::DivisionB);
    external.plan(&view, usual(&view));
    let orders = external.answered(view.now, KICK).unwrap().unwrap();
    let kick = Task::Kick { at: Point::new(4.5, 0.2), kick: KickOrder::Flat(600) };
    assert_eq!(tasks(&orders)[1], (1, kick));
    assert_eq!(orders[1].why, OrderReason::External);
    assert_eq!(tasks(&orders)[2], tasks(&usual(&view))[2]);
    assert_eq!(orders[2].why, OrderReason::OpenPlay);
}

#[test]
fn robots_of_a_silent_strategy_stand_in_open_play_and_keep_the_coach_s_restarts() {
    let run = view(Phase::Run);
    let mut external = External::new(League::DivisionB);
    external.plan(&run, usual(&run));
    external.answered(run.now, KICK).unwrap();
    let later = |ms, view: &View| View { now: run.now + Duration::millis(ms), ..view.clone() };
    let still = later(79, &run);
    assert!(matches!(tasks(&external.plan(&still, usual(&still)))[1].1, Task::Kick { .. }));
    let late = later(81, &run);
    let orders = external.plan(&late, usual(&late));
    assert!(orders.iter().all(|order| order.task == Task::Stand && order.why == OrderReason::ExternalSilent));
    assert_eq!(orders[0].role, Role::Keeper);
    let stop = later(81, &view(Phase::Stop));
    assert_eq!(tasks(&external.plan(&stop, usual(&stop))), tasks(&usual(&stop)));
    // It answers again.
    let orders = external.answered(stop.now, br#"{"orders":[]}"#).unwrap().unwrap();
    assert_eq!(tasks(&orders), tasks(&usual(&stop)));
}

#[test]
fn a_robot_that_has_to_leave_the_field_leaves_whatever_the_strategy_orders() {
    let view = view(Phase::Run);
    let mut bound = usual(&view);
    bound[1].why = OrderReason::TooMany { allowed: 2 };
    let mut external = External::new(League::DivisionB);
    external.plan(&view, bound.clone());
    let told: StrategyView = serde_json::from_str(&external.poll().unwrap()).unwrap();
    assert_eq!(told.bound, [1]);
    let orders = external.answered(view.now, KICK).unwrap().unwrap();
    assert_eq!(tasks(&orders), tasks(&bound));
}

#[test]
fn nobody_is_asked_while_the_game_is_halted() {
    let run = view(Phase::Run);
    let mut external = External::new(League::DivisionB);
    external.plan(&run, usual(&run));
    let halt = view(Phase::Halt);
    external.plan(&halt, usual(&halt));
    assert_eq!(external.poll(), None);
    assert_eq!(external.answered(halt.now, KICK), Ok(None), "an answer to an older view orders nothing");
}

#[test]
fn a_place_too_near_the_ball_is_made_lawful_while_the_opponents_restart() {
    let view = view(Phase::FreeKick(Side::Theirs));
    let mut external = External::new(League::DivisionB);
    external.plan(&view, usual(&view));
    let line = br#"{"orders":[{"robot":2,"task":{"go_to":{"at":[-0.7,0.5],"face":0.0}}}]}"#;
    let orders = external.answered(view.now, line).unwrap().unwrap();
    let Task::GoTo { at, .. } = orders[2].task else { panic!("{:?}", orders[2]) };
    let distance = at.distance(view.ball.unwrap().position);
    assert!(distance >= 0.5, "{distance} m: the rules ask for half a metre");
}

#[test]
fn answers_that_are_none_are_refused_with_a_reason_and_change_nothing() {
    let view = view(Phase::Run);
    let mut external = External::new(League::DivisionB);
    external.plan(&view, usual(&view));
    external.answered(view.now, KICK).unwrap();
    let wrong = [
        ("hello", "no answer of the form"),
        (r#"{"order":[]}"#, "unknown field `order`"),
        (r#"{"orders":[{"robot":16,"task":"stand"}]}"#, "numbers are 0 to 15"),
        (r#"{"orders":[{"robot":1,"task":"stand"},{"robot":1,"task":"stand"}]}"#, "two orders for robot 1"),
        (r#"{"orders":[{"robot":1,"task":{"kick":{"at":[1e9,0],"speed":1}}}]}"#, "the order of robot 1"),
        (r#"{"orders":[{"robot":1,"task":{"kick":{"at":[1,0],"speed":-1}}}]}"#, "the order of robot 1"),
        (r#"{"orders":[{"robot":1,"task":"fly"}]}"#, "unknown variant `fly`"),
        (r#"{"orders":[],"draw":[{"circle":{"at":[0,0],"radius":-1}}]}"#, "more than 64 shapes"),
    ];
    for (number, (line, expected)) in wrong.iter().enumerate() {
        let refused = external.answered(view.now, line.as_bytes()).unwrap_err().to_string();
        assert!(refused.contains(expected), "{line}: {refused}");
        assert_eq!(external.refused().0, number as u64 + 1);
    }
    let many = format!(
        r#"{{"orders":[],"values":{{{}}}}}"#,
        (0..17).map(|n| format!(r#""{n}":0"#)).collect::<Vec<_>>().join(",")
    );
    assert_eq!(external.answered(view.now, many.as_bytes()), Err(AnswerError::Drawing));
    assert!(
        matches!(tasks(&external.plan(&view, usual(&view)))[1].1, Task::Kick { .. }),
        "the last good one"
    );
}

#[test]
fn every_task_of_the_coach_comes_back_as_the_same_task() {
    let view = view(Phase::Run);
    let at = Point::new(1.5, -0.25);
    let all = [
        Task::Stand,
        Task::Gameplay,
        Task::GoTo { at, face: geometry::Angle::new(0.5) },
        Task::GetBall { face: at },
        Task::Kick { at, kick: KickOrder::Flat(612) },
        Task::Kick { at, kick: KickOrder::Chip(350) },
        Task::Pass { at, receiver: id(2), kick: KickOrder::Chip(417), ready: false },
        Task::Pass { at, receiver: id(2), kick: KickOrder::Flat(417), ready: true },
        Task::Receive { at, then: None },
        Task::Receive { at, then: Some(Point::new(4.5, 0.0)) },
        Task::Block { from: at, to: Point::new(0.0, 0.0) },
        Task::PlaceBall { at },
    ];
    for task in all {
        let mut external = External::new(League::DivisionB);
        let usual: Orders = [Order { robot: id(1), role: Role::Player, task, why: OrderReason::OpenPlay }]
            .into_iter()
            .collect();
        external.plan(&view, usual);
        let told: StrategyView = serde_json::from_str(&external.poll().unwrap()).unwrap();
        let answer = StrategyAnswer { orders: told.usual, ..StrategyAnswer::default() };
        let line = serde_json::to_string(&answer).unwrap();
        let orders = external.answered(view.now, line.as_bytes()).unwrap().unwrap();
        assert_eq!(orders[0].task, task, "{line}");
    }
}
