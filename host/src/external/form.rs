//! `form`: what a strategy in another program is told, as a line of JSON (docs/strategy-protocol.md). Attack
//! frame: we attack towards +x; m, m/s, radians counter-clockwise from +x, s.

use geometry::{Angle, Attack, Point, Vector};
use protocol::host::KickOrder;
use protocol::{Duration, Instant, RobotId};
use rules::{FieldSpec, League, Phase, Side};
use serde::{Deserialize, Serialize};

use crate::strategy::view::{ROBOTS_MAX, View, ViewBall, ViewRobot};
use crate::strategy::{Order, OrderReason, Orders, Role, Task};

/// Farthest coordinate of an order, m: beyond the largest field with its surroundings.
pub(super) const COORDINATE_MAX_M: f32 = 20.0;

/// A place or a velocity: x, y.
pub type Pair = [f32; 2];

/// One line to the strategy: everything that our own coach decides on, and what it decided.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StrategyView {
    /// Version of this form.
    pub version: u32,
    /// Name of the league: `division-b`, `division-a` or `ssl-2013`.
    pub league: String,
    /// Time on the host's clock, s.
    pub time: f64,
    /// The phase of the game.
    pub phase: StrategyPhase,
    /// The phase that will start next, if the referee sends it.
    pub next: Option<StrategyPhase>,
    /// Place for the ball during a placement, m.
    pub placement: Option<Pair>,
    /// The ball, if its place is known.
    pub ball: Option<StrategyBall>,
    /// Our robots on the field that can be commanded.
    pub ours: Vec<StrategyRobot>,
    /// Opponents that vision sees, by number.
    pub theirs: Vec<StrategyRobot>,
    /// Number of our keeper, as the referee names it.
    pub keeper: u8,
    /// Number of their keeper, as the referee names it.
    pub their_keeper: u8,
    /// Dimensions of the field, m.
    pub field: StrategyField,
    /// Our robots that the rules bind, so that the coach's order stands: they have to leave the field, or may
    /// not touch the ball again.
    pub bound: Vec<u8>,
    /// Orders of our coach; a robot without an order of the strategy gets this one.
    pub usual: Vec<StrategyOrder>,
}

/// A phase of the game.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct StrategyPhase {
    /// `halt`, `stop`, `run`, `timeout`, `ball-placement`, `prepare-kickoff`, `kickoff`, `prepare-penalty`,
    /// `penalty` or `free-kick`.
    pub name: String,
    /// Whether it is ours; none of `halt`, `stop` and `run`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ours: Option<bool>,
}

/// The ball in the attack frame, SI units.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct StrategyBall {
    /// Place on the ground, m.
    pub at: Pair,
    /// Velocity along the ground.
    pub velocity: Pair,
    /// Place where it stops if no robot intercepts it, m.
    pub rest: Pair,
    /// Height above the ground, m.
    pub height: f32,
    /// Time since a camera saw it, s.
    pub unseen: f32,
}

/// A robot in the attack frame, SI units.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct StrategyRobot {
    /// Number in its team, 0 to 15.
    pub robot: u8,
    /// Place of its centre.
    pub at: Pair,
    /// Heading of the robot, radians.
    pub heading: f32,
    /// Velocity of its centre.
    pub velocity: Pair,
    /// Whether its sensor detects the ball; of ours alone.
    #[serde(default)]
    pub ball_contact: bool,
}

/// Dimensions of the field, m.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct StrategyField {
    /// Between the goal lines.
    pub length: f32,
    /// Between the touch lines.
    pub width: f32,
    /// Width of a goal.
    pub goal_width: f32,
    /// Depth of a defence area.
    pub area_depth: f32,
    /// Width of a defence area.
    pub area_width: f32,
}

/// The order of one robot.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StrategyOrder {
    /// Number of the robot that gets the order.
    pub robot: u8,
    /// Task of the robot until the next answer.
    pub task: StrategyTask,
}

/// A task of a robot.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum StrategyTask {
    /// Stand still where the robot is.
    Stand,
    /// Play cases with the other robots that have this task.
    PlayCases,
    /// Go to a place.
    GoTo {
        /// Place of its centre.
        at: Pair,
        /// Heading at the place, radians.
        face: f32,
    },
    /// Take the ball so as to face this point across it.
    GetBall {
        /// The point to face.
        face: Pair,
    },
    /// Kick the ball along the ground.
    Kick {
        /// At this point.
        at: Pair,
        /// Speed of the ball, m/s.
        speed: f32,
    },
    /// Kick the ball through the air.
    Chip {
        /// At this point.
        at: Pair,
        /// Speed of the ball, m/s.
        speed: f32,
    },
    /// Pass to a teammate.
    Pass {
        /// Place of the reception, m.
        at: Pair,
        /// Number of the teammate that receives it.
        receiver: u8,
        /// Speed of the ball, m/s.
        speed: f32,
        /// Through the air instead of along the ground.
        #[serde(default)]
        chip: bool,
        /// The ball is kicked as soon as the passer has it; else the passer waits with it.
        #[serde(default = "yes")]
        ready: bool,
    },
    /// Receive a pass at a place, and hold or shoot the ball.
    Receive {
        /// Place of the reception, m.
        at: Pair,
        /// Shoot at this point at first touch; none: stop the ball.
        #[serde(default)]
        then: Option<Pair>,
    },
    /// Stand where the ball would cross this line.
    Block {
        /// One end of the line.
        from: Pair,
        /// Other end of the path, m.
        to: Pair,
    },
    /// Bring the ball to a place.
    PlaceBall {
        /// The place.
        at: Pair,
    },
}

const fn yes() -> bool {
    true
}

fn pair(p: Point<Attack>) -> Pair {
    [p.x(), p.y()]
}

pub(super) fn point([x, y]: Pair) -> Point<Attack> {
    Point::new(x, y)
}

impl StrategyPhase {
    fn of(phase: Phase<Side>) -> Self {
        let (name, side) = match phase {
            Phase::Halt => ("halt", None),
            Phase::Stop => ("stop", None),
            Phase::Run => ("run", None),
            Phase::Timeout(side) => ("timeout", Some(side)),
            Phase::BallPlacement(side) => ("ball-placement", Some(side)),
            Phase::PrepareKickoff(side) => ("prepare-kickoff", Some(side)),
            Phase::Kickoff(side) => ("kickoff", Some(side)),
            Phase::PreparePenalty(side) => ("prepare-penalty", Some(side)),
            Phase::Penalty(side) => ("penalty", Some(side)),
            Phase::FreeKick(side) => ("free-kick", Some(side)),
        };
        Self { name: name.to_owned(), ours: side.map(|side| side == Side::Ours) }
    }
}

impl StrategyRobot {
    fn of(robot: &ViewRobot, ball_contact: bool) -> Self {
        Self {
            robot: robot.id.number(),
            at: pair(robot.position),
            heading: robot.heading.radians(),
            velocity: [robot.velocity.x(), robot.velocity.y()],
            ball_contact,
        }
    }

    /// The robot as our planners see it; `None` for a number that no robot has.
    fn seen(&self) -> Option<ViewRobot> {
        Some(ViewRobot {
            id: RobotId::new(self.robot)?,
            position: point(self.at),
            heading: Angle::new(self.heading),
            velocity: Vector::new(self.velocity[0], self.velocity[1]),
        })
    }
}

impl StrategyView {
    /// The present version of the form.
    pub const VERSION: u32 = 1;

    /// A view with the coach's orders.
    pub fn of(league: League, view: &View, usual: &Orders) -> Self {
        let field = &view.field;
        Self {
            version: Self::VERSION,
            league: league.name().to_owned(),
            time: view.now.0 as f64 * 1e-6,
            phase: StrategyPhase::of(view.phase),
            next: view.next.map(StrategyPhase::of),
            placement: view.placement.map(pair),
            ball: view.ball.map(|ball| StrategyBall {
                at: pair(ball.position),
                velocity: [ball.velocity.x(), ball.velocity.y()],
                rest: pair(ball.rest),
                height: ball.height,
                unseen: ball.unseen.as_secs_f32(),
            }),
            ours: view.ours.iter().map(|ours| StrategyRobot::of(ours, view.contact.has(ours.id))).collect(),
            theirs: view.theirs.iter().map(|theirs| StrategyRobot::of(theirs, false)).collect(),
            keeper: view.keeper.number(),
            their_keeper: view.their_keeper.number(),
            field: StrategyField {
                length: field.length,
                width: field.width,
                goal_width: field.goal_width,
                area_depth: field.penalty_depth,
                area_width: field.penalty_width,
            },
            bound: usual.iter().filter(|order| is_bound(order)).map(|order| order.robot.number()).collect(),
            usual: usual.iter().map(StrategyOrder::of).collect(),
        }
    }

    /// A snapshot in open play for our own planners, such as [`crate::strategy::pass`]: robots, ball and
    /// keepers are as told, the field's further dimensions those of `field`.
    pub fn snapshot(&self, field: FieldSpec) -> View {
        let none = std::iter::empty;
        let keeper = |number| RobotId::new(number).unwrap_or(RobotId::ZERO);
        let mut view = View::still(field, Point::default(), none(), none());
        view.now = Instant((self.time.max(0.0) * 1e6) as u64);
        view.ball = self.ball.map(|ball| ViewBall {
            position: point(ball.at),
            velocity: Vector::new(ball.velocity[0], ball.velocity[1]),
            rest: point(ball.rest),
            height: ball.height,
            unseen: Duration((ball.unseen.max(0.0) * 1e6) as u64),
        });
        view.ours = self.ours.iter().filter_map(StrategyRobot::seen).take(ROBOTS_MAX).collect();
        view.theirs = self.theirs.iter().filter_map(StrategyRobot::seen).take(ROBOTS_MAX).collect();
        (view.keeper, view.their_keeper) = (keeper(self.keeper), keeper(self.their_keeper));
        for robot in self.ours.iter().filter(|robot| robot.ball_contact) {
            if let Some(id) = RobotId::new(robot.robot) {
                view.contact.insert(id);
            }
        }
        view
    }
}

impl StrategyOrder {
    fn of(order: &Order) -> Self {
        let speed = |kick: KickOrder| match kick {
            KickOrder::Flat(speed) | KickOrder::Chip(speed) => f32::from(speed) * 0.01,
        };
        let task = match order.task {
            Task::Stand => StrategyTask::Stand,
            Task::Gameplay | Task::Case(_) => StrategyTask::PlayCases,
            // No coach orders to dribble: a hand does, and only where no other program gives the orders.
            Task::GoTo { at, face } | Task::Dribble { at, face } => {
                StrategyTask::GoTo { at: pair(at), face: face.radians() }
            }
            Task::GetBall { face } => StrategyTask::GetBall { face: pair(face) },
            Task::Kick { at, kick: kick @ KickOrder::Flat(_) } => {
                StrategyTask::Kick { at: pair(at), speed: speed(kick) }
            }
            Task::Kick { at, kick } => StrategyTask::Chip { at: pair(at), speed: speed(kick) },
            Task::Pass { at, receiver, kick, ready } => StrategyTask::Pass {
                at: pair(at),
                receiver: receiver.number(),
                speed: speed(kick),
                chip: matches!(kick, KickOrder::Chip(_)),
                ready,
            },
            Task::Receive { at, then } => StrategyTask::Receive { at: pair(at), then: then.map(pair) },
            Task::Block { from, to } => StrategyTask::Block { from: pair(from), to: pair(to) },
            Task::PlaceBall { at } => StrategyTask::PlaceBall { at: pair(at) },
        };
        Self { robot: order.robot.number(), task }
    }
}

/// Whether the rules leave the robot no other order.
pub(super) fn is_bound(order: &Order) -> bool {
    matches!(order.why, OrderReason::TooMany { .. }) || order.role == Role::DoubleTouchBlocked
}
