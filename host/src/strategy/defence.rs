//! `defence`: places of keeper and defenders between ball and goal: the keeper before the goal, defenders at
//! the area's edge (Biswas et al. 2014 §5, its first step). Attack frame, m.

use geometry::{Angle, Attack, Point, Vector};
use protocol::host::KickOrder;

use super::order::{OrderReason, Task};
use super::view::{View, ViewBall, nearest};

/// The keeper's line lies this far before the goal line, m: a body, so that the posts do not stop it.
const KEEPER_OUT_M: f32 = 0.15;
/// A ball slower than this can be kicked without stopping it, m/s.
pub(super) const LYING_SPEED_MAX_M_S: f32 = 0.8;
/// A ball lower than this can be kicked, m: below a robot's height.
pub(super) const GROUND_HEIGHT_MAX_M: f32 = 0.1;
/// Distance of a clearance to the wing ahead of the ball, m.
const CLEAR_AHEAD_M: f32 = 2.5;
/// A clearance from before the area turns from straight out by this much, rad: 30°.
const CLEAR_TURN_RAD: f32 = core::f32::consts::FRAC_PI_6;
/// Distance inside the side line, m.
const CLEAR_INSIDE_M: f32 = 0.6;
/// A clearance to a teammate nearer than this is not tried, m.
const CLEAR_LENGTH_MIN_M: f32 = 1.2;
/// From this room on the ball is kicked along the ground, m: an opponent's reach in the half second that it
/// takes.
const ROOM_FOR_FLAT_M: f32 = 0.35;
/// cm/s, 3-D: at 45° the first hop is v²/g = 1.6 m.
const CLEAR_CHIP_CM_S: u16 = 400;
/// The ball counts as at least this far before our goal line when defenders place themselves, m.
const BALL_AHEAD_MIN_M: f32 = 0.15;
/// Defenders' centres stand this far outside the area, m: a body (0.09) and the error of tracking and
/// control.
pub const EDGE: f32 = 0.13;
/// Each of two defenders stands this far beside the line, m: bodies side by side, with a margin between.
const BESIDE_LINE_M: f32 = 0.105;
/// Opponents beyond this are not marked, m: in their own half.
const MARK_UP_TO_X_M: f32 = 0.5;
/// A marker stands this far from its opponent, m: two bodies and room to brake.
const MARK_OFF_M: f32 = 0.35;
/// An opponent this near the ball plays it: the wall and the defenders cover it, m.
const PLAYS_BALL_WITHIN_M: f32 = 0.4;

/// The line on which the keeper blocks the ball: before the opening of our goal, post to post.
pub fn keeper_line(view: &View) -> Task {
    let (x, half) = (view.our_goal().x() + KEEPER_OUT_M, view.field.goal_width * 0.5);
    Task::Block { from: Point::new(x, -half), to: Point::new(x, half) }
}

/// On the goal line itself, as the rules require at a penalty.
pub fn keeper_on_goal_line(view: &View) -> Task {
    let (x, half) = (view.our_goal().x(), view.field.goal_width * 0.5);
    Task::Block { from: Point::new(x, -half), to: Point::new(x, half) }
}

/// The keeper's task in open play: clears a ball that lies in our area, else guards.
pub fn keeper(view: &View) -> (Task, OrderReason) {
    let Some(ball) = view.ball else { return (keeper_line(view), OrderReason::NoBall) };
    let slow = ball.velocity.norm() < LYING_SPEED_MAX_M_S && ball.height < GROUND_HEIGHT_MAX_M;
    if slow && view.in_our_area(ball.position, 0.0) && ball.position.x() > view.our_goal().x() {
        let (at, kick, room) = clearance(view, &ball);
        return (Task::Kick { at, kick }, OrderReason::ClearsArea { room });
    }
    (keeper_line(view), OrderReason::OnBallLine { y: crossing(view, &ball) })
}

/// Crossing of the ball's path and our goal line, or the ball's line to the middle while it does not come.
fn crossing(view: &View, ball: &ViewBall) -> f32 {
    let (goal, v) = (view.our_goal(), ball.velocity);
    if v.x() < -LYING_SPEED_MAX_M_S {
        ball.position.y() + v.y() * (goal.x() - ball.position.x()) / v.x()
    } else {
        goal.y()
    }
}

/// Target, kick and room of a clearance: to the teammate or the wing with the freest path.
pub fn clearance(view: &View, ball: &ViewBall) -> (Point<Attack>, KickOrder, f32) {
    let wings = [1.0_f32, -1.0].map(|side| {
        Point::new(ball.position.x() + CLEAR_AHEAD_M, side * (view.field.width * 0.5 - CLEAR_INSIDE_M))
    });
    let teammates =
        view.ours.iter().filter(|teammate| teammate.id != view.keeper).map(|teammate| teammate.position);
    let far =
        |at: &Point<Attack>| at.distance(ball.position) > CLEAR_LENGTH_MIN_M && at.x() > ball.position.x();
    let best = teammates
        .filter(far)
        .chain(wings)
        .map(|at| (at, view.room_along(ball.position, at)))
        .reduce(|best, next| if next.1 > best.1 { next } else { best });
    let (at, room) = best.unwrap_or((Point::new(0.0, 0.0), 0.0));
    (at, clearing_kick(ball, at, room), room)
}

/// The same for a ball that lies before our area: away from the goal, so that the keeper approaches it from
/// its goal and stays between the two; turned by up to 30° to where there is room.
pub fn clearance_outwards(view: &View, ball: &ViewBall) -> (Point<Attack>, KickOrder, f32) {
    let out = (ball.position - view.our_goal()).unit().unwrap_or(Vector::new(1.0, 0.0));
    let turned = |turn: f32| {
        let at = ball.position + out.rotated(Angle::new(turn)) * CLEAR_AHEAD_M;
        let at = view.clamp(at, CLEAR_INSIDE_M);
        (at, view.room_along(ball.position, at))
    };
    let best = [CLEAR_TURN_RAD, -CLEAR_TURN_RAD].map(turned);
    let (at, room) =
        best.into_iter().fold(turned(0.0), |best, next| if next.1 > best.1 { next } else { best });
    (at, clearing_kick(ball, at, room), room)
}

/// Rolls to the target, and no farther than the halfway line: a kick across it and over their goal line
/// counts as an aimless kick.
fn clearing_kick(ball: &ViewBall, at: Point<Attack>, room: f32) -> KickOrder {
    let flat = super::support::push_kick(at.distance(ball.position));
    if room > ROOM_FOR_FLAT_M { flat } else { KickOrder::Chip(CLEAR_CHIP_CM_S) }
}

/// Places of two defenders: side by side at the edge of our area, across the line from the ball to our goal.
pub fn defenders(view: &View) -> ([Point<Attack>; 2], OrderReason) {
    let Some(ball) = view.ball else {
        return (
            [at_edge(view, Vector::new(1.0, 0.3)), at_edge(view, Vector::new(1.0, -0.3))],
            OrderReason::NoBall,
        );
    };
    let goal = view.our_goal();
    let mut to_ball = view.clamp(ball.position, 0.0) - goal;
    if to_ball.x() < BALL_AHEAD_MIN_M {
        to_ball = Vector::new(BALL_AHEAD_MIN_M, to_ball.y());
    }
    let edge = Edge::of(view);
    let middle = edge.along(at_edge(view, to_ball));
    // Around a corner of the edge bodies come nearer to each other than along it.
    let mut off = BESIDE_LINE_M;
    while edge.point(middle + off).distance(edge.point(middle - off)) < 2.0 * BESIDE_LINE_M
        && off < 2.0 * BESIDE_LINE_M
    {
        off += 0.01;
    }
    let middle = middle.clamp(off, edge.length() - off);
    (
        [edge.point(middle + off), edge.point(middle - off)],
        OrderReason::OnBallLine { y: crossing(view, &ball) },
    )
}

/// The edge of our area, grown by [`EDGE`]: from the goal line at −y around to the goal line at +y, by its
/// length.
struct Edge {
    goal: Point<Attack>,
    depth: f32,
    half: f32,
}

impl Edge {
    fn of(view: &View) -> Self {
        let (depth, half) = (view.field.penalty_depth + EDGE, view.field.penalty_width * 0.5 + EDGE);
        Self { goal: view.our_goal(), depth, half }
    }

    fn length(&self) -> f32 {
        2.0 * (self.depth + self.half)
    }

    /// Distance along the edge of a point on it, m.
    fn along(&self, p: Point<Attack>) -> f32 {
        let (out, y) = (p.x() - self.goal.x(), p.y());
        if out >= self.depth - 1e-4 {
            self.depth + self.half + y
        } else if y < 0.0 {
            out
        } else {
            self.length() - out
        }
    }

    /// The point that far along the edge.
    fn point(&self, along: f32) -> Point<Attack> {
        let Self { goal, depth, half } = *self;
        if along < depth {
            Point::new(goal.x() + along, -half)
        } else if along < depth + 2.0 * half {
            Point::new(goal.x() + depth, along - depth - half)
        } else {
            Point::new(goal.x() + self.length() - along, half)
        }
    }
}

/// Place where the ray from our goal's middle leaves our area, grown by the distance that keeps a robot
/// outside.
fn at_edge(view: &View, direction: Vector<Attack>) -> Point<Attack> {
    let (depth, half) = (view.field.penalty_depth + EDGE, view.field.penalty_width * 0.5 + EDGE);
    let (x, y) = (direction.x().max(1e-3), direction.y());
    let share = (depth / x).min(if y == 0.0 { f32::INFINITY } else { half / y.abs() });
    view.our_goal() + Vector::new(x, y) * share
}

/// Places between opponents and our goal, for the unmarked opponents nearest to it.
pub fn marks(view: &View) -> heapless::Vec<(Point<Attack>, protocol::RobotId), { super::view::ROBOTS_MAX }> {
    let goal = view.our_goal();
    let danger = |robot: &super::view::ViewRobot| robot.position.distance(goal);
    let mut them: heapless::Vec<_, { super::view::ROBOTS_MAX }> = view
        .theirs
        .iter()
        .filter(|robot| robot.id != view.their_keeper && robot.position.x() < MARK_UP_TO_X_M)
        .filter(|robot| {
            view.ball.is_none_or(|ball| ball.position.distance(robot.position) > PLAYS_BALL_WITHIN_M)
        })
        .collect();
    them.sort_unstable_by(|a, b| danger(a).total_cmp(&danger(b)).then(a.id.cmp(&b.id)));
    let place = |robot: &&super::view::ViewRobot| {
        let home = (goal - robot.position).unit().unwrap_or_default();
        let at = robot.position + home * MARK_OFF_M;
        let out = if view.in_our_area(at, EDGE) { at_edge(view, at - goal) } else { at };
        (out, robot.id)
    };
    them.iter().map(place).collect()
}

/// Whether an opponent could have the ball before time `ours`, s from now.
pub fn contested(view: &View, ours: f32) -> bool {
    let Some(ball) = view.ball else { return false };
    nearest(view.theirs.iter(), ball.rest)
        .is_some_and(|(robot, _)| super::roles::time_to(robot, ball.rest) < ours)
}

#[cfg(test)]
mod tests {
    use super::super::view::tests::view;
    use super::*;

    #[test]
    fn defenders_stand_outside_the_area_on_both_sides_of_the_line_to_the_goal() {
        for ball in [(0.0, 0.0), (-3.0, 2.5), (-4.4, 2.0), (-4.4, -2.9), (2.0, -1.0)] {
            let view = view(ball, &[], &[]);
            let (places, _) = defenders(&view);
            for place in places {
                assert!(!view.in_our_area(place, EDGE - 0.001), "{ball:?}: {place:?}");
                assert!(view.in_our_area(place, EDGE + 0.12), "{ball:?}: {place:?} is at its edge");
            }
            assert!(places[0].distance(places[1]) > 0.18, "{ball:?}: bodies do not touch {places:?}");
        }
        // Straight ahead: 1.13 m before the goal, `BESIDE_LINE_M` to either side.
        let (places, _) = defenders(&view((0.0, 0.0), &[], &[]));
        assert!(
            (places[0].x() + 3.37).abs() < 1e-3 && (places[0].y() - BESIDE_LINE_M).abs() < 1e-2,
            "{places:?}"
        );
    }

    #[test]
    fn the_keeper_clears_what_lies_in_its_area_to_the_freer_side() {
        let view = view((-4.2, 0.3), &[(-4.4, 0.0), (-2.0, 2.0), (-2.0, -2.0)], &[(-3.0, 1.1)]);
        let (task, _) = keeper(&view);
        let Task::Kick { at, kick } = task else { panic!("{task:?}") };
        assert!(at.y() < 0.0 && matches!(kick, KickOrder::Flat(_)), "{at:?}");
    }

    #[test]
    fn a_ball_outside_the_area_is_left_to_the_players() {
        assert!(matches!(keeper(&view((-3.0, 0.0), &[], &[])).0, Task::Block { .. }));
    }

    #[test]
    fn the_opponent_nearest_to_our_goal_is_marked_first_from_the_goals_side() {
        let view = view((3.0, 0.0), &[], &[(4.4, 0.0), (-1.0, 0.0), (-2.0, 1.5), (2.0, 2.0)]);
        let marks = marks(&view);
        assert_eq!(marks.iter().map(|(_, id)| id.number()).collect::<Vec<_>>(), [2, 1]);
        let goal = view.our_goal();
        assert!(marks[0].0.distance(goal) < Point::new(-2.0, 1.5).distance(goal));
    }
}
