//! `answer`: what a strategy in another program orders: its line of JSON, checked, and our own orders from
//! it. Attack frame.

use std::collections::BTreeMap;

use geometry::Angle;
use protocol::RobotId;
use protocol::host::KickOrder;
use rules::Phase;
use serde::{Deserialize, Serialize};

use super::drawing::{SHAPES_MAX, StrategyDrawing, StrategyShape, TEXT_MAX, VALUES_MAX};
use super::form::{COORDINATE_MAX_M, Pair, StrategyOrder, StrategyTask, point};
use crate::strategy::threat::{ThreatSettings, legal_for};
use crate::strategy::{Order, OrderReason, Role, Task, View};

/// Greatest speed of a kick that is ordered, m/s: robots kick no faster than the rules permit whatever is
/// ordered.
const KICK_SPEED_MAX_M_S: f32 = 10.0;

/// One line of the strategy.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StrategyAnswer {
    /// Orders; robots without one do what our coach orders.
    pub orders: Vec<StrategyOrder>,
    /// Shapes for the page.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub draw: Vec<StrategyShape>,
    /// Values for the page's plots.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub values: BTreeMap<String, f32>,
}

/// Why an answer is refused.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum AnswerError {
    /// A line that is not the JSON of an answer.
    #[error("no answer of the form {{\"orders\":[…]}}: {0}")]
    Json(String),
    /// An order is for a robot that is not among ours.
    #[error("an order for robot {0}: numbers are 0 to 15")]
    Robot(u8),
    /// Two orders are for the same robot.
    #[error("two orders for robot {0}")]
    Twice(u8),
    /// A number of this robot's order is not finite, or farther off the field or faster than any robot or
    /// ball can be.
    #[error(
        "the order of robot {0}: a number is not finite or beyond {COORDINATE_MAX_M} m or {KICK_SPEED_MAX_M_S} m/s"
    )]
    Number(u8),
    /// More to draw than fits, or in places where it cannot be drawn.
    #[error(
        "more than {SHAPES_MAX} shapes or {VALUES_MAX} values, a text of more than {TEXT_MAX} bytes, or a number that \
         is not finite or beyond {COORDINATE_MAX_M} m"
    )]
    Drawing,
}

impl StrategyAnswer {
    /// Adds an order; an earlier one of the same robot is replaced.
    pub fn order(&mut self, robot: u8, task: StrategyTask) {
        self.orders.retain(|order| order.robot != robot);
        self.orders.push(StrategyOrder { robot, task });
    }

    /// Reads an answer from a line of JSON.
    pub fn read(line: &[u8]) -> Result<(Vec<(RobotId, Task)>, StrategyDrawing), AnswerError> {
        let answer: Self =
            serde_json::from_slice(line).map_err(|error| AnswerError::Json(error.to_string()))?;
        let mut tasks: Vec<(RobotId, Task)> = Vec::new();
        for order in &answer.orders {
            let robot = RobotId::new(order.robot).ok_or(AnswerError::Robot(order.robot))?;
            if tasks.iter().any(|(other, _)| *other == robot) {
                return Err(AnswerError::Twice(order.robot));
            }
            tasks.push((robot, order.task.task().ok_or(AnswerError::Number(order.robot))?));
        }
        let drawing = StrategyDrawing { shapes: answer.draw, values: answer.values };
        if drawing.is_bounded() { Ok((tasks, drawing)) } else { Err(AnswerError::Drawing) }
    }
}

impl StrategyTask {
    /// The same as our own task; `None` where a number is out of bounds.
    fn task(self) -> Option<Task> {
        let at = |pair: Pair| pair.iter().all(|value| value.abs() <= COORDINATE_MAX_M).then(|| point(pair));
        let speed = |speed: f32| {
            (0.0..=KICK_SPEED_MAX_M_S).contains(&speed).then_some((speed * 100.0).round() as u16)
        };
        Some(match self {
            Self::Stand => Task::Stand,
            Self::PlayCases => Task::Gameplay,
            Self::GoTo { at: place, face } => {
                Task::GoTo { at: at(place)?, face: Angle::new(Some(face).filter(|face| face.is_finite())?) }
            }
            Self::GetBall { face } => Task::GetBall { face: at(face)? },
            Self::Kick { at: place, speed: of } => {
                Task::Kick { at: at(place)?, kick: KickOrder::Flat(speed(of)?) }
            }
            Self::Chip { at: place, speed: of } => {
                Task::Kick { at: at(place)?, kick: KickOrder::Chip(speed(of)?) }
            }
            Self::Pass { at: place, receiver, speed: of, chip, ready } => Task::Pass {
                at: at(place)?,
                receiver: RobotId::new(receiver)?,
                kick: if chip { KickOrder::Chip(speed(of)?) } else { KickOrder::Flat(speed(of)?) },
                ready,
            },
            Self::Receive { at: place, then } => {
                let then = match then {
                    Some(then) => Some(at(then)?),
                    None => None,
                };
                Task::Receive { at: at(place)?, then }
            }
            Self::Block { from, to } => Task::Block { from: at(from)?, to: at(to)? },
            Self::PlaceBall { at: place } => Task::PlaceBall { at: at(place)? },
        })
    }
}

/// The order of a robot by the external strategy. Who takes our restart is the kicker: the rules let only one
/// robot be at the ball.
pub(super) fn order(view: &View, robot: RobotId, task: Task) -> Order {
    let at_ball =
        matches!(task, Task::Kick { .. } | Task::Pass { .. } | Task::GetBall { .. } | Task::PlaceBall { .. });
    let role = if robot == view.keeper {
        Role::Keeper
    } else if at_ball && view.phase != Phase::Run {
        Role::Kicker
    } else {
        Role::Player
    };
    let task = match task {
        // While the ball is not in play no robot is sent to where the rules do not let it stand.
        Task::GoTo { at, face } if view.phase != Phase::Run => {
            let settings = ThreatSettings::default();
            Task::GoTo { at: legal_for(view, role.rule_role(), at, &[], &settings), face }
        }
        other => other,
    };
    Order { robot, role, task, why: OrderReason::External }
}
