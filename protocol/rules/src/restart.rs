//! `restart`: restart positions of ball and robots, by the rules of 2026, chapters "referee commands" and
//! "ball leaves the field". Field frame, m.

use geometry::{Field, GoalEnd, Point, math};
use heapless::Vec;

use crate::legality::{BoundaryLine, Crossing};
use crate::limits::{
    BALL_DISTANCE, BALL_STILL, PLACEMENT_CLEARANCE, PLACEMENT_SKIP_AREA_DISTANCE, PLACEMENT_SKIP_DISTANCE,
    PLACEMENT_TOLERANCE, ROBOT_RADIUS, ROBOTS_MAX,
};
use crate::{FieldSpec, Limits};

/// Throw-in and corner lie this far from their lines, m.
const FROM_LINE: f32 = 0.2;
/// A spot that is invalid by at most this counts as valid, m: places on the wire are whole millimetres.
const SPOT_TOLERANCE: f32 = 1e-3;
/// Steps along the border of the valid places, m, before the search halves them.
const SPOT_STEP: f32 = 0.01;
/// Number of halvings of the last step: 10 mm / 2¹⁰ is a hundredth of a millimetre.
const SPOT_HALVINGS: usize = 10;

/// Reason why a spot is invalid for a free kick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SpotFault {
    /// Too near to a touch line or goal line, or beyond it.
    Line {
        /// Distance inside the nearest line, m.
        distance: f32,
    },
    /// Too near to this end's defence area.
    Area {
        /// Goal whose area it is.
        goal: GoalEnd,
        /// Distance from it, m.
        distance: f32,
    },
}

/// Reason why a free kick may not be taken here; `None` if it may.
pub fn free_kick_fault(field: &FieldSpec, limits: &Limits, spot: Point<Field>) -> Option<SpotFault> {
    let inside = (field.length * 0.5 - spot.x().abs()).min(field.width * 0.5 - spot.y().abs());
    if inside < limits.spot_line_distance - SPOT_TOLERANCE {
        return Some(SpotFault::Line { distance: inside });
    }
    [GoalEnd::Negative, GoalEnd::Positive].into_iter().find_map(|goal| {
        let distance = field.distance_to_area(goal, spot);
        let near = distance < limits.spot_area_distance - SPOT_TOLERANCE;
        near.then_some(SpotFault::Area { goal, distance })
    })
}

/// The valid place for a free kick nearest to its intended spot. On a field with no valid place at all: the
/// nearest one inside the lines.
pub fn nearest_free_kick_spot(field: &FieldSpec, limits: &Limits, wanted: Point<Field>) -> Point<Field> {
    let inside = field.clamp(wanted, limits.spot_line_distance);
    let valid = |spot: &Point<Field>| free_kick_fault(field, limits, *spot).is_none();
    // Valid places are a rectangle with two cut-outs. The nearest one is inside, on the rectangle's border or
    // on a cut-out's.
    let on_bites = [GoalEnd::Negative, GoalEnd::Positive]
        .into_iter()
        .flat_map(|goal| pushed_out(field, goal, limits.spot_area_distance, wanted));
    let on_border = border_spots(field, limits.spot_line_distance, inside, &valid);
    let mut best: Option<(f32, Point<Field>)> = None;
    for spot in [inside].into_iter().chain(on_bites).chain(on_border).filter(&valid) {
        let distance = spot.distance(wanted);
        if best.is_none_or(|(least, _)| distance < least) {
            best = Some((distance, spot));
        }
    }
    best.map_or(inside, |(_, spot)| spot)
}

/// The points at `away` from each part of a defence area, nearest to `p`.
fn pushed_out(
    field: &FieldSpec,
    goal: GoalEnd,
    away: f32,
    p: Point<Field>,
) -> impl Iterator<Item = Point<Field>> {
    use geometry::Shape::{Box, Capsule, Disc};
    let mut spots: Vec<Point<Field>, 8> = Vec::new();
    for shape in field.defence_area(goal) {
        match shape {
            Disc { center, radius } => {
                spots.extend((p - center).unit().map(|to| center + to * (radius + away)));
            }
            Capsule { .. } => {}
            Box { low, high } => {
                let core =
                    Point::new(math::clamp(p.x(), low.x(), high.x()), math::clamp(p.y(), low.y(), high.y()));
                match (p - core).unit() {
                    Some(to) => spots.extend([core + to * away]),
                    None => spots.extend([
                        Point::new(low.x() - away, p.y()),
                        Point::new(high.x() + away, p.y()),
                        Point::new(p.x(), low.y() - away),
                        Point::new(p.x(), high.y() + away),
                    ]),
                }
            }
        }
    }
    spots.into_iter()
}

/// On each side of the rectangle `inside` the lines, and in each direction from the point next to `from`: the
/// first valid place.
fn border_spots(
    field: &FieldSpec,
    inside: f32,
    from: Point<Field>,
    valid: &impl Fn(&Point<Field>) -> bool,
) -> impl Iterator<Item = Point<Field>> {
    let (x, y) = (field.length * 0.5 - inside, field.width * 0.5 - inside);
    let mut spots: Vec<Point<Field>, 8> = Vec::new();
    for (along_x, fixed, start, end) in
        [(true, y, from.x(), x), (true, -y, from.x(), x), (false, x, from.y(), y), (false, -x, from.y(), y)]
    {
        let at = |t: f32| if along_x { Point::new(t, fixed) } else { Point::new(fixed, t) };
        for sign in [-1.0_f32, 1.0] {
            let steps = ((end * 2.0) / SPOT_STEP) as u32 + 1;
            let place = |i: u32| math::clamp(start + sign * SPOT_STEP * i as f32, -end, end);
            let Some(first) = (0..=steps).find(|i| valid(&at(place(*i)))) else { continue };
            let (mut bad, mut good) = (place(first.saturating_sub(1)), place(first));
            for _ in 0..SPOT_HALVINGS {
                let middle = (bad + good) * 0.5;
                if valid(&at(middle)) { good = middle } else { bad = middle }
            }
            spots.extend([at(good)]);
        }
    }
    spots.into_iter()
}

/// Restart after the ball has left the field without a goal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AfterOut {
    /// Kind of restart; each is a free kick for the team that did not touch the ball last.
    pub kind: OutKind,
    /// Spot of the restart, m.
    pub spot: Point<Field>,
}

/// Kind of restart after a ball that left the field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OutKind {
    /// Over a touch line.
    ThrowIn,
    /// Over the goal line of the team that did not touch it last.
    GoalKick,
    /// Over the goal line of the team that touched it last.
    Corner,
    /// Over the other goal line from the own half, without another touch (division B).
    AimlessKick,
}

/// Restart after the ball crossed a line; `own` is the goal of the team that touched it last, `kicked_from`
/// the place of that touch, none for the kick-off itself.
pub fn after_out(
    field: &FieldSpec,
    limits: &Limits,
    crossing: Crossing,
    own: GoalEnd,
    kicked_from: Option<Point<Field>>,
) -> AfterOut {
    let (x, y) = (field.length * 0.5 - FROM_LINE, field.width * 0.5 - FROM_LINE);
    let touch_line = |at: f32| if at < 0.0 { -y } else { y };
    match crossing.line {
        BoundaryLine::Touch { positive } => {
            let spot = Point::new(math::clamp(crossing.at.x(), -x, x), if positive { y } else { -y });
            AfterOut { kind: OutKind::ThrowIn, spot }
        }
        BoundaryLine::Goal(goal) | BoundaryLine::GoalOpening(goal) if goal == own => {
            let spot = Point::new(x * goal.sign() as f32, touch_line(crossing.at.y()));
            AfterOut { kind: OutKind::Corner, spot }
        }
        BoundaryLine::Goal(goal) | BoundaryLine::GoalOpening(goal) => {
            let aimless = kicked_from.filter(|from| {
                // The place of the last touch decides: from the own half it has crossed the halfway line
                // since.
                limits.aimless_kick && from.x() * own.sign() as f32 > 0.0
            });
            if let Some(from) = aimless {
                let spot = nearest_free_kick_spot(field, limits, from);
                return AfterOut { kind: OutKind::AimlessKick, spot };
            }
            let x = field.goal_line(goal) - goal.sign() as f32 * limits.goal_kick_distance;
            AfterOut { kind: OutKind::GoalKick, spot: Point::new(x, touch_line(crossing.at.y())) }
        }
    }
}

/// Continuation after the placement of a ball.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AfterPlacement {
    /// The placing team's free kick.
    FreeKick,
    /// A force start, for both teams.
    ForceStart,
}

impl AfterPlacement {
    /// Distance of robots' edges from the placed ball, m.
    pub const fn clearance(self) -> f32 {
        match self {
            Self::FreeKick => PLACEMENT_CLEARANCE,
            Self::ForceStart => BALL_DISTANCE,
        }
    }
}

/// Condition that a placement does not meet yet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PlacementLack {
    /// The ball is this far from its target, m.
    Distance(f32),
    /// The ball moves, m/s.
    Moving(f32),
    /// A robot's side is this near to the ball, m.
    Robot(f32),
}

/// Reason why the ball is not placed yet; time (at least 2 s, at most 30 s) is the caller's.
pub fn placement_lack(
    ball: Point<Field>,
    speed: f32,
    target: Point<Field>,
    robots: impl IntoIterator<Item = Point<Field>>,
    next: AfterPlacement,
) -> Option<PlacementLack> {
    let distance = ball.distance(target);
    if distance > PLACEMENT_TOLERANCE {
        return Some(PlacementLack::Distance(distance));
    }
    if speed > BALL_STILL {
        return Some(PlacementLack::Moving(speed));
    }
    let nearest = robots.into_iter().map(|robot| robot.distance(ball) - ROBOT_RADIUS).reduce(f32::min);
    nearest.filter(|near| *near < next.clearance()).map(PlacementLack::Robot)
}

/// Returns whether the ball lies well enough that no placement is needed.
pub fn placement_needless(field: &FieldSpec, ball: Point<Field>, speed: f32, target: Point<Field>) -> bool {
    let areas = [GoalEnd::Negative, GoalEnd::Positive].map(|goal| field.distance_to_area(goal, ball));
    ball.distance(target) < PLACEMENT_SKIP_DISTANCE
        && field.contains(ball)
        && areas.iter().all(|distance| *distance >= PLACEMENT_SKIP_AREA_DISTANCE)
        && speed <= BALL_STILL
}

/// Rule-compliant places for a team's kick-off: the keeper in its goal, then the robot nearest to the ball
/// (the kicker, behind it, if the kick-off is ours), then the others behind it, the nearest to the ball
/// first.
pub fn kickoff_places(field: &FieldSpec, own: GoalEnd, ours: bool) -> Vec<Point<Field>, ROBOTS_MAX> {
    let back = own.sign() as f32;
    let (half, side) = (field.length * 0.5, field.width * 0.5);
    // Shares of the distance from the centre to the own goal line, and of that to the touch line; no robot in
    // the circle or the area.
    const SHARES: [(f32, f32); ROBOTS_MAX - 2] = [
        (0.15, 0.5),
        (0.15, -0.5),
        (0.45, 0.15),
        (0.45, -0.15),
        (0.3, 0.75),
        (0.3, -0.75),
        (0.45, 0.45),
        (0.45, -0.45),
        (0.3, 0.0),
    ];
    let ball_to_kicker = 0.25;
    let circle = field.center_radius + 2.0 * ROBOT_RADIUS;
    let nearest = if ours { ball_to_kicker } else { circle };
    let mut places: Vec<Point<Field>, ROBOTS_MAX> = Vec::new();
    let keeper = Point::new(back * (half - 2.0 * ROBOT_RADIUS), 0.0);
    places.extend([keeper, Point::new(back * nearest, 0.0)]);
    places.extend(SHARES.map(|(x, y)| Point::new(back * (x * half).max(circle), y * side)));
    places
}

#[cfg(test)]
mod tests;
