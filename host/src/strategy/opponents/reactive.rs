//! `reactive`: opponent team of ball chasers. The nearest robot goes for the ball and shoots, or kicks it
//! ahead; a second backs it up, a third waits in front, the others defend. No robot passes on purpose. Attack
//! frame, m.

use geometry::{Attack, Point, Vector};
use protocol::RobotId;

use super::{Place, Places, Style, defenders, free_places};
use crate::strategy::order::{OrderReason, Role};
use crate::strategy::support::{Target, best_shot};
use crate::strategy::view::{View, ViewBall};

pub(super) const STYLE: Style = Style { target: shoot_or_clear, places, keeps_places_at_free_kicks: false };
/// Farther shots are not tried, m.
const SHOT_LENGTH_MAX_M: f32 = 4.0;
/// Distance to the stop position of a clearance, m: as far as the kicker is the first at it again.
const CLEAR_LENGTH_M: f32 = 2.0;
/// A clearance goes from the wing to the middle by this share of its distance.
const CLEAR_INWARD_SHARE: f32 = 0.5;
/// The second stays this far behind the ball, m: where a ball lost by the first stops.
const SECOND_BEHIND_M: f32 = 0.9;

/// A shot where one is worth it, else ahead along the freest path: the robot then follows its own ball.
pub(super) fn shoot_or_clear(view: &View, _robot: RobotId, ball: Point<Attack>) -> Target {
    let (at, room) = best_shot(view, ball);
    if ball.distance(view.their_goal()) < SHOT_LENGTH_MAX_M {
        return Target::Shot { at, room };
    }
    let ahead = |y: f32| {
        let at = view.clamp(Point::new(ball.x() + CLEAR_LENGTH_M, ball.y() * CLEAR_INWARD_SHARE + y), 0.5);
        (at, view.room_along(ball, at))
    };
    let (at, room) = [1.0, -1.0]
        .map(ahead)
        .into_iter()
        .fold(ahead(0.0), |best, next| if next.1 > best.1 { next } else { best });
    Target::Ahead { at, room }
}

fn places(view: &View, ball: &ViewBall, wanted: usize) -> Places {
    let home = (view.our_goal() - ball.position).unit().unwrap_or(Vector::new(-1.0, 0.0));
    let second: Place = (
        ball.position + home * SECOND_BEHIND_M,
        Role::Support(0),
        OrderReason::OnBallLine { y: view.our_goal().y() },
    );
    let [near, far] = defenders(view);
    [second, near]
        .into_iter()
        .chain(free_places(view, ball, 1))
        .chain([far])
        .chain(free_places(view, ball, wanted))
        .take(wanted)
        .collect()
}
