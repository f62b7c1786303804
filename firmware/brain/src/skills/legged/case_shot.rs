//! `case_shot`: a case's shot at goal: when to kick, and along which leg. Field frame, SI.
//!
//! The leg that retrieval checked is played, unless the moment has made another shot likelier a goal, or
//! waiting for a gap, or from afar pushing the ball on, is worth more: optimal stopping. A choice is worth
//! the probability that it comes to a goal, above that of play that goes on with the ball lost (an opponent
//! that takes the ball kicks it away, and it is fetched again), times the probability that the ball is still
//! held when it is made: an opponent at the ball takes it with the hazard of its grabs. So a shot that a
//! goalkeeper ends is made only where it is worth more than a lost ball. Out of time the case is over, unless
//! there is such a shot: the next case decides what the holder does.

use geometry::{Angle, Field, GoalEnd, Point, Segment, Vector, math};
use motion::legged::HOLD_DISTANCE;
use motion::legged::{CARRY_SPEED, CARRY_TURN_RATE, WALK_FORWARD};
use protocol::robot_io::LeggedKick;
use protocol::team::ShotRule;

use super::shot::{self, FAIR_SHOT, GOOD_SHOT, KICK_TIME};
use crate::belief::Belief;
use crate::body::{Intent, legged};
use crate::skills::legged as skills;

/// Something to do with the ball held, and what it is worth.
#[derive(Clone, Copy)]
struct Choice {
    worth: f32,
    intent: Intent,
    rule: ShotRule,
}

impl Choice {
    /// The one that is worth more; of equals this one.
    fn or(self, other: Self) -> Self {
        if other.worth > self.worth { other } else { self }
    }
}

/// The shot of a leg that ends at `end`, kicked with `kick`, and the rule that chose it; `patient` while
/// there is time left. `None` where there is none, and no shot worth making.
pub fn case_shot(
    belief: &Belief,
    attacked: GoalEnd,
    end: Point<Field>,
    kick: LeggedKick,
    patient: bool,
) -> Option<(Intent, ShotRule)> {
    let along = belief.pose.position.direction_to(end);
    let Some((chance, best)) = shot::chance_along(belief, attacked, along, kick) else {
        return patient.then(|| (skills::shoot(belief, along, kick), ShotRule::Leg));
    };
    let holding = Holding::new(belief, attacked);
    let other = holding.shot(best.direction, best.kick, best.chance);
    if !patient {
        return (best.chance >= FAIR_SHOT).then_some((other.intent, ShotRule::OutOfTime));
    }
    // Asking for twice the probability was measured: it costs 2 to 5 points to goal against a goalkeeper.
    let leg = Choice { rule: ShotRule::Leg, ..holding.shot(along, kick, chance) };
    let shot = if best.chance > chance { other } else { leg };
    let later = holding.waiting(best.chance).unwrap_or_else(|| holding.pushing_on());
    let Choice { intent, rule, .. } = shot.or(later);
    Some((intent, rule))
}

/// A robot with the ball, and the opponent that will be at it first.
struct Holding<'b> {
    belief: &'b Belief,
    attacked: GoalEnd,
    /// Time until that opponent is at the ball, if it comes past the holder's body on no way round, s; and
    /// its direction from the holder.
    presser: Option<(f32, Angle)>,
    /// A goalkeeper stands in its area.
    guarded: bool,
}

impl<'b> Holding<'b> {
    fn new(belief: &'b Belief, attacked: GoalEnd) -> Self {
        let ball = belief.ball.map_or(belief.pose.position, |ball| ball.position);
        let keeps = |at: &Point<Field>| shot::keeps_goal(belief, attacked, *at);
        // A goalkeeper stays in its area (paper §5.1.2).
        let comes = |at: &&Point<Field>| at.distance(ball) < GRABS_WITHIN || !keeps(at);
        let nearest = belief.opponents.iter().filter(comes).map(|at| (at.distance(ball), *at));
        let nearest = nearest.reduce(|a, b| if b.0 < a.0 { b } else { a });
        let presser = nearest.map(|(distance, at)| {
            let walks = ((distance - GRABS_WITHIN) / WALK_FORWARD).max(0.0);
            (walks, belief.pose.position.direction_to(at))
        });
        Self { belief, attacked, presser, guarded: belief.opponents.iter().any(keeps) }
    }

    /// Worth of a goal with that probability, and of what a miss leaves: before a goalkeeper that ends the
    /// play.
    fn goal(&self, chance: f32) -> f32 {
        if self.guarded { chance - LOST_BALL_COST } else { chance * (1.0 - LOST_BALL_COST) }
    }

    /// Probability that no opponent has taken the ball after `time` s with about that heading: the first
    /// walks up to it, round the holder's body where the ball is behind that, and then closes its legs again
    /// and again.
    fn still_held(&self, time: f32, heading: Angle) -> f32 {
        let Some((walks, direction)) = self.presser else { return 1.0 };
        let round = ((direction - heading).abs() - REACHES_PAST).max(0.0) / SLIDES_ROUND;
        math::exp(-STEAL_HAZARD * (time - walks - round).max(0.0))
    }

    /// A kick whose ball is worth `worth`, once the robot has turned to `heading`.
    fn kick(&self, heading: Angle, (intent, rule): (Intent, ShotRule), worth: f32) -> Choice {
        let turn = heading - self.belief.pose.heading;
        let on_the_way = self.belief.pose.heading + Angle::new(0.5 * turn.radians());
        let held = self.still_held(turn.abs() / CARRY_TURN_RATE + KICK_TIME, on_the_way);
        // What is worth less than a lost ball is no better for the chance of losing it before.
        Choice { worth: if worth > 0.0 { held * worth } else { worth }, intent, rule }
    }

    /// A shot that is a goal with that probability.
    fn shot(&self, along: Angle, kick: LeggedKick, chance: f32) -> Choice {
        let heading = along - legged::nominal(kick).0;
        let shoots = skills::shoot(self.belief, along, kick);
        self.kick(heading, (shoots, ShotRule::Likelier), self.goal(chance))
    }

    /// Carrying the ball to the best place for shots, or waiting there for the far post, where the best shot
    /// now has that probability.
    fn waiting(&self, chance: f32) -> Option<Choice> {
        let intent = shot::prepare(self.belief, self.attacked)?;
        let pose = self.belief.pose;
        let (time, heading) = match intent {
            Intent::Carry { to } => {
                (pose.position.distance(to) / CARRY_SPEED, pose.position.direction_to(to))
            }
            _ => (GOALKEEPER_CROSSES, pose.heading),
        };
        // The gap that it waits for comes or does not: even odds.
        let then = self.goal(0.5 * (GOOD_SHOT + chance));
        let worth = self.still_held(time + KICK_TIME, heading) * then;
        Some(Choice { worth, intent, rule: ShotRule::Gap })
    }

    /// A short kick towards the best place for shots, where that is far.
    fn pushing_on(&self) -> Choice {
        let place = shot::shooting_place(self.belief, self.attacked);
        let along = self.belief.pose.position.direction_to(place);
        let worth = self.after(along, legged::nominal(LeggedKick::ForwardSoft).1);
        let pushes = skills::push_on(self.belief, self.attacked);
        self.kick(along, (pushes, ShotRule::PushOn), worth)
    }

    /// What a ball is worth that is kicked `length` m ahead in that direction, not at the goal: a good shot,
    /// less the ground lost, if this robot is first at it. None where an opponent stands in its path; less
    /// where it leaves the field or comes to the goalkeeper, which ends the play.
    fn after(&self, along: Angle, length: f32) -> f32 {
        let (belief, from) = (self.belief, self.belief.pose.position);
        let unit = Vector::polar(1.0, along);
        let path = Segment::new(from, from + unit * length);
        let field = belief.league().field();
        let goalkeepers = self.guarded && field.in_penalty_area(self.attacked, path.to);
        if goalkeepers || field.clamp(path.to, LINE_MARGIN_M).distance(path.to) > 0.0 {
            return -LOST_BALL_COST;
        }
        let meets = |opponent: &Point<Field>| {
            let to = *opponent - from;
            if shot::is_at_holder(to) {
                shot::meets_at_ball(to - unit * HOLD_DISTANCE, unit)
            } else {
                path.distance_to(*opponent) < PASSES_BY
            }
        };
        if belief.opponents.iter().any(meets) {
            return 0.0;
        }
        let theirs = belief.nearest_opponent(path.to).map_or(f32::INFINITY, |(_, distance)| distance);
        let first = GRAB_SUCCEEDS * (theirs / length).min(1.0);
        let goal = field.goal_center(self.attacked);
        let lost = (path.to.distance(goal) - from.distance(goal)).max(0.0);
        first * (self.goal(GOOD_SHOT) - GROUND * lost).max(0.0)
    }
}

/// With the ball held and an opponent about to be at it: the shot that is worth more than to go on with the
/// case, which takes `time` s; before a goalkeeper only one that is made at once anywhere.
pub fn pressed_shot(belief: &Belief, attacked: GoalEnd, time: f32) -> Option<Intent> {
    let holding = Holding::new(belief, attacked);
    let (walks, _) = holding.presser?;
    if walks > PRESSED_FOR {
        return None;
    }
    let best = shot::best_shot(belief, attacked)?;
    if holding.guarded && best.chance < GOOD_SHOT {
        return None;
    }
    let shot = holding.shot(best.direction, best.kick, best.chance);
    let go_on = holding.still_held(time, belief.pose.heading) * holding.goal(GOOD_SHOT);
    (shot.worth > 0.0 && shot.worth > go_on).then_some(shot.intent)
}

/// Probability of a goal, as [`shot`] estimates it, at which a shot is worth a lost ball: of the shots
/// estimated at 0.10 to 0.15 in the paper's scenarios 0.31 came to goal; of the balls that opponents took out
/// of our legs 0.19 to 0.31 did later.
const LOST_BALL_COST: f32 = FAIR_SHOT;
/// A holder is pressed by an opponent that is at the ball within this time, s: a kick's, and a look.
const PRESSED_FOR: f32 = 1.0;
/// An opponent whose centre is this near the ball closes its legs on it, m: the grab's reach and a step.
const GRABS_WITHIN: f32 = 0.3;
/// Hazard of an opponent at a held ball, 1/s: a grab of 0.5 s takes it in 0.375 of tries (0.75 of grabs
/// succeed, half of those against a grip): −ln(1 − 0.375) / 0.5.
const STEAL_HAZARD: f32 = 0.94;
/// Two bodies touch at 0.24 m, and the ball lies 0.13 m before the holder's centre: farther than this off the
/// holder's heading an opponent has it beyond a grab's 0.17 m, rad.
const REACHES_PAST: f32 = 0.75;
/// An opponent that walks at the ball slides round the holder's body so fast, rad/s: of its 0.3 m/s half is
/// along a body 0.24 m away.
const SLIDES_ROUND: f32 = 0.65;
/// A goalkeeper that follows the ball's turn leaves the far post open within about this time, s.
const GOALKEEPER_CROSSES: f32 = 1.0;
/// A kick passes an opponent at this distance of centres, m: body and ball, and half the scatter over 0.8 m.
const PASSES_BY: f32 = 0.24;
/// Share of grabs that succeed, as bodies of this league do.
const GRAB_SUCCEEDS: f32 = 0.75;
/// A kick into free space ends this far within the lines, m.
const LINE_MARGIN_M: f32 = 0.3;
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

    fn chosen(belief: &Belief, y: f32, patient: bool) -> Option<(Intent, ShotRule)> {
        case_shot(belief, GoalEnd::Positive, Point::new(2.7, y), LeggedKick::ForwardHard, patient)
    }

    fn shot(belief: &Belief, y: f32, patient: bool) -> Option<Intent> {
        chosen(belief, y, patient).map(|(intent, _)| intent)
    }

    #[test]
    fn every_shot_names_the_rule_that_chose_it() {
        let rule = |belief: &Belief, y, patient| chosen(belief, y, patient).map(|(_, rule)| rule);
        // Through the middle no shot is likelier than the leg; beside a post the middle is.
        let unguarded = belief(1.4, 0.0, 0.0, &[]);
        assert_eq!(rule(&unguarded, 0.0, true), Some(ShotRule::Leg));
        assert_eq!(rule(&unguarded, 0.3, true), Some(ShotRule::Likelier));
        assert_eq!(rule(&unguarded, 0.0, false), Some(ShotRule::OutOfTime));
        // Aside of the goal's middle, with the goalkeeper opposite, the far post will open.
        assert_eq!(rule(&belief(1.4, 0.6, -0.3, &[(2.1, 0.33)]), 0.0, true), Some(ShotRule::Gap));
        assert_eq!(rule(&belief(-1.4, 0.0, 0.0, &[]), 0.0, true), Some(ShotRule::PushOn));
    }

    #[test]
    fn the_leg_is_the_one_that_is_kicked_unless_another_is_likelier_a_goal() {
        let kick = |heading: f32, y: f32| shot(&belief(1.4, 0.0, heading, &[]), y, true).unwrap();
        assert_eq!(kick(0.0, 0.0), Intent::Kick(LeggedKick::ForwardHard));
        assert!(matches!(kick(0.4, 0.0), Intent::Turn { .. }));
        // The goal is unguarded: its middle is likelier than beside a post.
        assert_eq!(kick(0.0, 0.3), Intent::Kick(LeggedKick::ForwardHard));
    }

    #[test]
    fn a_leg_that_the_moment_has_closed_gives_way_to_an_open_one() {
        let closed = belief(1.4, 0.0, 0.1, &[(2.2, 0.2)]);
        let other = match shot(&closed, 0.3, true).unwrap() {
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
        let pressed = belief(1.4, 0.6, -0.3, &[(2.1, 0.33), (1.55, 0.35)]);
        let waits = |belief: &Belief| {
            let holding = Holding::new(belief, GoalEnd::Positive);
            holding.still_held(GOALKEEPER_CROSSES + KICK_TIME, belief.pose.heading)
        };
        // The goalkeeper stays in its area.
        assert!(waits(&alone) > 0.9 && waits(&pressed) < 0.3);
    }

    #[test]
    fn an_opponent_behind_the_holder_comes_round_its_body_first() {
        let held = |at| {
            let belief = belief(1.4, 0.0, 0.0, &[at]);
            Holding::new(&belief, GoalEnd::Positive).still_held(1.0, Angle::ZERO)
        };
        assert!(held((1.16, 0.0)) == 1.0 && held((1.6, 0.13)) < 0.5);
    }

    #[test]
    fn out_of_time_the_case_is_over_without_a_shot_worth_a_lost_ball() {
        // The goalkeeper stands in the way of all of the goal.
        let closed = belief(1.5, 0.0, 0.0, &[(2.05, 0.0)]);
        assert_eq!(shot(&closed, 0.0, false), None);
        let open = belief(1.4, 0.6, -0.5, &[(2.1, 0.6)]);
        assert!(shot(&open, -0.3, false).is_some());
    }

    #[test]
    fn a_pressed_holder_shoots_where_that_is_worth_more_than_to_go_on() {
        let pressed = belief(1.4, 0.0, 0.0, &[(1.5, 0.22)]);
        let shoots = |belief: &Belief| pressed_shot(belief, GoalEnd::Positive, 2.0);
        assert!(
            matches!(shoots(&pressed), Some(Intent::Kick(_) | Intent::Turn { .. })),
            "{:?}",
            shoots(&pressed)
        );
        assert_eq!(shoots(&belief(1.4, 0.0, 0.0, &[(0.4, 0.0)])), None, "no opponent presses it");
        assert_eq!(shoots(&belief(-1.4, 0.0, 0.0, &[(-1.3, 0.22)])), None, "the goal is far");
        let guarded = belief(1.5, 0.0, 0.0, &[(1.6, 0.22), (2.05, 0.0)]);
        assert_eq!(shoots(&guarded), None, "before a goalkeeper it goes on without a good shot");
    }
}
