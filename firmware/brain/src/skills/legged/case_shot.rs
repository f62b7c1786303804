//! `case_shot`: a case's shot at goal: when to kick, and along which leg. Field frame, SI.
//!
//! The leg that retrieval checked is played, unless the moment has made another shot likelier a goal, or
//! waiting for a gap, or from afar pushing the ball on, is worth more: optimal stopping. A choice is worth
//! the goal that may follow times the probability that the ball is still held when it is made: an opponent at
//! the ball takes it with the hazard of its grabs. Out of time, the ball leaves by a kick that needs no turn.

use geometry::{Angle, Field, GoalEnd, Point, Segment, Vector, math};
use motion::legged::{CARRY_SPEED, CARRY_TURN_RATE, WALK_FORWARD};
use protocol::robot_io::LeggedKick;

use super::shot::{self, GOOD_SHOT};
use crate::belief::Belief;
use crate::body::{Intent, legged};
use crate::skills::legged as skills;

/// Something to do with the ball held, and what it is worth.
#[derive(Clone, Copy)]
struct Choice {
    worth: f32,
    intent: Intent,
}

/// The shot of a leg that ends at `end`, kicked with `kick`; `patient` while there is time left.
pub fn case_shot(
    belief: &Belief,
    attacked: GoalEnd,
    end: Point<Field>,
    kick: LeggedKick,
    patient: bool,
) -> Intent {
    let along = belief.pose.position.direction_to(end);
    let Some((chance, best)) = shot::chance_along(belief, attacked, along, kick) else {
        return if patient {
            skills::shoot(belief, along, kick)
        } else {
            into_space(belief, attacked).intent
        };
    };
    let leg = shot_at(belief, along, kick, chance);
    let other = shot_at(belief, best.direction, best.kick, best.chance);
    let better = |best: Choice, next: Choice| if next.worth > best.worth { next } else { best };
    if !patient {
        // What needs no turn any more.
        let kicks = [leg, other].into_iter().filter(|shot| matches!(shot.intent, Intent::Kick(_)));
        return kicks.fold(into_space(belief, attacked), better).intent;
    }
    // Asking for twice the probability was measured: it costs 2 to 5 points to goal against a goalkeeper.
    let shot = if best.chance > chance { other } else { leg };
    let later = waiting(belief, attacked).unwrap_or_else(|| pushing_on(belief, attacked));
    better(shot, later).intent
}

/// A shot that is a goal with that probability.
fn shot_at(belief: &Belief, along: Angle, kick: LeggedKick, chance: f32) -> Choice {
    let turn = (along - legged::nominal(kick).0 - belief.pose.heading).abs();
    let worth = if_held(belief, turn / CARRY_TURN_RATE + KICK_TIME, chance);
    Choice { worth, intent: skills::shoot(belief, along, kick) }
}

/// Carrying the ball to the best place for shots, or waiting there for the far post.
fn waiting(belief: &Belief, attacked: GoalEnd) -> Option<Choice> {
    let intent = shot::prepare(belief, attacked)?;
    let time = match intent {
        Intent::Carry { to } => belief.pose.position.distance(to) / CARRY_SPEED,
        _ => GOALKEEPER_CROSSES,
    };
    Some(Choice { worth: if_held(belief, time + KICK_TIME, GOOD_SHOT), intent })
}

/// A short kick towards the best place for shots, where that is far.
fn pushing_on(belief: &Belief, attacked: GoalEnd) -> Choice {
    let along = belief.pose.position.direction_to(shot::shooting_place(belief, attacked));
    let turn = (along - belief.pose.heading).abs();
    let then = after(belief, attacked, along, legged::nominal(LeggedKick::ForwardSoft).1);
    let worth = if_held(belief, turn / CARRY_TURN_RATE + KICK_TIME, then);
    Choice { worth, intent: skills::push_on(belief, attacked) }
}

/// The best soft or head kick without a turn.
fn into_space(belief: &Belief, attacked: GoalEnd) -> Choice {
    let choice = |kick| {
        let (off, length) = legged::nominal(kick);
        let then = after(belief, attacked, belief.pose.heading + off, length);
        Choice { worth: if_held(belief, KICK_TIME, then), intent: Intent::Kick(kick) }
    };
    [LeggedKick::Left, LeggedKick::Right]
        .into_iter()
        .map(choice)
        .fold(choice(LeggedKick::ForwardSoft), |best, next| if next.worth > best.worth { next } else { best })
}

/// What a ball is worth that is kicked `length` m in that direction, not at the goal: a good shot, less the
/// ground lost, if this robot is first at it. Nothing where an opponent stands in its path or it leaves the
/// field.
fn after(belief: &Belief, attacked: GoalEnd, along: Angle, length: f32) -> f32 {
    let from = belief.pose.position;
    let path = Segment::new(from, from + Vector::polar(length, along));
    let blocked = belief.opponents.iter().any(|opponent| path.distance_to(*opponent) < PASSES_BY);
    let field = belief.league().field();
    if blocked || field.clamp(path.to, INSIDE).distance(path.to) > 0.0 {
        return 0.0;
    }
    let theirs = belief.nearest_opponent(path.to).map_or(f32::INFINITY, |(_, distance)| distance);
    let first = GRAB_SUCCEEDS * (theirs / length).min(1.0);
    let goal = field.goal_center(attacked);
    let lost = (path.to.distance(goal) - from.distance(goal)).max(0.0);
    first * (GOOD_SHOT - GROUND * lost).max(0.0)
}

/// Worth of something in `time` s: `worth` if the ball is still held then.
fn if_held(belief: &Belief, time: f32, worth: f32) -> f32 {
    still_held(belief, time) * worth
}

/// Probability that no opponent has taken the ball after `time` s: the nearest walks up to it, and then
/// closes its legs again and again. A goalkeeper stays in its area (paper §5.1.2).
fn still_held(belief: &Belief, time: f32) -> f32 {
    let ball = belief.ball.map_or(belief.pose.position, |ball| ball.position);
    let (field, attacked) = (belief.league().field(), belief.game.defending.opposite());
    let comes = |at: &Point<Field>| at.distance(ball) < GRABS_WITHIN || !field.in_penalty_area(attacked, *at);
    let nearest = belief.opponents.iter().filter(|at| comes(at)).map(|at| at.distance(ball));
    let distance = nearest.fold(f32::INFINITY, f32::min);
    let arrives = ((distance - GRABS_WITHIN) / WALK_FORWARD).max(0.0);
    math::exp(-STEAL_HAZARD * (time - arrives).max(0.0))
}

/// From the order to ball contact, s: the body's.
const KICK_TIME: f32 = 0.4;
/// An opponent whose centre is this near the ball closes its legs on it, m: the grab's reach and a step.
const GRABS_WITHIN: f32 = 0.3;
/// Hazard of an opponent at a held ball, 1/s: a grab of 0.5 s takes it in 0.375 of tries (0.75 of grabs
/// succeed, half of those against a grip): −ln(1 − 0.375) / 0.5.
const STEAL_HAZARD: f32 = 0.94;
/// A goalkeeper that follows the ball's turn leaves the far post open within about this time, s.
const GOALKEEPER_CROSSES: f32 = 1.0;
/// A kick passes an opponent at this distance of centres, m: body and ball, and half the scatter over 0.8 m.
const PASSES_BY: f32 = 0.24;
/// Share of grabs that succeed, as bodies of this league do.
const GRAB_SUCCEEDS: f32 = 0.75;
/// A kick into free space ends this far within the lines, m.
const INSIDE: f32 = 0.3;
/// What a metre of ground lost costs of a good shot: 5 m from goal to goal are worth it all; an estimate.
const GROUND: f32 = 0.06;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::belief::BelievedBall;
    use geometry::Pose;
    use rules::League;

    fn belief(x: f32, y: f32, heading: f32, opponents: &[(f32, f32)]) -> Belief {
        let mut belief = Belief::new(League::FourLegged);
        belief.pose = Pose { position: Point::new(x, y), heading: Angle::new(heading) };
        let at = belief.pose.to_field(Point::new(0.13, 0.0));
        belief.ball = Some(BelievedBall { position: at, velocity: Vector::default(), rest: at });
        belief.holds_ball = true;
        for &(x, y) in opponents {
            let _ = belief.opponents.push(Point::new(x, y));
        }
        belief
    }

    fn shot(belief: &Belief, y: f32, patient: bool) -> Intent {
        case_shot(belief, GoalEnd::Positive, Point::new(2.7, y), LeggedKick::ForwardHard, patient)
    }

    #[test]
    fn the_leg_is_the_one_that_is_kicked_unless_another_is_likelier_a_goal() {
        let kick = |heading: f32, y: f32| shot(&belief(1.4, 0.0, heading, &[]), y, true);
        assert_eq!(kick(0.0, 0.0), Intent::Kick(LeggedKick::ForwardHard));
        assert!(matches!(kick(0.4, 0.0), Intent::Turn { .. }));
        // The goal is unguarded: its middle is likelier than beside a post.
        assert_eq!(kick(0.0, 0.3), Intent::Kick(LeggedKick::ForwardHard));
    }

    #[test]
    fn a_leg_that_the_moment_has_closed_gives_way_to_an_open_one() {
        let closed = belief(1.4, 0.0, 0.1, &[(2.2, 0.2)]);
        let other = match shot(&closed, 0.3, true) {
            Intent::Turn { heading } => heading.radians() < 0.05,
            Intent::Kick(_) => false,
            _ => true,
        };
        assert!(other, "{:?}", shot(&closed, 0.3, true));
    }

    #[test]
    fn with_an_opponent_at_the_ball_it_does_not_wait_for_a_gap() {
        // Aside of the goal's middle, with the goalkeeper opposite: alone it waits for the far post.
        let alone = belief(1.4, 0.6, -0.3, &[(2.1, 0.33)]);
        let pressed = belief(1.4, 0.6, -0.3, &[(2.1, 0.33), (1.4, 0.35)]);
        let waits = |belief: &Belief| still_held(belief, GOALKEEPER_CROSSES + KICK_TIME);
        // The goalkeeper stays in its area.
        assert!(waits(&alone) > 0.9 && waits(&pressed) < 0.3);
    }

    #[test]
    fn out_of_time_it_kicks_without_a_turn() {
        for heading in [0.0_f32, 1.2, -1.4, 3.0] {
            let held = belief(1.4, 0.2, heading, &[(1.6, 0.3)]);
            assert!(matches!(shot(&held, 0.3, false), Intent::Kick(_)));
        }
        // Turned away by 75° to the right, the head kick to the left is the shot.
        let aside = belief(1.9, 0.0, -1.31, &[]);
        assert_eq!(shot(&aside, 0.0, false), Intent::Kick(LeggedKick::Left));
    }
}
