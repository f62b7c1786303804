//! `legged`: reactive behaviour of walking robots without a case: that of the paper's comparison (§5).
//!
//! Every robot goes for a loose ball as fast as possible. The one that has it plays on alone towards the
//! attacked goal, and as long as it holds the ball, or is at it to take it, the others back up, off the line
//! from ball to goal; once the ball has left it, all go for the ball again (§5.2.1). An opponent is
//! considered only when it blocks the path within 0.4 m: then dodge, turning with the ball and stepping
//! diagonally, and kick as soon as the kick passes it. Short kicks advance, near the goal the robot turns to
//! the clearest lane and shoots. No passes.
//!
//! Needed to be as strong as the paper's (28 % to goal in scenario 1, 17 % in 3, defender and goalkeeper):
//! kicks out of a duel that pass the opponent and end where one of us is first, head kicks among them; shots
//! by the open angle of the goal, from aside of its middle, where a goalkeeper opposite the ball leaves the
//! far post open; standing turned to that post until it opens. `onetwo evaluate` measures it.

use geometry::{Angle, Field, GoalEnd, Point, Vector, math};
use protocol::robot_io::LeggedKick;
use protocol::team::{Role, Status};
use protocol::{Duration, Instant};

use crate::belief::{Belief, BelievedBall};
use crate::body::{Intent, legged};
use crate::execution::face_ball;
use crate::reactive::Freedom;
use crate::skills::Step;
use crate::skills::legged as skills;
use crate::teammates::{Teammate, Teammates};

/// State of the behaviour.
#[derive(Clone, Debug, Default)]
pub struct LeggedReactive {
    role: Role,
    held_since: Option<Instant>,
    dodge: Option<bool>,
}

impl LeggedReactive {
    /// This robot's present role in its team.
    pub fn role(&self) -> Role {
        self.role
    }

    /// While a case is played: resets roles and dodges.
    pub fn rest(&mut self) {
        *self = Self::default();
    }

    /// The intent of one step.
    pub fn step(
        &mut self,
        now: Instant,
        belief: &Belief,
        teammates: &Teammates,
        attacked: GoalEnd,
        freedom: Freedom,
    ) -> Intent {
        let Some(ball) = belief.ball else { return Intent::Stand { face: None } };
        if !belief.holds_ball {
            (self.held_since, self.dodge) = (None, None);
        }
        let mine = freedom != Freedom::KeepNear && is_attacker(now, &ball, belief, teammates);
        self.role = if mine { Role::Attacker } else { Role::Supporter };
        if !mine {
            let place = match freedom {
                Freedom::KeepNear => across(belief, &ball, attacked),
                _ => beside(belief, &ball, attacked),
            };
            return support(belief, place);
        }
        if belief.busy {
            return Intent::Stand { face: None };
        }
        let goal = belief.league().field().goal_center(attacked);
        if belief.holds_ball {
            return match freedom {
                Freedom::Full => self.advance(now, belief, teammates, &ball, attacked),
                _ => Intent::Stand { face: None },
            };
        }
        let exit_heading = ball.position.direction_to(goal);
        match skills::get_ball(belief, Some(exit_heading)) {
            // Between two gameplays a ball is taken only if an opponent is about to take it.
            Step::Running(Intent::Grab) if freedom != Freedom::Full && !disputed(belief, &ball) => {
                Intent::Stand { face: None }
            }
            Step::Running(intent) => intent,
            Step::Done => Intent::Stand { face: None },
        }
    }

    /// With the ball: shoot, dodge or push it on.
    fn advance(
        &mut self,
        now: Instant,
        belief: &Belief,
        teammates: &Teammates,
        ball: &BelievedBall,
        attacked: GoalEnd,
    ) -> Intent {
        let since = *self.held_since.get_or_insert(now);
        let patient = now.since(since) < DODGE_FOR;
        let me = belief.pose.position;
        let goal = belief.league().field().goal_center(attacked);
        let to_goal = me.direction_to(goal);
        if now.since(since) > HOLD_FOR {
            return skills::shoot(belief, to_goal, LeggedKick::ForwardHard);
        }
        if let Some(intent) = skills::attempt(belief, attacked, patient) {
            return intent;
        }
        let blocked = blocker(belief, ball, to_goal);
        // A dodge that has started is ended by a kick: otherwise an opponent at the limit would keep it
        // turning to and fro.
        let opponent =
            blocked.or_else(|| self.dodge.and(belief.nearest_opponent(ball.position)).map(|(at, _)| at));
        let Some(opponent) = opponent else {
            return skills::push_on(belief, attacked);
        };
        if let Some(kick) = way_out(now, belief, teammates, ball, goal) {
            return Intent::Kick(kick);
        }
        let left = *self.dodge.get_or_insert_with(|| left_is_clearer(belief, ball, to_goal));
        let past = past(ball, opponent, left);
        if patient {
            Intent::Carry { to: me + Vector::polar(DODGE_STEP, past) }
        } else {
            skills::shoot(belief, past, strength(belief, ball, past))
        }
    }
}

/// The kick from where the robot stands now that passes every opponent, ends in the field and is best for us
/// there.
fn way_out(
    now: Instant,
    belief: &Belief,
    teammates: &Teammates,
    ball: &BelievedBall,
    goal: Point<Field>,
) -> Option<LeggedKick> {
    let field = belief.league().field();
    let mut best: Option<(f32, LeggedKick)> = None;
    for kick in [LeggedKick::ForwardHard, LeggedKick::ForwardSoft, LeggedKick::Left, LeggedKick::Right] {
        let (off, length) = legged::nominal(kick);
        let direction = belief.pose.heading + off;
        let end = ball.position + Vector::polar(length, direction);
        let inside = field.clamp(end, KICK_INSIDE).distance(end) == 0.0;
        if !inside || clearance(belief, ball.position, direction, SOFT_KICK) < LANE {
            continue;
        }
        let ours = teammates.present(now).map(|(_, teammate)| teammate.pose().position.distance(end));
        let ours = ours.fold(belief.pose.position.distance(end), f32::min);
        let theirs = belief.nearest_opponent(end).map_or(f32::INFINITY, |(_, distance)| distance);
        let ahead = ball.position.distance(goal) - end.distance(goal);
        let worth = (theirs - ours).min(FIRST_BY) + ahead;
        if best.is_none_or(|(most, _)| worth > most) {
            best = Some((worth, kick));
        }
    }
    best.map(|(_, kick)| kick)
}

/// Whether an opponent is about to be at the ball.
fn disputed(belief: &Belief, ball: &BelievedBall) -> bool {
    belief.nearest_opponent(ball.position).is_some_and(|(_, distance)| distance < DISPUTED_WITHIN)
}

/// The hard kick if it stays within the lines, else the soft one.
fn strength(belief: &Belief, ball: &BelievedBall, direction: Angle) -> LeggedKick {
    let (_, length) = legged::nominal(LeggedKick::ForwardHard);
    let end = ball.position + Vector::polar(length, direction);
    let field = belief.league().field();
    if field.clamp(end, KICK_INSIDE).distance(end) > 0.0 {
        LeggedKick::ForwardSoft
    } else {
        LeggedKick::ForwardHard
    }
}

/// Whether the ball is this robot's to go for: unless a teammate holds it, or is at it and nearer (paper
/// §5.2.1: while one possesses the ball the other makes way; "once the action ends, both robots will try to
/// get near"). Two robots that both go up to a resting ball block each other for ever: so the first at it
/// possesses it.
fn is_attacker(now: Instant, ball: &BelievedBall, belief: &Belief, teammates: &Teammates) -> bool {
    let mine = belief.pose.position.distance(ball.position);
    let possesses = |teammate: &Teammate| {
        let theirs = teammate.pose().position.distance(ball.position);
        teammate.beacon.status.has(Status::HOLDS_BALL) || (theirs < AT_BALL && theirs < mine)
    };
    belief.holds_ball || !teammates.present(now).any(|(_, teammate)| possesses(teammate))
}

/// Back up: beside the ball, off its line to the goal, on the side with more room.
fn beside(belief: &Belief, ball: &BelievedBall, attacked: GoalEnd) -> Point<Field> {
    let field = belief.league().field();
    let to_goal = ball.position.direction_to(field.goal_center(attacked));
    let left = left_is_clearer(belief, ball, to_goal);
    let place = |left: bool| {
        let direction = to_goal + if left { SUPPORT_ANGLE } else { -SUPPORT_ANGLE };
        ball.position + Vector::polar(SUPPORT_DISTANCE, direction)
    };
    // The other side where this place is outside the field.
    let side = if field.contains(place(left)) || !field.contains(place(!left)) { left } else { !left };
    field.clamp(place(side), KEEP_INSIDE)
}

/// Beside a gameplay of others: across the field from the ball's stop position and ahead of it, for the next
/// one's pass.
fn across(belief: &Belief, ball: &BelievedBall, attacked: GoalEnd) -> Point<Field> {
    let goal = belief.league().field().goal_center(attacked);
    let me = belief.pose.position;
    let side = if ball.rest.y().abs() > ACROSS_FROM { -ball.rest.y() } else { me.y() }.signum();
    let ahead = goal.x().signum();
    let farthest = (goal.x().abs() - ACROSS_BEFORE_GOAL) * ahead;
    let x = ball.rest.x() + ACROSS_AHEAD * ahead;
    Point::new(if (x - farthest) * ahead > 0.0 { farthest } else { x }, ACROSS_OFF * side)
}

fn support(belief: &Belief, to: Point<Field>) -> Intent {
    if belief.holds_ball {
        return Intent::Stand { face: None };
    }
    if belief.pose.position.distance(to) < SUPPORT_TOLERANCE {
        return Intent::Stand { face: Some(face_ball(belief, belief.pose.position)) };
    }
    Intent::Walk { to, face: face_ball(belief, to), avoid_ball: true }
}

/// The opponent that is near the ball and on the path of a kick towards the goal.
fn blocker(belief: &Belief, ball: &BelievedBall, to_goal: Angle) -> Option<Point<Field>> {
    belief.opponents.iter().copied().find(|&opponent| {
        let v = opponent - ball.position;
        v.norm() < BLOCKED_WITHIN && (v.angle() - to_goal).abs() < BLOCKED_ANGLE
    })
}

/// Smallest distance of any opponent from a kick's path, m.
fn clearance(belief: &Belief, from: Point<Field>, direction: Angle, length: f32) -> f32 {
    let path = geometry::Segment::new(from, from + Vector::polar(length, direction));
    belief.opponents.iter().map(|&o| path.distance_to(o)).fold(f32::INFINITY, f32::min)
}

/// The direction in which a kick passes `opponent` on its left or right.
fn past(ball: &BelievedBall, opponent: Point<Field>, left: bool) -> Angle {
    let v = opponent - ball.position;
    let off = math::atan2(PASS_BY, v.norm()).clamp(DODGE_OFF[0], DODGE_OFF[1]);
    v.angle() + Angle::new(if left { off } else { -off })
}

/// On which side of the line to the goal a dodge is better: where a hard kick stays within the lines, else
/// the clearer, else the inner.
fn left_is_clearer(belief: &Belief, ball: &BelievedBall, to_goal: Angle) -> bool {
    let value = |direction: Angle| {
        let end = ball.position + Vector::polar(HARD_KICK, direction);
        let inside = if belief.league().field().contains(end) { 1.0 } else { 0.0 };
        let inner = -INNER_SIDE * direction.sin_cos().0 * ball.position.y();
        inside + inner + clearance(belief, ball.position, direction, SOFT_KICK).min(LANE_ENOUGH)
    };
    value(to_goal + DODGE_ANGLE) >= value(to_goal - DODGE_ANGLE)
}

/// The hard kick's nominal distance, m: from here a clear shot reaches the goal. Also the distance that a
/// dodge's kick should have within the lines.
const HARD_KICK: f32 = 2.15;
/// The soft kick's nominal distance, m.
const SOFT_KICK: f32 = 0.8;
/// "Approximately 40 cm away at most" (paper §5.3.1): ball to the opponent's centre, m.
const BLOCKED_WITHIN: f32 = 0.4;
/// An opponent this near the ball will be at it within the time of a grab and a step, m.
const DISPUTED_WITHIN: f32 = 0.5;
/// An opponent in this half angle about the goal's direction blocks a forward kick.
const BLOCKED_ANGLE: f32 = 0.8;
/// Angle of a dodge: diagonally, 45°.
const DODGE_ANGLE: Angle = Angle::const_new(core::f32::consts::FRAC_PI_4);
/// Length of a dodge, m ahead.
const DODGE_STEP: f32 = 0.5;
/// A ball may be held for 3 s by the league's rule; dodge for half of it.
const DODGE_FOR: Duration = Duration::millis(1500);
/// After this time the ball is kicked in any direction.
const HOLD_FOR: Duration = Duration::millis(3000);
/// A kick is free if it passes every opponent's centre at this distance, m: body and ball (0.1625) and its
/// scatter of 10° over 0.4 m.
const LANE: f32 = 0.24;
/// A lane clearer than this is no better, m.
const LANE_ENOUGH: f32 = 0.4;
/// A dodge aims to pass the opponent at this distance, m: [`LANE`] and what the opponent walks sideways while
/// the leg swings.
const PASS_BY: f32 = 0.3;
/// A dodge's direction is at least and at most this far off the opponent's, rad: about 35° and 70°.
const DODGE_OFF: [f32; 2] = [0.6, 1.2];
/// Being nearer than every opponent by more than this is no better, m: time for a grab that fails once.
const FIRST_BY: f32 = 0.5;
/// Prefers the side towards the field's middle axis: small enough to decide between equally clear sides
/// alone, per m off the axis.
const INNER_SIDE: f32 = 0.05;
/// A hard kick should end this far within the lines, m: half of its scatter in distance.
const KICK_INSIDE: f32 = 0.3;
/// A ball this far off the field's long axis is on one side, m.
const ACROSS_FROM: f32 = 0.3;
/// A robot that waits across the field waits this far ahead of the ball, m: within one pass and one
/// adaptation.
const ACROSS_AHEAD: f32 = 0.6;
/// And this far off the axis, m: half a penalty area's width, where a goalkeeper opposite the ball leaves the
/// far post open.
const ACROSS_OFF: f32 = 0.6;
/// But no nearer the goal line than this, m: half a metre before the penalty area.
const ACROSS_BEFORE_GOAL: f32 = 1.3;
/// A robot whose centre is this near the ball is at it, m: its next step is the grab's (0.17 m and a body).
const AT_BALL: f32 = 0.3;
/// A supporter keeps this far from the ball (an estimate between 0.8 and 1 m).
const SUPPORT_DISTANCE: f32 = 0.9;
/// And this far off the line from ball to goal: 70°.
const SUPPORT_ANGLE: Angle = Angle::const_new(1.221_730_5);
/// And stands still within, m.
const SUPPORT_TOLERANCE: f32 = 0.12;
/// Places of the behaviour keep this far within the lines, m.
const KEEP_INSIDE: f32 = 0.25;

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::Pose;
    use protocol::RobotId;
    use protocol::quantized::WirePose;
    use protocol::team::{Beacon, Progress};
    use rules::League;

    fn belief(me: (f32, f32), ball: (f32, f32)) -> Belief {
        let mut belief = Belief::new(League::FourLegged);
        belief.pose = Pose { position: Point::new(me.0, me.1), heading: Angle::ZERO };
        let at = Point::new(ball.0, ball.1);
        belief.ball = Some(BelievedBall { position: at, velocity: Vector::default(), rest: at });
        belief
    }

    fn step(reactive: &mut LeggedReactive, belief: &Belief, ms: u64) -> Intent {
        reactive.step(Instant(ms * 1000), belief, &Teammates::default(), GoalEnd::Positive, Freedom::Full)
    }

    #[test]
    fn alone_it_goes_for_the_ball() {
        let mut reactive = LeggedReactive::default();
        assert!(matches!(step(&mut reactive, &belief((0.0, 0.0), (1.0, 0.0)), 0), Intent::Walk { .. }));
        assert_eq!(reactive.role(), Role::Attacker);
    }

    #[test]
    fn it_makes_way_while_a_teammate_holds_the_ball_and_goes_for_a_ball_that_has_left() {
        let beacon = |status| Beacon {
            pose: WirePose::default(),
            ball: None,
            status,
            case_base: 0,
            cycle: None,
            progress: Progress::Idle,
            role: Role::None,
        };
        let (b, mut reactive) = (belief((0.2, 0.0), (1.0, 0.0)), LeggedReactive::default());
        let mut teammates = Teammates::default();
        for (ms, status, role) in [
            (40, Status::AVAILABLE, Role::Attacker),
            (80, Status::AVAILABLE.with(Status::HOLDS_BALL), Role::Supporter),
            (120, Status::AVAILABLE, Role::Attacker),
        ] {
            let now = Instant(ms * 1000);
            teammates.receive(now, RobotId::new(2).unwrap(), &beacon(status));
            reactive.step(now, &b, &teammates, GoalEnd::Positive, Freedom::Full);
            assert_eq!(reactive.role(), role, "{ms} ms");
        }
        // The teammate is at the ball, nearer than this robot, and about to take it.
        let near = belief((0.4, 0.0), (0.15, 0.0));
        reactive.step(Instant(120_000), &near, &teammates, GoalEnd::Positive, Freedom::Full);
        assert_eq!(reactive.role(), Role::Supporter);
    }

    #[test]
    fn an_opponent_farther_than_forty_centimetres_is_not_considered() {
        let mut b = belief((0.0, 0.0), (0.13, 0.0));
        b.holds_ball = true;
        let _ = b.opponents.push(Point::new(0.6, 0.0));
        // Turned to the best place for shots: 0.5 m before the penalty area, opposite its corner.
        b.pose.heading = Angle::new(math::atan2(0.65, 1.55));
        assert_eq!(step(&mut LeggedReactive::default(), &b, 0), Intent::Kick(LeggedKick::ForwardSoft));
    }

    #[test]
    fn a_near_opponent_ahead_is_dodged_to_its_other_side_and_only_for_a_while() {
        let mut b = belief((0.0, 0.0), (0.13, 0.0));
        b.holds_ball = true;
        let _ = b.opponents.push(Point::new(0.45, 0.05));
        // On either side stands another one, too near for a kick aside.
        let _ = b.opponents.push(Point::new(0.2, 0.35));
        let _ = b.opponents.push(Point::new(0.2, -0.35));
        let mut reactive = LeggedReactive::default();
        let Intent::Carry { to } = step(&mut reactive, &b, 0) else { panic!("dodges") };
        assert!(to.y() < 0.0, "opponent is on the left, dodge right: {to:?}");
        assert!(!matches!(step(&mut reactive, &b, 1600), Intent::Carry { .. }));
    }

    #[test]
    fn an_opponent_at_the_limit_cannot_make_it_hold_the_ball_for_ever() {
        let mut b = belief((0.0, 0.0), (0.13, 0.0));
        b.holds_ball = true;
        let mut reactive = LeggedReactive::default();
        let near = |ms: u64| if (ms / 200).is_multiple_of(2) { 0.35 } else { 0.45 };
        let kicked = (0..=100).map(|i| i * 40).any(|ms| {
            b.opponents.clear();
            let _ = b.opponents.push(Point::new(0.13 + near(ms), 0.0));
            matches!(step(&mut reactive, &b, ms), Intent::Kick(_))
        });
        assert!(kicked);
    }

    #[test]
    fn a_hard_kick_that_would_leave_the_field_is_a_soft_one() {
        let b = belief((0.0, 1.0), (0.13, 1.0));
        let kick = |heading| strength(&b, &b.ball.unwrap(), Angle::new(heading));
        assert_eq!((kick(-0.6), kick(0.6)), (LeggedKick::ForwardHard, LeggedKick::ForwardSoft));
    }

    #[test]
    fn a_supporter_backs_up_off_the_line_to_the_goal() {
        let b = belief((-0.5, -0.4), (0.0, -0.2));
        let to = beside(&b, &b.ball.unwrap(), GoalEnd::Positive);
        assert!((to.distance(Point::new(0.0, -0.2)) - SUPPORT_DISTANCE).abs() < 1e-3);
        assert!(to.y() > 0.5);
    }

    #[test]
    fn beside_a_gameplay_of_others_it_waits_across_the_field_and_ahead() {
        let b = belief((0.0, 0.3), (0.2, 0.9));
        let to = across(&b, &b.ball.unwrap(), GoalEnd::Positive);
        assert!(to.distance(Point::new(0.8, -0.6)) < 1e-5, "{to:?}");
        let near_goal = belief((1.0, 0.0), (1.8, -0.8));
        let to = across(&near_goal, &near_goal.ball.unwrap(), GoalEnd::Positive);
        assert!(to.distance(Point::new(1.4, 0.6)) < 1e-5, "{to:?}");
        let other_way = belief((0.0, 0.3), (-0.2, 0.9));
        let to = across(&other_way, &other_way.ball.unwrap(), GoalEnd::Negative);
        assert!(to.distance(Point::new(-0.8, -0.6)) < 1e-5, "{to:?}");
    }

    #[test]
    fn in_a_duel_it_kicks_where_we_are_first() {
        let mut b = belief((0.0, 0.0), (0.13, 0.0));
        b.holds_ball = true;
        let _ = b.opponents.push(Point::new(0.4, 0.0));
        // Straight ahead is the opponent; to the left, behind it, waits a second one.
        let _ = b.opponents.push(Point::new(0.44, 1.16));
        let goal = Point::new(2.7, 0.0);
        let kick = way_out(Instant(0), &b, &Teammates::default(), &b.ball.unwrap(), goal);
        assert_eq!(kick, Some(LeggedKick::Right));
    }
}
