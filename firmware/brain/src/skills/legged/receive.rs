//! `receive_ball`: intercepts a passed ball and takes it, or reports why it cannot be had. Field frame, SI.

use geometry::Angle;

use crate::belief::Belief;
use crate::skills::legged::get_ball;
use crate::skills::{Reception, Step};

/// Receives a ball that has been passed to this robot.
pub fn receive(belief: &Belief, exit_heading: Option<Angle>) -> Reception {
    if belief.holds_ball {
        return Reception::Going(Step::Done);
    }
    let Some(ball) = belief.ball else { return Reception::Going(get_ball(belief, exit_heading)) };
    let me = belief.pose.position;
    let missed = if ball.is_at_rest() {
        ball.position.distance(me) > FETCH_WITHIN
    } else {
        // Rolling away, and its path to the stop position comes no nearer than can be fetched.
        ball.path().distance_to(me) > FETCH_WITHIN
    };
    if missed { Reception::Missed } else { Reception::Going(get_ball(belief, exit_heading)) }
}

/// A pass that ends within this distance is still fetched, m: 3 s of walking, one case's typical time.
const FETCH_WITHIN: f32 = 0.9;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::belief::BelievedBall;
    use geometry::{Point, Vector};
    use rules::League;

    #[test]
    fn a_ball_that_rests_out_of_reach_is_missed_and_a_near_one_fetched() {
        let mut belief = Belief::new(League::FourLegged);
        let lying = |x| BelievedBall {
            position: Point::new(x, 0.0),
            velocity: Vector::default(),
            rest: Point::new(x, 0.0),
        };
        belief.ball = Some(lying(1.2));
        assert_eq!(receive(&belief, None), Reception::Missed);
        belief.ball = Some(lying(0.7));
        assert!(matches!(receive(&belief, None), Reception::Going(Step::Running(_))));
        belief.ball = Some(BelievedBall {
            position: Point::new(1.5, 0.0),
            velocity: Vector::new(-0.9, 0.0),
            rest: Point::new(0.35, 0.0),
        });
        assert!(matches!(receive(&belief, None), Reception::Going(Step::Running(_))));
    }
}
