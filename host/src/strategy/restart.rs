//! `restart`: positions while the ball is not in play, and our restarts (rules 2026: stop, kick-off, free
//! kick, penalty, ball placement). Attack frame, m. The robots' own keep-outs hold the rules to the
//! centimetre; this module chooses places within them.

use geometry::{Attack, Point, Vector};

use rules::Phase;
use rules::limits::{NEAR_MARK, ROBOT_RADIUS};

use super::off_ball::OFF_BALL;
use super::order::{OrderReason, Task};
use super::support::{self, Target};
use super::view::{View, ViewBall};

/// Distance behind the ball at which our kicker waits, m.
const KICKER_WAITS_BEHIND_M: f32 = 0.7;
/// Distance behind the mark of all robots except kicker and keeper at a penalty, m: the rules' 1 m, a body
/// and a margin, and room for another robot (0.23 m) to pass in front of the row to its place, or for a ball
/// that lies a little behind the mark.
const BEHIND_PENALTY_M: f32 = 1.45;
/// From the middle to the first robot that waits at a penalty, m: the kicker passes between the teams.
const PENALTY_FIRST_M: f32 = 0.3;
/// Largest distance between robots that wait at a penalty, m: a third passes between two of them.
const PENALTY_APART_MAX_M: f32 = 0.6;
/// From the touch line to the last place of a row behind a penalty, m: a body.
const PENALTY_INSIDE_M: f32 = 0.1;
/// Margin on either side of a body that passes between two walls, m.
const ROOM_TO_PASS_M: f32 = 0.04;
/// Distance of the two receivers from the halfway line at kick-off, m: a kicker that passes to them lines up
/// beside the halfway line, not beyond the ball.
const KICKOFF_BESIDE_M: f32 = 0.35;
/// Distance of other field players from the halfway line at kick-off, m: far enough from an opponent to
/// receive a pass.
const KICKOFF_BACK_M: f32 = 0.9;
/// A robot reaches a ball this far beyond the field surface's edge, m: as the league's simulators let one be.
const REACH_BEYOND_EDGE_M: f32 = 0.03;

/// Waiting place of our kicker for its restart from `ball`: behind it, as seen from their goal.
pub fn kicker_waits(view: &View, ball: Point<Attack>) -> Point<Attack> {
    let back = (ball - view.their_goal()).unit().unwrap_or(Vector::new(-1.0, 0.0));
    view.clamp(ball + back * KICKER_WAITS_BEHIND_M, -0.1)
}

/// Our kicker's task for its target; without one it waits behind the ball until its teammates have taken
/// their places.
pub fn take(view: &View, ball: &ViewBall, target: Option<Target>) -> (Task, OrderReason) {
    let distance = |at: Point<Attack>| at.distance(ball.position);
    match target {
        None => {
            let at = kicker_waits(view, ball.position);
            (Task::GoTo { at, face: at.direction_to(ball.position) }, OrderReason::Referee)
        }
        Some(Target::Shot { at, room }) => {
            (Task::Kick { at, kick: support::SHOT }, OrderReason::BestTarget { room })
        }
        Some(Target::Ahead { at, room }) => {
            (Task::Kick { at, kick: support::push_kick(distance(at)) }, OrderReason::BestTarget { room })
        }
        Some(Target::Teammate { id, at, room }) => {
            let kick = support::pass_kick(distance(at));
            (Task::Pass { at, receiver: id, kick, ready: true }, OrderReason::BestTarget { room })
        }
    }
}

/// Places of field players at our kick-off: on our half, within a pass of the kicker.
pub fn kickoff_places(view: &View) -> [Point<Attack>; 6] {
    let (x, wing) = (-KICKOFF_BACK_M, view.field.width * 0.5);
    [
        Point::new(-KICKOFF_BESIDE_M, wing * 0.55),
        Point::new(-KICKOFF_BESIDE_M, -wing * 0.55),
        Point::new(x - 0.8, 0.0),
        Point::new(x - 0.3, wing * 0.8),
        Point::new(x - 0.3, -wing * 0.8),
        Point::new(x - 1.4, wing * 0.4),
    ]
}

/// Place of the wall at their restart: on the line from the ball to our goal.
pub fn wall(view: &View, ball: &ViewBall) -> Point<Attack> {
    let home = (view.our_goal() - ball.position).unit().unwrap_or(Vector::new(-1.0, 0.0));
    ball.position + home * OFF_BALL
}

/// Place of a penalty, ours or theirs: where the referee designates the ball's place, or lets it lie, else
/// the mark.
pub fn penalty_spot(view: &View, ours: bool) -> Point<Attack> {
    let ahead = if ours { 1.0 } else { -1.0 };
    let mark = Point::new(ahead * (view.field.length * 0.5 - view.field.penalty_mark), 0.0);
    view.placement.or_else(|| lies_at(view, mark)).unwrap_or(mark)
}

/// Place from which our kick-off is taken, likewise.
pub fn kickoff_spot(view: &View) -> Point<Attack> {
    let mark = Point::default();
    view.placement.or_else(|| lies_at(view, mark)).unwrap_or(mark)
}

/// The ball's place, where it lies for a restart from `mark`.
fn lies_at(view: &View, mark: Point<Attack>) -> Option<Point<Attack>> {
    let ball = view.ball.filter(|_| view.phase != Phase::Stop)?;
    Some(ball.position).filter(|at| at.distance(mark) < NEAR_MARK)
}

/// Places of robots other than kicker and keeper at a penalty from `spot`, `waiting` in number: in a row
/// behind it, each team on its own left, so that no two are sent to one place.
pub fn behind_penalty(
    view: &View,
    spot: Point<Attack>,
    ours: bool,
    slot: usize,
    waiting: usize,
) -> Point<Attack> {
    let back = if ours { -1.0 } else { 1.0 };
    let wide = view.field.width * 0.5 - PENALTY_INSIDE_M - PENALTY_FIRST_M;
    let apart = PENALTY_APART_MAX_M.min(wide / waiting.saturating_sub(1).max(1) as f32);
    let at = Point::new(spot.x() + back * BEHIND_PENALTY_M, PENALTY_FIRST_M + apart * slot as f32);
    view.clamp(at, PENALTY_INSIDE_M)
}

/// Whether no robot can reach a ball there: between a goal's back and the wall, where that is too narrow for
/// a body, or off the field surface.
pub fn is_out_of_reach(view: &View, ball: Point<Attack>) -> bool {
    let field = &view.field;
    let behind = ball.x().abs() - field.length * 0.5 - field.goal_depth;
    let aside = ball.y().abs() - field.goal_width * 0.5 - field.goal_wall;
    let room = field.goal_line_margin - field.goal_depth - field.goal_wall;
    let hidden = behind > 0.0 && aside < 0.0 && room < 2.0 * ROBOT_RADIUS + ROOM_TO_PASS_M;
    // A ball pressed against a board is seen slightly beyond it.
    let off = behind + field.goal_depth > field.goal_line_margin + REACH_BEYOND_EDGE_M
        || ball.y().abs() - field.width * 0.5 > field.margin + REACH_BEYOND_EDGE_M;
    hidden || off
}

#[cfg(test)]
mod tests {
    use super::super::view::tests::view;
    use super::*;
    use rules::{League, Side};

    #[test]
    fn at_kick_off_everyone_stands_on_the_own_half_outside_the_circle() {
        let view = view((0.0, 0.0), &[], &[]);
        for place in kickoff_places(&view) {
            assert!(place.x() < -0.1 && place.distance(Point::new(0.0, 0.0)) > 0.6, "{place:?}");
        }
    }

    #[test]
    fn at_a_penalty_all_others_are_a_metre_behind_the_mark_each_in_its_own_place() {
        for league in [League::Ssl2013, League::DivisionB, League::DivisionA] {
            let field = league.field();
            // The ball still lies at another place.
            let mut view = View::still(field, Point::new(0.4, -0.6), [], []);
            view.phase = Phase::Stop;
            let robots = if league == League::DivisionA { 10 } else { 5 };
            let (shooting, defending) = (penalty_spot(&view, true), penalty_spot(&view, false));
            assert_eq!(shooting, Point::new(field.length * 0.5 - field.penalty_mark, 0.0));
            // The same mark, seen from the other side.
            assert_eq!(defending, Point::new(-shooting.x(), -shooting.y()));
            let turned = |at: Point<Attack>| Point::<Attack>::new(-at.x(), -at.y());
            let ours = (0..robots).map(|slot| behind_penalty(&view, shooting, true, slot, robots));
            let theirs =
                (0..robots).map(|slot| turned(behind_penalty(&view, defending, false, slot, robots)));
            let all: Vec<_> = ours.chain(theirs).collect();
            for (i, at) in all.iter().enumerate() {
                assert!(shooting.x() - at.x() > 1.1, "{league:?}: {at:?}");
                assert!(view.clamp(*at, 0.1) == *at, "{league:?}: {at:?}");
                assert!(all[..i].iter().all(|other| other.distance(*at) > 0.3), "{league:?}: {all:?}");
                // A robot does not have to pass between two that are there already.
                assert!((at.x() - all[0].x()).abs() < 0.01, "{league:?}: {all:?}");
            }
        }
    }

    #[test]
    fn a_penalty_is_taken_from_where_the_referee_wants_the_ball() {
        let mut view = view((-3.0, 2.0), &[], &[]);
        (view.phase, view.next) = (Phase::Stop, Some(Phase::PreparePenalty(Side::Ours)));
        view.placement = Some(Point::new(-1.4, 0.05));
        assert_eq!(penalty_spot(&view, true), Point::new(-1.4, 0.05));
        // No robot needs to keep off the line from the ball to it.
        let between = Point::new(-2.2, 1.0);
        assert_eq!(super::super::off_ball::kept_off(&view, between), between);
    }

    #[test]
    fn behind_a_goal_a_ball_is_out_of_reach_where_no_body_fits() {
        let reach = |league: League, x, y| {
            is_out_of_reach(&View::still(league.field(), Point::new(0.0, 0.0), [], []), Point::new(x, y))
        };
        assert!(reach(League::DivisionB, 4.75, 0.3) && reach(League::DivisionB, -4.75, -0.3));
        assert!(!reach(League::DivisionB, 4.6, 0.3), "in the goal");
        assert!(!reach(League::DivisionB, 4.75, 0.7), "beside it");
        assert!(!reach(League::DivisionA, 6.4, 0.3), "0.4 m of room");
    }
}
