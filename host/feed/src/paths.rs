//! `paths`: planned paths of robots. As the motion of its own body plans it, step by step, around what its
//! host sees and out of where the rules forbid it; other robots are assumed to keep their velocity. Robots do
//! not send their plans, so this is the host's estimate of them. m, s, field frame.

use brain::body::omni::LIMITS;
use geometry::{Field, GoalEnd, Point};
use host::world::{Robot, World};
use motion::avoid::{Carried, Course, EFFORT_MAX, OBSTACLES_MAX, Obstacle, plan};
use page::milli;
use rules::keep_out::{Situation, keep_out};
use rules::limits::ROBOT_RADIUS;
use rules::{Colour, FieldSpec, Phase, RuleRole};

/// Time from one point of a path to the next, s.
const STEP_S: f32 = 0.1;
/// Points of a path: what is farther is a straight line.
const POINTS_MAX: usize = 15;
/// A path ends this near its goal, m.
const ARRIVED_WITHIN_M: f32 = 0.03;
/// Least distance between bodies, and added to the rules' distances, m: as the robot's own.
const MARGIN_M: f32 = 0.03;

pub(super) struct Paths<'a> {
    pub(super) world: &'a World,
    pub(super) phase: Phase<Colour>,
    pub(super) placement: Option<Point<Field>>,
    pub(super) field: &'a FieldSpec,
    pub(super) own: GoalEnd,
}

impl Paths<'_> {
    /// Path from the robot's position to `to`.
    pub(super) fn to(&self, robot: &Robot, to: [f32; 2], rule_role: RuleRole) -> Vec<[f32; 2]> {
        let to = Point::<Field>::new(to[0], to[1]);
        let rules = keep_out(&Situation {
            field: self.field,
            own: self.own,
            phase: self.phase.seen_by(robot.who.colour),
            rule_role,
            ball: self.world.ball.map(|ball| ball.position),
            placement: self.placement,
            ball_in_play: true,
        });
        let regions = rules.forbidden.iter().map(|region| region.shape.grown(ROBOT_RADIUS + MARGIN_M));
        let mut obstacles: Vec<_> = regions.map(Obstacle::region).collect();
        let standing = obstacles.len();
        let others = self.world.robots().filter(|other| other.who != robot.who);
        let disc = 2.0 * ROBOT_RADIUS + MARGIN_M;
        obstacles.extend(others.map(|other| Obstacle::robot(other.pose.position, other.velocity, disc)));
        obstacles.truncate(OBSTACLES_MAX);
        let (mut from, mut velocity) = (robot.pose.position, robot.velocity);
        let mut points = vec![from];
        let mut carried = Carried::default();
        for _ in 0..POINTS_MAX {
            let within = Some(rules.within.grown(-ROBOT_RADIUS));
            let course = Course {
                from,
                velocity,
                to,
                limits: LIMITS,
                obstacles: &obstacles,
                within,
                straight_on: false,
                step: STEP_S,
                effort: EFFORT_MAX,
            };
            let path = plan(&course, &mut carried);
            (from, velocity) = (path.next.position, path.next.velocity);
            points.push(from);
            if from.distance(path.goal) < ARRIVED_WITHIN_M {
                break;
            }
            for other in &mut obstacles[standing..] {
                other.shape = moved(other.shape, other.velocity * STEP_S);
            }
        }
        if from.distance(to) > ARRIVED_WITHIN_M {
            points.push(to);
        }
        points.into_iter().map(|at| [milli(at.x()), milli(at.y())]).collect()
    }
}

/// A disc, displaced by `by`.
fn moved(shape: geometry::Shape<Field>, by: geometry::Vector<Field>) -> geometry::Shape<Field> {
    match shape {
        geometry::Shape::Disc { center, radius } => geometry::Shape::Disc { center: center + by, radius },
        other => other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::{Angle, Pose, Vector};
    use protocol::{Instant, RobotId, Who};
    use rules::League;

    fn robot(colour: Colour, at: [f32; 2]) -> Robot {
        Robot {
            who: Who { colour, id: RobotId::ZERO },
            pose: Pose { position: Point::new(at[0], at[1]), heading: Angle::ZERO },
            velocity: Vector::default(),
            angular: 0.0,
            confidence: 1.0,
            seen: Instant(0),
        }
    }

    fn path(others: &[[f32; 2]], to: [f32; 2]) -> Vec<[f32; 2]> {
        let field = League::DivisionB.field();
        let mut world = World::default();
        let own = robot(Colour::Blue, [0.0, 0.0]);
        world.put(own);
        for at in others {
            world.put(robot(Colour::Yellow, *at));
        }
        let (phase, own_goal) = (Phase::Run, GoalEnd::Negative);
        let paths = Paths { world: &world, phase, placement: None, field: &field, own: own_goal };
        paths.to(&own, to, RuleRole::Player)
    }

    #[test]
    fn a_free_way_is_straight_and_ends_there() {
        let path = path(&[[1.0, 2.0]], [1.0, 0.0]);
        assert!(path.iter().all(|[_, y]| y.abs() < 1e-3), "{path:?}");
        let [x, _] = *path.last().unwrap();
        assert!((x - 1.0).abs() < ARRIVED_WITHIN_M && path.len() > 5, "{path:?}");
    }

    #[test]
    fn a_way_leads_around_whoever_stands_in_it() {
        let path = path(&[[0.8, 0.02]], [1.6, 0.0]);
        let nearest = path.iter().map(|[x, y]| ((x - 0.8).powi(2) + (y - 0.02).powi(2)).sqrt());
        assert!(nearest.fold(f32::INFINITY, f32::min) > 2.0 * ROBOT_RADIUS, "{path:?}");
        assert!(path.iter().any(|[_, y]| y.abs() > 0.15), "{path:?}");
    }

    #[test]
    fn a_way_that_takes_longer_than_is_looked_ahead_goes_on_straight() {
        let path = path(&[], [4.0, 0.0]);
        assert_eq!((path.len(), *path.last().unwrap()), (POINTS_MAX + 2, [4.0, 0.0]));
    }
}
