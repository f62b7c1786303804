//! `wheels`: reactive behaviour of wheeled robots without a case; simple and rule-compliant.
//!
//! The robot that has the ball soonest goes for it; with it, it shoots where the goal is open, shields it
//! from an opponent beside it, carries it on while there is room and the rules allow it, else kicks it up the
//! freer wing. The others take places ahead of the ball and behind it, one each. SI, field frame.

use geometry::{Field, GoalEnd, Point, Segment, Vector, math};
use protocol::robot_io::OmniKick;
use protocol::team::{Role, Status};
use protocol::{Instant, RobotId};

use crate::belief::{Belief, BelievedBall};
use crate::body::Intent;
use crate::body::omni::{Drive, SHOT};
use crate::reactive::Freedom;
use crate::skills::Step;
use crate::skills::wheels as skills;
use crate::teammates::Teammates;

/// State of the behaviour.
#[derive(Clone, Debug, Default)]
pub struct WheeledReactive {
    role: Role,
}

impl WheeledReactive {
    /// This robot's present role in its team.
    pub fn role(&self) -> Role {
        self.role
    }

    /// While a case or a directive is executed: resets the role.
    pub fn rest(&mut self) {
        *self = Self::default();
    }

    /// The intent of one step.
    pub fn step(
        &mut self,
        now: Instant,
        me: RobotId,
        belief: &Belief,
        teammates: &Teammates,
        attacked: GoalEnd,
        freedom: Freedom,
    ) -> Intent {
        let Some(ball) = belief.ball else { return Intent::Stand { face: None } };
        let mine = freedom != Freedom::KeepNear && is_attacker(now, me, &ball, belief, teammates, self.role);
        self.role = if mine { Role::Attacker } else { Role::Supporter };
        let goal = belief.league().field().goal_center(attacked);
        if !mine {
            let to = place(now, me, belief, teammates, &ball, attacked);
            return Drive::avoiding(to, to.direction_to(ball.position)).into();
        }
        if belief.holds_ball {
            return match freedom {
                Freedom::Full => advance(belief, attacked),
                _ => skills::kick_held(belief, goal, OmniKick::None),
            };
        }
        let face = ball.position.direction_to(goal);
        if freedom == Freedom::Approach && !contested(belief, &ball) {
            // Between two gameplays: near enough, but without moving the ball before the next one.
            let behind = ball.rest - Vector::polar(APPROACH, face);
            return Drive::avoiding(behind, face).into();
        }
        match skills::get_ball(belief, Some(face)) {
            Step::Running(intent) => intent,
            Step::Done => Intent::Stand { face: None },
        }
    }
}

/// With the ball: shoot, carry it on, or clear.
fn advance(belief: &Belief, attacked: GoalEnd) -> Intent {
    let goal = belief.league().field().goal_center(attacked);
    let dribbler_point = belief.dribbler_point();
    let (at, room) = skills::target(belief, dribbler_point, attacked);
    let near = dribbler_point.distance(goal) < SHOOTS_FROM;
    if near && room > OPEN {
        return skills::kick_held(belief, at, OmniKick::Flat(SHOT));
    }
    // Near their goal a kick into its defenders brings more than a kept ball (docs/drills.md).
    if !near && let Some(intent) = skills::shield(belief) {
        return intent;
    }
    let ahead = Segment::new(dribbler_point, dribbler_point + (goal - dribbler_point).clamped(LOOKS_AHEAD));
    let blocked = belief.opponents.iter().any(|o| ahead.distance_to(*o) < BLOCKS);
    let carries = !blocked && belief.carried() < CARRIES && dribbler_point.distance(goal) > TOO_NEAR;
    if carries {
        return Drive::holding(ahead.to, dribbler_point.direction_to(goal)).into();
    }
    skills::clear_or_shoot(belief, attacked)
}

/// Whether the ball is this robot's: it has it, or no other robot under the same directive has it sooner.
fn is_attacker(
    now: Instant,
    me: RobotId,
    ball: &BelievedBall,
    belief: &Belief,
    teammates: &Teammates,
    role: Role,
) -> bool {
    if belief.holds_ball {
        return true;
    }
    let soon = ball.position + (ball.rest - ball.position).clamped(ball.velocity.norm() * PREDICTION_S);
    let far = |from: Point<Field>, role: Role| {
        from.distance(soon) - if role == Role::Attacker { ATTACKER_BONUS_M } else { 0.0 }
    };
    let mine = far(belief.pose.position, role);
    teammates.present(now).all(|(id, teammate)| {
        let theirs = far(teammate.pose().position, teammate.beacon.role);
        !teammate.beacon.status.has(Status::HOLDS_BALL) && (mine < theirs || (mine == theirs && me < id))
    })
}

/// A supporter's place: the first one ahead on the freer side, the second on the other, the third behind.
fn place(
    now: Instant,
    me: RobotId,
    belief: &Belief,
    teammates: &Teammates,
    ball: &BelievedBall,
    attacked: GoalEnd,
) -> Point<Field> {
    let field = belief.league().field();
    let sign = attacked.sign() as f32;
    let side = if ball.rest.y() > 0.0 { -1.0 } else { 1.0 };
    // Attackers and robots that play a case are no supporters: places go by rank among the others.
    let before = teammates
        .present(now)
        .filter(|(id, teammate)| *id < me && teammate.beacon.role == Role::Supporter)
        .count();
    let offsets =
        [[1.5, 1.5 * side], [1.2, -1.5 * side], [-1.2, 0.0], [-0.8, 1.8 * side], [-0.8, -1.8 * side]];
    let [along, across] = offsets[before % offsets.len()];
    let farthest = 0.5 * field.length - field.penalty_depth - BEFORE_AREA;
    let x = math::clamp(sign * ball.rest.x() + along, -farthest, farthest) * sign;
    let y = math::clamp(
        ball.rest.y() + across,
        SIDE_LINE_MARGIN_M - 0.5 * field.width,
        0.5 * field.width - SIDE_LINE_MARGIN_M,
    );
    Point::new(x, y)
}

fn contested(belief: &Belief, ball: &BelievedBall) -> bool {
    belief.nearest_opponent(ball.position).is_some_and(|(_, distance)| distance < CONTESTED)
}

/// Between gameplays a robot waits this far behind the ball, m.
const APPROACH: f32 = 0.3;
/// An opponent this near the ball is about to take it, m.
const CONTESTED: f32 = 0.6;
/// Distance up to which the robot shoots at the goal, m.
const SHOOTS_FROM: f32 = 4.5;
/// A shot with that much room beyond the reach of bodies is taken, m.
const OPEN: f32 = 0.03;
/// It checks this far ahead for opponents on its path, m.
const LOOKS_AHEAD: f32 = 0.6;
/// An opponent this near the path ahead blocks it, m: two bodies and a hand.
const BLOCKS: f32 = 0.25;
/// A ball is carried no farther, m: the rules' metre, less what it takes to kick.
const CARRIES: f32 = 0.55;
/// Nearer to the goal's centre carrying on has no benefit, m.
const TOO_NEAR: f32 = 1.8;
/// The robot that goes for the ball keeps it unless another is nearer by this, m.
const ATTACKER_BONUS_M: f32 = 0.3;
/// Prediction time for the position of a rolling ball at which a robot arrives, s.
const PREDICTION_S: f32 = 0.6;
/// Places keep this far before the area, m.
const BEFORE_AREA: f32 = 0.5;
/// And this far within the side lines, m.
const SIDE_LINE_MARGIN_M: f32 = 0.4;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::skills::wheels::testing::belief;
    use protocol::quantized::WirePose;
    use protocol::team::{Beacon, Progress};

    fn id(n: u8) -> RobotId {
        RobotId::new(n).unwrap()
    }

    fn teammate(x: f32, role: Role) -> Beacon {
        let pose = WirePose::from(geometry::Pose::from_mm_deg(x * 1000.0, 0.0, 0.0));
        let status = Status::AVAILABLE;
        Beacon { pose, ball: None, status, case_base: 0, cycle: None, progress: Progress::Idle, role }
    }

    fn step(belief: &Belief, teammates: &Teammates, freedom: Freedom) -> (Intent, Role) {
        let mut reactive = WheeledReactive::default();
        let intent = reactive.step(Instant(0), id(2), belief, teammates, GoalEnd::Positive, freedom);
        (intent, reactive.role())
    }

    #[test]
    fn the_nearest_goes_for_the_ball_and_the_others_take_a_place_each() {
        let b = belief((0.0, 0.0, 0.0), (0.5, 0.0));
        assert_eq!(step(&b, &Teammates::default(), Freedom::Full).1, Role::Attacker);
        let mut teammates = Teammates::default();
        teammates.receive(Instant(0), id(1), &teammate(0.4, Role::Attacker));
        let (Intent::Drive(first), Role::Supporter) = step(&b, &teammates, Freedom::Full) else { panic!() };
        teammates.receive(Instant(0), id(0), &teammate(-2.0, Role::Supporter));
        let (Intent::Drive(second), _) = step(&b, &teammates, Freedom::Full) else { panic!() };
        assert!(first.to.distance(second.to) > 1.0, "{first:?} {second:?}");
        assert!(first.to.x() > 1.5, "ahead of the ball");
    }

    #[test]
    fn with_the_ball_it_shoots_at_an_open_goal_and_carries_it_on_from_afar() {
        let mut near = belief((2.5, 0.0, 0.0), (2.5945, 0.0));
        near.holds_ball = true;
        let (Intent::Drive(shot), _) = step(&near, &Teammates::default(), Freedom::Full) else { panic!() };
        assert!(shot.armed && shot.to.distance(near.pose.position) < 0.05, "shoots on the spot: {shot:?}");
        let mut far = belief((-2.0, 0.0, 0.0), (-1.9055, 0.0));
        far.holds_ball = true;
        let (Intent::Drive(carry), _) = step(&far, &Teammates::default(), Freedom::Full) else { panic!() };
        assert!(carry.to.x() > -1.5 && carry.dribbler == 1.0);
    }

    #[test]
    fn beside_a_gameplay_of_others_no_one_goes_for_the_ball() {
        let b = belief((0.0, 0.0, 0.0), (0.2, 0.0));
        assert_eq!(step(&b, &Teammates::default(), Freedom::KeepNear).1, Role::Supporter);
        let (Intent::Drive(waits), _) = step(&b, &Teammates::default(), Freedom::Approach) else { panic!() };
        assert!(waits.to.distance(Point::new(0.2, 0.0)) > 0.25);
    }
}
