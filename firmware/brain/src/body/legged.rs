//! `legged`: numbers of the walking robot. SI.

use geometry::Angle;
use motion::legged::{CARRY_SPEED, WALK_FORWARD};
use protocol::Duration;
use protocol::robot_io::LeggedKick;

use super::BodySpec;

/// Nominal result of a kick: direction from straight ahead, distance to its stop position in m.
///
/// Straight kicks: UT Austin's 50 measured ERS-7 power kicks stop 2.15 m ahead on average; the soft one and
/// the head kicks are the simulator's nominal values.
pub fn nominal(kick: LeggedKick) -> (Angle, f32) {
    match kick {
        LeggedKick::ForwardSoft => (Angle::ZERO, 0.8),
        LeggedKick::ForwardHard => (Angle::ZERO, 2.15),
        LeggedKick::Left => (Angle::degrees(75.0), 1.2),
        LeggedKick::Right => (Angle::degrees(-75.0), 1.2),
        LeggedKick::Pass(distance) => (Angle::ZERO, distance),
    }
}

/// What planning takes of robots on four legs.
pub(crate) const SPEC: BodySpec = BodySpec {
    speed: WALK_FORWARD,
    carry_speed: CARRY_SPEED,
    // A quarter turn at 1 rad/s.
    turn: 1.5,
    // Grabs of 0.5 s each, of which three in four succeed.
    grab: 1.5,
    kick: 0.5,
    // Half the adaptation limit of 1.5 m at walking speed.
    longest_fetch: 2.5,
    arrived_within: 0.15,
    // A step away from touching it.
    next_to_ball: 0.35,
    // The robot turns first, and the ball arrives fast.
    receiver_haste: 0.6,
    receiver_near: 0.3,
    // The league's 3 s of holding a ball.
    shot_patience: Duration::millis(3000),
    // Radii of body (0.12) and ball (0.0425) and a centimetre.
    opponent_holds_within: 0.1725,
    // An arm's length more than touching.
    disputed_within: 0.25,
    doubt_steps: 5,
    meets_rolling_balls: false,
};
