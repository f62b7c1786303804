//! Tests: every robot has one plausible order in every phase.

use super::*;
use crate::strategy::pass::bridge::RADIUS;
use crate::strategy::support;
use crate::strategy::threat::Guards;
use crate::strategy::view::ViewBall;
use crate::strategy::view::tests::view;
use crate::strategy::view::{CaseNext, CasePass, RobotSet};
use casebase::CaseRobot;
use geometry::{Attack, Point, Vector};
use protocol::CaseId;
use protocol::host::Directive;

const OURS: [(f32, f32); 6] = [(-4.4, 0.0), (-3.0, 0.5), (-3.0, -0.5), (-0.5, 0.0), (0.5, 1.5), (0.5, -1.5)];
const THEIRS: [(f32, f32); 3] = [(4.4, 0.0), (2.0, 1.0), (1.0, -1.0)];

fn coach() -> Coach {
    Coach::new(Team::Ours, Tactics::default(), League::DivisionB)
}

/// Open play by thresholds and cases.
fn by_thresholds() -> Coach {
    Coach::new(Team::Ours, Tactics::ROUND_1, League::DivisionB)
}

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
                    for tactics in [Tactics::NONE, Tactics::ALL] {
                        let orders = Coach::new(Team::Ours, tactics, League::DivisionB).decide(&view);
                        let ids: Vec<_> = orders.iter().map(|order| order.robot.number()).collect();
                        assert_eq!(
                            ids,
                            (0..robots as u8).collect::<Vec<_>>(),
                            "{phase:?} {ball:?} {tactics:?}"
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn in_halt_everyone_stands() {
    let mut view = view((0.0, 0.0), &OURS, &THEIRS);
    view.phase = Phase::Halt;
    assert!(coach().decide(&view).iter().all(|order| order.task == Task::Stand));
}

#[test]
fn in_open_play_there_are_a_keeper_two_defenders_and_three_who_play_cases() {
    let orders = by_thresholds().decide(&view((0.0, 0.0), &OURS, &THEIRS));
    let of = |task: fn(&Order) -> bool| orders.iter().filter(|order| task(order)).count();
    assert_eq!(of(|order| order.role == Role::Keeper), 1);
    assert_eq!(of(|order| matches!(order.role, Role::Defender(_))), 2);
    assert_eq!(of(|order| order.task == Task::Gameplay), 3);
}

#[test]
fn by_the_rated_list_one_plays_the_ball_and_two_stand_for_its_passes() {
    let orders = coach().decide(&view((0.0, 0.0), &OURS, &THEIRS));
    let of = |which: fn(&Order) -> bool| orders.iter().filter(|order| which(order)).count();
    assert_eq!(of(|order| order.role == Role::Keeper), 1);
    assert_eq!(of(|order| matches!(order.role, Role::Defender(_))), 2);
    assert_eq!(of(|order| order.role == Role::Player), 1);
    assert_eq!(of(|order| matches!(order.role, Role::Support(_) | Role::Receiver)), 2);
}

#[test]
fn the_list_that_an_order_is_from_is_kept_with_what_was_rejected() {
    let mut coach = coach();
    let seen = view((0.0, 0.0), &OURS, &THEIRS);
    assert!(coach.rated().is_none());
    let orders = coach.decide(&seen);
    let (who, list) = coach.rated().unwrap();
    let player = orders.iter().find(|order| order.role == Role::Player).unwrap();
    assert_eq!(who, player.robot);
    assert!(list.len() > 2 && list.windows(2).all(|pair| pair[0].worth >= pair[1].worth), "{list:?}");
    let best = list[0].to_string();
    assert!(best.contains(&format!("{:+.3}", list[0].worth)), "{best}");
    coach.decide(&View { phase: Phase::Stop, ..seen });
    assert!(coach.rated().is_none(), "no list is played by while the ball is not in play");
}

#[test]
fn by_the_rated_list_the_owner_plays_on_though_another_is_nearer_to_the_stop() {
    let mut coach = coach();
    // Our 3 has it before its front plate; our 4 is behind it.
    let mut view = view((-0.4, 0.0), &OURS, &THEIRS);
    view.ours[4].position = Point::new(-0.7, 0.15);
    for _ in 0..3 {
        let orders = coach.decide(&view);
        let players: Vec<_> = orders.iter().filter(|order| order.role == Role::Player).collect();
        assert_eq!(players.iter().map(|order| order.robot.number()).collect::<Vec<_>>(), [3], "{players:?}");
        view.now = Instant(view.now.0 + 10_000);
        view.ball.as_mut().unwrap().rest = Point::new(-0.6, 0.15);
    }
}

#[test]
fn in_the_other_half_one_defender_joins_the_attack_until_the_ball_is_theirs() {
    let mut coach = coach();
    let mut ours = OURS;
    ours[3] = (1.9, 0.0);
    let defenders = |orders: &Orders| orders.iter().filter(|o| matches!(o.role, Role::Defender(_))).count();
    let mut view = view((2.0, 0.0), &ours, &THEIRS);
    assert_eq!(defenders(&coach.decide(&view)), 1);
    view.theirs[1].position = Point::new(2.1, 0.0);
    view.theirs[1].heading = geometry::Angle::HALF_TURN;
    view.ours[3].position = Point::new(0.5, 0.0);
    for _ in 0..3 {
        view.now = Instant(view.now.0 + 10_000);
        coach.decide(&view);
    }
    assert_eq!(defenders(&coach.decide(&view)), 2);
}

#[test]
fn among_equals_a_case_is_proposed_to_the_robots_that_play_it() {
    // Balls before the goal, until one lies where the robots would retrieve a shot of our 3 alone: the same
    // shot is no better.
    let before_the_goal = |i: u8| {
        let ball = (2.0 + 0.2 * f32::from(i % 9), 0.4 * f32::from(i / 9) - 1.2);
        let mut view = view(ball, &OURS, &[(4.4, 0.1)]);
        view.ours[3].position = Point::new(ball.0 - 0.15, ball.1);
        view.ours.iter().for_each(|robot| view.knows_cases.insert(robot.id));
        view
    };
    let of_a_case = |view: &View| matches!(coach().decide(view)[3].task, Task::Case(_));
    let mut view = (0..63).map(before_the_goal).find(of_a_case).unwrap();
    let orders = coach().decide(&view);
    let Task::Case(cast) = orders[3].task else { panic!("{:?}", orders[3]) };
    assert!(cast.has(orders[3].robot));
    assert!(matches!(orders[3].why, OrderReason::PlaysCase { case } if case == cast.case));
    let Directive::Gameplay { hint: Some(hint) } = orders[3].task.directive(view.flip) else { panic!() };
    assert_eq!((hint.case, hint.robots.first()), (cast.case, Some(&orders[3].robot)));
    view.knows_cases = RobotSet::default();
    assert!(matches!(coach().decide(&view)[3].task, Task::Kick { .. }));
}

#[test]
fn one_too_many_goes_to_the_touch_line_and_it_is_not_the_keeper() {
    let view = view((0.0, 0.0), &OURS, &THEIRS).allowing(4);
    let orders = coach().decide(&view);
    let leaving: Vec<_> =
        orders.iter().filter(|order| order.role == Role::Leaving).map(|order| order.robot.number()).collect();
    assert_eq!(leaving, [4, 5]);
}

#[test]
fn our_free_kicks_kicker_avoids_the_ball_until_another_robot_touches_it() {
    let mut coach = coach();
    let mut view = view((-0.35, 0.0), &OURS, &THEIRS);
    view.phase = Phase::FreeKick(Side::Ours);
    let kicker = coach.decide(&view).iter().find(|order| order.role == Role::Kicker).unwrap().robot;
    assert_eq!(kicker.number(), 3);
    view.phase = Phase::Run;
    let orders = coach.decide(&view);
    assert_eq!(orders[3].role, Role::DoubleTouchBlocked);
    // Another one is at the ball: it may touch it again.
    let ball = Point::new(0.5, 1.4);
    view.ball = Some(ViewBall { position: ball, rest: ball, ..view.ball.unwrap() });
    assert_ne!(coach.decide(&view)[3].role, Role::DoubleTouchBlocked);
}

#[test]
fn no_robot_is_sent_near_the_ball_in_a_stop_nor_to_a_ball_in_their_area() {
    for ball in [(0.0, 0.0), (-3.2, 0.3), (4.2, 2.7), (-4.3, -2.8)] {
        let mut view = view(ball, &OURS, &THEIRS);
        view.phase = Phase::Stop;
        for order in coach().decide(&view) {
            if let Task::GoTo { at, .. } = order.task {
                assert!(at.distance(Point::new(ball.0, ball.1)) > 0.6, "{ball:?}: {order:?}");
            }
        }
    }
    let orders = coach().decide(&view((4.2, 0.3), &OURS, &THEIRS));
    assert!(
        orders.iter().all(|order| !matches!(order.task, Task::Gameplay | Task::Kick { .. })),
        "{orders:?}"
    );
}

#[test]
fn the_same_views_give_the_same_orders_and_roles_hold_between_them() {
    let (mut a, mut b) = (coach(), coach());
    for step in 0..50 {
        let view = view((step as f32 * 0.01, 0.1), &OURS, &THEIRS);
        assert_eq!(a.decide(&view), b.decide(&view));
    }
    let first = a.decide(&view((0.0, 0.0), &OURS, &THEIRS));
    let jittered = a.decide(&view((0.01, -0.01), &OURS, &THEIRS));
    let roles = |orders: &Orders| orders.iter().map(|order| order.role).collect::<Vec<_>>();
    assert_eq!(roles(&first), roles(&jittered));
}

#[test]
fn against_threats_defenders_give_the_open_angle_and_others_return_for_their_ball() {
    let tactics = Tactics { threats: true, second_level: true, ..Tactics::NONE };
    let guards = |orders: &Orders| {
        orders
            .iter()
            .filter(|order| matches!(order.why, OrderReason::Threat(_)))
            .map(|order| order.robot.number())
            .collect::<Vec<_>>()
    };
    // Ours: our 3 is at the ball. Theirs: their 2 is, and their 1 is free before our goal.
    let ours = view((-0.4, 0.0), &OURS, &[(4.4, 0.0), (-2.0, 1.5), (1.0, -1.0)]);
    assert_eq!(guards(&Coach::new(Team::Ours, tactics, League::DivisionB).decide(&ours)), [0, 1, 2]);
    let theirs = view((0.9, -1.0), &OURS, &[(4.4, 0.0), (-2.0, 1.5), (1.0, -1.0)]);
    let mut far = theirs.clone();
    far.ours.iter_mut().skip(3).for_each(|robot| robot.position = robot.position - Vector::new(1.5, 0.0));
    let orders = Coach::new(Team::Ours, tactics, League::DivisionB).decide(&far);
    let marks = |order: &&Order| matches!(order.why, OrderReason::Threat(Guards::SecondLevel { opponent, .. }) if opponent.number() == 1);
    assert!(orders.iter().any(|order| marks(&order)), "{orders:?}");
    let alone = Tactics { second_level: false, ..tactics };
    assert_eq!(guards(&Coach::new(Team::Ours, alone, League::DivisionB).decide(&far)), [0, 1, 2]);
}

/// A free kick of ours with the kicker behind the ball, `x` m before our 4 at its place, after `ms`.
fn free_kick(ms: u64, receiver: (f32, f32), theirs: &[(f32, f32)]) -> View {
    let ours = [(-4.4, 0.0), (-3.2, 0.3), (-3.2, -0.3), (0.855, 0.0), receiver, (-1.0, -2.0)];
    let mut view = view((1.0, 0.0), &ours, theirs);
    view.phase = Phase::FreeKick(Side::Ours);
    view.now = Instant(1_000_000 + ms * 1_000);
    view
}

#[test]
fn a_pass_ahead_leaves_when_its_receiver_will_be_in_time_at_the_place_it_is_sent_to() {
    let tactics = Tactics { pass_ahead: true, ..Tactics::NONE };
    let mut coach = Coach::new(Team::Ours, tactics, League::DivisionB);
    // Six of them before their goal: no shot.
    let theirs = [(4.4, 0.0), (3.2, 0.3), (3.2, -0.3), (2.9, 0.05), (3.0, -0.15), (2.6, 0.0)];
    let mut receiver = (1.0, 2.0);
    let (mut went, mut left) = (None, None);
    for ms in (0..3_500).step_by(20) {
        let mut view = free_kick(ms, receiver, &theirs);
        let kicker = view.ours[3].id;
        if let Some((at, _)) = went {
            // The kicker faces x*, the receiver moves there at 2 m/s.
            let at: Point<Attack> = at;
            let ball = Point::new(1.0, 0.0);
            view.ours[3].heading = ball.direction_to(at);
            view.ours[3].position = ball - (at - ball).unit().unwrap() * 0.14;
            let offset = at - Point::new(receiver.0, receiver.1);
            let step = offset.unit().unwrap_or_default() * 0.04_f32.min(offset.norm());
            receiver = (receiver.0 + step.x(), receiver.1 + step.y());
        }
        let orders = coach.decide(&view);
        for order in &orders {
            if let Task::Pass { at, ready, receiver, .. } = order.task {
                assert_eq!(order.robot, kicker);
                assert!(
                    matches!(order.why, OrderReason::Chances { receive, .. } if receive > 0.3),
                    "{:?}",
                    order.why
                );
                went.get_or_insert((at, receiver));
                if ready && left.is_none() {
                    left = Some(ms);
                    let reported = orders.iter().find(|order| order.robot == receiver).unwrap();
                    assert!(
                        matches!(reported.task, Task::Receive { at: there, .. } if there == at),
                        "{reported:?}"
                    );
                }
            }
        }
    }
    assert!(left.is_some_and(|left| left > 200), "{went:?} {left:?}");
    // Once it is in play the receiver has it, and the pass is counted once.
    let mut view = free_kick(3_500, receiver, &theirs);
    view.phase = Phase::Run;
    let (at, id) = went.unwrap();
    let orders = coach.decide(&view);
    let reported = orders.iter().find(|order| order.robot == id).unwrap();
    assert!(matches!(reported.task, Task::Receive { at: there, .. } if there == at), "{reported:?}");
    let sent = coach.take_sent().unwrap();
    assert_eq!((sent.to, sent.receiver, sent.planned), (at, id, None));
    assert_eq!(coach.take_sent(), None);
}

#[test]
fn at_a_shot_at_our_goal_no_defender_leaves_its_place_nor_the_keeper_its_role() {
    for coach in [by_thresholds, coach] {
        shot_at_our_goal(coach());
    }
}

fn shot_at_our_goal(mut coach: Coach) {
    let mut ours = OURS;
    ours[3] = (-1.8, 0.2);
    let mut view = view((-1.5, 0.2), &ours, &[(4.4, 0.0), (-1.3, 0.2)]);
    let before: Vec<_> = coach.decide(&view).iter().map(|order| order.role).collect();
    assert_eq!(
        (before[0], before[1..3].iter().all(|role| matches!(role, Role::Defender(_)))),
        (Role::Keeper, true)
    );
    // 6 m/s towards (−4.5, 0.05): past both defenders, to a stop position far behind the goal, where the
    // keeper would be soonest.
    let velocity = Vector::new(-6.0, -0.3);
    let ball =
        ViewBall { velocity, rest: Point::new(-20.0, -0.7), ..ViewBall::at_rest(Point::new(-2.0, 0.175)) };
    view.ball = Some(ball);
    let orders = coach.decide(&view);
    let roles: Vec<_> = orders.iter().map(|order| order.role).collect();
    assert_eq!(roles[..3], before[..3]);
    assert!(matches!(orders[0].task, Task::Block { .. }), "{:?}", orders[0]);
    assert!(orders.iter().all(|order| order.task != Task::Gameplay), "{orders:?}");
}

#[test]
fn a_ball_before_our_area_is_the_keepers_unless_a_field_player_is_there_first() {
    let kicks = |ball: (f32, f32)| -> Vec<u8> {
        let orders = coach().decide(&view(ball, &OURS, &THEIRS));
        let plays = |order: &&Order| matches!(order.task, Task::Kick { .. } | Task::Gameplay);
        orders.iter().filter(plays).map(|order| order.robot.number()).collect()
    };
    // The area reaches to x = −3.5 and y = ±1.
    assert_eq!(kicks((-3.3, 0.2)), [0]);
    assert_eq!(kicks((-4.2, 1.2)), [0]);
    assert!(!kicks((-3.1, 0.2)).contains(&0));
    // A defender that is there first plays it, and lines up outside our area.
    let mut ours = OURS;
    ours[1] = (-3.15, 0.3);
    let near = view((-3.3, 0.2), &ours, &THEIRS);
    let orders = coach().decide(&near);
    let Task::Kick { at, .. } = orders[1].task else { panic!("{:?}", orders[1]) };
    assert!(matches!(orders[0].task, Task::GoTo { .. }), "{:?}", orders[0]);
    let ball = Point::new(-3.3, 0.2);
    assert!(!near.in_our_area(ball - (at - ball).unit().unwrap() * 0.165, 0.1), "{at:?}");
    // Without a keeper a field player tries.
    let mut alone = view((-3.3, 0.2), &OURS, &THEIRS);
    alone.keeper = RobotId::new(9).unwrap();
    let tries = |order: &Order| order.role == Role::Player && order.task != Task::Stand;
    assert!(coach().decide(&alone).iter().any(tries));
    assert!(by_thresholds().decide(&alone).iter().any(|order| order.task == Task::Gameplay));
}

/// Our 3 stands behind the ball at (2, 0), our 4 and 5 at these places; with these opponents.
pub(super) fn attack(
    teammates: [(f32, f32); 2],
    theirs: &[(f32, f32)],
    tactics: Tactics,
) -> (Coach, View, Orders) {
    let ours = [(-4.4, 0.0), (-3.2, 0.3), (-3.2, -0.3), (1.85, 0.0), teammates[0], teammates[1]];
    let view = view((2.0, 0.0), &ours, theirs);
    let mut coach = Coach::new(Team::Ours, tactics, League::DivisionB);
    let orders = coach.decide(&view);
    (coach, view, orders)
}

#[test]
fn open_play_shoots_at_an_open_goal_passes_around_a_closed_one_else_plays_a_case() {
    let far = [(-2.0, 2.0), (-2.0, -2.0)];
    let (_, _, shoots) = attack(far, &[(4.4, 0.3)], Tactics::ROUND_1);
    assert!(
        matches!(shoots[3].task, Task::Kick { at, kick } if at.y() < 0.1 && kick == support::SHOT),
        "{:?}",
        shoots[3]
    );
    assert!(
        matches!(shoots[3].why, OrderReason::Chances { receive, goal } if receive == 1.0 && goal > WORTH),
        "{:?}",
        shoots[3]
    );
    // A wall before the ball, and a teammate beside it.
    let wall = [(4.4, 0.0), (2.4, 0.0), (2.45, 0.2), (2.45, -0.2)];
    let (_, _, passes) = attack([(3.0, 1.8), (-2.0, -2.0)], &wall, Tactics::ROUND_1);
    let Task::Pass { at, receiver, .. } = passes[3].task else { panic!("{:?}", passes[3]) };
    assert_eq!(receiver.number(), 4);
    assert!(matches!(passes[4].task, Task::Receive { at: there, .. } if there == at), "{:?}", passes[4]);
    // All our robots are marked, and the goal closed.
    let closed = [wall[0], wall[1], wall[2], wall[3], (-1.8, 2.0), (-1.8, -2.0)];
    let (_, _, case) = attack(far, &closed, Tactics::ROUND_1);
    assert_eq!(case[3].task, Task::Gameplay);
    let without = Tactics { attack: false, ..Tactics::ROUND_1 };
    assert_eq!(attack(far, &[(4.4, 0.3)], without).2[3].task, Task::Gameplay);
}

#[test]
fn with_the_bridge_a_running_cases_pass_goes_near_its_place_to_its_receiver() {
    // The goal is closed and no pass may be worth it; the case has 5 receive it in free space.
    let closed = [(4.4, 0.0), (2.4, 0.0), (2.45, 0.2), (2.45, -0.2), (-1.8, 2.0)];
    let ours = [(-4.4, 0.0), (-3.2, 0.3), (-3.2, -0.3), (1.85, 0.0), (-2.0, 2.0), (-0.8, -2.0)];
    let at = Point::new(-0.8, -1.8);
    let decide = |bridge, passer| {
        let seen = view((2.0, 0.0), &ours, &closed);
        let part = |part, robot: usize| (seen.ours[robot].id, CaseRobot::new(part).unwrap());
        let pass = CasePass { case: CaseId(12), passer: part(0, passer), receiver: part(1, 5), at };
        let seen = seen.proposing(Some(CaseNext::Pass(pass)));
        let tactics = Tactics { bridge, ..Tactics::ROUND_1 };
        Coach::new(Team::Ours, tactics, League::DivisionB).decide(&seen)
    };
    let orders = decide(true, 3);
    let Task::Pass { at: there, receiver, .. } = orders[3].task else { panic!("{:?}", orders[3]) };
    assert_eq!(receiver.number(), 5);
    assert!(there.distance(at) <= RADIUS);
    assert!(matches!(orders[5].task, Task::Receive { at, .. } if at == there), "{:?}", orders[5]);
    for (robot, part) in [(3, 0), (5, 1)] {
        let OrderReason::OfCase { case, part: reported, moved, receive, .. } = orders[robot].why else {
            panic!("{:?}", orders[robot])
        };
        assert_eq!((case, reported.index()), (CaseId(12), part));
        assert!((moved - there.distance(at)).abs() < 1e-6 && receive > 0.5, "{:?}", orders[robot]);
    }
    // Another robot's pass is not this one's, and without the bridge the case is played as it is.
    assert_eq!(decide(true, 4)[3].task, Task::Gameplay);
    assert_eq!(decide(false, 3)[3].task, Task::Gameplay);
}

/// Clearly above the least value of a shot (0.05).
const WORTH: f32 = 0.1;

#[test]
fn a_placement_that_gets_nowhere_is_given_up_and_everyone_keeps_away() {
    let mut coach = coach();
    let mut view = view((2.0, 2.0), &OURS, &THEIRS);
    view.phase = Phase::BallPlacement(Side::Ours);
    view.placement = Some(Point::new(-1.0, 0.0));
    let places = |orders: &Orders| orders.iter().any(|order| matches!(order.task, Task::PlaceBall { .. }));
    let begun = view.now;
    // Half a metre each five seconds is progress; none for thirty is not.
    for second in 0..60_u64 {
        view.now = Instant(begun.0 + second * 1_000_000);
        let moved = 0.5 * (second.min(20) / 5) as f32;
        let at = Point::new(2.0 - moved, 2.0);
        view.ball = Some(ViewBall::at_rest(at));
        let orders = coach.decide(&view);
        assert_eq!(places(&orders), second <= 50, "{second} s");
        if second > 50 {
            let spine = geometry::Segment::new(at, Point::new(-1.0, 0.0));
            for order in &orders {
                if let Task::GoTo { at, .. } = order.task {
                    assert!(spine.distance_to(at) > 0.6, "{order:?}");
                }
            }
        }
    }
    // The next placement is tried again.
    view.phase = Phase::Stop;
    coach.decide(&view);
    view.phase = Phase::BallPlacement(Side::Ours);
    assert!(places(&coach.decide(&view)));
}

#[test]
fn a_ball_behind_the_goal_that_no_robot_gets_at_is_given_up_at_once() {
    let mut coach = coach();
    let mut view = view((4.75, 0.2), &OURS, &THEIRS);
    view.phase = Phase::BallPlacement(Side::Ours);
    view.placement = Some(Point::new(4.3, 2.8));
    coach.decide(&view);
    view.now = Instant(view.now.0 + 2_500_000);
    assert!(!coach.decide(&view).iter().any(|order| matches!(order.task, Task::PlaceBall { .. })));
}

#[test]
fn without_a_ball_in_a_stop_robots_are_sent_to_legal_places_and_do_not_just_stand() {
    for phase in [Phase::Stop, Phase::PreparePenalty(Side::Theirs), Phase::PrepareKickoff(Side::Ours)] {
        let mut view = view((0.0, 0.0), &OURS, &THEIRS);
        (view.phase, view.ball) = (phase, None);
        let orders = coach().decide(&view);
        assert!(orders.iter().all(|order| order.task != Task::Stand), "{phase:?}: {orders:?}");
    }
}
