//! Tests: the three placements are those of the paper. Compared with rays and hand-computed places.

use super::super::super::view::{ViewRobot, tests::view};
use super::super::angle::BODY;
use super::*;
use geometry::{Angle, Segment};
use rules::League;

fn at(league: League, threat: (f32, f32), available: usize) -> (View, Cover) {
    let mut view = view(threat, &[], &[]);
    view.field = league.field();
    let cover = cover(&view, Point::new(threat.0, threat.1), available, None, &ThreatSettings::default());
    (view, cover)
}

/// Share of 2,000 shots from the threat to the goal opening that no body blocks.
fn free_rays(view: &View, cover: &Cover) -> f32 {
    let (from, goal, width) = (cover.opening.from, view.our_goal(), view.field.goal_width);
    let bodies: Vec<_> = cover.primaries.iter().copied().chain([cover.keeper]).collect();
    let free = (0..2_000).filter(|i| {
        let y = width * ((*i as f32 + 0.5) / 2_000.0 - 0.5);
        let path = Segment::new(from, Point::new(goal.x(), y));
        bodies.iter().all(|body| path.distance_to(*body) > BODY)
    });
    free.count() as f32 / 2_000.0
}

#[test]
fn one_defender_suffices_where_the_open_angle_is_narrow() {
    // From (−4.2, 2.5): the goal's angle is 3.5°, far below the angle of a body at 1.4 m.
    let (view, cover) = at(League::DivisionB, (-4.2, 2.5), 2);
    assert_eq!(cover.case, Case::Defender);
    assert_eq!(cover.keeper, view.our_goal() + Vector::new(0.125, 0.0));
    // It is on the bisector: its direction from the threat is the opening's middle.
    let off = (cover.opening.from.direction_to(cover.primaries[0]) - cover.opening.middle).abs();
    assert!(off < 1e-3 && cover.uncovered == 0.0 && free_rays(&view, &cover) == 0.0, "{cover:?}");
}

#[test]
fn a_defender_at_the_nearer_post_and_the_keeper_share_a_wider_one() {
    let (view, cover) = at(League::Ssl2013, (-1.4, 1.2), 2);
    assert_eq!(cover.case, Case::DefenderAndKeeper, "{cover:?}");
    // The line from the threat to the nearer post touches the defender's body, from inside.
    let line = Segment::new(cover.opening.from, Point::new(-3.0, 0.35));
    assert!((line.distance_to(cover.primaries[0]) - BODY).abs() < 1e-3, "{cover:?}");
    let far = Segment::new(cover.opening.from, Point::new(-3.0, -0.35));
    assert!(far.distance_to(cover.primaries[0]) < far.distance_to(Point::new(-3.0, 0.35)));
    // The keeper is as far back as it can be: a centimetre farther back it would leave a gap.
    assert!(cover.uncovered < 1e-3 && free_rays(&view, &cover) < 0.005, "{cover:?}");
    let back = cover.keeper + (cover.keeper - cover.opening.from).unit().unwrap() * 0.03;
    let lazy = Cover { keeper: back, ..cover.clone() };
    let on_the_line = cover.keeper.x() - view.our_goal().x() < 0.126;
    assert!(on_the_line || free_rays(&view, &lazy) > 0.0, "{cover:?}");
}

#[test]
fn else_two_defenders_stand_on_the_bisectors_of_what_the_keeper_leaves() {
    let (view, cover) = at(League::Ssl2013, (-0.2, 0.3), 2);
    assert_eq!((cover.case, cover.primaries.len()), (Case::DefendersAndKeeper, 2), "{cover:?}");
    let keeper = cover.opening.shadow(cover.keeper, f32::INFINITY).unwrap();
    assert!(keeper.middle().abs() < 1e-3, "the keeper is on the bisector of all");
    let half = cover.opening.half;
    for place in &cover.primaries {
        let off = (cover.opening.from.direction_to(*place) - cover.opening.middle).radians();
        let rest = if off < 0.0 { 0.5 * (-half + keeper.right) } else { 0.5 * (half + keeper.left) };
        assert!((off - rest).abs() < 2e-3, "{off} {rest}");
    }
    assert!(free_rays(&view, &cover) < 0.005, "{cover:?}");
}

/// Carriers near our area, by their place, with a needed primary that is this far from its own, m.
fn with_a_primary_on_its_way(mut each: impl FnMut(View, Cover, Point<Attack>)) {
    for i in 0..40 {
        let (along, side) = ((i / 2) as f32 / 20.0, if i % 2 == 0 { 1.0 } else { -1.0 });
        let (sin, cos) = Angle::degrees(85.0 * along).sin_cos();
        let threat = (-4.5 + 2.0 * cos, 2.0 * sin * side);
        let (mut view, cover) = at(League::DivisionB, threat, 1);
        let keeper = ViewRobot::at_rest(view.keeper, cover.keeper);
        let _ = view.ours.push(keeper);
        let edge = Edge::of(&view.field, ThreatSettings::default().off_area);
        let place = edge.along(cover.primaries[0]);
        for off in [0.2, 0.4, 0.6] {
            each(view.clone(), cover.clone(), edge.point(place - off * side));
        }
    }
}

/// The widest range of directions to our goal, rad, that no body blocks: 2,000 rays.
fn widest_by_rays(view: &View, cover: &Cover, bodies: [Point<Attack>; 2]) -> f32 {
    let (from, goal, width) = (cover.opening.from, view.our_goal(), view.field.goal_width);
    let (mut widest, mut since) = (0.0_f32, None);
    for i in 0..2_000 {
        let at = Point::new(goal.x(), width * ((i as f32 + 0.5) / 2_000.0 - 0.5));
        let path = Segment::new(from, at);
        let free = bodies.iter().all(|body| path.distance_to(*body) > BODY);
        let start = *since.get_or_insert(at);
        let angle = (from.direction_to(at) - from.direction_to(start)).abs();
        if free { widest = widest.max(angle) } else { since = None }
    }
    widest
}

#[test]
fn while_a_primary_is_on_its_way_the_keeper_narrows_the_widest_gap() {
    let (mut before, mut meanwhile, mut count) = (0.0, 0.0, 0);
    with_a_primary_on_its_way(|view, cover, body| {
        let keeper = cover.keeper_meanwhile(&view, [body].into_iter(), &ThreatSettings::default());
        let [papers, now] =
            [cover.keeper, keeper].map(|keeper| widest_by_rays(&view, &cover, [body, keeper]));
        // Its way, and the gap of later, count too: nowhere is it much worse off now.
        assert!(now < papers + 0.035, "{body:?}: {now} rad, {papers} at the paper's place");
        (before, meanwhile, count) = (before + papers, meanwhile + now, count + 1);
    });
    assert!(meanwhile < 0.85 * before, "{meanwhile} of {before} rad in {count}");
}

#[test]
fn once_the_primary_is_at_its_place_the_keepers_is_the_papers() {
    with_a_primary_on_its_way(|view, cover, _| {
        let there = cover.primaries.iter().copied();
        assert_eq!(cover.keeper_meanwhile(&view, there, &ThreatSettings::default()), cover.keeper);
    });
}

#[test]
fn the_keeper_does_not_swing_while_a_primary_comes_nearer() {
    let (mut driven, mut count) = (0.0, 0);
    with_a_primary_on_its_way(|mut view, cover, body| {
        let start = cover.primaries[0];
        let (from, steps) = (body - start, 40);
        for step in 0..=steps {
            let primary = start + from * (1.0 - step as f32 / steps as f32);
            let at = cover.keeper_meanwhile(&view, [primary].into_iter(), &ThreatSettings::default());
            // It drives with 1.5 m/s, the primary with 0.4 to 1.
            let keeper = &mut view.ours[0].position;
            let way = at - *keeper;
            let next = *keeper + way * (0.02 / way.norm().max(0.02));
            driven += next.distance(*keeper);
            *keeper = next;
        }
        count += 1;
    });
    // Places weighted by the cubes of the gaps made it drive 0.68 m each time, these 0.28.
    assert!(driven / (count as f32) < 0.4, "{driven} m in {count}");
}

#[test]
fn primaries_are_always_at_the_edge_and_bodies_never_in_each_other() {
    let settings = ThreatSettings::default();
    for league in [League::Ssl2013, League::DivisionB, League::DivisionA] {
        let field = league.field();
        let edge = Edge::of(&field, settings.off_area);
        for i in 0..1_200 {
            let (column, row) = ((i % 40) as f32 / 39.0, (i / 40) as f32 / 29.0);
            let threat = ((column - 0.5) * field.length, (row - 0.5) * field.width);
            for available in 0..=2 {
                let (view, cover) = at(league, threat, available);
                assert!(cover.primaries.len() <= available);
                for place in &cover.primaries {
                    assert!(edge.distance_to(*place).abs() < 1e-3, "{league:?} {threat:?} {cover:?}");
                    assert!(cover.keeper.distance(*place) > 0.18, "{league:?} {threat:?} {cover:?}");
                }
                if let [a, b] = cover.primaries[..] {
                    assert!(
                        a.distance(b) > 2.0 * settings.shoulder - 1e-3,
                        "{league:?} {threat:?} {cover:?}"
                    );
                }
                let out = cover.keeper.x() - view.our_goal().x();
                assert!(out > settings.keeper_back - 1e-4 && out < settings.keeper_out + 1e-3, "{cover:?}");
                assert!(cover.keeper.y().abs() <= field.goal_width * 0.5 + 1e-4, "{cover:?}");
            }
        }
    }
}

#[test]
fn what_is_left_open_is_what_rays_find_and_in_the_papers_world_it_is_nothing() {
    let mut worst: f32 = 0.0;
    for i in 0..600 {
        let (column, row) = ((i % 30) as f32 / 29.0, (i / 30) as f32 / 19.0);
        let threat = (-2.9 + column * 2.9, (row - 0.5) * 3.9);
        let (view, cover) = at(League::Ssl2013, threat, 2);
        if view.in_our_area(cover.opening.from, 0.35) {
            continue; // the defenders stand behind or beside it there, where rays from it do not reach them
        }
        let free = free_rays(&view, &cover);
        assert_eq!(
            free < 0.005,
            cover.uncovered < 0.005 * cover.opening.angle() + 1e-3,
            "{threat:?} {free} {cover:?}"
        );
        worst = worst.max(free);
    }
    assert_eq!(worst, 0.0, "keeper and two defenders take all of it");
}

#[test]
fn a_placement_is_kept_while_fewer_bodies_suffice_only_just() {
    // Moves outwards along a circle until one defender barely suffices without a memory.
    let settings = ThreatSettings::default();
    let angle = |deg: f32| {
        let (s, c) = Angle::degrees(deg).sin_cos();
        Point::<Attack>::new(-4.5 + 2.6 * c, 2.6 * s)
    };
    let view = view((0.0, 0.0), &[], &[]);
    let case = |deg: f32, before| cover(&view, angle(deg), 2, before, &settings).case;
    let first = (0..900).map(|i| i as f32 * 0.1).find(|deg| case(*deg, None) == Case::Defender).unwrap();
    let two = Some(Before { case: Case::DefenderAndKeeper, upper_post: true });
    let one = Some(Before { case: Case::Defender, upper_post: true });
    assert_eq!(case(first, two), Case::DefenderAndKeeper);
    assert_eq!(case(first, one), Case::Defender);
    assert_eq!(case(first + 10.0, two), Case::Defender);
}
