//! `order`: order of a robot, and its reason. A task in the attack frame, the role it serves, and the numbers
//! behind it.

use core::fmt;

use casebase::CaseRobot;
use geometry::{Angle, Attack, Point};
use protocol::host::{Directive, KickOrder, RuleRole};
use protocol::{CaseId, RobotId};

use super::case_candidate::CastCase;
use super::threat::Guards;
use super::view::Flip;

/// The order of one robot, with its reason.
#[derive(Clone, Debug, PartialEq)]
pub struct Order {
    /// Our robot, by its number.
    pub robot: RobotId,
    /// Role of the robot in the team.
    pub role: Role,
    /// Task of the robot, in the attack frame.
    pub task: Task,
    /// Reason of role and task, with its numbers.
    pub why: OrderReason,
}

/// A robot's role in the team at this moment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Guards the goal; only the keeper may be in our defence area.
    Keeper,
    /// At the edge of our defence area, between ball and goal: 0 the first, 1 the second.
    Defender(u8),
    /// Plays the ball in open play, with the other field players.
    Player,
    /// Takes our restart, or places the ball.
    Kicker,
    /// Receives the pass of our restart.
    Receiver,
    /// Took our restart and must not touch the ball before another robot has.
    DoubleTouchBlocked,
    /// Draws an opponent away before our free kick.
    Coercer,
    /// Stands where a pass can come.
    Support(u8),
    /// Stands between an opponent and our goal.
    Marker(u8),
    /// Stands on the line of their restart.
    Wall,
    /// One of too many on the field: waits in a substitution area.
    Leaving,
}

/// The reason of an order, with its numbers; SI units, attack frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum OrderReason {
    /// The referee's command requires it.
    Referee,
    /// Nearest to the ball: this many seconds away.
    SoonestAtBall {
        /// Time to the ball, s.
        seconds: f32,
    },
    /// On the line from the ball to our goal.
    OnBallLine {
        /// Crossing of that line and the goal line, m.
        y: f32,
    },
    /// The ball lies in our area and only the keeper may touch it.
    ClearsArea {
        /// Room along the path of the ball, m.
        room: f32,
    },
    /// The best free place found.
    FreePlace {
        /// Value of the place, 0–1.
        worth: f32,
    },
    /// This opponent is nearest to our goal and not marked.
    Marks {
        /// The opponent to be marked.
        opponent: RobotId,
    },
    /// The best target found for the ball.
    BestTarget {
        /// Room along the path of the ball, m.
        room: f32,
    },
    /// Part of the robot in the defence against threats.
    Threat(Guards),
    /// The likeliest pass found, with its probabilities.
    Chances {
        /// P(receive): probability that the receiver gets the ball.
        receive: f32,
        /// P(goal | receive): probability of a goal then.
        goal: f32,
    },
    /// The pass of a case, refined near the case's place for it.
    OfCase {
        /// The stored case being played.
        case: CaseId,
        /// The robot's part in it.
        part: CaseRobot,
        /// Distance from the case's own place to where the pass is received, m.
        moved: f32,
        /// P(receive): probability that the receiver gets the ball.
        receive: f32,
        /// P(goal | receive): probability of a goal then.
        goal: f32,
    },
    /// The ball beside it is hidden from all cameras, and it does not have it: it makes way for their view.
    Uncovers,
    /// This opponent has the ball: it is challenged.
    Challenges {
        /// The opponent with the ball.
        opponent: RobotId,
    },
    /// Plays a case that is worth as much as any other action.
    PlaysCase {
        /// The stored case proposed.
        case: CaseId,
    },
    /// This opponent follows it and shall be drawn off the path.
    Coerces {
        /// The opponent that follows the robot.
        marker: RobotId,
    },
    /// Waits until coercers are in place.
    Coercing {
        /// Number of coercers in place.
        arrived: usize,
        /// Number of coercers of the plan.
        of: usize,
    },
    /// Open play: the robots choose among themselves.
    OpenPlay,
    /// The ball's place is unknown.
    NoBall,
    /// The team is the one that only stands still.
    Idle,
    /// The strategy of another program wants it.
    External,
    /// The strategy of another program has not answered.
    ExternalSilent,
    /// A robot's kicker is tested.
    Test,
    /// A robot is driven by hand.
    ByHand,
    /// The referee allows us fewer robots.
    TooMany {
        /// Number of robots allowed.
        allowed: usize,
    },
}

/// A task in the attack frame; [`Task::directive`] is its form in the protocol.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Task {
    /// Brake and stand still.
    Stand,
    /// Go to a place with a heading.
    GoTo {
        /// Place of the robot's centre, m.
        at: Point<Attack>,
        /// Heading at the place, attack frame.
        face: Angle,
    },
    /// Take the ball, approaching it so as to face this point across it.
    GetBall {
        /// The point to face.
        face: Point<Attack>,
    },
    /// Kick the ball at this point.
    Kick {
        /// Target of the ball, m.
        at: Point<Attack>,
        /// Kind and speed of the kick.
        kick: KickOrder,
    },
    /// Pass to a teammate.
    Pass {
        /// Place of the reception, m.
        at: Point<Attack>,
        /// Number of the receiving teammate.
        receiver: RobotId,
        /// Kind and speed of the kick.
        kick: KickOrder,
        /// Whether the ball may be kicked now.
        ready: bool,
    },
    /// Receive a teammate's pass.
    Receive {
        /// Place of the reception, m.
        at: Point<Attack>,
        /// Shoot it at this point at first touch; none: stop it.
        then: Option<Point<Attack>>,
    },
    /// Stand where the ball would cross this line.
    Block {
        /// One end of the line.
        from: Point<Attack>,
        /// The other end of the line.
        to: Point<Attack>,
    },
    /// Carry the ball to a place, with a heading there.
    Dribble {
        /// Place of the robot's centre, m.
        at: Point<Attack>,
        /// Heading at the place, attack frame.
        face: Angle,
    },
    /// Bring the ball to a place.
    PlaceBall {
        /// Designated position of the ball, m.
        at: Point<Attack>,
    },
    /// Play cases with the teammates.
    Gameplay,
    /// The same, with the host's proposal of a case.
    Case(CastCase),
}

impl Task {
    /// The task as a directive of the protocol, in the field frame.
    pub fn directive(&self, flip: Flip) -> Directive {
        match *self {
            Self::Stand => Directive::Stand,
            Self::GoTo { at, face } => Directive::GoTo { pose: flip.pose_to_wire(at, face) },
            Self::GetBall { face } => Directive::GetBall { face: Some(flip.to_wire(face)) },
            Self::Kick { at, kick } => Directive::Kick { at: flip.to_wire(at), kick },
            Self::Pass { at, receiver, kick, ready } => {
                Directive::Pass { at: flip.to_wire(at), receiver, kick, ready }
            }
            Self::Receive { at, then } => {
                Directive::Receive { at: flip.to_wire(at), then: then.map(|then| flip.to_wire(then)) }
            }
            Self::Block { from, to } => Directive::Block { from: flip.to_wire(from), to: flip.to_wire(to) },
            Self::Dribble { at, face } => Directive::Dribble { pose: flip.pose_to_wire(at, face) },
            Self::PlaceBall { at } => Directive::PlaceBall { at: flip.to_wire(at) },
            Self::Gameplay => Directive::Gameplay { hint: None },
            Self::Case(cast) => Directive::Gameplay { hint: Some(cast.hint()) },
        }
    }
}

impl fmt::Display for OrderReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Referee => f.write_str("required by the referee's command"),
            Self::SoonestAtBall { seconds } => write!(f, "soonest at the ball, in {seconds:.2} s"),
            Self::OnBallLine { y } => {
                write!(f, "on the line from the ball to our goal, {y:.2} m off the goal centre")
            }
            Self::ClearsArea { room } => write!(f, "only the keeper may play it there; {room:.2} m of room"),
            Self::FreePlace { worth } => write!(f, "the best free place, worth {worth:.2}"),
            Self::Marks { opponent } => {
                write!(f, "opponent {opponent} is nearest to our goal and not marked")
            }
            Self::BestTarget { room } => write!(f, "the best target for the ball, {room:.2} m of room"),
            Self::Threat(guards) => write!(f, "{guards}"),
            Self::Chances { receive, goal } if receive >= 1.0 => {
                write!(f, "the best shot: a goal with {goal:.2}")
            }
            Self::Chances { receive, goal } => {
                write!(f, "the best pass: received with {receive:.2}, then a goal with {goal:.2}")
            }
            Self::OfCase { case, part, moved, receive, goal } => write!(
                f,
                "{part} of case {case}, its pass moved by {moved:.2} m: received with {receive:.2}, then a goal with {goal:.2}"
            ),
            Self::Uncovers => f.write_str("makes way so that cameras see the ball beside it"),
            Self::Challenges { opponent } => write!(f, "challenges opponent {opponent}, who has the ball"),
            Self::PlaysCase { case } => write!(f, "case {case} is the best action"),
            Self::Coerces { marker } => write!(f, "opponent {marker} follows it, out of the play"),
            Self::Coercing { arrived, of } => {
                write!(f, "{arrived} of {of} are where opponents shall follow them")
            }
            Self::OpenPlay => f.write_str("open play: the robots choose among themselves"),
            Self::Idle => f.write_str("the team only stands"),
            Self::External => f.write_str("ordered by the team's own strategy"),
            Self::ExternalSilent => f.write_str("the team's own strategy does not answer"),
            Self::Test => f.write_str("a kicker is tested"),
            Self::ByHand => f.write_str("a robot is driven by hand"),
            Self::NoBall => f.write_str("no ball is seen"),
            Self::TooMany { allowed } => write!(f, "the referee lets us have {allowed}"),
        }
    }
}

impl Role {
    /// The role under the rules: permissions beyond those of other robots.
    pub fn rule_role(self) -> RuleRole {
        match self {
            Self::Keeper => RuleRole::Keeper,
            Self::Kicker => RuleRole::Kicker,
            _ => RuleRole::Player,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::GoalEnd;
    use protocol::quantized::WirePoint;

    #[test]
    fn an_orders_reason_prints_its_numbers() {
        let marker = RobotId::new(3).unwrap();
        assert_eq!(OrderReason::Coerces { marker }.to_string(), "opponent 3 follows it, out of the play");
        let chances = OrderReason::Chances { receive: 0.75, goal: 0.2 };
        assert_eq!(chances.to_string(), "the best pass: received with 0.75, then a goal with 0.20");
        let part = CaseRobot::new(1).unwrap();
        let of_case = OrderReason::OfCase { case: CaseId(12), part, moved: 0.31, receive: 0.75, goal: 0.2 };
        let description =
            "tm2 of case 12, its pass moved by 0.31 m: received with 0.75, then a goal with 0.20";
        assert_eq!(of_case.to_string(), description);
        let held = OrderReason::Threat(Guards::Held { opponent: marker, primaries_off: 0.5 });
        assert!(held.to_string().contains("0.50 m"), "{held}");
    }

    #[test]
    fn a_task_is_turned_for_the_team_that_attacks_towards_minus_x() {
        let task = Task::PlaceBall { at: Point::new(1.0, -0.5) };
        let turned = task.directive(Flip::defending(GoalEnd::Positive));
        assert_eq!(turned, Directive::PlaceBall { at: WirePoint { x: -1000, y: 500 } });
        let straight = task.directive(Flip::defending(GoalEnd::Negative));
        assert_eq!(straight, Directive::PlaceBall { at: WirePoint { x: 1000, y: -500 } });
    }
}
