//! Beliefs for the tests of skills.

use geometry::{Point, Pose, Vector};
use motion::ball::BallModel;
use rules::League;

use crate::belief::{Belief, BelievedBall};

/// A robot of division B at x, y (m) and a heading (degrees), and a ball that lies.
pub(crate) fn belief(me: (f32, f32, f32), ball: (f32, f32)) -> Belief {
    let mut belief = Belief::new(League::DivisionB);
    belief.pose = Pose::from_mm_deg(me.0 * 1000.0, me.1 * 1000.0, me.2);
    let at = Point::new(ball.0, ball.1);
    belief.ball = Some(BelievedBall { position: at, velocity: Vector::default(), rest: at });
    belief
}

/// The same, with the ball rolling.
pub(crate) fn rolling(mut belief: Belief, velocity: (f32, f32)) -> Belief {
    if let Some(ball) = &mut belief.ball {
        ball.velocity = Vector::new(velocity.0, velocity.1);
        ball.rest = BallModel::default().rolling(ball.position, ball.velocity).rest();
    }
    belief
}
