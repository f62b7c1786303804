//! `support`: support positions and pass targets. A few fixed places and targets, rated by room and by the
//! open goal; the search by probabilities is `pass::search`. Attack frame, m.

use geometry::{Attack, Point, Segment};
use motion::ball::BallModel;
use protocol::RobotId;
use protocol::host::KickOrder;

use super::pass::{Kicks, PassScene};
use super::view::{ROBOTS_MAX, View, ViewRobot};

/// A shot, cm/s: as fast as the rules allow, less a kicker's error.
pub const SHOT: KickOrder = KickOrder::Flat(620);
const GRID: (usize, usize) = (12, 7);
/// Least distance between teammates, m.
const PLACES_APART_M: f32 = 1.2;
/// A place this near to where a supporter stood, m, counts more by this factor.
const STOOD_WITHIN_M: f32 = 0.5;
const STOOD_FACTOR: f32 = 1.2;
/// Room above this gives no further value, m.
const ROOM_ENOUGH_M: f32 = 0.7;
/// Supporters stay this far off the areas, m: the rules' 0.2 m, a body and as much margin.
const OFF_AREAS_M: f32 = 0.4;
/// Shorter passes gain nothing, longer ones are intercepted by other robots, m.
const PASS_LENGTH_MIN_M: f32 = 1.0;
const PASS_LENGTH_MAX_M: f32 = 5.0;
/// A pass may go back this far, m.
const PASS_BACK_MAX_M: f32 = 1.0;
/// Least room beside the path of a shot, m: bodies of robot and ball (0.11) and the distance a keeper covers
/// while it flies.
const SHOT_ROOM_MIN_M: f32 = 0.2;
/// Bodies of robot and ball, m: with less than this beside its path the ball hits a robot.
const BODIES_ROOM_M: f32 = 0.12;
/// A teammate nearer to a line than this is no receiver, m: a ball that it misses is out.
const INSIDE_LINES_M: f32 = 0.3;
/// Farther shots are caught, m.
const SHOT_LENGTH_MAX_M: f32 = 4.0;
/// With the ball far ahead the grid of places starts here, m: short of the halfway line.
const GRID_FROM_X_MAX_M: f32 = -0.5;
/// Below this value a pass is not played, 0–1.
const PASS_WORTH_MIN: f32 = 0.2;
/// Shots are aimed this far inside the posts, m: twice the ball's radius, and the scatter of a kick.
const INSIDE_POST_M: f32 = 0.08;
/// Number of points of the goal tried.
const GOAL_POINTS: usize = 9;
/// A receiver can control a ball of this speed, m/s; one that it misses rolls 2 m farther (v²/0.7), not off
/// the field.
const ARRIVAL_SPEED_M_S: f32 = 1.2;
/// Speed that counts as stopped, m/s.
const STOPPED_SPEED_M_S: f32 = 0.2;

/// Places for teammates of a robot with the ball at `ball`, best first, apart from each other; with their
/// value, 0–1.
pub fn places(
    view: &View,
    ball: Point<Attack>,
    wanted: usize,
) -> heapless::Vec<(Point<Attack>, f32), ROBOTS_MAX> {
    let mut chosen: heapless::Vec<(Point<Attack>, f32), ROBOTS_MAX> = heapless::Vec::new();
    for _ in 0..wanted.min(ROBOTS_MAX) {
        let mut best: Option<(Point<Attack>, f32)> = None;
        for place in grid(view, ball) {
            if chosen.iter().any(|(other, _)| other.distance(place) < PLACES_APART_M) {
                continue;
            }
            let worth = worth(view, ball, place);
            if best.is_none_or(|(_, most)| worth > most) {
                best = Some((place, worth));
            }
        }
        let Some(best) = best else { break };
        // As many as ROBOTS_MAX fit.
        let _ = chosen.push(best);
    }
    chosen
}

/// Places at which a robot that stood there would be passed to with the greatest value, best first, apart
/// from each other; those within half a metre of `stood` count a little more.
pub fn pass_places(
    view: &View,
    kicks: &Kicks,
    ball: Point<Attack>,
    passer: Option<RobotId>,
    stood: &[Point<Attack>],
) -> heapless::Vec<(Point<Attack>, f32), ROBOTS_MAX> {
    let mut chosen: heapless::Vec<(Point<Attack>, f32), ROBOTS_MAX> = heapless::Vec::new();
    // No robot of ours: the receivers are those that are sent there.
    let placeholder = ViewRobot::at_rest(RobotId::ZERO, ball);
    let scene = PassScene::of(view, kicks, ball, passer, &placeholder).keeping();
    let rated: heapless::Vec<(Point<Attack>, f32), { GRID.0 * GRID.1 }> = grid(view, ball)
        .chain(stood.iter().copied().filter(|at| at.distance(ball) > PASS_LENGTH_MIN_M))
        .take(GRID.0 * GRID.1)
        .map(|at| {
            let kept = stood.iter().any(|stood| stood.distance(at) < STOOD_WITHIN_M);
            (at, scene.received_at(at).rate(at).value() * if kept { STOOD_FACTOR } else { 1.0 })
        })
        .collect();
    for _ in 0..ROBOTS_MAX {
        let apart = |at: Point<Attack>| chosen.iter().all(|(other, _)| other.distance(at) >= PLACES_APART_M);
        let best = rated.iter().filter(|(at, _)| apart(*at)).fold(None, |best, next| match best {
            Some((_, most)) if most >= next.1 => best,
            _ => Some(*next),
        });
        let Some(best) = best else { break };
        // As many as ROBOTS_MAX fit.
        let _ = chosen.push(best);
    }
    chosen
}

/// The value of having the ball at `place` after a pass from `ball`: room on the path, room there, and a
/// clear line to the goal.
pub fn worth(view: &View, ball: Point<Attack>, place: Point<Attack>) -> f32 {
    let room_share = view.room_along(ball, place).min(ROOM_ENOUGH_M) / ROOM_ENOUGH_M;
    let there =
        view.nearest_theirs(place).map_or(ROOM_ENOUGH_M, |(_, d)| d).min(ROOM_ENOUGH_M) / ROOM_ENOUGH_M;
    let ahead = ((place.x() - ball.x()) / view.field.length + 0.5).clamp(0.0, 1.0);
    let shot = view.room_along(place, view.their_goal()).min(ROOM_ENOUGH_M) / ROOM_ENOUGH_M;
    room_share * there * (0.4 + 0.3 * ahead + 0.3 * shot)
}

/// The places considered: a coarse grid ahead of and beside the ball, outside the areas and inside the lines.
fn grid(view: &View, ball: Point<Attack>) -> impl Iterator<Item = Point<Attack>> {
    let (length, width) = (view.field.length, view.field.width);
    let columns = GRID.0;
    (0..columns * GRID.1)
        .map(move |i| {
            let (column, row) = (i % columns, i / columns);
            let share = |k: usize, n: usize| (k as f32 + 0.5) / n as f32 - 0.5;
            Point::new(share(column, columns) * (length - 1.0), share(row, GRID.1) * (width - 0.8))
        })
        .filter(move |at| !view.in_their_area(*at, OFF_AREAS_M) && !view.in_our_area(*at, OFF_AREAS_M))
        .filter(move |at| {
            let distance = at.distance(ball);
            let line = (ball.x() - PASS_BACK_MAX_M).min(GRID_FROM_X_MAX_M);
            (PASS_LENGTH_MIN_M..PASS_LENGTH_MAX_M).contains(&distance) && at.x() > line
        })
}

/// The best target of a ball that lies still: a shot with room, else the best teammate, else ahead along the
/// freest path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// Shoot at this point of the goal.
    Shot {
        /// Target point of the shot, m.
        at: Point<Attack>,
        /// Room along the path, m.
        room: f32,
    },
    /// Pass to this teammate.
    Teammate {
        /// Number of the teammate.
        id: RobotId,
        /// Place of the reception, m.
        at: Point<Attack>,
        /// Room along the path, m.
        room: f32,
    },
    /// No teammate is free: ahead.
    Ahead {
        /// Target point of the kick, m.
        at: Point<Attack>,
        /// Room along the path, m.
        room: f32,
    },
}

/// Whether a teammate can receive a pass of the ball: inside the lines, neither far back nor too near or too
/// far; the keeper never.
fn is_receivable(view: &View, ball: Point<Attack>, teammate: &ViewRobot) -> bool {
    let distance = teammate.position.distance(ball);
    teammate.id != view.keeper
        && view.clamp(teammate.position, INSIDE_LINES_M) == teammate.position
        && teammate.position.x() > ball.x() - PASS_BACK_MAX_M
        && (PASS_LENGTH_MIN_M..PASS_LENGTH_MAX_M).contains(&distance)
}

/// Chooses the target for the robot `kicker` with the ball at `ball`.
pub fn target(view: &View, kicker: RobotId, ball: Point<Attack>) -> Target {
    let (shot, room) = best_shot(view, ball);
    if room > SHOT_ROOM_MIN_M && ball.distance(view.their_goal()) < SHOT_LENGTH_MAX_M {
        return Target::Shot { at: shot, room };
    }
    let best = view
        .ours
        .iter()
        .filter(|teammate| teammate.id != kicker && is_receivable(view, ball, teammate))
        .map(|teammate| (teammate, worth(view, ball, teammate.position)))
        .reduce(|best, next| if next.1 > best.1 { next } else { best });
    match best {
        Some((teammate, worth)) if worth > PASS_WORTH_MIN => {
            let room = view.room_along(ball, teammate.position);
            Target::Teammate { id: teammate.id, at: teammate.position, room }
        }
        _ if room > BODIES_ROOM_M && ball.distance(view.their_goal()) < SHOT_LENGTH_MAX_M => {
            Target::Shot { at: shot, room }
        }
        // A kick at an opponent's body, from beside the touch line, goes out for them: a pass back to any
        // teammate there is better.
        Some((teammate, _)) if view.room_along(ball, teammate.position) > BODIES_ROOM_M => {
            let room = view.room_along(ball, teammate.position);
            Target::Teammate { id: teammate.id, at: teammate.position, room }
        }
        _ => {
            let half = view.field.width * 0.5 - 0.6;
            let ahead = [0.0, -half, half]
                .map(|y| Point::new((ball.x() + 2.0).min(view.field.length * 0.5 - 1.5), y));
            let (at, room) = ahead
                .into_iter()
                .map(|at| (at, view.room_along(ball, at)))
                .fold((ahead[0], -1.0), |best, next| if next.1 > best.1 { next } else { best });
            Target::Ahead { at, room }
        }
    }
}

/// The point of their goal with the freest path from `ball`, and the room along that path, m.
pub fn best_shot(view: &View, ball: Point<Attack>) -> (Point<Attack>, f32) {
    let (x, half) = (view.their_goal().x(), view.field.goal_width * 0.5 - INSIDE_POST_M);
    let mut best = (view.their_goal(), -1.0);
    for i in 0..GOAL_POINTS {
        let y = half * (2.0 * i as f32 / (GOAL_POINTS - 1) as f32 - 1.0);
        let at = Point::new(x, y);
        let room_share = Segment::new(ball, at);
        let room = view.theirs.iter().map(|robot| room_share.distance_to(robot.position)).fold(1.0, f32::min);
        if room > best.1 {
            best = (at, room);
        }
    }
    best
}

/// The kick that brings the ball over `distance` to a teammate that can still control it.
pub fn pass_kick(distance: f32) -> KickOrder {
    flat(distance, ARRIVAL_SPEED_M_S)
}

/// The kick whose ball stops at `distance`.
pub fn push_kick(distance: f32) -> KickOrder {
    flat(distance, STOPPED_SPEED_M_S)
}

fn flat(distance: f32, arrival: f32) -> KickOrder {
    let speed = BallModel::default().kick_speed(distance, arrival).clamp(1.0, 6.0);
    KickOrder::Flat((speed * 100.0) as u16)
}

#[cfg(test)]
mod tests {
    use super::super::view::tests::view;
    use super::*;

    #[test]
    fn places_lie_on_the_field_outside_the_areas_and_apart() {
        let view = view((0.0, 0.0), &[], &[(1.0, 1.0), (2.0, 0.0), (4.4, 0.0)]);
        let places = places(&view, Point::new(0.0, 0.0), 3);
        assert_eq!(places.len(), 3);
        for (i, (place, _)) in places.iter().enumerate() {
            assert!(view.field.contains(Point::new(place.x(), place.y())));
            assert!(!view.in_their_area(*place, 0.2));
            for (other, _) in &places[..i] {
                assert!(place.distance(*other) >= PLACES_APART_M);
            }
        }
        assert!(places[0].1 >= places[2].1, "best first");
    }

    #[test]
    fn a_shot_goes_past_the_keeper_and_a_blocked_one_becomes_a_pass() {
        let open = view((2.0, 0.0), &[(1.9, 0.0)], &[(4.4, -0.3)]);
        let Target::Shot { at, .. } = target(&open, open.ours[0].id, Point::new(2.0, 0.0)) else { panic!() };
        assert!(at.y() > 0.2);
        let ours = [(-4.4, 0.0), (1.9, 0.0), (2.0, 2.0)];
        let blocked = view((2.0, 0.0), &ours, &[(4.4, 0.0), (2.6, 0.0), (2.6, 0.15), (2.6, -0.15)]);
        let Target::Teammate { id, .. } = target(&blocked, blocked.ours[1].id, Point::new(2.0, 0.0)) else {
            panic!()
        };
        assert_eq!(id.number(), 2);
    }

    #[test]
    fn a_pass_over_two_metres_starts_with_the_speed_that_arrives_with_1_2() {
        // Slides 3.9 m/s² to 5/7 of its speed, then rolls 0.35: v² = (1.44 + 2·0.35·2)/(0.5102 +
        // 0.4898·0.35/3.9) = 5.125
        assert_eq!(pass_kick(2.0), KickOrder::Flat(226));
        assert!(matches!(push_kick(2.0), KickOrder::Flat(speed) if speed < 170));
    }
}
