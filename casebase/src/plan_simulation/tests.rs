//! Tests: the plan simulation follows docs/case-format.md §3.1 step by step. Small gameplays whose ball path
//! is worked out by hand.

extern crate std;
use std::vec::Vec;

use super::*;
use crate::{Primitive, TurnTarget};

/// A case in memory: the ball at (100, 50), robots with their lists.
struct Written {
    defending: GoalEnd,
    robots: Vec<(PointMm, Vec<Action>)>,
}

impl Script for Written {
    fn teammates(&self) -> usize {
        self.robots.len()
    }
    fn defending(&self) -> GoalEnd {
        self.defending
    }
    fn ball(&self) -> PointMm {
        PointMm::new(100, 50)
    }
    fn position(&self, robot: CaseRobot) -> PointMm {
        self.robots.get(robot.index()).map_or(self.ball(), |(at, _)| *at)
    }
    fn action(&self, robot: CaseRobot, index: usize) -> Option<Action> {
        self.robots.get(robot.index())?.1.get(index).copied()
    }
}

/// Kick 0: 1000 mm ahead; 1: 1000 mm to the left; 2: at the goal, 200 mm left of its centre.
struct League;

impl Kicks for League {
    fn kick(&self, id: KickId) -> Option<CaseKick> {
        let aim = match id.0 {
            0 => KickAim::Heading { degrees: 0, length_mm: 1000 },
            1 => KickAim::Heading { degrees: 90, length_mm: 1000 },
            2 => KickAim::Goal { offset_mm: 200 },
            _ => return None,
        };
        Some(CaseKick { aim, r_min: 80, r_max: 240, primitive: Primitive::Unspecified })
    }
    fn pass(&self) -> Pass {
        Pass { r_min: 100, r_max: 300 }
    }
    fn field(&self) -> FieldMm {
        FieldMm {
            length: 5400,
            width: 3600,
            margin: 0,
            goal_width: 800,
            penalty_depth: 650,
            penalty_width: 1300,
        }
    }
}

const AHEAD: Action = Action::Kick(KickId(0));
const LEFT: Action = Action::Kick(KickId(1));
const AT_GOAL: Action = Action::Kick(KickId(2));

fn tm(number: usize) -> CaseRobot {
    CaseRobot::new(number - 1).unwrap()
}

fn point(x: i32, y: i32) -> PointMm {
    PointMm::new(x, y)
}

/// A robot's position and actions.
type Part<'a> = ((i32, i32), &'a [Action]);

fn written(robots: &[Part<'_>]) -> Written {
    let robots = robots.iter().map(|((x, y), actions)| (point(*x, *y), actions.to_vec())).collect();
    Written { defending: GoalEnd::Negative, robots }
}

fn steps(script: &Written) -> Result<Vec<PlanStep>, PlanError> {
    let mut steps = Vec::new();
    plan_simulation(script, &League, |step| steps.push(step)).map(|()| steps)
}

/// From and to of every leg, relative to the ball, whole mm; `true` where the end is a point of the field.
fn legs(script: &Written) -> Vec<([i32; 2], [i32; 2], bool)> {
    let whole = |at: [f32; 2]| at.map(math::round_to_i32);
    let as_leg = |step| match step {
        PlanStep::Leg { from, to, .. } => Some((whole(from.at), whole(to.at), to.on_field)),
        _ => None,
    };
    steps(script).unwrap().into_iter().filter_map(as_leg).collect()
}

#[test]
fn a_pass_runs_to_the_receiver_and_the_shot_from_there_to_the_goal() {
    let case = written(&[
        ((0, 50), &[Action::GetBall, Action::PassBall(tm(2))]),
        ((1100, 550), &[Action::Wait, Action::ReceiveBall(tm(1)), AT_GOAL]),
    ]);
    assert_eq!(legs(&case), [([0, 0], [1000, 500], false), ([1000, 500], [2700, 200], true)]);
}

#[test]
fn the_goal_s_left_is_the_attacker_s_left() {
    let mut case = written(&[((0, 50), &[Action::GetBall, AT_GOAL])]);
    case.defending = GoalEnd::Positive;
    assert_eq!(legs(&case), [([0, 0], [-2700, -200], true)]);
    let mut case = written(&[((0, 50), &[Action::GetBall, LEFT])]);
    case.defending = GoalEnd::Positive;
    assert_eq!(legs(&case), [([0, 0], [0, -1000], false)]);
}

#[test]
fn the_receiver_is_met_where_its_walk_has_brought_it() {
    let case = written(&[
        (
            (0, 50),
            &[
                Action::GetBall,
                Action::PassBall(tm(2)),
                Action::GoToPoint(point(600, -450)),
                Action::ReceiveBall(tm(2)),
            ],
        ),
        (
            (0, 1000),
            &[
                Action::GoToPoint(point(1100, 50)),
                Action::Turn(TurnTarget::HeadingDeg(9)),
                Action::ReceiveBall(tm(1)),
                Action::PassBall(tm(1)),
            ],
        ),
    ]);
    assert_eq!(legs(&case), [([0, 0], [1000, 0], false), ([1000, 0], [500, -500], false)]);
}

#[test]
fn a_dribble_carries_the_ball_without_a_leg() {
    let case = written(&[((0, 50), &[Action::GetBall, Action::DribbleTo(point(400, 250)), AHEAD])]);
    assert_eq!(legs(&case), [([300, 200], [1300, 200], false)]);
    let carried = steps(&case).unwrap();
    assert!(matches!(carried[0], PlanStep::Leg { carried_by: Some((robot, 1)), .. } if robot == tm(1)));
}

#[test]
fn walking_without_a_dribble_leaves_the_ball_where_it_is() {
    let case = written(&[((0, 50), &[Action::GetBall, Action::GoToPoint(point(900, 900)), AHEAD])]);
    assert_eq!(legs(&case), [([0, 0], [1000, 0], false)]);
}

#[test]
fn after_a_kick_the_lowest_numbered_chaser_goes_on_where_the_ball_rests() {
    let chase: &[Action] = &[Action::Wait, Action::GetBall, LEFT];
    let case = written(&[((0, 50), &[Action::GetBall, AHEAD]), ((0, 900), chase), ((0, -900), chase)]);
    // tm2 takes the first kick's ball, tm3 that of tm2's kick.
    let expected =
        [([0, 0], [1000, 0], false), ([1000, 0], [1000, 1000], false), ([1000, 1000], [1000, 2000], false)];
    assert_eq!(legs(&case), expected);
    let steps = steps(&case).unwrap();
    let hands: Vec<_> = steps.iter().filter_map(|step| step.hand_over()).collect();
    let by_kick = |from, to| HandOver { from, to, by_pass: false };
    assert_eq!(hands, [by_kick((tm(1), 1), (tm(2), 1)), by_kick((tm(2), 2), (tm(3), 1))]);
}

#[test]
fn a_robot_may_chase_its_own_kick() {
    let case = written(&[((0, 50), &[Action::GetBall, LEFT, Action::GetBall, AHEAD])]);
    assert_eq!(legs(&case), [([0, 0], [0, 1000], false), ([0, 1000], [1000, 1000], false)]);
}

#[test]
fn a_leg_after_a_kick_at_the_goal_begins_at_a_point_of_the_field() {
    let case = written(&[((0, 50), &[Action::GetBall, AT_GOAL, Action::GetBall, LEFT])]);
    assert_eq!(legs(&case), [([0, 0], [2700, 200], true), ([2700, 200], [2700, 1200], true)]);
}

#[test]
fn a_robot_that_got_the_ball_stands_at_the_ball() {
    // tm1 gets the ball, passes, and receives it back where it got it.
    let case = written(&[
        ((0, 50), &[Action::GetBall, Action::PassBall(tm(2)), Action::ReceiveBall(tm(2))]),
        ((100, 550), &[Action::ReceiveBall(tm(1)), Action::PassBall(tm(1))]),
    ]);
    assert_eq!(legs(&case), [([0, 0], [0, 500], false), ([0, 500], [0, 0], false)]);
}

#[test]
fn a_plan_that_cannot_be_simulated_names_robot_and_action() {
    let get: &[Action] = &[Action::GetBall];
    let cases: &[(&[Part<'_>], PlanError)] = &[
        (&[((0, 0), &[Action::Wait])], PlanError::NoGetter),
        (&[((0, 0), get), ((0, 0), &[AHEAD])], PlanError::NotHolding(tm(2), 0)),
        (&[((0, 0), &[Action::GetBall, AHEAD, AHEAD])], PlanError::NotHolding(tm(1), 2)),
        (
            &[((0, 0), &[Action::GetBall, AHEAD, Action::DribbleTo(point(0, 0))])],
            PlanError::NotHolding(tm(1), 2),
        ),
        (
            &[((0, 0), &[Action::GetBall, Action::PassBall(tm(2))]), ((0, 0), &[Action::Wait])],
            PlanError::PassUnanswered(tm(1), 1),
        ),
        (
            &[
                ((0, 0), &[Action::GetBall, Action::PassBall(tm(2))]),
                ((0, 0), &[Action::Wait, AHEAD, Action::ReceiveBall(tm(1))]),
            ],
            PlanError::NotHolding(tm(2), 1),
        ),
        (
            &[((0, 0), get), ((0, 0), &[Action::Wait, Action::ReceiveBall(tm(1))])],
            PlanError::ReceiveUnanswered(tm(2), 1),
        ),
        (
            &[((0, 0), &[Action::GetBall, Action::ReceiveBall(tm(2))]), ((0, 0), &[])],
            PlanError::ReceiveUnanswered(tm(1), 1),
        ),
        (&[((0, 0), &[Action::GetBall, Action::Kick(KickId(9))])], PlanError::UnknownKick(tm(1), 1)),
        // A get_ball that is never reached holds no ball to kick.
        (
            &[((0, 0), get), ((0, 0), &[Action::Wait, Action::GetBall, AHEAD])],
            PlanError::NotHolding(tm(2), 2),
        ),
    ];
    for (robots, expected) in cases {
        assert_eq!(steps(&written(robots)).unwrap_err(), *expected);
    }
}

#[test]
fn a_get_ball_after_the_last_kick_is_never_reached() {
    let case = written(&[((0, 0), &[Action::GetBall]), ((0, 0), &[Action::Wait, Action::GetBall])]);
    assert_eq!(steps(&case).unwrap(), [PlanStep::NeverReached { robot: tm(2), action: 1 }]);
}

#[test]
fn headings_are_exact_at_quarters_and_equal_in_size_left_and_right() {
    assert_eq!(
        [0, 90, 180, -90, 270, 360].map(unit_of_degrees).map(|[x, y]| [x as i32, y as i32]),
        [[1, 0], [0, 1], [-1, 0], [0, -1], [0, -1], [1, 0]]
    );
    for degrees in -400..=400 {
        let ([x, y], [mx, my]) = (unit_of_degrees(degrees), unit_of_degrees(-degrees));
        assert_eq!((x, y), (mx, -my), "{degrees}");
        let truth = f64::from(degrees).to_radians();
        assert!(
            (f64::from(x) - truth.cos()).abs() < 3e-7 && (f64::from(y) - truth.sin()).abs() < 3e-7,
            "{degrees}"
        );
    }
}
