//! `roles`: role assignment. Few, clear roles, held until a change is worth it, so that no robot turns round
//! twice a second.
//!
//! First the robot that plays the ball (soonest there), then the defenders (nearest to their places); the
//! remaining ones are field players. Robots that play a case stay field players until it ends. A robot leaves
//! a role only for a gain of [`WORTH`].

use geometry::{Attack, Point};
use protocol::RobotId;
use rules::RobotSpec;

use super::view::{View, ViewRobot};

/// Time by which another robot must be there sooner to take over a role, s: the time in which a robot brakes
/// and turns.
pub const WORTH: f32 = 0.4;
/// Speed of a moving robot, m/s.
const TYPICAL_SPEED: f32 = RobotSpec::OURS.assumed.role.speed;
/// Acceleration of a moving robot, m/s².
const TYPICAL_ACCELERATION: f32 = RobotSpec::OURS.assumed.role.acceleration;
/// Time lost in speeding up and braking, s: v/a with the two above.
const SPEEDING_UP_S: f32 = 0.65;

/// The robots that have the roles, held until a change is worth it.
#[derive(Clone, Debug, Default)]
pub(super) struct RoleMemory {
    /// Goes for the ball, or takes our restart.
    pub(super) ball_player: Option<RobotId>,
    /// The primary defenders, by their places.
    pub(super) defenders: [Option<RobotId>; 2],
    /// All other robots that got a place in order, by that place: at most all field players, as behind a
    /// penalty of the opponents.
    pub(super) placed: [Option<RobotId>; 10],
}

/// Estimated time until `robot` could be at `place`, s: at its top speed, after the time it needs to get
/// there.
pub fn time_to(robot: &ViewRobot, place: Point<Attack>) -> f32 {
    let offset = place - robot.position;
    let distance = offset.norm();
    let closing = offset.unit().map_or(0.0, |along| robot.velocity.dot(along));
    // From the closing speed with constant acceleration: time gained, or time lost in turning back.
    (distance / TYPICAL_SPEED + SPEEDING_UP_S - closing / TYPICAL_ACCELERATION).max(0.0)
}

/// The robot of `robots` with the least `cost`; `held` is kept unless another one is better by more than
/// `worth`.
pub fn choose<'r>(
    robots: impl Iterator<Item = &'r ViewRobot>,
    held: Option<RobotId>,
    worth: f32,
    cost: impl Fn(&ViewRobot) -> f32,
) -> Option<(RobotId, f32)> {
    let mut best: Option<(RobotId, f32)> = None;
    let mut kept = None;
    for robot in robots {
        let cost = cost(robot);
        if held == Some(robot.id) {
            kept = Some((robot.id, cost));
        }
        if best.is_none_or(|(_, least)| cost < least) {
            best = Some((robot.id, cost));
        }
    }
    match (kept, best) {
        (Some(kept), Some(best)) if kept.1 <= best.1 + worth => Some(kept),
        _ => best,
    }
}

/// Gives each of `places` to one of `free`, in their order, nearest first; `held` lists which robot had which
/// place.
///
/// Returns the robot of place i; removes those robots from `free`.
pub fn assign<const N: usize>(
    view: &View,
    free: &mut heapless::Vec<RobotId, { super::view::ROBOTS_MAX }>,
    places: &[Point<Attack>],
    held: &[Option<RobotId>; N],
) -> [Option<RobotId>; N] {
    let mut taken = [None; N];
    for (i, place) in places.iter().enumerate().take(N) {
        let robots = view.ours.iter().filter(|robot| free.contains(&robot.id));
        let chosen = choose(robots, held[i], WORTH * TYPICAL_SPEED, |robot| robot.position.distance(*place));
        if let Some((id, _)) = chosen {
            free.retain(|other| *other != id);
            taken[i] = Some(id);
        }
    }
    taken
}

#[cfg(test)]
mod tests {
    use super::super::view::tests::view;
    use super::*;

    #[test]
    fn a_role_is_held_until_another_robot_gains_enough() {
        let view = view((0.0, 0.0), &[(1.0, 0.0), (0.9, 0.0)], &[]);
        let id = |n| RobotId::new(n);
        let cost = |robot: &ViewRobot| robot.position.distance(Point::new(0.0, 0.0));
        assert_eq!(choose(view.ours.iter(), None, 0.3, cost).unwrap().0, id(1).unwrap());
        assert_eq!(choose(view.ours.iter(), id(0), 0.3, cost).unwrap().0, id(0).unwrap());
        assert_eq!(choose(view.ours.iter(), id(0), 0.05, cost).unwrap().0, id(1).unwrap());
        assert_eq!(
            choose(view.ours.iter(), id(7), 0.3, cost).unwrap().0,
            id(1).unwrap(),
            "gone from the field"
        );
    }

    #[test]
    fn every_place_gets_one_robot_and_no_robot_two_places() {
        let view = view((0.0, 0.0), &[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)], &[]);
        let mut free = view.ours.iter().map(|robot| robot.id).collect();
        let places = [Point::new(1.9, 0.0), Point::new(2.1, 0.0)];
        let taken = assign::<2>(&view, &mut free, &places, &[None; 2]);
        assert_eq!(taken.map(|id| id.unwrap().number()), [2, 1]);
        assert_eq!(free.len(), 1);
    }
}
