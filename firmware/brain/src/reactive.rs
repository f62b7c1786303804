//! What does a robot do by itself, when no case binds it? The reactive behaviour of the paper's comparison (§5).
//!
//! The robot nearest the ball goes for it as fast as possible and alone towards the attacked goal; the others back up,
//! off the line from ball to goal. An opponent is considered only when it blocks the way within 0.4 m: then dodge,
//! carrying the ball diagonally past it. Short kicks advance, near the goal the robot turns and shoots. No passes.

use geometry::{Angle, Field, GoalEnd, Point, Vector};
use protocol::robot_io::LeggedKick;
use protocol::team::{Role, Status};
use protocol::{Duration, Instant, RobotId};

use crate::belief::{Ball, Belief};
use crate::body::{Intent, legged};
use crate::execution::face_ball;
use crate::mates::Mates;
use crate::skills::{self, Step};

/// How much of the behaviour is wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Freedom {
    /// All of it.
    Full,
    /// Keep near the ball, leave it to others: a robot that waits for the end of a gameplay.
    KeepNear,
    /// Approach, but neither grab nor kick: the short time between two gameplays.
    Approach,
}

/// The behaviour's small memory.
#[derive(Clone, Debug, Default)]
pub struct Reactive {
    role: Role,
    held_since: Option<Instant>,
    dodge: Option<Angle>,
}

impl Reactive {
    /// What this robot presently is to its team.
    pub fn role(&self) -> Role {
        self.role
    }

    /// Bound by a case: forget roles and dodges.
    pub fn rest(&mut self) {
        *self = Self::default();
    }

    /// One step.
    pub fn step(
        &mut self,
        now: Instant,
        me: RobotId,
        belief: &Belief,
        mates: &Mates,
        attacked: GoalEnd,
        freedom: Freedom,
    ) -> Intent {
        let Some(ball) = belief.ball else { return Intent::Stand { face: None } };
        if !belief.holds_ball {
            (self.held_since, self.dodge) = (None, None);
        }
        let mine = freedom != Freedom::KeepNear && is_attacker(now, me, &ball, belief, mates, self.role);
        self.role = if mine { Role::Attacker } else { Role::Supporter };
        if !mine {
            return support(belief, &ball, attacked);
        }
        if belief.busy {
            return Intent::Stand { face: None };
        }
        let goal = belief.league().field().goal_center(attacked);
        if belief.holds_ball {
            return match freedom {
                Freedom::Full => self.advance(now, belief, &ball, goal),
                _ => Intent::Stand { face: None },
            };
        }
        let onwards = ball.position.direction_to(goal);
        match skills::get_ball(belief, Some(onwards)) {
            Step::Running(Intent::Grab) if freedom != Freedom::Full => Intent::Stand { face: None },
            Step::Running(intent) => intent,
            Step::Done => Intent::Stand { face: None },
        }
    }

    /// With the ball: shoot, dodge or push it on.
    fn advance(&mut self, now: Instant, belief: &Belief, ball: &Ball, goal: Point<Field>) -> Intent {
        let since = *self.held_since.get_or_insert(now);
        let to_goal = belief.pose.position.direction_to(goal);
        if belief.pose.position.distance(goal) < SHOOT_WITHIN {
            let target = open_side(belief, goal);
            return skills::shoot(belief, skills::aim(belief, target), LeggedKick::ForwardHard);
        }
        if now.since(since) < DODGE_FOR {
            if self.dodge.is_none() {
                self.dodge = blocker(belief, ball, to_goal).map(|opponent| {
                    let left = (opponent - ball.position).cross(Vector::polar(1.0, to_goal)) > 0.0;
                    to_goal + if left { DODGE_ANGLE } else { -DODGE_ANGLE }
                });
            }
            if let Some(direction) = self.dodge {
                let to = belief.pose.position + Vector::polar(DODGE_STEP, direction);
                return Intent::Carry { to: belief.league().field().clamp(to, KEEP_INSIDE) };
            }
        }
        match (self.dodge, blocker(belief, ball, to_goal)) {
            // Still blocked after the dodge: with the head, to the side it dodged to.
            (Some(side), Some(_)) => {
                let kick =
                    if (side - to_goal).radians() > 0.0 { LeggedKick::Left } else { LeggedKick::Right };
                skills::shoot(belief, to_goal + legged::nominal(kick).0, kick)
            }
            (dodged, _) => skills::shoot(belief, dodged.unwrap_or(to_goal), LeggedKick::ForwardSoft),
        }
    }
}

/// Whether the ball is this robot's: it holds it, or nobody does and nobody is nearer (the one who already goes for it
/// keeps it unless beaten clearly).
fn is_attacker(now: Instant, me: RobotId, ball: &Ball, belief: &Belief, mates: &Mates, role: Role) -> bool {
    if belief.holds_ball {
        return true;
    }
    let mine = belief.pose.position.distance(ball.position);
    let mine = if role == Role::Attacker { mine - KEEP_ROLE } else { mine };
    mates.present(now).all(|(id, mate)| {
        let theirs = mate.pose().position.distance(ball.position);
        let theirs = if mate.beacon.role == Role::Attacker { theirs - KEEP_ROLE } else { theirs };
        !mate.beacon.status.has(Status::HOLDS_BALL) && (mine < theirs || (mine == theirs && me < id))
    })
}

/// Back up: beside the ball, off its line to the goal, on the side where the robot is.
fn support(belief: &Belief, ball: &Ball, attacked: GoalEnd) -> Intent {
    let field = belief.league().field();
    let to_goal = ball.position.direction_to(field.goal_center(attacked));
    let left = Vector::polar(1.0, to_goal).cross(belief.pose.position - ball.position) > 0.0;
    let place = |left: bool| {
        let direction = to_goal + if left { SUPPORT_ANGLE } else { -SUPPORT_ANGLE };
        ball.position + Vector::polar(SUPPORT_DISTANCE, direction)
    };
    // The other side where this one lies outside the field.
    let side = if field.contains(place(left)) || !field.contains(place(!left)) { left } else { !left };
    let to = field.clamp(place(side), KEEP_INSIDE);
    if belief.holds_ball {
        return Intent::Stand { face: None };
    }
    if belief.pose.position.distance(to) < SUPPORT_TOLERANCE {
        return Intent::Stand { face: Some(face_ball(belief, belief.pose.position)) };
    }
    Intent::Walk { to, face: face_ball(belief, to), shy_of_ball: true }
}

/// The opponent that blocks a kick towards the goal, if one does.
fn blocker(belief: &Belief, ball: &Ball, to_goal: Angle) -> Option<Point<Field>> {
    belief.opponents.iter().copied().find(|&opponent| {
        let v = opponent - ball.position;
        v.norm() < BLOCKED_WITHIN && (v.angle() - to_goal).abs() < BLOCKED_ANGLE
    })
}

/// The point of the goal mouth whose line from the robot keeps farthest from every opponent.
fn open_side(belief: &Belief, goal: Point<Field>) -> Point<Field> {
    let half = belief.league().field().goal_width * 0.5;
    let targets = [0.0, 0.6, -0.6].map(|share| Point::new(goal.x(), half * share));
    let clearance = |target: Point<Field>| {
        let line = geometry::Segment::new(belief.pose.position, target);
        belief.opponents.iter().map(|&o| line.distance_to(o)).fold(f32::INFINITY, f32::min)
    };
    // The middle unless a side is clearer.
    targets.into_iter().reduce(|a, b| if clearance(b) > clearance(a) { b } else { a }).unwrap_or(goal)
}

/// From here the hard kick (2.15 m) reaches the goal with power left, m.
const SHOOT_WITHIN: f32 = 1.7;
/// "Approximately 40 cm away at most" (paper §5.3.1), m.
const BLOCKED_WITHIN: f32 = 0.4;
/// An opponent in this half angle about the goal's direction blocks a forward kick.
const BLOCKED_ANGLE: f32 = 0.8;
/// Diagonally: 45°.
const DODGE_ANGLE: Angle = Angle::const_new(core::f32::consts::FRAC_PI_4);
/// Where the dodge leads, m ahead.
const DODGE_STEP: f32 = 0.5;
/// A ball may be held for 3 s by the league's rule; dodge for half of it.
const DODGE_FOR: Duration = Duration::millis(1500);
/// A supporter keeps this far from the ball (checklist §3.5: 0.8–1 m).
const SUPPORT_DISTANCE: f32 = 0.9;
/// And this far off the line from ball to goal: 70°.
const SUPPORT_ANGLE: Angle = Angle::const_new(1.221_730_5);
/// And stands still within, m.
const SUPPORT_TOLERANCE: f32 = 0.12;
/// Places of the behaviour keep this far within the lines, m.
const KEEP_INSIDE: f32 = 0.25;
/// A robot that goes for the ball counts as this much nearer, m: roles do not flicker.
const KEEP_ROLE: f32 = 0.2;

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::Pose;
    use rules::League;

    fn belief(me: (f32, f32), ball: (f32, f32)) -> Belief {
        let mut belief = Belief::new(League::FourLegged);
        belief.pose = Pose { position: Point::new(me.0, me.1), heading: Angle::ZERO };
        let at = Point::new(ball.0, ball.1);
        belief.ball = Some(Ball { position: at, velocity: Vector::default(), rest: at });
        belief
    }

    fn step(reactive: &mut Reactive, belief: &Belief, ms: u64) -> Intent {
        let me = RobotId::new(1).unwrap();
        reactive.step(Instant(ms * 1000), me, belief, &Mates::default(), GoalEnd::Positive, Freedom::Full)
    }

    #[test]
    fn alone_it_goes_for_the_ball() {
        let mut reactive = Reactive::default();
        assert!(matches!(step(&mut reactive, &belief((0.0, 0.0), (1.0, 0.0)), 0), Intent::Walk { .. }));
        assert_eq!(reactive.role(), Role::Attacker);
    }

    #[test]
    fn an_opponent_farther_than_forty_centimetres_is_not_considered() {
        let mut b = belief((0.0, 0.0), (0.13, 0.0));
        b.holds_ball = true;
        let _ = b.opponents.push(Point::new(0.6, 0.0));
        assert_eq!(step(&mut Reactive::default(), &b, 0), Intent::Kick(LeggedKick::ForwardSoft));
    }

    #[test]
    fn a_near_opponent_ahead_is_dodged_to_its_other_side_and_only_for_a_while() {
        let mut b = belief((0.0, 0.0), (0.13, 0.0));
        b.holds_ball = true;
        let _ = b.opponents.push(Point::new(0.45, 0.05));
        let mut reactive = Reactive::default();
        let Intent::Carry { to } = step(&mut reactive, &b, 0) else { panic!("dodges") };
        assert!(to.y() < 0.0, "opponent is on the left, dodge right: {to:?}");
        assert!(!matches!(step(&mut reactive, &b, 1600), Intent::Carry { .. }));
    }

    #[test]
    fn a_shot_goes_where_the_goalie_is_not() {
        let mut b = belief((1.5, 0.0), (1.63, 0.0));
        b.holds_ball = true;
        let _ = b.opponents.push(Point::new(2.5, 0.15));
        assert!(open_side(&b, Point::new(2.7, 0.0)).y() < 0.0);
    }

    #[test]
    fn a_supporter_backs_up_off_the_line_to_the_goal() {
        let b = belief((-0.5, 0.4), (0.0, 0.0));
        let Intent::Walk { to, .. } = support(&b, &b.ball.unwrap(), GoalEnd::Positive) else {
            panic!("walks")
        };
        assert!((to.distance(Point::new(0.0, 0.0)) - SUPPORT_DISTANCE).abs() < 1e-3);
        assert!(to.y() > 0.5);
    }
}
