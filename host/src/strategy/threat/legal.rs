//! `legal`: moves a place to where `rules::keep_out` allows a robot's body in this phase. Attack frame, m.

use std::sync::LazyLock;

use geometry::{Angle, Attack, Field, GoalEnd, Point, Vector};
use rules::keep_out::{KeepOut, Situation, keep_out};
use rules::limits::{OPPONENT_AREA_DISTANCE, ROBOT_RADIUS};
use rules::{Phase, RuleRole, Side};

use super::super::off_ball;
use super::super::view::View;
use super::ThreatSettings;
use super::edge::Edge;

/// Margin of bodies to forbidden areas in play, m: the overshoot of control; less than that of `off_area`.
const AREA_MARGIN_IN_PLAY_M: f32 = 0.01;
/// The same while the ball is not in play, m: the robots' own margin (0.04, `brain`'s surroundings), less
/// rounding. Robots would not go to a nearer place.
const AREA_MARGIN_STOPPED_M: f32 = 0.038;
/// From the ball to other robots' centres while we place it, m: the placer goes around it, 0.28 m off, and
/// needs a body beyond that.
const PLACER_ROOM_M: f32 = 0.5;
/// Least distance of two places, m: two bodies and the gap between two defenders of one line (`defence`,
/// `BESIDE_LINE_M`).
const PLACES_APART_MIN_M: f32 = 0.2;
/// Spacing of the rings, m.
const RING_SPACING_M: f32 = 0.1;
const RINGS: u32 = 15;
const SPOKES: usize = 24;

/// The directions of places on a ring, evenly spaced.
static DIRECTIONS: LazyLock<[Vector<Attack>; SPOKES]> = LazyLock::new(|| {
    std::array::from_fn(|spoke| {
        Vector::polar(1.0, Angle::new(geometry::math::TAU * spoke as f32 / SPOKES as f32))
    })
});

/// The nearest place to `at` where a field player may stand: within the lines, out of our area (at its edge),
/// and off everything else that the phase forbids.
pub fn legal(view: &View, at: Point<Attack>, settings: &ThreatSettings) -> Point<Attack> {
    legal_for(view, RuleRole::Player, at, &[], settings)
}

/// The same for a robot of that role under the rules (a keeper may stay in our area, a kicker near the ball),
/// a body clear of the `taken` places.
pub fn legal_for(
    view: &View,
    rule_role: RuleRole,
    at: Point<Attack>,
    taken: &[Point<Attack>],
    settings: &ThreatSettings,
) -> Point<Attack> {
    let ours = Edge::of(&view.field, settings.off_area);
    let more =
        if matches!(view.phase, Phase::Stop | Phase::FreeKick(_)) { OPPONENT_AREA_DISTANCE } else { 0.0 };
    let theirs = Edge::of(&view.field, settings.off_area + more);
    let out = |at| {
        if rule_role == RuleRole::Player { out_of_areas(view, at, &ours, &theirs) } else { at }
    };
    let mut place = out(at);
    if view.phase != Phase::Run {
        place = out(off_ball::kept_off(view, place));
    }
    let margin = if view.phase == Phase::Run { AREA_MARGIN_IN_PLAY_M } else { AREA_MARGIN_STOPPED_M };
    let rules = forbidden_to(view, rule_role);
    let free = |place: &Point<Attack>| {
        let body = Point::new(place.x(), place.y());
        taken.iter().all(|other| other.distance(*place) >= PLACES_APART_MIN_M)
            && rules.offence(body, ROBOT_RADIUS + margin).is_none()
            && !in_the_way(view, rule_role, *place)
    };
    if free(&place) {
        return place;
    }
    // Rare: where areas, lines and the ball leave little room. Tries rings around it, the nearest free place
    // first.
    let around = (1..=RINGS)
        .flat_map(|ring| DIRECTIONS.iter().map(move |direction| *direction * (RING_SPACING_M * ring as f32)));
    around.map(|by| out(place + by)).find(free).unwrap_or(place)
}

/// The place inside the lines and out of both areas that is nearest to `at`.
fn out_of_areas(view: &View, at: Point<Attack>, ours: &Edge, theirs: &Edge) -> Point<Attack> {
    let inside = view.clamp(at, ROBOT_RADIUS);
    let (back, ahead) = (ours.distance_to(inside), theirs.distance_to(turned(inside)));
    match (back < 0.0, ahead < 0.0) {
        (true, _) => ours.nearest(inside),
        (_, true) => turned(theirs.nearest(turned(inside))),
        _ => inside,
    }
}

/// Half a turn: maps their end to ours.
fn turned(at: Point<Attack>) -> Point<Attack> {
    Point::new(-at.x(), -at.y())
}

/// Whether a robot there leaves our own placer no room at the ball: the rules let it stand there.
fn in_the_way(view: &View, rule_role: RuleRole, at: Point<Attack>) -> bool {
    let placed = matches!(view.phase, Phase::BallPlacement(Side::Ours)) && rule_role != RuleRole::Kicker;
    placed && view.ball.is_some_and(|ball| ball.position.distance(at) < PLACER_ROOM_M)
}

/// Places where a body of that role must not be, in the attack frame: we defend −x in it, as a team of that
/// end does on the field.
fn forbidden_to(view: &View, rule_role: RuleRole) -> KeepOut {
    let on_field = |at: Point<Attack>| Point::<Field>::new(at.x(), at.y());
    keep_out(&Situation {
        field: &view.field,
        own: GoalEnd::Negative,
        phase: view.phase,
        rule_role,
        ball: view.ball.map(|ball| on_field(ball.position)),
        placement: view.placement.map(on_field),
        ball_in_play: false,
    })
}

#[cfg(test)]
mod tests {
    use super::super::super::view::tests::view;
    use super::*;
    use rules::League;

    #[test]
    fn while_we_place_the_ball_no_other_robot_is_sent_to_it() {
        // Beside our area, moving off the ball leads into the area.
        let settings = ThreatSettings::default();
        let ball = Point::new(-4.44, 1.17);
        let mut view = view((-4.44, 1.17), &[(0.0, 0.0)], &[]);
        view.phase = Phase::BallPlacement(Side::Ours);
        view.placement = Some(Point::new(-2.0, 0.9));
        for at in [(-4.41, 1.13), (-4.4, 1.2), (-4.3, 1.0)] {
            let place = legal_for(&view, RuleRole::Player, Point::new(at.0, at.1), &[], &settings);
            assert!(place.distance(ball) >= PLACER_ROOM_M, "{at:?}: {place:?}");
        }
        let at = Point::new(-4.4, 1.2);
        assert!(in_the_way(&view, RuleRole::Player, at) && !in_the_way(&view, RuleRole::Kicker, at));
    }

    #[test]
    fn a_place_is_moved_to_where_the_rules_let_a_player_be() {
        let settings = ThreatSettings::default();
        let phases = [
            Phase::Run,
            Phase::Stop,
            Phase::FreeKick(Side::Theirs),
            Phase::FreeKick(Side::Ours),
            Phase::BallPlacement(Side::Theirs),
            Phase::Kickoff(Side::Theirs),
        ];
        let (mut moved, mut asked) = (0, 0);
        for league in [League::DivisionB, League::Ssl2013, League::DivisionA] {
            for phase in phases {
                for (ball, placement) in [((-3.1, 0.4), (0.0, 0.0)), ((-2.0, -1.9), (-1.0, -1.5))] {
                    let mut view = view(ball, &[], &[]);
                    view.field = league.field();
                    view.phase = phase;
                    view.placement = Some(Point::new(placement.0, placement.1));
                    let rules = forbidden_to(&view, RuleRole::Player);
                    for i in 0..400 {
                        let (column, row) = ((i % 20) as f32 / 19.0 - 0.5, (i / 20) as f32 / 19.0 - 0.5);
                        let at = Point::new(column * view.field.length, row * view.field.width);
                        let place = legal(&view, at, &settings);
                        let body = Point::<Field>::new(place.x(), place.y());
                        let offence = rules.offence(body, ROBOT_RADIUS);
                        // Their own half at a kick-off is far from some of these places: so only our half is
                        // searched.
                        let ours = !matches!(phase, Phase::Kickoff(_)) || at.x() < 0.9;
                        assert!(
                            !ours || offence.is_none(),
                            "{league:?} {phase:?} {at:?} → {place:?}: {offence:?}"
                        );
                        moved += usize::from(place.distance(at) > 0.01);
                        asked += 1;
                    }
                }
            }
        }
        assert!(moved > asked / 20 && moved < asked / 2, "{moved} of {asked}");
    }

    #[test]
    fn a_place_that_a_teammate_is_sent_to_is_taken() {
        let mut view = view((-3.1, 0.4), &[], &[]);
        view.phase = Phase::Stop;
        let settings = ThreatSettings::default();
        let mut taken = Vec::new();
        // Seven robots are sent between the ball and the goal, where its circle overlaps our area.
        for _ in 0..7 {
            let place = legal_for(&view, RuleRole::Player, Point::new(-3.4, 0.2), &taken, &settings);
            let near = taken.iter().map(|other| place.distance(*other)).fold(f32::MAX, f32::min);
            assert!(near >= 2.0 * ROBOT_RADIUS, "{place:?} is {near} m from one of {taken:?}");
            let body = Point::<Field>::new(place.x(), place.y());
            assert_eq!(forbidden_to(&view, RuleRole::Player).offence(body, ROBOT_RADIUS), None, "{place:?}");
            taken.push(place);
        }
    }
}
