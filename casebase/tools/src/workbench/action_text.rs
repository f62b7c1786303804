//! `action_text`: an action as data, in the form in which case files have it (docs/case-format.md §1). mm,
//! whole degrees.

use std::fmt;
use std::str::FromStr;

use casebase::{Action, CaseRobot, TurnTarget};
use serde::{Deserialize, Serialize};
use toml_edit::{Array, InlineTable, Value};

use super::edit_error::EditError;
use crate::league::CaseLeague;

/// An action as a case file has it: `"wait"`, `{ "go_to_point": [x, y] }`, `{ "kick": "goal" }`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ActionText {
    /// Waits for its next ball action.
    Wait,
    /// The robot takes the ball.
    GetBall,
    /// Goes to a point, mm.
    GoToPoint([i32; 2]),
    /// The robot turns on the spot.
    Turn(TurnText),
    /// Carries the ball to a point, mm.
    DribbleTo([i32; 2]),
    /// Passes to the robot of this number.
    PassBall(u8),
    /// Receives the pass of the robot of this number.
    ReceiveBall(u8),
    /// Kicks; the name of a kind of `league.toml`.
    Kick(String),
}

impl fmt::Display for ActionText {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.value().fmt(f)
    }
}

impl FromStr for ActionText {
    type Err = EditError;

    fn from_str(text: &str) -> Result<Self, EditError> {
        #[derive(Deserialize)]
        #[serde(deny_unknown_fields)]
        struct Line {
            action: ActionText,
        }
        let line = toml::from_str::<Line>(&format!("action = {text}"));
        line.map(|line| line.action).map_err(|error| EditError::Syntax(error.message().to_owned()))
    }
}

/// Direction to which a robot turns.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TurnText {
    /// Heading, whole degrees.
    HeadingDeg(i32),
    /// Point that is faced, mm.
    Face([i32; 2]),
}

impl ActionText {
    /// An action that was read, in words of the league.
    pub(super) fn of(action: Action, league: &CaseLeague) -> Self {
        match action {
            Action::Wait => Self::Wait,
            Action::GetBall => Self::GetBall,
            Action::GoToPoint(at) => Self::GoToPoint([at.x, at.y]),
            Action::DribbleTo(at) => Self::DribbleTo([at.x, at.y]),
            Action::Turn(TurnTarget::HeadingDeg(degrees)) => Self::Turn(TurnText::HeadingDeg(degrees)),
            Action::Turn(TurnTarget::Face(at)) => Self::Turn(TurnText::Face([at.x, at.y])),
            Action::PassBall(robot) => Self::PassBall(robot.number()),
            Action::ReceiveBall(robot) => Self::ReceiveBall(robot.number()),
            Action::Kick(id) => {
                let name = league.kicks.get(usize::from(id.0)).map(|(name, _)| name.clone());
                Self::Kick(name.unwrap_or_default())
            }
        }
    }

    /// The robot that it names, and whether it passes to it.
    pub(super) const fn partner(&self) -> Option<(u8, bool)> {
        match self {
            Self::PassBall(robot) => Some((*robot, true)),
            Self::ReceiveBall(robot) => Some((*robot, false)),
            _ => None,
        }
    }

    /// The point that it names, mm.
    pub(super) const fn point(&self) -> Option<[i32; 2]> {
        match self {
            Self::GoToPoint(at) | Self::DribbleTo(at) | Self::Turn(TurnText::Face(at)) => Some(*at),
            _ => None,
        }
    }

    /// Value of a case file.
    pub(super) fn value(&self) -> Value {
        let table = |key: &str, value: Value| Value::InlineTable(InlineTable::from_iter([(key, value)]));
        let number = |robot: &u8| Value::from(i64::from(*robot));
        match self {
            Self::Wait => "wait".into(),
            Self::GetBall => "get_ball".into(),
            Self::GoToPoint(at) => table("go_to_point", point(*at)),
            Self::DribbleTo(at) => table("dribble_to", point(*at)),
            Self::Turn(TurnText::HeadingDeg(degrees)) => {
                table("turn", table("heading_deg", i64::from(*degrees).into()))
            }
            Self::Turn(TurnText::Face(at)) => table("turn", table("face", point(*at))),
            Self::PassBall(robot) => table("pass_ball", number(robot)),
            Self::ReceiveBall(robot) => table("receive_ball", number(robot)),
            Self::Kick(kind) => table("kick", kind.as_str().into()),
        }
    }

    /// The action that it means; `None` where robot or kick kind is unknown.
    pub(super) fn action(&self, league: &CaseLeague) -> Option<Action> {
        let point = |at: &[i32; 2]| casebase::PointMm::new(at[0], at[1]);
        let robot = |number: &u8| CaseRobot::new(usize::from(*number).checked_sub(1)?);
        Some(match self {
            Self::Wait => Action::Wait,
            Self::GetBall => Action::GetBall,
            Self::GoToPoint(at) => Action::GoToPoint(point(at)),
            Self::DribbleTo(at) => Action::DribbleTo(point(at)),
            Self::Turn(TurnText::HeadingDeg(degrees)) => Action::Turn(TurnTarget::HeadingDeg(*degrees)),
            Self::Turn(TurnText::Face(at)) => Action::Turn(TurnTarget::Face(point(at))),
            Self::PassBall(number) => Action::PassBall(robot(number)?),
            Self::ReceiveBall(number) => Action::ReceiveBall(robot(number)?),
            Self::Kick(kind) => Action::Kick(league.kick_id(kind)?),
        })
    }
}

/// A point as the TOML list `[x, y]`.
pub(super) fn point(at: [i32; 2]) -> Value {
    Value::Array(Array::from_iter(at.map(i64::from)))
}
