//! Does everybody have one sensible order in every phase of the game?

use super::*;
use crate::strategy::view::Ball;
use crate::strategy::view::tests::view;

const OURS: [(f32, f32); 6] = [(-4.4, 0.0), (-3.0, 0.5), (-3.0, -0.5), (-0.5, 0.0), (0.5, 1.5), (0.5, -1.5)];
const THEIRS: [(f32, f32); 3] = [(4.4, 0.0), (2.0, 1.0), (1.0, -1.0)];

fn phases() -> Vec<Phase<Side>> {
    let by = |side| {
        [
            Phase::Timeout(side),
            Phase::BallPlacement(side),
            Phase::PrepareKickoff(side),
            Phase::Kickoff(side),
            Phase::PreparePenalty(side),
            Phase::Penalty(side),
            Phase::FreeKick(side),
        ]
    };
    [Phase::Halt, Phase::Stop, Phase::Run].into_iter().chain(by(Side::Ours)).chain(by(Side::Theirs)).collect()
}

#[test]
fn every_robot_has_exactly_one_order_in_every_phase_with_and_without_a_ball() {
    for phase in phases() {
        for next in [None, Some(Phase::FreeKick(Side::Ours)), Some(Phase::PreparePenalty(Side::Theirs))] {
            for ball in [Some((0.3, 0.2)), Some((-4.2, 0.0)), Some((4.3, 0.1)), Some((4.6, 3.1)), None] {
                for robots in 0..=OURS.len() {
                    let mut view = view(ball.unwrap_or_default(), &OURS[..robots], &THEIRS);
                    (view.phase, view.next) = (phase, next);
                    view.placement = Some(Point::new(1.0, 1.0));
                    if ball.is_none() {
                        view.ball = None;
                    }
                    let orders = Coach::default().decide(&view);
                    let ids: Vec<_> = orders.iter().map(|order| order.robot.number()).collect();
                    assert_eq!(ids, (0..robots as u8).collect::<Vec<_>>(), "{phase:?} {ball:?}");
                }
            }
        }
    }
}

#[test]
fn in_halt_everybody_stands() {
    let mut view = view((0.0, 0.0), &OURS, &THEIRS);
    view.phase = Phase::Halt;
    assert!(Coach::default().decide(&view).iter().all(|order| order.task == Task::Stand));
}

#[test]
fn in_open_play_there_are_a_keeper_two_defenders_and_three_who_play_cases() {
    let orders = Coach::default().decide(&view((0.0, 0.0), &OURS, &THEIRS));
    let of = |task: fn(&Order) -> bool| orders.iter().filter(|order| task(order)).count();
    assert_eq!(of(|order| order.role == Role::Keeper), 1);
    assert_eq!(of(|order| matches!(order.role, Role::Defender(_))), 2);
    assert_eq!(of(|order| order.task == Task::Gameplay), 3);
}

#[test]
fn one_too_many_goes_to_the_touch_line_and_it_is_not_the_keeper() {
    let view = view((0.0, 0.0), &OURS, &THEIRS).allowing(4);
    let orders = Coach::default().decide(&view);
    let leaving: Vec<_> =
        orders.iter().filter(|order| order.role == Role::Leaving).map(|order| order.robot.number()).collect();
    assert_eq!(leaving, [4, 5]);
}

#[test]
fn who_took_our_free_kick_leaves_the_ball_to_others_until_somebody_touched_it() {
    let mut coach = Coach::default();
    let mut view = view((-0.35, 0.0), &OURS, &THEIRS);
    view.phase = Phase::FreeKick(Side::Ours);
    let taker = coach.decide(&view).iter().find(|order| order.role == Role::Taker).unwrap().robot;
    assert_eq!(taker.number(), 3);
    view.phase = Phase::Run;
    let orders = coach.decide(&view);
    assert_eq!(orders[3].role, Role::Barred);
    // Another one at the ball: it may again.
    let ball = Point::new(0.5, 1.4);
    view.ball = Some(Ball { position: ball, rest: ball, ..view.ball.unwrap() });
    assert_ne!(coach.decide(&view)[3].role, Role::Barred);
}

#[test]
fn nobody_is_sent_near_the_ball_in_stop_nor_to_a_ball_in_their_area() {
    for ball in [(0.0, 0.0), (-3.2, 0.3), (4.2, 2.7), (-4.3, -2.8)] {
        let mut view = view(ball, &OURS, &THEIRS);
        view.phase = Phase::Stop;
        for order in Coach::default().decide(&view) {
            if let Task::GoTo { at, .. } = order.task {
                assert!(at.distance(Point::new(ball.0, ball.1)) > 0.6, "{ball:?}: {order:?}");
            }
        }
    }
    let orders = Coach::default().decide(&view((4.2, 0.3), &OURS, &THEIRS));
    assert!(
        orders.iter().all(|order| !matches!(order.task, Task::Gameplay | Task::Kick { .. })),
        "{orders:?}"
    );
}

#[test]
fn the_same_views_give_the_same_orders_and_roles_hold_between_them() {
    let (mut a, mut b) = (Coach::default(), Coach::default());
    for step in 0..50 {
        let view = view((step as f32 * 0.01, 0.1), &OURS, &THEIRS);
        assert_eq!(a.decide(&view), b.decide(&view));
    }
    let first = a.decide(&view((0.0, 0.0), &OURS, &THEIRS));
    let jittered = a.decide(&view((0.01, -0.01), &OURS, &THEIRS));
    let roles = |orders: &Orders| orders.iter().map(|order| order.role).collect::<Vec<_>>();
    assert_eq!(roles(&first), roles(&jittered));
}
