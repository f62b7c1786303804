//! `places`: where robots may be taken off and returned, and where robots cannot reach the ball. m, field
//! frame.

use geometry::{Field, GoalEnd, Point, Pose};
use rules::{FieldSpec, limits};

/// In the centre substitution area, with its centre off the field: the rules permit taking a robot that is
/// only partly in, but one that plays beside the touch line has not left.
pub(super) fn beside_halfway_line(field: &FieldSpec, place: Point<Field>) -> bool {
    place.x().abs() <= limits::SUBSTITUTION_REACH && place.y().abs() > field.width * 0.5
}

/// Pose at which a robot of the team that owns `own` is returned: beside the touch line of its half, near the
/// halfway line, where no robot stands and the ball is far enough away. `None` while there is no such
/// position.
pub(super) fn way_in(
    field: &FieldSpec,
    own: GoalEnd,
    ball: Point<Field>,
    others: &[Point<Field>],
) -> Option<Pose<Field>> {
    let y = field.width * 0.5 + field.margin * 0.5;
    // A robot's diameter and a hand's breadth apart, from the end of the area towards the halfway line.
    let steps = [0.85_f32, 0.55, 0.25].map(|share| share * limits::SUBSTITUTION_REACH * own.sign() as f32);
    let mut places = steps.into_iter().flat_map(|x| [Point::new(x, y), Point::new(x, -y)]);
    let place = places.find(|place| {
        place.distance(ball) >= limits::SUBSTITUTION_BALL_DISTANCE + limits::ROBOT_RADIUS
            && others.iter().all(|other| other.distance(*place) >= 2.0 * limits::ROBOT_RADIUS + HAND_BREADTH)
    })?;
    Some(Pose { position: place, heading: place.direction_to(Point::new(place.x(), 0.0)) })
}

/// The position inside the field, nearest to a ball that robots cannot reach, from which they can reach it.
pub(super) fn within_reach(field: &FieldSpec, ball: Point<Field>) -> Point<Field> {
    field.clamp(ball, INTO_THE_FIELD)
}

/// A hand's breadth, m.
const HAND_BREADTH: f32 = 0.1;
/// Distance inside the lines at which a ball is brought back, m: where a throw-in is taken.
const INTO_THE_FIELD: f32 = 0.2;
