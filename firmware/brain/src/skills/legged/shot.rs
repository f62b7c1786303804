//! `shot`: aim of a shot between the posts. The open angle of the goal, as kicks scatter. Field frame, SI.
//!
//! Rays from the robot fan over the goal opening. A ray is free where no opponent can be at it when the ball
//! passes: each covers its body and what it walks sideways until then, from where it will be when the ball
//! leaves. An opponent at the ball covers only what lies before the ball: one abreast of it lets it pass. A
//! kick in one of these directions deviates as kicks do (motion's spread); its probability is the share of
//! such kicks that run along free rays, times the probability of rolling far enough: to the goal, or where no
//! goalkeeper guards it into its area, from where it is brought in.

use geometry::{Angle, Field, GoalEnd, Point, Vector, math};
use motion::legged::{
    HOLD_DISTANCE, KICK_ANGLE_SPREAD, KICK_LENGTH_SPREAD, WALK_ACCELERATION, WALK_FORWARD, WALK_SIDEWAYS,
};
use motion::rolling::RollingBall;
use protocol::robot_io::{LeggedKick, OPPONENTS_MAX};

use crate::belief::Belief;
use crate::body::{Intent, legged};
use crate::skills::legged as skills;

/// A shot at goal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Shot {
    /// Direction on the field.
    pub(super) direction: Angle,
    /// Kick to use.
    pub(super) kick: LeggedKick,
    /// Probability of a goal, 0 to 1.
    pub(super) chance: f32,
}

/// With the ball near their goal: shoot if the probability of a goal is good, or fair while an opponent is
/// about to take the ball (or there is no more time); else walk with the ball to the best place for shots.
/// `None` while neither is near.
pub fn attempt(belief: &Belief, attacked: GoalEnd, patient: bool) -> Option<Intent> {
    let pressed = is_pressed(belief);
    let enough = if pressed || !patient { FAIR_SHOT } else { GOOD_SHOT };
    let shot = best_shot(belief, attacked)?;
    if shot.chance >= enough {
        return Some(skills::shoot(belief, shot.direction, shot.kick));
    }
    prepare(belief, attacked)
}

/// With the ball near their goal: carry it to the best place for shots, or there turn to the post that the
/// goalkeeper will leave open; `None` while that place is far.
pub(super) fn prepare(belief: &Belief, attacked: GoalEnd) -> Option<Intent> {
    let me = belief.pose.position;
    let place = shooting_place(belief, attacked);
    if me.distance(place) > CARRIED_AT_MOST {
        return None;
    }
    // A goalkeeper that walks towards the ball's new position leaves the far post open: face that post by
    // then.
    let goal = belief.league().field().goal_center(attacked);
    let far = Point::new(goal.x(), -FAR_POST * me.y());
    let aside = me.y().abs() > ASIDE;
    Some(if aside { Intent::Turn { heading: me.direction_to(far) } } else { Intent::Carry { to: place } })
}

/// Whether an opponent is about to take the ball.
fn is_pressed(belief: &Belief) -> bool {
    belief.nearest_opponent(belief.pose.position).is_some_and(|(_, distance)| distance < PRESSED_WITHIN)
}

/// A short kick towards the best place for shots.
pub fn push_on(belief: &Belief, attacked: GoalEnd) -> Intent {
    let place = shooting_place(belief, attacked);
    skills::shoot(belief, belief.pose.position.direction_to(place), LeggedKick::ForwardSoft)
}

/// Best place for a shot: before the goal, beside its middle, where a goalkeeper opposite the ball leaves the
/// far post open.
pub(super) fn shooting_place(belief: &Belief, attacked: GoalEnd) -> Point<Field> {
    let field = belief.league().field();
    let goal = field.goal_center(attacked);
    let side = if belief.pose.position.y() < 0.0 { -1.0 } else { 1.0 };
    let out = (field.penalty_depth + SHOT_BEFORE_AREA) * goal.x().signum();
    Point::new(goal.x() - out, 0.5 * field.penalty_width * side)
}

/// The shot at the goal at `attacked` with the best probability, less the cost of turning for it; `None` from
/// behind the goal line.
pub(super) fn best_shot(belief: &Belief, attacked: GoalEnd) -> Option<Shot> {
    best_of(belief, &Fan::new(belief, attacked)?)
}

/// The best shot into that opening.
fn best_of(belief: &Belief, fan: &Fan) -> Option<Shot> {
    let mut best: Option<(f32, Shot)> = None;
    for kick in SHOTS {
        let (off, length) = legged::nominal(kick);
        let (free, far) = (fan.free_rays(belief, off, length), reaches(length, fan.distance));
        for aim in (0..RAYS).step_by(2) {
            let direction = fan.ray(aim);
            let chance = far * fan.chance(&free, aim);
            let turn = (direction - off - belief.pose.heading).abs();
            let worth = chance - TURN_PRICE * turn;
            if best.as_ref().is_none_or(|(most, _)| worth > *most) {
                best = Some((worth, Shot { direction, kick, chance }));
            }
        }
    }
    best.map(|(_, shot)| shot)
}

/// Probability of a goal by a kick in that direction, and the best shot of all; `None` from behind the goal
/// line.
pub(super) fn chance_along(
    belief: &Belief,
    attacked: GoalEnd,
    direction: Angle,
    kick: LeggedKick,
) -> Option<(f32, Shot)> {
    let fan = Fan::new(belief, attacked)?;
    let (off, length) = legged::nominal(kick);
    let ray = (direction - fan.right).radians() / fan.step.max(f32::MIN_POSITIVE);
    let chance = match math::round_to_i32(ray) {
        aim @ 0.. if (aim as usize) < RAYS => {
            reaches(length, fan.distance) * fan.chance(&fan.free_rays(belief, off, length), aim as usize)
        }
        // Beside the goal.
        _ => 0.0,
    };
    Some((chance, best_of(belief, &fan)?))
}

/// Probability that a kick nominally `length` long rolls beyond `distance`.
fn reaches(length: f32, distance: f32) -> f32 {
    // The logistic curve of slope 1.7 is the normal distribution within 0.01.
    let margin = (length - distance) / (KICK_LENGTH_SPREAD * length);
    1.0 / (1.0 + math::exp(-1.7 * margin))
}

/// Directions from the robot into the goal, from its right post to its left.
struct Fan {
    right: Angle,
    /// Angle between neighbouring rays, rad.
    step: f32,
    /// The rays' directions, of length 1.
    along: [Vector<Field>; RAYS],
    /// Probability density of a kick by the number of rays off its aim; 1 for none.
    density: [f32; RAYS],
    /// Distance to the goal's centre, or where no goalkeeper guards it to its area, m.
    distance: f32,
    /// From the robot to where each opponent will be when the ball leaves.
    opponents: heapless::Vec<Vector<Field>, OPPONENTS_MAX>,
}

impl Fan {
    fn new(belief: &Belief, attacked: GoalEnd) -> Option<Self> {
        let (field, from) = (belief.league().field(), belief.pose.position);
        let center = field.goal_center(attacked);
        let half = field.goal_width * 0.5 - belief.league().ball().radius;
        let posts = [-half, half].map(|y| from.direction_to(Point::new(center.x(), y)));
        let (right, width) = match attacked {
            GoalEnd::Positive => (posts[0], (posts[1] - posts[0]).radians()),
            GoalEnd::Negative => (posts[1], (posts[0] - posts[1]).radians()),
        };
        if width <= 0.0 {
            return None;
        }
        let step = width / (RAYS - 1) as f32;
        // Both are needed repeatedly: each is computed once.
        let along = core::array::from_fn(|index| Vector::polar(1.0, right + Angle::new(step * index as f32)));
        let density = core::array::from_fn(|off| {
            let z = step * off as f32 / KICK_ANGLE_SPREAD;
            math::exp(-0.5 * z * z)
        });
        let mut guarded = false;
        let mut opponents = heapless::Vec::new();
        for at in &belief.opponents {
            let keeps = keeps_goal(belief, attacked, *at);
            guarded |= keeps;
            // As many as the belief has room for.
            let _room = opponents.push(comes(belief, *at, keeps) - from);
        }
        let distance = from.distance(center) - if guarded { 0.0 } else { field.penalty_depth };
        Some(Self { right, step, along, density, distance, opponents })
    }

    fn ray(&self, index: usize) -> Angle {
        self.right + Angle::new(self.step * index as f32)
    }

    /// The rays along which a ball that is kicked that far, at that angle from the heading, passes every
    /// opponent.
    fn free_rays(&self, belief: &Belief, off: Angle, length: f32) -> [bool; RAYS] {
        let mut free = [true; RAYS];
        let rolling = RollingBall { deceleration: belief.league().ball().rolling_deceleration };
        let speed = rolling.speed_for(length);
        let body = belief.league().robot().radius + belief.league().ball().radius;
        for &to in &self.opponents {
            if is_at_holder(to) {
                let (sin, cos) = off.sin_cos();
                for (along, free) in self.along.iter().zip(&mut free) {
                    // The ball leaves from before the holder's body, whose heading is `off` beside the kick.
                    let (x, y) = (along.x(), along.y());
                    let heading = Vector::new(cos * x + sin * y, cos * y - sin * x);
                    *free &= !meets_at_ball(to - heading * HOLD_DISTANCE, *along);
                }
                continue;
            }
            // A ball that stops before the opponent is certainly covered.
            let Some(time) = rolling.travel_time(speed, to.norm()) else { continue };
            let covered = body + sidestep(time);
            for (along, free) in self.along.iter().zip(&mut free) {
                if along.dot(to) > 0.0 && along.cross(to).abs() < covered {
                    *free = false;
                }
            }
        }
        free
    }

    /// The share of kicks aimed along ray `aim` that run along free rays.
    fn chance(&self, free: &[bool; RAYS], aim: usize) -> f32 {
        let density = |index: usize| self.density.get(index.abs_diff(aim)).copied().unwrap_or(0.0);
        let sum: f32 = (0..RAYS).filter(|&index| free[index]).map(density).sum();
        sum * self.step / (KICK_ANGLE_SPREAD * ROOT_TWO_PI)
    }
}

/// Whether an opponent there is a goalkeeper: in its area, or with its body on the area's edge, from where it
/// meets balls.
pub(super) fn keeps_goal(belief: &Belief, attacked: GoalEnd, at: Point<Field>) -> bool {
    let (field, radius) = (belief.league().field(), belief.league().robot().radius);
    let to = field.goal_center(attacked) - at;
    to.x().abs() < field.penalty_depth + radius && to.y().abs() < 0.5 * field.penalty_width + radius
}

/// Whether an opponent at `to` from the holder's centre is in contact with it, or about to be.
pub(super) fn is_at_holder(to: Vector<Field>) -> bool {
    to.norm() < AT_HOLDER
}

/// Whether a ball kicked `along` meets an opponent at the holder that stands at `to` from the ball. Such an
/// opponent faces the ball, which lies between its front legs as deep as in a hold: what does not lead deeper
/// rolls past its body.
pub(super) fn meets_at_ball(to: Vector<Field>, along: Vector<Field>) -> bool {
    along.dot(to) > 0.0 && along.cross(to).abs() < HOLD_DISTANCE
}

/// Where an opponent will be when the ball leaves: until then it walks at the ball, a goalkeeper to where it
/// stands opposite the ball.
fn comes(belief: &Belief, at: Point<Field>, keeps: bool) -> Point<Field> {
    let Some(ball) = belief.ball.map(|ball| ball.position) else { return at };
    let (way, speed) = if keeps {
        (Vector::new(0.0, ball.y() - at.y()), WALK_SIDEWAYS)
    } else {
        let way = ball - at;
        (way.clamped((way.norm() - AT_BALL).max(0.0)), WALK_FORWARD)
    };
    at + way.clamped(speed * KICK_TIME)
}

/// Distance that a robot that now stands walks sideways within `time`, m.
fn sidestep(time: f32) -> f32 {
    let time = (time - REACTION).max(0.0);
    let speeding = WALK_SIDEWAYS / WALK_ACCELERATION;
    if time < speeding {
        0.5 * WALK_ACCELERATION * time * time
    } else {
        WALK_SIDEWAYS * (time - 0.5 * speeding)
    }
}

/// Kicks to shoot with: the hard one, and from near the goal the head kicks, which save turning.
const SHOTS: [LeggedKick; 3] = [LeggedKick::ForwardHard, LeggedKick::Left, LeggedKick::Right];
/// A shot with this probability is taken at once: about the best there is against a well-placed goalkeeper.
pub(super) const GOOD_SHOT: f32 = 0.3;
/// A shot with this probability is taken if an opponent is about to take the ball.
pub(super) const FAIR_SHOT: f32 = 0.12;
/// An opponent whose centre is this near the robot's is about to take the ball, m: two bodies and a second's
/// walk.
const PRESSED_WITHIN: f32 = 0.6;
/// Shots are made from this far before the penalty area, m: out of its goalkeeper's reach.
const SHOT_BEFORE_AREA: f32 = 0.5;
/// The ball is carried no farther for a shot, m: 5 s of walking with it.
const CARRIED_AT_MOST: f32 = 0.8;
/// This far off the goal's middle axis waiting for the far post is useful, m.
const ASIDE: f32 = 0.35;
/// Aim while waiting, beside the goal's middle, as a share of the own distance from the axis.
const FAR_POST: f32 = 0.4;
/// Rays in a fan: at 1 m from the goal they stand 3° apart, a third of a kick's spread.
const RAYS: usize = 15;
/// Probability of a goal that a shot gives up to turn 1 rad less: with the ball that takes 1 s, in which a
/// goalkeeper walks half a goal's width.
const TURN_PRICE: f32 = 0.1;
/// From the order to ball contact, s: the body's.
pub(super) const KICK_TIME: f32 = 0.4;
/// An opponent whose centre is this near the holder's touches it within a kick's time, m: two radii and half
/// a step.
const AT_HOLDER: f32 = 0.3;
/// An opponent at the ball comes no nearer to it, m: body and ball, less than a grab's reach.
const AT_BALL: f32 = 0.16;
/// Time that a standing robot needs to perceive a kick and to lift a leg, s.
const REACTION: f32 = 0.3;
/// Square root of 2π, √(2π).
const ROOT_TWO_PI: f32 = 2.506_628_3;

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::Pose;
    use rules::League;

    fn belief(x: f32, y: f32, opponents: &[(f32, f32)]) -> Belief {
        let mut belief = Belief::new(League::FourLegged);
        belief.pose = Pose { position: Point::new(x, y), heading: Angle::ZERO };
        for &(x, y) in opponents {
            let _ = belief.opponents.push(Point::new(x, y));
        }
        belief
    }

    fn chance(belief: &Belief) -> f32 {
        best_shot(belief, GoalEnd::Positive).unwrap().chance
    }

    #[test]
    fn an_empty_goal_is_as_wide_as_it_looks_to_a_scattering_kick() {
        // From 1 m the posts (less the ball) stand at ±19.7°: a deviation of 10° stays within in 95 of 100,
        // and nearly every hard kick of 2.15 ± 0.645 m rolls the 0.35 m to the area before the goal.
        assert!((chance(&belief(1.7, 0.0, &[])) - 0.95 * 0.99).abs() < 0.03);
        // From 2.15 m 84 of 100 roll the 1.5 m to it, and the posts stand at ±9.4°: 65 of 100.
        assert!((chance(&belief(0.55, 0.0, &[])) - 0.84 * 0.65).abs() < 0.04);
        // Guarded, it is the goal that counts: a goalkeeper out of the way leaves half of the hard kicks.
        assert!((chance(&belief(0.55, 0.0, &[(2.65, 0.75)])) - 0.5 * 0.65).abs() < 0.03);
    }

    #[test]
    fn a_shot_goes_where_the_goalie_is_not() {
        let shot = best_shot(&belief(1.5, 0.0, &[(2.5, 0.15)]), GoalEnd::Positive).unwrap();
        assert!(shot.direction.radians() < 0.0, "{shot:?}");
        // Directly before the goalkeeper there is no gap at all.
        assert_eq!(chance(&belief(1.5, 0.0, &[(2.05, 0.0)])), 0.0);
    }

    #[test]
    fn against_a_goalie_opposite_the_ball_the_best_place_is_aside_of_the_goals_middle() {
        let opposite = |y: f32| chance(&belief(1.4, y, &[(2.05, y)]));
        assert!(opposite(0.6) > 0.4 && opposite(0.6) > opposite(0.3) && opposite(0.3) > opposite(0.0));
    }

    #[test]
    fn an_opponent_abreast_of_a_held_ball_lets_a_kick_pass_and_one_before_it_does_not() {
        // The holder at 1.4 m faces the goal, the ball 0.13 m ahead of it, another body in contact with its
        // own.
        let with = |beside: f32| {
            let at = Vector::<Field>::polar(0.24, Angle::new(beside));
            let mut held = belief(1.4, 0.0, &[(1.4 + at.x(), at.y())]);
            held.ball = Some(crate::belief::BelievedBall {
                position: Point::new(1.53, 0.0),
                velocity: Vector::default(),
                rest: Point::new(1.53, 0.0),
            });
            chance_along(&held, GoalEnd::Positive, Angle::ZERO, LeggedKick::ForwardHard).unwrap().0
        };
        assert!(with(1.0) > 0.6, "{}", with(1.0));
        assert!(with(0.2) < 0.3, "{}", with(0.2));
    }

    #[test]
    fn a_goalkeeper_on_its_way_is_where_it_will_be_when_the_ball_leaves() {
        let chance = |keeper: f32| chance(&belief_with_ball(1.4, 0.5, &[(2.05, keeper)]));
        // Opposite the ball it stays; 0.3 m aside it comes 0.08 m nearer while the leg swings.
        let (walks, stands) = (chance(0.2), best_shot(&belief(1.4, 0.5, &[(2.05, 0.2)]), GoalEnd::Positive));
        assert!(walks < stands.unwrap().chance, "{walks}");
        assert!(keeps_goal(&belief(0.0, 0.0, &[]), GoalEnd::Positive, Point::new(2.049, 0.66)));
        assert!(!keeps_goal(&belief(0.0, 0.0, &[]), GoalEnd::Positive, Point::new(1.9, 0.3)));
    }

    fn belief_with_ball(x: f32, y: f32, opponents: &[(f32, f32)]) -> Belief {
        let mut belief = belief(x, y, opponents);
        let at = Point::new(x + 0.13, y);
        belief.ball =
            Some(crate::belief::BelievedBall { position: at, velocity: Vector::default(), rest: at });
        belief
    }

    #[test]
    fn the_other_goal_is_the_same_goal_turned_round() {
        let there = best_shot(&belief(1.5, 0.4, &[(2.1, 0.5)]), GoalEnd::Positive).unwrap();
        let mut turned = belief(-1.5, -0.4, &[(-2.1, -0.5)]);
        turned.pose.heading = Angle::HALF_TURN;
        let here = best_shot(&turned, GoalEnd::Negative).unwrap();
        assert!((here.direction - there.direction - Angle::HALF_TURN).abs() < 1e-3);
        assert!((here.chance - there.chance).abs() < 1e-3 && here.kick == there.kick);
    }

    #[test]
    fn without_a_gap_it_waits_facing_the_far_post_and_under_pressure_shoots_anyway() {
        // The goalkeeper is still crossing: near post open by a little.
        let waiting = belief(1.4, 0.6, &[(2.05, 0.33)]);
        let Some(Intent::Turn { heading }) = attempt(&waiting, GoalEnd::Positive, true) else {
            panic!("waits")
        };
        assert!(heading.radians() < -0.4, "{heading:?}");
        // In the middle it walks aside first; far away this skill does not apply.
        let middle = belief(1.4, 0.1, &[(2.05, 0.1)]);
        assert!(matches!(attempt(&middle, GoalEnd::Positive, true), Some(Intent::Carry { .. })));
        assert_eq!(attempt(&belief(0.0, 0.0, &[(2.05, 0.0)]), GoalEnd::Positive, true), None);
        let fair = belief(0.8, -0.5, &[(2.05, -0.5)]);
        let pressed = belief(0.8, -0.5, &[(2.05, -0.5), (0.6, -0.1)]);
        let share = chance(&fair);
        assert!((FAIR_SHOT..GOOD_SHOT).contains(&share), "{share}");
        assert!(!matches!(attempt(&pressed, GoalEnd::Positive, true), Some(Intent::Carry { .. }) | None));
    }
}
