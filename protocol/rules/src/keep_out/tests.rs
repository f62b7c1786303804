//! Tests: the shapes are those of the rules. Places worked out by hand on the fields of 2013 and 2026.

use super::*;
use crate::League;

const SIDES: [Side; 2] = [Side::Ours, Side::Theirs];
const ROLES: [RuleRole; 3] = [RuleRole::Player, RuleRole::Keeper, RuleRole::Kicker];

fn phases() -> impl Iterator<Item = Phase<Side>> {
    let with = SIDES.into_iter().flat_map(|side| {
        [
            Phase::Timeout(side),
            Phase::BallPlacement(side),
            Phase::PrepareKickoff(side),
            Phase::Kickoff(side),
            Phase::PreparePenalty(side),
            Phase::Penalty(side),
            Phase::FreeKick(side),
        ]
    });
    [Phase::Halt, Phase::Stop, Phase::Run].into_iter().chain(with)
}

fn why(field: &FieldSpec, phase: Phase<Side>, rule_role: RuleRole, at: (f32, f32)) -> Option<KeepOutReason> {
    why_with_ball(field, phase, rule_role, (0.0, 0.0), at)
}

fn why_with_ball(
    field: &FieldSpec,
    phase: Phase<Side>,
    rule_role: RuleRole,
    ball: (f32, f32),
    at: (f32, f32),
) -> Option<KeepOutReason> {
    let ball = Some(Point::new(ball.0, ball.1));
    let placement = Some(Point::new(2.0, 0.0));
    let s =
        Situation { field, own: GoalEnd::Negative, phase, rule_role, ball, placement, ball_in_play: false };
    keep_out(&s).offence(Point::new(at.0, at.1), ROBOT_RADIUS)
}

#[test]
fn on_stop_a_robots_side_is_half_a_metre_from_the_ball() {
    let field = League::DivisionB.field();
    let at = |x| why(&field, Phase::Stop, RuleRole::Kicker, (x, 0.0));
    assert_eq!((at(0.58), at(0.60)), (Some(KeepOutReason::BallDistance), None));
}

#[test]
fn attackers_keep_20_cm_off_the_area_on_stop_and_out_of_it_in_play() {
    let field = League::DivisionB.field();
    // The area starts at x = 3.495, its line's outer edge; with the body's 0.09: 3.205 and 3.405.
    let at = |phase, x| why(&field, phase, RuleRole::Player, (x, 0.0));
    for phase in [Phase::Stop, Phase::FreeKick(Side::Ours), Phase::FreeKick(Side::Theirs)] {
        assert_eq!(
            (at(phase, 3.22), at(phase, 3.20)),
            (Some(KeepOutReason::OpponentArea), None),
            "{phase:?}"
        );
        assert!(KeepOutReason::OpponentArea.offends(phase));
    }
    assert_eq!((at(Phase::Run, 3.42), at(Phase::Run, 3.40)), (Some(KeepOutReason::OpponentArea), None));
    assert!(!KeepOutReason::OpponentArea.offends(Phase::Run));
}

#[test]
fn only_the_keeper_is_in_its_own_area() {
    let field = League::DivisionB.field();
    for phase in [Phase::Stop, Phase::Run, Phase::FreeKick(Side::Ours), Phase::Kickoff(Side::Theirs)] {
        assert_eq!(why(&field, phase, RuleRole::Player, (-3.58, 0.0)), Some(KeepOutReason::OwnArea));
        assert_eq!(why(&field, phase, RuleRole::Kicker, (-3.58, 0.0)), Some(KeepOutReason::OwnArea));
        assert_eq!(why(&field, phase, RuleRole::Player, (-3.40, 0.0)), None);
        assert_eq!(why(&field, phase, RuleRole::Keeper, (-4.3, 0.0)), None);
    }
    assert_eq!(why(&field, Phase::BallPlacement(Side::Ours), RuleRole::Player, (-4.0, 0.0)), None);
}

#[test]
fn the_round_area_of_2013_lets_robots_cut_its_corner() {
    let field = League::Ssl2013.field();
    // 0.095 m beyond the curve at 45°: 0.895 / √2 = 0.633 from its centre at (−3, 0.175).
    let at = |d: f32| why(&field, Phase::Run, RuleRole::Player, (-3.0 + d, 0.175 + d));
    assert_eq!((at(0.62), at(0.64)), (Some(KeepOutReason::OwnArea), None));
}

#[test]
fn at_a_kick_off_only_the_kicker_is_in_the_circle() {
    let field = League::DivisionB.field();
    for phase in [Phase::PrepareKickoff(Side::Ours), Phase::Kickoff(Side::Ours)] {
        let player = |x, y| why(&field, phase, RuleRole::Player, (x, y));
        assert_eq!(player(-0.08, 1.0), Some(KeepOutReason::OtherHalf));
        assert_eq!(player(-0.10, 1.0), None);
        assert_eq!(player(-0.58, 0.0), Some(KeepOutReason::CentreCircle));
        assert_eq!(player(-0.60, 0.0), None);
        let kicker = |x, y| why(&field, phase, RuleRole::Kicker, (x, y));
        assert_eq!(kicker(-0.12, 0.0), None);
        assert_eq!(kicker(0.12, 0.0), None, "the whole circle is the kicker's");
        // Around the ball 0.17 m off, and 0.04 m beside that, as robots do.
        assert_eq!(kicker(0.08, 0.22), None, "a body passes beside the ball");
        assert_eq!(kicker(0.5, 0.0), Some(KeepOutReason::OtherHalf));
        assert_eq!(kicker(0.0, 0.6), Some(KeepOutReason::OtherHalf));
    }
    let touch = |phase| why(&field, phase, RuleRole::Kicker, (-0.1, 0.0));
    assert_eq!(touch(Phase::PrepareKickoff(Side::Ours)), Some(KeepOutReason::BallTouch));
    assert_eq!(touch(Phase::Kickoff(Side::Ours)), None);
    let theirs = |rule_role, x| why(&field, Phase::Kickoff(Side::Theirs), rule_role, (x, 0.0));
    assert_eq!(
        (theirs(RuleRole::Kicker, -0.3), theirs(RuleRole::Player, -0.6)),
        (Some(KeepOutReason::CentreCircle), None)
    );
}

#[test]
fn at_a_penalty_all_others_are_a_metre_behind_the_ball() {
    let field = League::DivisionB.field();
    for phase in [Phase::PreparePenalty(Side::Ours), Phase::Penalty(Side::Ours)] {
        // The ball is at x = −1.6, 0.1 m behind its mark, and we attack +x: the body ends at x = −2.6.
        let player = |x| why_with_ball(&field, phase, RuleRole::Player, (-1.6, 0.0), (x, 2.0));
        assert_eq!((player(-2.68), player(-2.70)), (Some(KeepOutReason::BehindBall), None));
        // A ball that was carried elsewhere: the mark, at x = −1.5, is used.
        let carried = |x| why(&field, phase, RuleRole::Player, (x, 2.0));
        assert_eq!((carried(-2.58), carried(-2.60)), (Some(KeepOutReason::BehindBall), None));
        assert_eq!(why(&field, phase, RuleRole::Keeper, (-4.4, 0.0)), None);
        assert_eq!(why(&field, phase, RuleRole::Kicker, (-0.3, 0.0)), None);
    }
    for phase in [Phase::PreparePenalty(Side::Theirs), Phase::Penalty(Side::Theirs)] {
        // They attack −x: behind the ball is x > 2.6.
        let player = |x| why_with_ball(&field, phase, RuleRole::Player, (1.6, 0.0), (x, 2.0));
        assert_eq!((player(2.68), player(2.70)), (Some(KeepOutReason::BehindBall), None));
        let keeper = |x, y| why(&field, phase, RuleRole::Keeper, (x, y));
        assert_eq!(keeper(-4.5, 0.0), None);
        assert_eq!(keeper(-4.42, 0.4), None);
        assert_eq!(keeper(-4.40, 0.0), Some(KeepOutReason::KeeperLine));
        assert_eq!(keeper(-4.60, 0.0), Some(KeepOutReason::KeeperLine));
        assert_eq!(keeper(-4.5, 0.42), Some(KeepOutReason::KeeperLine));
    }
}

#[test]
fn a_penalty_that_is_in_play_frees_the_keeper() {
    let field = League::DivisionB.field();
    let (phase, rule_role) = (Phase::Penalty(Side::Theirs), RuleRole::Keeper);
    let (ball, own) = (Some(Point::new(1.0, 0.0)), GoalEnd::Negative);
    let s = Situation { field: &field, own, phase, rule_role, ball, placement: None, ball_in_play: true };
    assert_eq!(keep_out(&s).forbidden.len(), 0);
}

#[test]
fn robots_that_do_not_place_keep_out_of_the_stadium() {
    let field = League::DivisionB.field();
    // Ball at 0, target at (2, 0).
    let theirs = |x, y| why(&field, Phase::BallPlacement(Side::Theirs), RuleRole::Player, (x, y));
    assert_eq!((theirs(1.0, 0.58), theirs(1.0, 0.60)), (Some(KeepOutReason::Stadium), None));
    assert_eq!((theirs(2.58, 0.0), theirs(2.60, 0.0)), (Some(KeepOutReason::Stadium), None));
    let ours = |rule_role, x| why(&field, Phase::BallPlacement(Side::Ours), rule_role, (x, 0.0));
    assert_eq!((ours(RuleRole::Kicker, 2.0), ours(RuleRole::Player, 2.5), ours(RuleRole::Player, 1.0)), {
        (None, Some(KeepOutReason::Target), None)
    });
}

#[test]
fn walls_end_the_surface_in_every_phase() {
    let field = League::DivisionA.field();
    for phase in phases() {
        // Division A has 0.6 m behind the goal lines, 0.3 m beside the touch lines.
        let keeper = |x, y| why(&field, phase, RuleRole::Keeper, (x, y));
        assert!(keeper(-6.52, 0.0).is_some(), "{phase:?}");
        assert!(keeper(-3.0, 4.72).is_some(), "{phase:?}");
    }
    assert_eq!(why(&field, Phase::Run, RuleRole::Keeper, (-6.50, 0.0)), None);
    assert_eq!(why(&field, Phase::Run, RuleRole::Keeper, (-3.0, 4.70)), None);
}

#[test]
fn no_situation_has_more_regions_than_the_list_holds() {
    let (ball, placement) = (Some(Point::new(0.1, 0.2)), Some(Point::new(1.0, 2.0)));
    for league in [League::Ssl2013, League::DivisionB] {
        let field = &league.field();
        for phase in phases() {
            for rule_role in ROLES {
                for own in [GoalEnd::Negative, GoalEnd::Positive] {
                    let s = Situation { field, own, phase, rule_role, ball, placement, ball_in_play: false };
                    // `List::add` asserts in tests; here: capacity is left.
                    assert!(keep_out(&s).forbidden.len() < FORBIDDEN_MAX, "{s:?}");
                }
            }
        }
    }
}

#[test]
fn both_ends_are_mirror_images() {
    let field = &League::Ssl2013.field();
    let turned = |p: Point<Field>| Point::new(-p.x(), -p.y());
    let (ball, placement) = (Point::new(0.4, -0.7), Point::new(-1.3, 1.1));
    let grid = (-16..=16).flat_map(|i| (-11..=11).map(move |j| (i as f32 * 0.2, j as f32 * 0.2)));
    for (x, y) in grid {
        let at = Point::new(x, y);
        for phase in phases() {
            for rule_role in ROLES {
                let mut s = Situation {
                    field,
                    own: GoalEnd::Negative,
                    phase,
                    rule_role,
                    ball: Some(ball),
                    placement: Some(placement),
                    ball_in_play: false,
                };
                let here = keep_out(&s).offence(at, ROBOT_RADIUS);
                (s.own, s.ball, s.placement) =
                    (GoalEnd::Positive, Some(turned(ball)), Some(turned(placement)));
                let there = keep_out(&s).offence(turned(at), ROBOT_RADIUS);
                assert_eq!(here, there, "{phase:?} {rule_role:?} {at:?}");
            }
        }
    }
}

#[test]
fn halt_stops_stop_slows_and_only_that() {
    for phase in phases() {
        let limit = match phase {
            Phase::Halt | Phase::Timeout(_) => Some(0.0),
            Phase::Stop => Some(1.5),
            _ => None,
        };
        assert_eq!(speed_limit(&phase), limit, "{phase:?}");
    }
}

#[test]
fn only_permitted_robots_touch_the_ball() {
    let field = &League::DivisionB.field();
    let touch = |phase, rule_role, x: f32| {
        let (own, ball, placement) = (GoalEnd::Negative, None, None);
        let s = Situation { field, own, phase, rule_role, ball, placement, ball_in_play: true };
        may_touch_ball(&s, Point::new(x, 0.0))
    };
    for phase in phases() {
        for rule_role in ROLES {
            let may = match phase {
                Phase::Run => true,
                Phase::Penalty(Side::Theirs) => rule_role == RuleRole::Keeper,
                Phase::BallPlacement(Side::Ours)
                | Phase::Kickoff(Side::Ours)
                | Phase::FreeKick(Side::Ours)
                | Phase::Penalty(Side::Ours) => rule_role == RuleRole::Kicker,
                _ => false,
            };
            let expected = if may { Touch::Allowed } else { Touch::NotNow };
            assert_eq!(touch(phase, rule_role, 0.0), expected, "{phase:?} {rule_role:?}");
        }
    }
    // Areas start at 3.495: partly in theirs from 3.405, entirely in ours from −3.585.
    assert_eq!(touch(Phase::Run, RuleRole::Player, 3.42), Touch::InOpponentArea);
    assert_eq!(touch(Phase::Run, RuleRole::Player, 3.40), Touch::Allowed);
    assert_eq!(touch(Phase::Run, RuleRole::Player, -3.60), Touch::InOwnArea);
    assert_eq!(touch(Phase::Run, RuleRole::Player, -3.58), Touch::Allowed);
    assert_eq!(touch(Phase::Run, RuleRole::Keeper, -4.0), Touch::Allowed);
    assert_eq!(touch(Phase::BallPlacement(Side::Ours), RuleRole::Kicker, 4.0), Touch::Allowed);
}

#[test]
fn keep_out_forbids_the_places_that_the_referee_punishes() {
    use crate::legality::{InArea, in_area, interferes, too_close_to_area, too_close_to_ball};
    let field = &League::DivisionB.field();
    let (ball, target) = (Point::new(1.03, -0.52), Point::new(-2.01, 1.47));
    let grid = (-120..=120).flat_map(|i| (-80..=80).map(move |j| (i as f32 * 0.037, j as f32 * 0.037)));
    let mut offences = 0;
    for (x, y) in grid {
        let at = Point::new(x, y);
        let found = |phase, why| {
            let (own, rule_role) = (GoalEnd::Negative, RuleRole::Player);
            let (ball, placement) = (Some(ball), Some(target));
            let s = Situation { field, own, phase, rule_role, ball, placement, ball_in_play: false };
            let list = keep_out(&s).forbidden;
            list.iter().any(|region| region.why == why && region.shape.distance_to(at) < ROBOT_RADIUS)
        };
        let both = [
            (found(Phase::Stop, KeepOutReason::BallDistance), too_close_to_ball(at, ball)),
            (
                found(Phase::Stop, KeepOutReason::OpponentArea),
                too_close_to_area(field, GoalEnd::Positive, at),
            ),
            (found(Phase::BallPlacement(Side::Theirs), KeepOutReason::Stadium), interferes(at, ball, target)),
            (found(Phase::Run, KeepOutReason::OwnArea), in_area(field, GoalEnd::Negative, at) != InArea::Out),
        ];
        for (forbidden, whistled) in both {
            // Corners of grown boxes stay corners: more is forbidden there than is penalised, never less.
            assert!(forbidden || !whistled, "{at:?}: {both:?}");
            offences += u32::from(whistled);
        }
        assert_eq!(both[0].0, both[0].1, "{at:?}");
        assert_eq!(both[2].0, both[2].1, "{at:?}");
    }
    assert!(offences > 1000);
}
