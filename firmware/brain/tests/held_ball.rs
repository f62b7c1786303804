//! `held_ball`: tests: a robot that has to leave a ball which lies within its own outline, as in simulators
//! that hold it there. Field frame, SI.

use brain::actuation::Drivetrain;
use brain::belief::{Belief, BelievedBall};
use brain::body::omni::Drive;
use geometry::{Angle, GoalEnd, Point, Pose, Vector};
use protocol::Instant;
use rules::{League, Phase, RuleRole, Side};

/// Distance of the robot from the ball after two seconds, m.
fn left(gap: f32, held: bool, phase: Phase<Side>) -> f32 {
    let mut belief = Belief::defending(League::DivisionB, GoalEnd::Positive);
    (belief.game.phase, belief.game.rule_role) = (phase, RuleRole::Player);
    let heading = Angle::degrees(139.0);
    belief.pose = Pose { position: Point::new(0.948, 1.512), heading };
    let ball = belief.pose.position + Vector::polar(gap, heading);
    belief.holds_ball = held;
    let (mut drivetrain, drive) = (Drivetrain::default(), Drive::avoiding(Point::new(2.46, 0.19), heading));
    for step in 0..200_u64 {
        belief.ball = Some(BelievedBall { position: ball, velocity: Vector::default(), rest: ball });
        let wanted = drivetrain.actuate(Instant(step * 10_000), &belief, drive.into());
        belief.velocity = belief.pose.vector_to_field(wanted.twist.linear);
        belief.pose.position += belief.velocity * 0.01;
        drivetrain.set_speed_order(&belief, wanted.twist);
        if belief.pose.position.distance(ball) > 0.12 {
            belief.holds_ball = false;
        }
    }
    belief.pose.position.distance(ball)
}

#[test]
fn a_robot_with_the_ball_at_or_within_its_front_leaves_it() {
    for phase in [Phase::Stop, Phase::FreeKick(Side::Theirs), Phase::BallPlacement(Side::Theirs)] {
        for gap in [0.115, 0.1, 0.0945, 0.08, 0.07, 0.05] {
            for held in [true, false] {
                let off = left(gap, held, phase);
                assert!(off > 0.5, "{phase:?}, {gap} m, held {held}: {off} m off after 2 s");
            }
        }
    }
}
