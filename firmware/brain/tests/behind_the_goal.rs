//! A keeper that was off the field, behind its own goal, comes around the goal to its line: with the robot's
//! own motion planner, followed exactly. Field frame, SI.

use brain::actuation::Drivetrain;
use brain::belief::{Belief, BelievedBall};
use brain::body::omni::Drive;
use geometry::{Angle, Field, GoalEnd, Point, Pose, Vector};
use protocol::Instant;
use rules::{League, Phase, RuleRole, Side};

const STEP: f32 = 0.01;

/// The robot's last second of ten, a place every tenth.
fn last_second(phase: Phase<Side>, from: Point<Field>, to: Point<Field>) -> Vec<Point<Field>> {
    let own = GoalEnd::Positive;
    let mut belief = Belief::defending(League::DivisionA, own);
    (belief.game.phase, belief.game.rule_role) = (phase, RuleRole::Keeper);
    belief.pose = Pose { position: from, heading: Angle::HALF_TURN };
    let ball = League::DivisionA.field().penalty_spot(own);
    belief.ball = Some(BelievedBall { position: ball, velocity: Vector::default(), rest: ball });
    let mut drivetrain = Drivetrain::default();
    // Four frames: as many as a host that shows two teams sends, and a teammate's.
    drivetrain.set_spent(7_800);
    let mut places = Vec::new();
    for step in 0..1000 {
        let drive = Drive::bold(to, Angle::HALF_TURN);
        let wanted = drivetrain.actuate(Instant(step * 10_000), &belief, drive.into());
        let half = Angle::new(0.5 * wanted.twist.angular * STEP);
        let midway = Pose { heading: belief.pose.heading + half, ..belief.pose };
        belief.velocity = midway.vector_to_field(wanted.twist.linear);
        belief.angular = wanted.twist.angular;
        belief.pose.position += belief.velocity * STEP;
        belief.pose.heading = midway.heading + half;
        drivetrain.set_speed_order(&belief, wanted.twist);
        if step >= 900 && step % 10 == 0 {
            places.push(belief.pose.position);
        }
    }
    places
}

#[test]
fn a_keeper_behind_its_goal_is_on_its_line_ten_seconds_later() {
    let to = League::DivisionA.field().goal_center(GoalEnd::Positive);
    let mut failed = Vec::new();
    for phase in [Phase::Stop, Phase::PreparePenalty(Side::Theirs)] {
        for i in -25_i8..=25 {
            for x in [6.29, 6.31, 6.323, 6.40, 6.45, 6.48] {
                let from = Point::new(x, 0.1 * f32::from(i) + 0.026);
                let places = last_second(phase, from, to);
                if places.iter().any(|at| at.distance(to) > 0.05) {
                    failed.push(format!("{phase:?} from {from:?}: ends at {:?}", places.last()));
                }
            }
        }
    }
    assert!(failed.is_empty(), "{} of 612:\n{}", failed.len(), failed[..failed.len().min(20)].join("\n"));
}
