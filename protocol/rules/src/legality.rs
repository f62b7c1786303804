//! `legality`: predicates of offences for an automatic referee, each with its rule (2026), without state.
//!
//! Distances from a robot are measured from its nearest side with an assumed radius of 0.09 m. Lines belong
//! to the areas and the field that they bound, so those are left over a line's outer edge. Field frame, m,
//! m/s.

use geometry::{Field, GoalEnd, Point, Segment, Vector, math};

use crate::limits::{
    BALL_DISTANCE, BALL_RADIUS, CRASH_DRAWN, CRASH_SPEED, GOAL_BALL_HEIGHT, IN_PLAY_DISTANCE,
    OPPONENT_AREA_DISTANCE, ROBOT_RADIUS, STOP_SPEED,
};
use crate::{FieldSpec, Limits};

/// A line of the field that a ball can leave by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BoundaryLine {
    /// A touch line: the one at +y, or the one at −y.
    Touch {
        /// True for the line at +y.
        positive: bool,
    },
    /// A goal line beside the goal.
    Goal(GoalEnd),
    /// A goal line between the posts.
    GoalOpening(GoalEnd),
}

/// Position and line where a ball left the field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// Line that was crossed.
    pub line: BoundaryLine,
    /// The point of that line where the ball's centre crossed it.
    pub at: Point<Field>,
}

/// Share of a path at which its coordinate crosses a line at ±`limit`; `None` where it does not end beyond
/// it.
fn share_to_line(start: f32, motion: f32, end: f32, limit: f32) -> Option<f32> {
    let crossed = end.abs() > limit && motion != 0.0;
    crossed.then(|| (((if end < 0.0 { -limit } else { limit }) - start) / motion).clamp(0.0, 1.0))
}

/// Distance of the ball's centre beyond a line's centre when the whole ball is over the whole line, m.
fn beyond(field: &FieldSpec) -> f32 {
    BALL_RADIUS + field.line_width * 0.5
}

/// Returns whether all of the ball is over a line ("fully crossing the field line"; ball leaves the field).
pub fn ball_is_out(field: &FieldSpec, ball: Point<Field>) -> bool {
    let over = beyond(field);
    ball.x().abs() > field.length * 0.5 + over || ball.y().abs() > field.width * 0.5 + over
}

/// The line that the ball crossed between two observations, the second of which is out; `None` while it is
/// in.
///
/// A ball whose centre was beyond a line's centre before is taken to have come over the nearest line,
/// straight: at most a ball's radius off.
pub fn crossing(field: &FieldSpec, before: Point<Field>, now: Point<Field>) -> Option<Crossing> {
    if !ball_is_out(field, now) {
        return None;
    }
    let (x, y) = (field.length * 0.5, field.width * 0.5);
    let from = if field.contains(before) { before } else { field.clamp(now, 0.0) };
    let (dx, dy) = (now.x() - from.x(), now.y() - from.y());
    let over_goal_line = share_to_line(from.x(), dx, now.x(), x);
    let over_touch_line = share_to_line(from.y(), dy, now.y(), y);
    let goal_first = match (over_goal_line, over_touch_line) {
        (Some(goal), Some(touch)) => goal <= touch,
        (goal, _) => goal.is_some(),
    };
    if goal_first {
        let goal = if now.x() < 0.0 { GoalEnd::Negative } else { GoalEnd::Positive };
        let at = Point::new(field.goal_line(goal), from.y() + dy * over_goal_line.unwrap_or(1.0));
        let is_opening = at.y().abs() < field.goal_width * 0.5;
        let line = if is_opening { BoundaryLine::GoalOpening(goal) } else { BoundaryLine::Goal(goal) };
        Some(Crossing { line, at })
    } else {
        let positive = now.y() > 0.0;
        let at = Point::new(from.x() + dx * over_touch_line.unwrap_or(1.0), if positive { y } else { -y });
        Some(Crossing { line: BoundaryLine::Touch { positive }, at })
    }
}

/// Reason why a ball in the goal is no goal (scoring goals).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NoGoal {
    /// The scorers had more robots on the field than they may.
    TooManyRobots,
    /// The ball was higher than 0.15 m after their last touch.
    Height(f32),
    /// The scorers committed a foul that did not stop the game at most 2 s before.
    Foul,
}

/// Reason why a ball in the goal does not count, if any: `height` is the greatest since the scorers' last
/// touch, m (the ball's lower side where it is known, else its centre), `since_foul` the time since their
/// last foul that did not stop the game, s.
pub fn no_goal(robots: u32, robots_allowed: u32, height: f32, since_foul: Option<f32>) -> Option<NoGoal> {
    if robots > robots_allowed {
        Some(NoGoal::TooManyRobots)
    } else if height > GOAL_BALL_HEIGHT {
        Some(NoGoal::Height(height))
    } else {
        since_foul.filter(|time| *time < crate::limits::GOAL_AFTER_FOUL).map(|_| NoGoal::Foul)
    }
}

/// Share of a robot in a defence area.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum InArea {
    /// No part of it.
    Out,
    /// A part of the robot.
    Partly,
    /// The whole robot is in the area.
    Entirely,
}

/// Share of a robot with its centre here that is in the defence area at that end, lines included; a robot
/// behind the goal line is out.
pub fn in_area(field: &FieldSpec, goal: GoalEnd, robot: Point<Field>) -> InArea {
    let behind = (robot.x() - field.goal_line(goal)) * goal.sign() as f32;
    let edge = field.line_width * 0.5;
    let distance = field.distance_to_area(goal, robot) - edge;
    if behind >= ROBOT_RADIUS || distance > ROBOT_RADIUS {
        InArea::Out
    } else if behind <= -ROBOT_RADIUS + edge && distance <= -ROBOT_RADIUS {
        InArea::Entirely
    } else {
        // Within a robot's width of the goal line a robot may extend beyond it, but the part on the field may
        // all be inside.
        let on_field = Point::new(
            math::clamp(robot.x(), -field.length * 0.5 + ROBOT_RADIUS, field.length * 0.5 - ROBOT_RADIUS),
            robot.y(),
        );
        let rest = field.distance_to_area(goal, on_field) - edge;
        if behind > -ROBOT_RADIUS + edge && rest <= -ROBOT_RADIUS { InArea::Entirely } else { InArea::Partly }
    }
}

/// Distance from the robot's edge to the ball's centre, m.
pub fn ball_distance(robot: Point<Field>, ball: Point<Field>) -> f32 {
    robot.distance(ball) - ROBOT_RADIUS
}

/// Too close to the ball on STOP, or at the opponents' kick-off or free kick.
pub fn too_close_to_ball(robot: Point<Field>, ball: Point<Field>) -> bool {
    ball_distance(robot, ball) < BALL_DISTANCE
}

/// Too close to the opponents' defence area on STOP or at a free kick.
pub fn too_close_to_area(field: &FieldSpec, opponents: GoalEnd, robot: Point<Field>) -> bool {
    let edge = field.line_width * 0.5;
    field.distance_to_area(opponents, robot) - edge - ROBOT_RADIUS < OPPONENT_AREA_DISTANCE
}

/// Interferes with the opponents' placement: within 0.5 m of the line from the ball to its target.
pub fn interferes(robot: Point<Field>, ball: Point<Field>, target: Point<Field>) -> bool {
    Segment::new(ball, target).distance_to(robot) - ROBOT_RADIUS < BALL_DISTANCE
}

/// Too fast on STOP.
pub fn too_fast_in_stop(velocity: Vector<Field>) -> bool {
    velocity.norm() > STOP_SPEED
}

/// The ball was kicked too fast, `speed` in three dimensions, m/s.
pub fn kicked_too_fast(limits: &Limits, speed: f32) -> bool {
    speed > limits.ball_speed
}

/// The ball was dribbled too far from where the contact started.
pub fn dribbled_too_far(limits: &Limits, from: Point<Field>, ball: Point<Field>) -> bool {
    from.distance(ball) > limits.dribble
}

/// The kicker touches the ball a second time: no other robot has touched it since, and it had moved 0.05 m
/// from its place.
pub fn double_touch(place: Point<Field>, ball: Point<Field>, touched_by_other: bool) -> bool {
    !touched_by_other && place.distance(ball) >= IN_PLAY_DISTANCE
}

/// Team that is responsible for a collision.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Blame {
    /// The team of the first robot.
    First,
    /// The team of the second robot.
    Second,
    /// Both: they were about equally fast.
    Both,
}

/// A collision that was too fast.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crash {
    /// Team that commits the foul.
    pub blame: Blame,
    /// Speed difference along the line between the robots, m/s.
    pub speed: f32,
    /// Speed of the first minus speed of the second, m/s.
    pub difference: f32,
}

/// Judges the collision of two robots of different teams with these places and velocities.
pub fn crash(first: (Point<Field>, Vector<Field>), second: (Point<Field>, Vector<Field>)) -> Option<Crash> {
    let towards = (second.0 - first.0).unit()?;
    let speed = (first.1 - second.1).dot(towards).abs();
    if speed <= CRASH_SPEED {
        return None;
    }
    let difference = first.1.norm() - second.1.norm();
    let blame = if difference.abs() < CRASH_DRAWN {
        Blame::Both
    } else if difference > 0.0 {
        Blame::First
    } else {
        Blame::Second
    };
    Some(Crash { blame, speed, difference })
}

/// The keeper has turned a penalty's ball by at least 90° (where the scalar product changes its sign), which
/// ends it without a goal.
pub fn turned_back(before: Vector<Field>, after: Vector<Field>) -> bool {
    before.dot(after) <= 0.0 && before.norm() > 0.0
}

#[cfg(test)]
mod tests;
