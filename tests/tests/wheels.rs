//! `wheels`: tests of wheeled robots in the simulator's physics. Every skill from order to outcome, and the
//! rules.

use brain::governor::Ruling;
use casebase::CaseBase;
use geometry::{Angle, Field, GoalEnd, Point};
use match_tests::test_field::{TestField, kicks, pose};
use protocol::RobotId;
use protocol::host::{Condition, Directive, Hint, KickOrder, RuleRole};
use protocol::quantized::{WirePoint, WirePose};
use protocol::team::{Closure, TeamMessage};
use rules::{League, Phase, Side};

fn base() -> CaseBase<'static> {
    case_library::division_b()
}

fn field(ball: (f32, f32), ours: &[(u8, f32, f32, f32)]) -> TestField<'static> {
    let mut field = TestField::new(League::DivisionB, base(), ball, ours);
    for &(number, ..) in ours {
        field.give_order(number, RuleRole::Player, Directive::Stand);
    }
    // The link must have been good for half a second.
    field.during(0.6, |_| {});
    field
}

fn at(x: f32, y: f32) -> WirePoint {
    Point::<Field>::new(x, y).into()
}

fn go_to(x: f32, y: f32, degrees: f32) -> Directive {
    Directive::GoTo { pose: WirePose::from(pose(x, y, degrees)) }
}

#[test]
fn three_metres_take_less_than_2_2_s_and_end_within_1_cm() {
    let mut field = field((0.0, 2.5), &[(1, -1.0, -1.0, 0.0)]);
    field.give_order(1, RuleRole::Player, go_to(1.0, 1.236, 135.0));
    let goal = Point::new(1.0, 1.236);
    let there = |field: &TestField<'_>| {
        let robot = field.ours(1);
        robot.pose.position.distance(goal) < 0.01
            && robot.velocity.norm() < 0.05
            && (robot.pose.heading - Angle::degrees(135.0)).abs() < 0.05
    };
    // From standstill to standstill with 3 and 3.5 m/s²: √(2·3·(1/3 + 1/3.5)) = 1.93 s.
    let took = field.until(4.0, there).expect("arrives");
    assert!(took < 2.2, "{took}");
    field.during(1.0, |field| assert!(there(field), "stays"));
}

#[test]
fn a_step_with_many_messages_of_teammates_plans_as_one_without_them() {
    let robot = RobotId::new(1).unwrap();
    // Whether its order of that step changes when it is ordered back.
    let turns = |teammates: u8| {
        let [on, back] = [go_to(1.0, 1.236, 135.0), go_to(-1.0, -1.0, 0.0)].map(|second| {
            let mut field = field((0.0, 2.5), &[(1, -1.0, -1.0, 0.0)]);
            field.give_order(1, RuleRole::Player, go_to(1.0, 1.236, 135.0));
            field.during(0.3, |_| {});
            field.give_order(1, RuleRole::Player, second);
            field.chatter = teammates;
            field.step();
            field.orders[&robot]
        });
        on != back
    };
    assert!(turns(0) && turns(9), "packets that it has no time for are left unopened");
}

#[test]
fn on_a_saturated_radio_channel_a_robot_arrives_at_most_0_125_s_later() {
    let goal = Point::new(1.0, 1.236);
    let [quiet, full] = [0, 9].map(|chatter| {
        let mut field = field((0.0, 2.5), &[(1, -1.0, -1.0, 0.0)]);
        field.chatter = chatter;
        field.give_order(1, RuleRole::Player, go_to(1.0, 1.236, 135.0));
        field.until(4.0, |field| field.ours(1).pose.position.distance(goal) < 0.01).expect("arrives")
    });
    // Packets that a step has no time for are left unopened.
    assert!(full < quiet + 0.125, "{full} s instead of {quiet}");
}

#[test]
fn robots_send_20_beacons_a_second_and_at_most_two_of_six_per_step() {
    let places: Vec<_> = (0..6).map(|n| (n, 0.5 * f32::from(n), -1.0, 0.0)).collect();
    let mut field = field((0.0, 2.5), &places);
    let mut beacons = [0; 6];
    field.during(1.0, |field| {
        let speaks = |(_, message): &&_| matches!(message, TeamMessage::Beacon(_));
        let speakers: Vec<_> =
            field.sent_messages().iter().filter(speaks).map(|(id, _)| id.index()).collect();
        assert!(speakers.len() <= 2, "{speakers:?}");
        for id in speakers {
            beacons[id] += 1;
        }
    });
    assert_eq!(beacons, [20; 6]);
}

#[test]
fn a_robot_in_the_way_is_passed_without_touching_it() {
    let mut field = field((0.0, 2.5), &[(1, -1.5, 0.0, 0.0)]);
    field.opponent(1, 0.0, 0.02, 0.0);
    field.opponent(2, 0.3, -0.3, 0.0);
    field.give_order(1, RuleRole::Player, go_to(1.5, 0.0, 0.0));
    let took = field.until(4.0, |field| field.ours(1).pose.position.distance(Point::new(1.5, 0.0)) < 0.02);
    assert!(took.is_some_and(|took| took < 3.2), "{took:?}");
    assert!(field.events.is_empty(), "{:?}", field.events);
}

#[test]
fn get_ball_takes_a_resting_ball_facing_the_requested_way() {
    for (x, y) in [(0.8, 0.0), (-0.8, 0.3), (0.0, 1.0)] {
        let mut field = field((0.0, 0.0), &[(1, x, y, 30.0)]);
        field.give_order(1, RuleRole::Player, Directive::GetBall { face: Some(at(4.5, 0.0)) });
        let took = field.until(5.0, |field| {
            field.ours(1).ball_contact && (field.ours(1).pose.turn_to(Point::new(4.5, 0.0))).abs() < 0.05
        });
        assert!(took.is_some_and(|took| took < 3.5), "from {x}, {y}: {took:?}");
        field.during(1.0, |_| {});
        assert!(field.ours(1).ball_contact, "kept, from {x}, {y}");
    }
}

#[test]
fn get_ball_intercepts_a_rolling_ball() {
    for (from, velocity) in [((2.0, 0.4), (-2.0, 0.0)), ((-2.0, 1.5), (1.2, -0.8)), ((0.5, -1.0), (0.4, 0.9))]
    {
        let mut field = field((0.0, 2.9), &[(1, 0.0, 0.0, 0.0)]);
        field.roll(from, velocity);
        field.give_order(1, RuleRole::Player, Directive::GetBall { face: None });
        let took = field.until(6.0, |field| field.brain(1).belief().holds_ball);
        assert!(took.is_some(), "{from:?} {velocity:?}: ball at {:?}", field.ball());
        field.during(0.5, |_| {});
        assert!(field.ours(1).ball_contact, "kept: {from:?} {velocity:?}");
    }
}

#[test]
fn a_kick_goes_where_it_was_aimed_with_the_speed_asked() {
    for (target, speed) in [((4.5, 0.3), 600), ((0.0, -2.0), 300), ((-3.0, 2.0), 450)] {
        let mut field = field((0.5, 0.2), &[(1, -0.5, -0.4, 0.0)]);
        field.give_order(
            1,
            RuleRole::Player,
            Directive::Kick { at: at(target.0, target.1), kick: KickOrder::Flat(speed) },
        );
        let took = field.until(6.0, |field| !field.kicks().is_empty());
        assert!(took.is_some_and(|took| took < 5.0), "{target:?}: {took:?}");
        let (_, left, velocity) = field.kicks()[0];
        assert!((left - f32::from(speed) * 0.01).abs() < 0.25, "{left}");
        let wanted = field.ball().direction_to(Point::new(target.0, target.1));
        assert!((velocity.angle() - wanted).abs() < 0.08, "{:?} {wanted:?}", velocity.angle());
    }
}

#[test]
fn a_chip_flies() {
    let mut field = field((0.5, 0.2), &[(1, -0.5, -0.4, 0.0)]);
    field.give_order(1, RuleRole::Player, Directive::Kick { at: at(3.5, 0.3), kick: KickOrder::Chip(400) });
    assert!(field.until(6.0, |field| field.world.ball.height > 0.2).is_some());
}

#[test]
fn a_free_kick_takes_one_touch_and_the_kicker_then_leaves_the_ball() {
    let mut field = field((-1.0, 1.0), &[(1, -1.5, 0.6, 0.0)]);
    field.phase = Phase::FreeKick(Side::Ours);
    field.give_order(1, RuleRole::Kicker, Directive::Kick { at: at(1.0, 1.0), kick: KickOrder::Flat(150) });
    assert!(field.until(6.0, |field| !field.kicks().is_empty()).is_some());
    let touches = |field: &TestField<'_>| {
        field
            .events
            .iter()
            .filter(|(_, e)| matches!(e, hil_sim::small_size::PhysicsEvent::Touched { .. }))
            .count()
    };
    let before = touches(&field);
    field.phase = Phase::Run;
    field.during(4.0, |_| {});
    assert_eq!(touches(&field), before, "{:?}", field.events);
    assert!(before <= 1);
}

#[test]
fn a_pass_waits_behind_the_ball_until_it_is_ready() {
    let mut field = field((0.0, 0.0), &[(1, -0.6, 0.2, 0.0), (2, 2.0, 1.0, 0.0)]);
    field.phase = Phase::FreeKick(Side::Ours);
    let receiver = RobotId::new(2).unwrap();
    let order = |ready| Directive::Pass { at: at(2.0, 1.0), receiver, kick: KickOrder::Flat(350), ready };
    field.give_order(1, RuleRole::Kicker, order(false));
    field.during(3.0, |field| assert!(!field.ours(1).touching));
    field.give_order(1, RuleRole::Kicker, order(true));
    let took = field.until(2.0, |field| !field.kicks().is_empty()).expect("passes");
    assert!(took < 1.0, "{took}");
}

#[test]
fn a_pass_is_received() {
    for speed in [2.0, 3.5, 4.5] {
        let mut field = field((0.0, 0.0), &[(2, 2.3, 0.3, 0.0)]);
        field.give_order(2, RuleRole::Player, Directive::Receive { at: at(2.0, 0.0), then: None });
        field.during(1.0, |_| {});
        field.roll((-1.0, 0.1), (speed, 0.0));
        let took = field.until(4.0, |field| field.brain(2).belief().holds_ball);
        assert!(took.is_some(), "{speed} m/s");
        field.during(0.6, |_| {});
        assert!(
            field.ours(2).ball_contact,
            "{speed} m/s: ball at {:?}, robot at {:?}",
            field.ball(),
            field.ours(2).pose
        );
    }
}

#[test]
fn a_pass_is_shot_at_the_goal_at_first_touch() {
    let mut field = field((0.0, 0.0), &[(2, 2.5, 0.0, 0.0)]);
    field.give_order(2, RuleRole::Player, Directive::Receive { at: at(2.5, 0.0), then: Some(at(4.5, 0.0)) });
    field.during(1.0, |_| {});
    // From the front left: the goal lies 45° to the right of the ball's origin.
    field.roll((4.0, 1.5), (-2.1, -2.1));
    let took = field.until(3.0, |field| field.ball().x() > 4.5 && field.ball().y().abs() < 0.5);
    assert!(took.is_some(), "ball at {:?}, {:?}", field.ball(), field.kicks());
}

#[test]
fn the_ball_is_dribbled_for_less_than_a_metre_at_a_time() {
    let mut field = field((0.0, 0.0), &[(1, -0.4, 0.0, 0.0)]);
    field.give_order(1, RuleRole::Player, Directive::Dribble { pose: WirePose::from(pose(2.5, 0.0, 0.0)) });
    let mut longest = 0.0_f32;
    field.during(10.0, |field| {
        if let Some(from) = field.ours(1).dribbling_from {
            longest = longest.max(from.distance(field.ball()));
        }
    });
    assert!(longest < 0.95, "{longest}");
    assert!(field.ball().x() > 2.0, "and gets on: {:?}", field.ball());
}

#[test]
fn a_keeper_on_its_stretch_stops_shots() {
    let mut stopped = 0;
    let shots = [(1.0, -0.35, 4.0), (0.5, 0.3, 5.0), (-0.8, 0.0, 5.5), (1.5, 0.25, 4.5), (-1.2, -0.3, 4.0)];
    for (y, aim, speed) in shots {
        let mut field = field((-2.0, y), &[(0, -4.3, 0.0, 0.0)]);
        field.give_order(0, RuleRole::Keeper, Directive::Block { from: at(-4.35, -0.5), to: at(-4.35, 0.5) });
        field.during(1.5, |_| {});
        let (from, to) = (Point::<Field>::new(-1.5, y), Point::new(-4.5, aim));
        let v = (to - from).unit().unwrap() * speed;
        field.roll((from.x(), from.y()), (v.x(), v.y()));
        let goal = field.until(3.0, |field| field.ball().x() < -4.53);
        stopped += usize::from(goal.is_none());
    }
    assert!(stopped >= 4, "{stopped} of {}", shots.len());
}

#[test]
fn the_ball_is_placed_from_all_over_the_surface_and_then_left_alone() {
    let spots = [(0.0, 0.0), (2.0, 3.25), (4.75, 3.25), (-4.6, 0.3), (-4.75, -1.0)];
    for spot in spots {
        let target = Point::new(1.0, -1.5);
        let mut field = field(spot, &[(1, 0.5, 0.5, 0.0)]);
        field.phase = Phase::BallPlacement(Side::Ours);
        field.placement = Some(target);
        field.give_order(1, RuleRole::Kicker, Directive::PlaceBall { at: target.into() });
        let done = field.until(28.0, |field| {
            field.ball().distance(target) < 0.15
                && field.world.ball.velocity.norm() < 0.01
                && field.ours(1).pose.position.distance(field.ball()) > 0.6
        });
        assert!(done.is_some(), "{spot:?}: ball at {:?}, robot at {:?}", field.ball(), field.ours(1).pose);
        field.during(2.0, |_| {});
        assert!(field.ball().distance(target) < 0.15, "{spot:?}");
    }
}

#[test]
fn on_halt_a_robot_at_full_speed_stops_within_a_second() {
    let mut field = field((0.0, 2.5), &[(1, -3.0, -1.0, 0.0)]);
    field.give_order(1, RuleRole::Player, go_to(3.0, -1.0, 0.0));
    field.until(3.0, |field| field.ours(1).velocity.norm() > 2.8).expect("gets fast");
    field.phase = Phase::Halt;
    let took = field.until(2.0, |field| field.ours(1).velocity.norm() < 0.02).expect("stands");
    assert!(took < 1.0, "{took}");
    field.during(2.0, |field| {
        assert!(field.ours(1).velocity.norm() < 0.05);
        assert!(field.orders.values().all(|order| !kicks(order)));
        assert!(matches!(field.brain(1).ruling(), Ruling::Braking(_)));
    });
}

#[test]
fn in_stop_robots_keep_below_1_5_m_per_s_and_half_a_metre_off_the_ball() {
    let mut field = field((0.0, 0.0), &[(1, -2.0, 0.0, 0.0), (2, -0.3, 0.2, 0.0)]);
    field.phase = Phase::Stop;
    field.give_order(1, RuleRole::Player, go_to(2.0, 0.0, 0.0));
    field.give_order(2, RuleRole::Player, go_to(-0.2, 0.2, 0.0));
    field.during(1.5, |_| {});
    let mut fastest = 0.0_f32;
    field.during(3.0, |field| {
        fastest = fastest.max(field.ours(1).velocity.norm());
        for robot in [field.ours(1), field.ours(2)] {
            let gap = robot.pose.position.distance(field.ball()) - 0.09;
            assert!(gap > 0.5, "{gap}");
        }
    });
    assert!(fastest < 1.4, "{fastest}");
    assert!(field.ours(1).pose.position.distance(Point::new(2.0, 0.0)) < 0.02, "and gets there around it");
}

#[test]
fn a_silent_host_stops_a_robot_until_half_a_second_after_its_return() {
    let mut field = field((0.0, 2.5), &[(1, -3.0, -1.0, 0.0)]);
    field.give_order(1, RuleRole::Player, go_to(3.0, -1.0, 0.0));
    field.until(3.0, |field| field.ours(1).velocity.norm() > 2.8).expect("gets fast");
    field.silent = true;
    let took = field.until(2.0, |field| field.ours(1).velocity.norm() < 0.02).expect("stands");
    assert!(took < 1.0, "{took}");
    field.silent = false;
    field.during(0.45, |field| assert!(field.ours(1).velocity.norm() < 0.05));
    assert!(field.until(1.0, |field| field.ours(1).velocity.norm() > 0.5).is_some());
}

#[test]
fn only_the_keeper_enters_its_own_defence_area() {
    let mut field = field((0.0, 2.5), &[(0, -3.0, 1.5, 0.0), (1, -3.0, -1.5, 0.0)]);
    field.give_order(0, RuleRole::Keeper, go_to(-4.2, 0.2, 0.0));
    field.give_order(1, RuleRole::Player, go_to(-4.2, -0.3, 0.0));
    field.during(4.0, |field| {
        let p = field.ours(1).pose.position;
        let area = League::DivisionB.field().defence_area(GoalEnd::Negative);
        assert!(area.iter().all(|shape| shape.distance_to(p) > 0.09), "{p:?}");
    });
    assert!(field.ours(0).pose.position.distance(Point::new(-4.2, 0.2)) < 0.02);
}

fn gameplay(field: &mut TestField<'_>, robots: &[u8]) {
    for &robot in robots {
        field.give_order(robot, RuleRole::Player, Directive::Gameplay { hint: None });
    }
}

#[test]
fn three_wheeled_robots_play_cases_and_score_without_opponents() {
    let (mut scored, mut starts) = (0, 0);
    let mut ends = Vec::new();
    for ball in [
        (-0.2, 0.1),
        (0.8, 1.0),
        (2.2, -0.2),
        (-1.5, 0.5),
        (2.6, 1.8),
        (0.0, -1.5),
        (1.2, -2.0),
        (1.5, 0.4),
        (-0.8, 1.7),
        (2.8, -1.0),
        (0.4, 2.2),
        (-1.2, -1.2),
        (3.0, 0.5),
        (1.9, -1.6),
        (-0.5, -0.6),
    ] {
        let (x, y) = ball;
        let mut field =
            field(ball, &[(1, x - 0.6, y, 0.0), (2, x + 0.5, y + 1.0, 0.0), (3, x, y - 1.3, 0.0)]);
        gameplay(&mut field, &[1, 2, 3]);
        let goal = field.until(15.0, |field| field.ball().x() > 4.5 && field.ball().y().abs() < 0.5);
        starts += 1;
        scored += usize::from(goal.is_some());
        ends.extend(field.ends.iter().map(|(_, end)| *end));
    }
    let finished = ends.iter().filter(|end| **end == Closure::Finished).count();
    let broken = ends.iter().filter(|end| matches!(end, Closure::Aborted { .. })).count();
    assert!(scored * 5 >= starts * 4, "{scored} of {starts}");
    assert!(finished > broken, "{finished} finished, {broken} aborted: {ends:?}");
}

#[test]
fn a_robot_ordered_elsewhere_leaves_its_gameplay_and_the_others_retrieve() {
    let mut field = field((-0.2, 0.1), &[(1, -0.8, 0.1, 0.0), (2, 0.3, 1.1, 0.0), (3, -0.2, -1.2, 0.0)]);
    gameplay(&mut field, &[1, 2, 3]);
    let id = |n| RobotId::new(n).unwrap();
    let plays = |field: &TestField<'_>, n| {
        field.brain(1).cycle().play().is_some_and(|play| play.part_of(id(n)).is_some())
    };
    field.until(3.0, |field| plays(field, 2)).expect("a gameplay with robot 2");
    field.give_order(2, RuleRole::Player, go_to(-2.0, 2.0, 0.0));
    let took = field.until(1.0, |field| !plays(field, 2)).expect("leaves");
    assert!(took <= 0.1, "{took}");
    field.during(4.0, |field| assert!(!plays(field, 2)));
}

#[test]
fn the_hosts_proposal_is_played_while_it_is_fresh_and_only_if_it_can_be() {
    let base = base();
    let robots = |ids: &[u8]| ids.iter().map(|n| RobotId::new(*n).unwrap()).collect();
    let problem = (-0.2, 0.1);
    let places = [(1, -0.8, 0.1, 0.0), (2, 0.3, 1.1, 0.0), (3, -0.2, -1.2, 0.0)];
    // Any case towards +x for two robots, with the correspondence that retrieval would not choose.
    let case = (0..base.len() as u16)
        .map(protocol::CaseId)
        .find(|id| {
            base.case(*id).is_some_and(|case| {
                case.defending() == geometry::GoalEnd::Negative && case.robots().count() == 2
            })
        })
        .unwrap();
    let mut field = field(problem, &places);
    let hint = |ids: &[u8]| Some(Hint { case, robots: robots(ids), pass_point: None });
    for robot in [1, 2, 3] {
        field.give_order(robot, RuleRole::Player, Directive::Gameplay { hint: hint(&[3, 1]) });
    }
    let proposed = |field: &TestField<'_>, ids: &[u8]| {
        field.brain(1).cycle().play().is_some_and(|play| play.case == case && play.robots == robots(ids))
    };
    assert!(field.until(2.0, |field| proposed(field, &[3, 1])).is_some());
    // Robot 7 is absent: the robots play the case that they retrieve themselves.
    let mut alone = self::field(problem, &places);
    for robot in [1, 2, 3] {
        alone.give_order(robot, RuleRole::Player, Directive::Gameplay { hint: hint(&[7, 1]) });
    }
    alone.during(2.0, |field| assert!(!proposed(field, &[7, 1])));
    assert!(
        alone.ends.iter().any(|(_, end)| *end != Closure::NoCase) || alone.brain(1).cycle().play().is_some()
    );
}

#[test]
fn telemetry_comes_ten_times_a_second_and_reports_a_lost_link() {
    let mut field = field((0.0, 2.5), &[(1, -1.0, 0.0, 0.0)]);
    let one = RobotId::new(1).unwrap();
    // The kicker was discharged until the link was good, and charging takes half a second.
    field.during(0.6, |_| {});
    field.during(1.0, |field| {
        let (at, telemetry) = field.telemetry[&one];
        assert!(field.now().since(at) <= protocol::Duration::millis(100));
        assert!(telemetry.condition.has(Condition::KICKER_READY) && telemetry.battery > 1400);
        assert!(!telemetry.condition.has(Condition::LINK_LOST) && telemetry.silence < 300);
    });
    field.silent = true;
    let lost = |field: &TestField<'_>| field.telemetry[&one].1.condition.has(Condition::LINK_LOST);
    let took = field.until(1.0, lost).expect("a report of the lost link");
    assert!((0.095..0.15).contains(&took), "{took}");
}

#[test]
fn without_a_host_a_robot_does_nothing() {
    let mut field = TestField::new(League::DivisionB, base(), (0.3, 0.0), &[(1, 0.0, 0.0, 0.0)]);
    field.silent = true;
    field.during(2.0, |field| {
        assert!(field.ours(1).velocity.norm() < 1e-3);
        assert!(field.orders.values().all(|order| !kicks(order)));
    });
}
