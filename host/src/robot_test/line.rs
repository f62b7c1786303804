//! `line`: where a test kicks to: along the line from the ball that is longest within the field and free of
//! robots. m, attack frame.

use core::f32::consts::TAU;

use geometry::{Angle, Attack, Point, Vector};
use protocol::RobotId;

use super::step;
use crate::strategy::View;

/// Directions that are tried.
const DIRECTIONS: u8 = 24;
/// The line ends so far before the field's edge, m.
const INSIDE_FIELD_M: f32 = 0.2;
/// Robots are farther off the line, m: a hull, the ball, and what a kick scatters.
const ROBOT_CLEARANCE_M: f32 = 0.3;
/// A ball from which every line is shorter lies at an edge or is surrounded: it goes to the middle, m.
const LINE_LENGTH_MIN_M: f32 = 0.5;
/// Step along the line, m.
const LINE_STEP_M: f32 = 0.1;

/// The end of the longest line; other robots of ours stand, theirs may not.
pub(super) fn longest(view: &View, kicker: RobotId, ball: Point<Attack>) -> Point<Attack> {
    let of = |number: u8| free(view, kicker, ball, TAU * f32::from(number) / f32::from(DIRECTIONS));
    // The first of equal ones, so that the same field gives the same target.
    let best =
        (0..DIRECTIONS).map(of).reduce(|best, next| if next.0 > best.0 + LINE_STEP_M { next } else { best });
    best.filter(|(length, _)| *length > LINE_LENGTH_MIN_M).map_or(Point::new(0.0, 0.0), |(_, to)| to)
}

/// Length of the free line in a direction, and its end.
fn free(view: &View, kicker: RobotId, ball: Point<Attack>, direction: f32) -> (f32, Point<Attack>) {
    let along: Vector<Attack> = Vector::polar(1.0, Angle::new(direction));
    let [half_length, half_width] =
        [view.field.length * 0.5 - INSIDE_FIELD_M, view.field.width * 0.5 - INSIDE_FIELD_M];
    let ours = view.ours.iter().filter(|robot| robot.id != kicker);
    let others: Vec<Point<Attack>> = ours.chain(&view.theirs).map(|robot| robot.position).collect();
    let mut length = LINE_STEP_M;
    loop {
        let at = step(ball, along, length);
        let inside = at.x().abs() < half_length && at.y().abs() < half_width;
        // In defence areas a robot may not fetch it again.
        let areas = view.in_our_area(at, ROBOT_CLEARANCE_M) || view.in_their_area(at, ROBOT_CLEARANCE_M);
        if !inside || areas || others.iter().any(|other| other.distance(at) < ROBOT_CLEARANCE_M) {
            return (length - LINE_STEP_M, at);
        }
        length += LINE_STEP_M;
    }
}
