//! Kick, chip and pass: with the ball held, turn until it points right, and kick; a ball that lies is kicked
//! as it is touched.
//!
//! In a restart the kicker may touch the ball once: it goes in only when everything points right, kicker
//! armed and dribbler still, so that the first touch is the kick.

use geometry::{Field, Point, Vector};
use motion::ball::BallModel;
use protocol::robot_io::OmniKick;
use rules::Phase;
use rules::limits::ROBOT_RADIUS;

use crate::belief::Belief;
use crate::body::Intent;
use crate::body::omni::{BALL_AT, Drive, SHOT};
use crate::governor::may_kick;
use crate::skills::wheels::contest::contest;
use crate::skills::wheels::get_ball::{Approach, approach, go_for_ball};

/// Kicks the ball at a point.
pub fn kick(belief: &Belief, at: Point<Field>, kick: OmniKick) -> Intent {
    pass(belief, at, kick, true)
}

/// The same, but the robot waits behind the ball, or turned with it, until it is `ready`.
pub fn pass(belief: &Belief, at: Point<Field>, kick: OmniKick, ready: bool) -> Intent {
    let ready = ready && may_kick(belief.game.phase);
    let once = belief.game.phase != Phase::Run;
    if belief.holds_ball && !once {
        let kick = if ready { kick } else { OmniKick::None };
        return kick_held(belief, at, kick);
    }
    let Some(ball) = belief.ball else { return Intent::Stand { face: None } };
    let face = ball.position.direction_to(at);
    // Contact first, the turn after.
    if !once
        && ready
        && let Some(intent) = contest(belief, &ball, face, kick)
    {
        return intent;
    }
    // Where an opponent stands behind the ball there is no room to line up: the ball is taken first, and
    // turned.
    let behind = ball.position - Vector::polar(LINES_UP, face);
    let blocked = belief.nearest_opponent(behind).is_some_and(|(_, distance)| distance < BODIES);
    if !once && (ball.velocity.norm() > REST_SPEED_MAX || blocked) {
        return go_for_ball(belief, &ball, Some(face));
    }
    match approach(belief, &ball, face, GO_IN) {
        Approach::In(drive) if ready => {
            let aimed = (face - belief.pose.heading).abs() < tolerance(ball.position.distance(at))
                && is_still(belief, 1.0);
            if aimed || ball.position.distance(belief.pose.position) > BALL_AT + FACING_DISTANCE_M {
                Drive { kick: if aimed { kick } else { OmniKick::None }, ..drive }.into()
            } else {
                // This near, driving on before it is aimed would push the ball: turn on the spot.
                Drive::bold(belief.pose.position, face).into()
            }
        }
        Approach::In(drive) => {
            let behind = ball.position - Vector::polar(BALL_AT + WAIT_OFF, face);
            Drive { to: behind, ..drive }.into()
        }
        Approach::Around(drive) => drive.into(),
    }
}

/// With the ball held: turns with it until the kick goes to `at`, then kicks.
pub fn kick_held(belief: &Belief, at: Point<Field>, kick: OmniKick) -> Intent {
    let me = belief.pose.position;
    let face = me.direction_to(at);
    let off = (face - belief.pose.heading).abs();
    // A robot that cannot aim well kicks as well as it can.
    let slack = 1.0 + LOOSENS * (belief.held() - AIMS_FOR).max(0.0);
    let armed = off < tolerance(me.distance(at)) * slack && is_still(belief, slack);
    // Armed for as long as it points right, though the break-beam signal may flicker: the kicker acts when
    // the ball is there. The beam reaches farther than kicker and roller: a ball that stays where it is has
    // not come near enough.
    let to = if armed { me + Vector::polar(GOES_ON, belief.pose.heading) } else { me };
    Drive { kick, armed, ..Drive::holding(to, face) }.into()
}

/// The speed of a pass over `distance` m, m/s: it arrives fast enough not to be caught up with, slow enough
/// to be taken.
pub fn pass_speed(distance: f32) -> f32 {
    BallModel::default().kick_speed(distance, ARRIVES).clamp(SLOWEST, SHOT)
}

/// Aiming tolerance of a kick over that distance, rad: a robot's width at the end, never more than 3°.
fn tolerance(distance: f32) -> f32 {
    (AIM_WIDTH / distance.max(0.1)).clamp(AIM_BEST, AIM_WORST)
}

/// It turns and drifts so slowly, or `slack` times as fast, that a kick goes along its heading.
fn is_still(belief: &Belief, slack: f32) -> bool {
    belief.angular.abs() < STILL_TURNING * slack && sideways(belief) < STILL_SIDEWAYS * slack
}

/// The ball keeps the robot's sideways speed.
fn sideways(belief: &Belief) -> f32 {
    Vector::polar(1.0, belief.pose.heading).cross(belief.velocity).abs()
}

/// A slower ball counts as stationary, m/s.
const REST_SPEED_MAX: f32 = 0.25;
/// Distance from a ball to the centre of a robot that lines up behind it, m (`get_ball`); and two bodies side
/// by side.
const LINES_UP: f32 = 0.165;
const BODIES: f32 = 2.0 * ROBOT_RADIUS;
/// How fast a robot goes in for a kick, m/s.
const GO_IN: f32 = 0.35;
/// Within this distance of the ball it must face the target before it continues, m.
const FACING_DISTANCE_M: f32 = 0.02;
/// Between front and ball while the robot waits for the order to kick, m.
const WAIT_OFF: f32 = 0.04;
/// A pass arrives with this speed, m/s: Thunderbots' passes are received at 2 and below, and one of 1.3 that
/// is missed rolls 2.4 m farther (v²/0.7), one of 2 nearly 6 m and off the field.
const ARRIVES: f32 = 1.3;
/// Slowest pass, m/s.
const SLOWEST: f32 = 1.5;
/// A kick should pass its target within this, m: less than half a robot.
const AIM_WIDTH: f32 = 0.06;
/// Best aiming tolerance, rad: the accuracy of the heading.
const AIM_BEST: f32 = 0.015;
/// Worst aiming tolerance, rad: 3°.
const AIM_WORST: f32 = 0.05;
/// Time for which a robot with the ball aims with full precision, s: half a turn with the ball takes 1.2 s.
const AIMS_FOR: f32 = 1.4;
/// Then every tolerance of the aim grows by this share of itself per second: 0.3 to 0.5 rad after another 1.3
/// s (estimate).
const LOOSENS: f32 = 7.0;
/// With the kicker armed it goes on by this distance, m: the reach of the break beam beyond the kicker's.
const GOES_ON: f32 = 0.03;
/// A robot that turns no faster than this kicks along its heading, rad/s.
const STILL_TURNING: f32 = 0.6;
/// Sideways speed below which it kicks, m/s.
const STILL_SIDEWAYS: f32 = 0.15;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::actuation::Drivetrain;
    use crate::body::omni::LIMITS;
    use crate::skills::wheels::testing::belief;
    use protocol::Instant;
    use protocol::host::RuleRole;
    use rules::Side;

    fn drive(intent: Intent) -> Drive {
        match intent {
            Intent::Drive(drive) => drive,
            other => panic!("{other:?}"),
        }
    }

    const FLAT: OmniKick = OmniKick::Flat(4.0);

    #[test]
    fn behind_the_ball_and_aimed_it_goes_in_with_the_kicker_armed_and_no_dribbler() {
        let mut b = belief((-0.15, 0.0, 0.0), (0.0, 0.0));
        b.game.phase = Phase::FreeKick(Side::Ours);
        let armed = drive(kick(&b, Point::new(3.0, 0.0), FLAT));
        assert_eq!((armed.kick, armed.dribbler), (FLAT, 0.0));
        // 10° off it must not touch the ball.
        let mut b = belief((-0.11, 0.0, 8.0), (0.0, 0.0));
        b.game.phase = Phase::FreeKick(Side::Ours);
        let turning = drive(kick(&b, Point::new(3.0, 0.0), FLAT));
        assert_eq!((turning.kick, turning.to), (OmniKick::None, b.pose.position));
    }

    #[test]
    fn a_robot_that_turns_past_its_aim_does_not_arm_the_kicker() {
        let mut b = belief((-BALL_AT - 0.01, 0.0, 0.0), (0.0, 0.0));
        b.angular = 2.0;
        assert_eq!(drive(kick(&b, Point::new(3.0, 0.0), FLAT)).kick, OmniKick::None);
        b.angular = 0.1;
        assert_eq!(drive(kick(&b, Point::new(3.0, 0.0), FLAT)).kick, FLAT);
    }

    #[test]
    fn a_pass_that_is_not_ready_waits_behind_the_ball() {
        let mut b = belief((-0.15, 0.0, 0.0), (0.0, 0.0));
        b.game.phase = Phase::FreeKick(Side::Ours);
        let waiting = drive(pass(&b, Point::new(3.0, 0.0), FLAT, false));
        assert_eq!(waiting.kick, OmniKick::None);
        assert!((waiting.to.x() + BALL_AT + WAIT_OFF).abs() < 1e-6);
    }

    #[test]
    fn where_the_phase_does_not_allow_a_kick_there_is_none() {
        for phase in [Phase::Stop, Phase::PrepareKickoff(Side::Ours), Phase::FreeKick(Side::Theirs)] {
            let mut b = belief((-0.15, 0.0, 0.0), (0.0, 0.0));
            b.game.phase = phase;
            assert_eq!(drive(kick(&b, Point::new(3.0, 0.0), FLAT)).kick, OmniKick::None, "{phase:?}");
        }
    }

    #[test]
    fn two_metres_are_passed_with_what_arrives_at_1_3_m_per_s() {
        // v0 = √((v² + 2·0.35·d)/(c² + (1 − c²)·0.35/3.9)) with d = 2, c = 5/7.
        let (c2, share) = (25.0_f32 / 49.0, 0.35_f32 / 3.9);
        let expected = ((1.69 + 1.4) / (c2 + (1.0 - c2) * share)).sqrt();
        assert!((pass_speed(2.0) - expected).abs() < 1e-3, "{} {expected}", pass_speed(2.0));
    }

    #[test]
    fn a_keeper_speeds_up_to_a_ball_before_it_harder_than_planned() {
        let mut b = belief((-0.3, 0.0, 0.0), (0.0, 0.0));
        (b.game.phase, b.game.rule_role) = (Phase::Run, RuleRole::Keeper);
        let mut drivetrain = Drivetrain::default();
        for tick in 1..=25_u64 {
            let wanted = drivetrain.actuate(Instant(tick * 10_000), &b, kick(&b, Point::new(3.0, 0.0), FLAT));
            drivetrain.set_speed_order(&b, wanted.twist);
            b.velocity = b.pose.vector_to_field(wanted.twist.linear);
            b.pose.position += b.velocity * 0.01;
        }
        let planned = 0.5 * LIMITS.acceleration * 0.25 * 0.25;
        assert!(b.pose.position.x() + 0.3 > 1.15 * planned, "{:?}", b.pose);
    }
}
