//! `bodies`: the speed that a robot keeps towards other robots: bodies touch slowly. SI, field frame.

use geometry::{Field, Vector, math};
use rules::limits::ROBOT_RADIUS;

use crate::belief::Belief;
use crate::body::omni::DriveMode;

/// `velocity`, slowed towards robots that it would reach too fast: paths take them to keep their velocity,
/// and both may turn towards each other before either has noticed. A robot on its way to the ball goes on to
/// a touch, even if an opponent comes.
#[inline(never)]
pub(super) fn short_of_bodies(
    belief: &Belief,
    mut velocity: Vector<Field>,
    mode: DriveMode,
) -> Vector<Field> {
    let least = if mode == DriveMode::Avoiding { 0.0 } else { CONTESTS_AT };
    for other in &belief.others {
        let off = other.pose.position - belief.pose.position;
        let square = off.dot(off);
        if !(f32::MIN_POSITIVE..=NOTICES * NOTICES).contains(&square) {
            continue;
        }
        // One that is passed beside is no obstacle ahead.
        let relative = velocity - other.velocity;
        let across = off.cross(relative);
        if across * across > PASSES * PASSES * relative.dot(relative) {
            continue;
        }
        let distance = math::sqrt(square);
        let along = off * (1.0 / distance);
        let (own, theirs) = (velocity.dot(along), other.velocity.dot(along));
        let closing = own - theirs;
        let gap = distance - 2.0 * ROBOT_RADIUS - CONTROL_DELAY_S * closing;
        let most = TOUCHES_AT + math::sqrt(2.0 * BOTH_BRAKE * math::max(gap, 0.0));
        // A robot that comes at one that stands has to slow down itself.
        let kept = math::max(most + theirs, least);
        if own > kept {
            velocity += along * (kept - own);
        }
    }
    velocity
}

/// Robots within this distance are slowed for, m: two that close at 3 m/s are a third of a second apart.
const NOTICES: f32 = 1.0;
/// Centres that pass this far apart do not touch, m: two radii, and what positions and directions err by.
const PASSES: f32 = 2.0 * ROBOT_RADIUS + 0.05;
/// Time until an order for the wheels shows, s: cameras, radio and wheels are 0.05 to 0.15 s late.
const CONTROL_DELAY_S: f32 = 0.12;
/// Bodies touch no faster than this, m/s: a crash is a foul above 1.5 (rules), less the errors of velocities.
const TOUCHES_AT: f32 = 1.0;
/// Speed of a robot at the ball, m/s: the faster of two causes a crash, and bodies that close at less than
/// 1.5 m/s do not crash (rules), so that this robot never does.
const CONTESTS_AT: f32 = 0.5;
/// Deceleration down to that, m/s²: what weak brakes do (estimate).
const BOTH_BRAKE: f32 = 2.0;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::belief::Other;
    use crate::skills::wheels::testing::belief;
    use rules::Side;

    const AVOIDING: DriveMode = DriveMode::Avoiding;

    /// The speed towards an opponent `apart` m ahead that comes with `theirs` m/s, of a robot that wants 3.
    fn towards(apart: f32, theirs: f32, mode: DriveMode) -> f32 {
        let mut b = belief((0.0, 0.0, 0.0), (-2.0, 0.0));
        let pose = geometry::Pose::from_mm_deg(apart * 1000.0, 0.0, 0.0);
        let _ = b.others.push(Other {
            side: Side::Theirs,
            id: protocol::RobotId::ZERO,
            pose,
            velocity: Vector::new(-theirs, 0.0),
        });
        short_of_bodies(&b, Vector::new(3.0, 0.5), mode).x()
    }

    #[test]
    fn a_robot_slows_before_another_and_not_for_one_that_it_follows() {
        assert_eq!(towards(1.2, 0.0, AVOIDING), 3.0, "far away");
        assert!(
            towards(0.6, 0.0, AVOIDING) < 2.1 && towards(0.2, 0.0, AVOIDING) <= 1.0,
            "{}",
            towards(0.6, 0.0, AVOIDING)
        );
        assert!(towards(0.6, 2.0, AVOIDING) < 0.1, "head on it brakes: {}", towards(0.6, 2.0, AVOIDING));
        assert!(towards(0.3, 3.0, AVOIDING) >= 0.0, "and does not flee");
        assert_eq!(towards(0.4, -3.0, AVOIDING), 3.0, "it follows as fast as the other drives");
        assert!(
            (towards(0.3, 2.0, DriveMode::Bold) - 0.5).abs() < 0.01,
            "to a ball it goes on, slower than who comes"
        );
    }
}
