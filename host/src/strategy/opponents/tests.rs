//! Tests: each opponent team gives every robot one rule-compliant order and plays in its own style.

use rules::{League, Phase, Side};

use super::*;
use crate::strategy::Tactics;
use crate::strategy::coach::Coach;
use crate::strategy::view::tests::view;

const OURS: [(f32, f32); 6] = [(-4.4, 0.0), (-3.0, 0.5), (-3.0, -0.5), (-0.5, 0.0), (0.5, 1.5), (0.5, -1.5)];
const THEIRS: [(f32, f32); 4] = [(4.4, 0.0), (-1.5, 1.4), (-1.0, -1.6), (2.0, 0.5)];

fn orders(team: Team, view: &View) -> Orders {
    let mut free = view.ours.iter().map(|robot| robot.id).collect();
    let mut orders = OpponentModel::of(team).unwrap().open_play(view, &mut free, None);
    assert!(free.is_empty() || view.ball.is_none(), "{team:?} leaves {free:?}");
    orders.sort_unstable_by_key(|order| order.robot);
    orders
}

#[test]
fn every_robot_has_one_order_and_only_the_keeper_goes_into_an_area_or_over_a_line() {
    for team in Team::OPPONENTS {
        for ball in [(0.3, 0.2), (-4.2, 0.0), (4.3, 0.1), (4.4, 2.9), (-2.9, -2.8), (-3.3, 0.0)] {
            for robots in 0..=OURS.len() {
                let view = view(ball, &OURS[..robots], &THEIRS);
                let orders = orders(team, &view);
                let ids: Vec<_> = orders.iter().map(|order| order.robot.number()).collect();
                assert_eq!(ids, (0..robots as u8).collect::<Vec<_>>(), "{team:?} {ball:?}");
                for order in orders.iter().filter(|order| order.role != Role::Keeper) {
                    if let Task::GoTo { at, .. } = order.task {
                        assert!(!view.in_our_area(at, 0.1) && !view.in_their_area(at, 0.2), "{order:?}");
                        assert_eq!(view.clamp(at, 0.0), at, "{order:?}");
                    }
                }
            }
        }
    }
}

#[test]
fn only_the_keeper_plays_a_ball_in_an_area_and_a_double_touch_is_avoided() {
    for team in Team::OPPONENTS {
        for ball in [(-4.2, 0.3), (4.2, 0.3)] {
            let orders = orders(team, &view(ball, &OURS, &THEIRS));
            assert!(orders.iter().skip(1).all(|order| matches!(order.task, Task::GoTo { .. })), "{orders:?}");
        }
        let view = view((-0.4, 0.0), &OURS, &THEIRS);
        let mut free = view.ours.iter().map(|robot| robot.id).collect();
        let double_touch_blocked = view.ours[3].id;
        let orders = OpponentModel::of(team).unwrap().open_play(&view, &mut free, Some(double_touch_blocked));
        let order = orders.iter().find(|order| order.robot == double_touch_blocked).unwrap();
        assert_eq!(order.role, Role::DoubleTouchBlocked, "{team:?}");
        assert!(matches!(order.task, Task::GoTo { .. }), "{order:?}");
    }
}

#[test]
fn chasers_shoot_near_the_goal_and_kick_ahead_far_from_it() {
    let near = orders(Team::Reactive, &view((2.0, 0.0), &[(-4.4, 0.0), (1.8, 0.0)], &[(4.4, 0.0)]));
    assert!(matches!(near[1].task, Task::Kick { at, kick } if at.x() > 4.4 && kick == support::SHOT));
    let far = orders(Team::Reactive, &view((-2.0, 1.0), &[(-4.4, 0.0), (-2.2, 1.0)], &[(4.4, 0.0)]));
    assert!(matches!(far[1].task, Task::Kick { at, .. } if (at.x() - 0.0).abs() < 0.01), "{far:?}");
}

#[test]
fn a_marker_stands_between_each_opponent_and_the_goal() {
    // Their robot has the ball: all robots except keeper, first and one defender mark.
    let view = view((2.0, 0.4), &OURS, &THEIRS);
    let orders = orders(Team::Marking, &view);
    for opponent in [1, 2] {
        let them = view.theirs[opponent];
        let marker = orders
            .iter()
            .find(|order| matches!(order.why, OrderReason::Marks { opponent } if opponent == them.id))
            .unwrap();
        let Task::GoTo { at, .. } = marker.task else { panic!("{marker:?}") };
        let (to_goal, goal) = (view.our_goal() - them.position, at - them.position);
        assert!(goal.norm() < 0.31 && to_goal.unit().unwrap().dot(goal) > 0.29, "{marker:?}");
    }
}

#[test]
fn the_wall_stands_across_the_line_from_ball_to_goal_and_moves_with_the_ball() {
    for ball in [(0.0, 1.0), (0.0, -1.0), (-1.0, 2.0)] {
        let view = view(ball, &OURS, &THEIRS);
        let wall: Vec<_> = orders(Team::Zone, &view)
            .iter()
            .filter(|order| order.role == Role::Wall)
            .filter_map(|order| if let Task::GoTo { at, .. } = order.task { Some(at) } else { None })
            .collect();
        // One plays the ball, one waits in front, and one may be the receiver of a pass.
        assert!(wall.len() >= 2, "{ball:?}: {wall:?}");
        let n = wall.len() as f32;
        let middle = Point::<Attack>::new(
            wall.iter().map(|p| p.x()).sum::<f32>() / n,
            wall.iter().map(|p| p.y()).sum::<f32>() / n,
        );
        let line = geometry::Segment::new(Point::new(ball.0, ball.1), view.our_goal());
        assert!(line.distance_to(middle) < 0.05, "{ball:?}: {wall:?}");
    }
}

#[test]
fn a_team_is_read_by_the_word_it_is_written_with() {
    for team in Team::ALL {
        assert_eq!(Team::from_label(team.label()), Some(team));
        assert_eq!(serde_json::to_string(&team).unwrap(), format!("\"{}\"", team.label()));
    }
    assert_eq!(Team::from_label("best"), None);
}

/// A free kick of theirs, 4 m before our goal.
fn against_free_kick(team: Team) -> Orders {
    let mut view = view((-0.5, 1.0), &OURS, &THEIRS);
    view.phase = Phase::FreeKick(Side::Theirs);
    Coach::new(team, Tactics::NONE, League::DivisionB).decide(&view)
}

#[test]
fn three_teams_defend_in_three_ways_against_a_free_kick() {
    let of = |team| {
        let orders = against_free_kick(team);
        assert_eq!(orders.len(), OURS.len());
        let wall = orders.iter().filter(|order| order.role == Role::Wall).count();
        let marks = orders.iter().filter(|order| matches!(order.role, Role::Marker(_))).count();
        (wall, marks)
    };
    // Three of theirs are outside their area, one 1.1 m from the ball.
    assert_eq!(of(Team::Reactive), (1, 2));
    assert_eq!(of(Team::Marking), (0, 3));
    assert_eq!(of(Team::Zone), (4, 0));
}

#[test]
fn no_robot_stands_nearer_to_their_free_kick_than_the_rules_permit() {
    for team in Team::OPPONENTS {
        for order in against_free_kick(team).iter().filter(|order| order.role != Role::Keeper) {
            let Task::GoTo { at, .. } = order.task else { panic!("{order:?}") };
            // 0.5 m from the ball to the nearest part of a robot.
            assert!(at.distance(Point::new(-0.5, 1.0)) > 0.59, "{team:?} {order:?}");
        }
    }
}
