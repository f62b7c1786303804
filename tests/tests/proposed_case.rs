//! `proposed_case`: cases that the host proposes, in the simulator's physics: for a ball that rolls, and with
//! a robot that has done its part.

use casebase::{Case, CaseBase};
use geometry::{GoalEnd, Point, Vector};
use match_tests::test_field::TestField;
use protocol::host::{Directive, Hint, RuleRole};
use protocol::quantized::WirePose;
use protocol::team::{AbortReason, Closure, Progress};
use protocol::{CaseId, RobotId};
use rules::League;

/// The cases of division B for a team that defends the goal at −x, whose getter passes.
fn cases<'b>(base: &'b CaseBase<'static>) -> impl Iterator<Item = Case<'b>> {
    let all = (0..base.len() as u16).filter_map(|id| base.case(CaseId(id)));
    all.filter(|case| {
        let first = case.legs(case.ball()).next();
        let is_pass = first.is_some_and(|leg| matches!(leg.kind, casebase::LegKind::Pass(_)));
        case.defending() == GoalEnd::Negative && is_pass
    })
}

/// Robots 1, 2 and so on at their places in the case, with its proposal, and the ball at rest in its place.
fn proposed<'b>(base: CaseBase<'b>, case: &Case<'_>) -> TestField<'b> {
    let numbers = 1..=case.robots().count() as u8;
    let places = case.robots().zip(numbers.clone()).map(|(part, number)| {
        let at: Point<geometry::Field> = case.adapted(part, case.ball()).into();
        (number, at.x(), at.y(), 0.0)
    });
    let places: Vec<_> = places.collect();
    let ball: Point<geometry::Field> = case.ball().into();
    let mut field = TestField::new(League::DivisionB, base, (ball.x(), ball.y()), &places);
    for (number, ..) in &places {
        field.give_order(*number, RuleRole::Player, Directive::Stand);
    }
    field.during(0.6, |_| {});
    let robots = numbers.filter_map(RobotId::new).collect();
    let hint = Hint { case: case.id(), robots, pass_point: None };
    for (number, ..) in &places {
        field.give_order(*number, RuleRole::Player, Directive::Gameplay { hint: Some(hint.clone()) });
    }
    field
}

fn left_the_scope(field: &TestField<'_>) -> bool {
    let left = |end: &Closure| matches!(end, Closure::Aborted { reason: AbortReason::BallOutOfScope, .. });
    field.ends.iter().any(|(_, end)| left(end))
}

#[test]
fn a_ball_that_rolls_through_the_scope_is_in_it_until_it_has_passed() {
    let base = case_library::division_b();
    let (mut through, mut past) = (0, 0);
    for case in cases(&base).take(12) {
        let ball: Point<geometry::Field> = case.ball().into();
        // It would stop far beyond the scope: 2 m/s roll 5 m.
        for (begins, ends) in [(-0.5, false), (1.2, true)] {
            let mut field = proposed(base, &case);
            let along = if ball.y() > 0.0 { -1.0 } else { 1.0 };
            field.roll((ball.x(), ball.y() + along * begins), (0.0, along * 2.0));
            let plays = |field: &TestField<'_>| field.brain(1).cycle().play().is_some();
            if field.until(0.3, plays).is_none() {
                continue;
            }
            // A doubt lasts a fifth of a second before it ends a case.
            field.during(0.21, |_| {});
            let rest = field.ball() + Vector::new(0.0, along * 3.0);
            assert!(!case.ball_in_scope(rest.into()), "case {}", case.id());
            *(if ends { &mut past } else { &mut through }) += 1;
            assert_eq!(left_the_scope(&field), ends, "case {} from {begins} m", case.id());
        }
    }
    assert!(through > 5 && past > 5, "{through} through, {past} past it");
}

#[test]
fn a_robot_that_has_passed_may_be_ordered_elsewhere_and_the_case_goes_on() {
    let base = case_library::division_b();
    let (mut went, mut finished) = (0, 0);
    for case in cases(&base).take(12) {
        let mut field = proposed(base, &case);
        let passer = case.getter().index() as u8 + 1;
        let done = |field: &TestField<'_>| {
            field.brain(passer).cycle().progress == Progress::WaitEnd { finished: true }
        };
        if field.until(6.0, done).is_none() {
            continue;
        }
        went += 1;
        let before = field.ends.len();
        let pose = WirePose::from(match_tests::test_field::pose(-3.0, 2.0, 0.0));
        field.give_order(passer, RuleRole::Player, Directive::GoTo { pose });
        field.during(0.3, |_| {});
        let by_it = |end: &Closure| matches!(end, Closure::Aborted { by, .. } if by.number() == passer);
        assert!(
            !field.ends[before..].iter().any(|(_, end)| by_it(end)),
            "case {}: {:?}",
            case.id(),
            field.ends
        );
        let ended = field.until(6.0, |field| field.ends.len() > before).is_some();
        finished += u32::from(ended && field.ends[before].1 == Closure::Finished);
    }
    assert!(went > 3 && finished > 0, "{went} passed, {finished} finished");
}
