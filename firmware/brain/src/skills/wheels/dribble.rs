//! Dribble: carry the ball, never farther than the rules allow (1 m; 0.5 m in 2013), counted from the first
//! touch.
//!
//! Near the limit the ball is let go: dribbler off, a step back, until the gap is visible; then it may be
//! taken again.

use geometry::{Angle, Field, Point, Pose, Vector, math};
use protocol::robot_io::OmniKick;
use rules::League;

use crate::belief::Belief;
use crate::body::Intent;
use crate::body::omni::{BALL_AT, Drive, DriveMode};
use crate::skills::Step;
use crate::skills::wheels::get_ball::get_ball;
use crate::skills::wheels::kick::kick_held;
use crate::skills::wheels::shoot::clear_or_shoot;

/// Brings the ball to `pose`.
pub fn dribble(belief: &Belief, pose: Pose<Field>) -> Intent {
    if belief.holds_ball {
        // Braking, a weak roller loses what rolls freely.
        let left = belief.pose.position.distance(pose.position);
        let speed = math::sqrt(2.0 * BRAKES * left) + CREEPS;
        return Drive { speed, ..Drive::holding(pose.position, pose.heading) }.into();
    }
    let Some(ball) = belief.ball else {
        // It may lie hidden before this robot: backwards, until cameras see it.
        let back = belief.pose.position - Vector::polar(STEP_BACK, belief.pose.heading);
        return Drive { speed: REVEALS, ..Drive::bold(back, belief.pose.heading) }.into();
    };
    match get_ball(belief, Some(ball.position.direction_to(pose.position))) {
        Step::Running(intent) => intent,
        Step::Done => Intent::Stand { face: None },
    }
}

/// The case language's `dribble_to`: the ball comes within `tolerance` of the place.
pub fn carry_to(belief: &Belief, to: Point<Field>, tolerance: f32) -> Step {
    let dribbler_point = belief.dribbler_point();
    if dribbler_point.distance(to) <= tolerance {
        return Step::Done;
    }
    let me = belief.pose.position;
    let face = if me.distance(to) > TURNS_FROM { me.direction_to(to) } else { belief.pose.heading };
    Step::Running(Drive::holding(to - Vector::polar(BALL_AT, face), face).into())
}

/// Shields a held ball: turns the back to the opponent near it, and backs away from it for as far as the
/// rules let the ball be carried. `None` without such an opponent, and when it has been kept long enough.
pub fn shield(belief: &Belief) -> Option<Intent> {
    let me = belief.pose.position;
    let (opponent, _) = belief.nearest_opponent(me).filter(|(_, apart)| *apart < SHIELDS_WITHIN_M)?;
    if belief.held() > SHIELDS_FOR_S {
        return None;
    }
    let away = opponent.direction_to(me);
    let left = limit(belief.league()) - SPARE - belief.carried();
    let to = me + Vector::polar(left.clamp(0.0, SHIELDS_AHEAD_M), away);
    Some(Drive { speed: SHIELDS_AT_M_S, ..Drive::holding(to, away) }.into())
}

/// Any skill's intent, but with the ball let go before it was held too long or carried too far.
///
/// Host, case and reactive behaviour may all change their target while the opponents move with it. So the
/// ball's target is fixed after `SETTLES` to the one wanted then, or after `ACTS` where there is none;
/// [`kick_held`] tolerates more aiming error from then on, and after `LASTS` the robot leaves the ball.
pub fn let_go_in_time(belief: &mut Belief, intent: Intent) -> Intent {
    let held = belief.held();
    if belief.disputed() > DISPUTED_BEFORE_TURN_S && belief.holds_ball {
        // Both turn in the same direction: their fronts part, and the ball goes with one of them, which kicks
        // it a little farther round.
        let aside = belief.pose.position + Vector::polar(AFAR, belief.pose.heading + Angle::new(TURN));
        belief.resolved = Some((aside, OmniKick::Flat(FREED)));
    } else if belief.disputed() > DISPUTES
        && let Intent::Drive(drive) = intent
    {
        return break_free(belief, drive).into();
    }
    if !belief.holds_ball {
        return intent;
    }
    if belief.resolved.is_none() && held > SETTLES {
        let mut meant = intent;
        if held > ACTS && !aims(&meant) {
            meant = clear_or_shoot(belief, belief.game.defending.opposite());
        }
        if let Intent::Drive(drive) = meant
            && aims(&meant)
        {
            belief.resolved = Some((belief.pose.position + Vector::polar(AFAR, drive.face), drive.kick));
        }
    }
    let intent = match belief.resolved {
        Some((at, kick)) => kick_held(belief, at, kick),
        None => intent,
    };
    let Intent::Drive(drive) = intent else { return intent };
    if drive.mode != DriveMode::Holding || intent.lets_go() {
        return intent;
    }
    let left = limit(belief.league()) - SPARE - belief.carried();
    if left > 0.0 && held < LASTS {
        // It must be slow by then: a ball that is released while it moves rolls on.
        let slow = math::sqrt(2.0 * SLOWS * left) + CRAWL;
        return Drive { speed: drive.speed.min(slow), ..drive }.into();
    }
    let back = belief.pose.position - Vector::polar(STEP_BACK, belief.pose.heading);
    Drive { speed: STEP_BACK_SPEED, ..Drive::bold(back, belief.pose.heading) }.into()
}

/// Two robots that press the ball against each other block each other: the first touch is a kick, unless the
/// robot faces its own goal.
fn break_free(belief: &Belief, drive: Drive) -> Drive {
    let own = belief.league().field().goal_center(belief.game.defending);
    let off = (belief.pose.position.direction_to(own) - belief.pose.heading).abs();
    let kick = if off > OWN_GOAL { OmniKick::Flat(FREED) } else { drive.kick };
    Drive { kick, armed: true, ..drive }
}

/// Whether the robot turns towards the ball's target.
fn aims(intent: &Intent) -> bool {
    matches!(intent, Intent::Drive(drive) if drive.mode == DriveMode::Holding && drive.kick != OmniKick::None)
}

/// Distance over which that league's rules let a robot dribble, m.
fn limit(league: League) -> f32 {
    league.limits().map_or(f32::INFINITY, |limits| limits.dribble)
}

/// The ball's target is fixed after this time with it, s: host and robots have updated their targets several
/// times by then.
const SETTLES: f32 = 0.7;
/// A robot that only carries, shields or waits acts on the ball after this time with it, s: what 0.75 m take,
/// and a pass waits for its receiver.
const ACTS: f32 = 2.5;
/// An opponent whose centre is this near to the robot's may take the ball, m: half a metre between bodies.
const SHIELDS_WITHIN_M: f32 = 0.7;
/// A ball is shielded for this long, s: until it is acted on.
const SHIELDS_FOR_S: f32 = ACTS;
/// A robot that shields backs away so far at a time, m, and so fast, m/s: no faster than a ball is dribbled.
const SHIELDS_AHEAD_M: f32 = 0.3;
const SHIELDS_AT_M_S: f32 = 0.8;
/// A robot that is prevented from that lets the ball go after this time, s.
const LASTS: f32 = 3.0;
/// Time for which two robots dispute the ball before one kicks it in any direction, s: longer than a tackle
/// takes.
const DISPUTES: f32 = 0.8;
/// After this time it turns away with the ball, s: two or three kicks.
const DISPUTED_BEFORE_TURN_S: f32 = 1.3;
/// It kicks this much farther round than where the ball came free, rad: past the other robot.
const TURN: f32 = 0.8;
/// Speed of that kick, m/s: out of reach, not out of the field.
const FREED: f32 = 2.5;
/// No such kick within this angle of the direction of the own goal, rad.
const OWN_GOAL: f32 = 0.8;
/// Approximate distance of a target, m.
const AFAR: f32 = 3.0;
/// Distance before the limit at which the ball is let go, m: what the ball rolls on from a crawl, a robot's
/// delay, and noise.
const SPARE: f32 = 0.25;
/// Deceleration towards that, m/s².
const SLOWS: f32 = 1.0;
/// The same at the place where the ball is carried to, m/s²: 0.35 of rolling and 0.5 of the weakest roller.
const BRAKES: f32 = 0.7;
/// Remaining speed there, m/s.
const CREEPS: f32 = 0.05;
/// Remaining speed then, m/s.
const CRAWL: f32 = 0.15;
/// Distance of the step back, m.
const STEP_BACK: f32 = 0.2;
/// Speed of the step back, m/s.
const STEP_BACK_SPEED: f32 = 0.8;
/// Speed at which it backs off a ball that cameras may not see for it, m/s.
const REVEALS: f32 = 0.3;
/// Nearer than this it keeps its heading, m.
const TURNS_FROM: f32 = 0.2;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::skills::wheels::testing::belief;
    use crate::snapshot::HostSnapshot;
    use geometry::Twist;
    use protocol::robot_io::{Health, SensorFrame};
    use protocol::{Instant, RobotId};

    fn holding_sensors() -> SensorFrame {
        SensorFrame {
            pose: None,
            ball: None,
            opponents: heapless::Vec::new(),
            ball_contact: true,
            busy: false,
            odometry: Twist::default(),
            health: Health::default(),
            camera: None,
        }
    }

    /// A robot at the origin that has had the ball for `ms` ms.
    fn holding(ms: u64) -> Belief {
        let mut b = belief((0.0, 0.0, 0.0), (BALL_AT, 0.0));
        let sensors = holding_sensors();
        let snapshot = HostSnapshot::new(RobotId::new(1).unwrap());
        for at in [0, ms] {
            b.show(Instant(at * 1000), &snapshot, &sensors);
        }
        b
    }

    fn drive(intent: Intent) -> Drive {
        match intent {
            Intent::Drive(drive) => drive,
            other => panic!("{other:?}"),
        }
    }

    const KICK: OmniKick = OmniKick::Flat(6.0);

    #[test]
    fn what_is_aimed_at_after_a_while_stays_whatever_is_wanted_then() {
        let left = Point::new(3.0, 2.0);
        let mut b = holding(750);
        let wanted = kick_held(&b, left, KICK);
        let first = drive(let_go_in_time(&mut b, wanted));
        // Its opponent has moved: now the other side is roomier, and then its host wants it elsewhere.
        let wanted = kick_held(&b, Point::new(3.0, -2.0), KICK);
        let second = drive(let_go_in_time(&mut b, wanted));
        let third = drive(let_go_in_time(&mut b, Drive::holding(left, Angle::HALF_TURN).into()));
        for kept in [second, third] {
            assert!((kept.face - first.face).abs() < 1e-3 && kept.kick == KICK, "{kept:?}");
        }
    }

    #[test]
    fn who_only_stands_with_the_ball_kicks_it_after_two_and_a_half_seconds() {
        let stands = Intent::Stand { face: None };
        assert_eq!(let_go_in_time(&mut holding(2400), stands), stands);
        assert_ne!(drive(let_go_in_time(&mut holding(2600), stands)).kick, OmniKick::None);
    }

    #[test]
    fn a_ball_is_shielded_from_an_opponent_near_it_for_as_long_and_far_as_it_may_be() {
        let mut b = holding(1000);
        assert_eq!(shield(&b), None, "no opponent");
        let _ = b.opponents.push(Point::new(0.0, 0.5));
        let back = drive(shield(&b).unwrap());
        assert!((back.face.to_degrees() + 90.0).abs() < 1e-3 && back.kick == OmniKick::None, "{back:?}");
        assert!(back.to.y() < 0.0 && back.dribbler == 1.0, "{back:?}");
        assert!(b.carried() - back.to.y() <= limit(b.league()) - SPARE);
        let mut late = holding(2600);
        let _ = late.opponents.push(Point::new(0.0, 0.5));
        assert_eq!(shield(&late), None);
        b.opponents[0] = Point::new(0.0, 0.8);
        assert_eq!(shield(&b), None, "too far off to take it");
    }

    #[test]
    fn an_aim_gets_less_exact_with_time_and_at_last_the_ball_is_left() {
        let aside = Point::new(3.0, 0.6);
        let armed = |ms: u64| {
            let mut b = holding(ms);
            let wanted = kick_held(&b, aside, KICK);
            drive(let_go_in_time(&mut b, wanted))
        };
        assert!(!armed(1300).armed, "11 degrees off");
        assert!(armed(2900).armed);
        let mut b = holding(3100);
        let wanted = kick_held(&b, Point::new(-3.0, 0.0), KICK);
        assert!(drive(let_go_in_time(&mut b, wanted)).to.x() < -0.1);
    }

    #[test]
    fn a_disputed_ball_is_kicked_as_it_is_touched_but_not_at_the_own_goal() {
        let disputed = |heading: f32, ms: u64| {
            let mut b = belief((0.0, 0.0, heading), (BALL_AT, 0.0));
            let snapshot = HostSnapshot::new(RobotId::new(1).unwrap());
            let sensors = holding_sensors();
            b.show(Instant(0), &snapshot, &sensors);
            let _ = b.opponents.push(b.dribbler_point() + Vector::polar(0.1, b.pose.heading));
            for at in [0, ms] {
                b.dispute(Instant(at * 1000));
            }
            let wanted = kick_held(&b, Point::new(0.0, 3.0), KICK);
            drive(let_go_in_time(&mut b, wanted))
        };
        assert!(!disputed(0.0, 600).armed, "it still turns to where the ball shall go");
        let kicks = disputed(0.0, 900);
        assert!(kicks.armed && kicks.kick == OmniKick::Flat(FREED), "{kicks:?}");
        let turns = disputed(0.0, 1400);
        assert!(turns.kick == OmniKick::Flat(FREED) && !turns.armed, "{turns:?}");
        assert!((turns.face.radians() - TURN).abs() < 1e-3, "{turns:?}");
        assert_eq!(disputed(180.0, 900).kick, KICK, "towards the own goal nothing but what is wanted");
    }

    #[test]
    fn a_ball_that_no_camera_sees_is_revealed_by_backing_off() {
        let mut b = belief((0.0, 0.0, 0.0), (0.0, 0.0));
        b.ball = None;
        let back = drive(dribble(&b, Pose::from_mm_deg(1000.0, 0.0, 0.0)));
        assert!(back.to.x() < -0.1 && back.speed < 0.5, "{back:?}");
    }
}
