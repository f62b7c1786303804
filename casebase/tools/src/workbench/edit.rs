//! `edit`: one change of a case file's text: comments, order and layout of all else stay. mm, field frame.

use casebase::{OPPONENTS_MAX, PointMm, Presence, Symmetry, TEAMMATES_MAX};
use serde::{Deserialize, Serialize};

use super::action_text::{ActionText, TurnText};
use super::case_text::CaseText;
use super::edit_error::EditError;
use super::part::Part;
use crate::keys::{COORDINATES, POSITIVE};

/// A change. Robots, opponents and actions count from 1, as in findings.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "edit", rename_all = "snake_case", deny_unknown_fields)]
pub enum Edit {
    /// Puts ball, robot, opponent or an action's point there.
    Move {
        /// Object that is moved.
        part: Part,
        /// New position, mm, field frame.
        to: [i32; 2],
    },
    /// Moves the whole case.
    MoveAll {
        /// Displacement, mm, x and y.
        by: [i32; 2],
    },
    /// Gives ball or opponent a scope.
    Scope {
        /// Ball or opponent of the scope.
        part: Part,
        /// New radii τx and τy, mm.
        radii: [i32; 2],
    },
    /// Says what an opponent's scope demands.
    Presence {
        /// Number of the opponent, from 1.
        opponent: usize,
        /// Demand of the scope.
        presence: Presence,
    },
    /// Says what the case is for.
    Intent {
        /// Intent, in one sentence.
        intent: String,
    },
    /// Says which goal is defended.
    Defending {
        /// Goal that is defended, `yellow` or `cyan`.
        goal: String,
    },
    /// Puts another action in the place of one.
    SetAction {
        /// Number of the robot, from 1.
        robot: usize,
        /// Number of the action, from 1.
        number: usize,
        /// The action that it becomes.
        action: ActionText,
    },
    /// Adds an action; a pass that its receiver does not expect yet is added to its list too.
    AddAction {
        /// Number of the robot, from 1.
        robot: usize,
        /// Number of the new action, from 1.
        number: usize,
        /// Action that is added.
        action: ActionText,
    },
    /// Takes an action out.
    RemoveAction {
        /// Number of the robot, from 1.
        robot: usize,
        /// Number of the action, from 1.
        number: usize,
    },
    /// Moves an action within its list.
    MoveAction {
        /// Number of the robot, from 1.
        robot: usize,
        /// Number of the action, from 1.
        number: usize,
        /// New number of the action, from 1.
        to: usize,
    },
    /// Adds a robot that waits.
    AddRobot {
        /// Position of the robot, mm.
        at: [i32; 2],
    },
    /// Takes a robot out, with the passes to and from it; those behind it get other numbers.
    RemoveRobot {
        /// Number of the robot, from 1.
        robot: usize,
    },
    /// Adds an opponent with its scope.
    AddOpponent {
        /// Position of the opponent, mm.
        at: [i32; 2],
        /// The radii of its scope.
        scope: [i32; 2],
    },
    /// Takes an opponent out.
    RemoveOpponent {
        /// Number of the opponent, from 1.
        opponent: usize,
    },
}

impl Edit {
    /// The change of the file that is seen as this one in a symmetric copy.
    pub fn under(self, symmetry: Symmetry) -> Self {
        let mut edit = self;
        let (Self::Move { to: point, .. }
        | Self::MoveAll { by: point }
        | Self::AddRobot { at: point }
        | Self::AddOpponent { at: point, .. }) = &mut edit
        else {
            return edit;
        };
        let PointMm { x, y } = symmetry.point(PointMm::new(point[0], point[1]));
        *point = [x, y];
        edit
    }

    /// The text after this change.
    pub fn apply(&self, text: &str) -> Result<String, EditError> {
        let mut case = CaseText::read(text)?;
        self.in_range()?;
        match self {
            Self::Move { part, to } => put(&mut case, part, *to)?,
            Self::MoveAll { by } => move_all(&mut case, *by)?,
            Self::Scope { part, radii } => case.set_point(part, "scope", *radii)?,
            Self::Presence { opponent, presence } => case.set_presence(*opponent, *presence)?,
            Self::Intent { intent } => case.set_text("intent", intent),
            Self::Defending { goal } => case.set_text("defending", goal),
            Self::SetAction { robot, number, action } => case.set_action(*robot, *number, action)?,
            Self::AddAction { robot, number, action } => {
                case.add_action(*robot, *number, action)?;
                if let ActionText::PassBall(receiver) = action {
                    answer(&mut case, *robot, usize::from(*receiver))?;
                }
            }
            Self::RemoveAction { robot, number } => drop(case.remove_action(*robot, *number)?),
            Self::MoveAction { robot, number, to } => {
                let action = case.remove_action(*robot, *number)?;
                case.add_value(*robot, *to, action)?;
            }
            Self::AddRobot { at } => {
                let room = "a case has 4 robots at most: take one out first";
                case.add_entry("teammates", TEAMMATES_MAX, *at, None).map_err(|()| EditError::Count(room))?;
            }
            Self::RemoveRobot { robot } => remove_robot(&mut case, *robot)?,
            Self::AddOpponent { at, scope } => {
                let room = "a case has 4 opponents at most: take one out first";
                let added = case.add_entry("opponents", OPPONENTS_MAX, *at, Some(*scope));
                added.map_err(|()| EditError::Count(room))?;
            }
            Self::RemoveOpponent { opponent } => case.remove_entry("opponents", *opponent)?,
        }
        Ok(case.text())
    }

    fn in_range(&self) -> Result<(), EditError> {
        let near = |at: &[i32; 2]| at.iter().all(|mm| COORDINATES.contains(mm));
        let radii = |radii: &[i32; 2]| radii.iter().all(|mm| POSITIVE.contains(mm));
        let far = EditError::Range("a coordinate is 1000000 mm at most");
        let small = EditError::Range("both radii of a scope are above 0 mm");
        match self {
            Self::Move { to: at, .. } | Self::MoveAll { by: at } | Self::AddRobot { at } if !near(at) => {
                Err(far)
            }
            Self::AddOpponent { at, .. } if !near(at) => Err(far),
            Self::SetAction { action, .. } | Self::AddAction { action, .. }
                if action.point().is_some_and(|at| !near(&at)) =>
            {
                Err(far)
            }
            Self::Scope { radii: both, .. } | Self::AddOpponent { scope: both, .. } if !radii(both) => {
                Err(small)
            }
            _ => Ok(()),
        }
    }
}

/// Puts a part there; an action by its point.
fn put(case: &mut CaseText, part: &Part, to: [i32; 2]) -> Result<(), EditError> {
    let Part::Action(robot, number) = *part else { return case.set_point(part, "at", to) };
    let moved = match case.action(robot, number)? {
        ActionText::GoToPoint(_) => ActionText::GoToPoint(to),
        ActionText::DribbleTo(_) => ActionText::DribbleTo(to),
        ActionText::Turn(TurnText::Face(_)) => ActionText::Turn(TurnText::Face(to)),
        _ => return Err(EditError::NoPart(format!("point of {part}"))),
    };
    case.set_action(robot, number, &moved)
}

fn move_all(case: &mut CaseText, by: [i32; 2]) -> Result<(), EditError> {
    for part in case.parts() {
        if let Some([x, y]) = case.point_of(&part) {
            let to = [x.saturating_add(by[0]), y.saturating_add(by[1])];
            if !to.iter().all(|mm| COORDINATES.contains(mm)) {
                return Err(EditError::Range("a coordinate is 1000000 mm at most"));
            }
            put(case, &part, to)?;
        }
    }
    Ok(())
}

/// Lets `receiver` expect one more pass of `robot`, where it expects fewer than are played.
fn answer(case: &mut CaseText, robot: usize, receiver: usize) -> Result<(), EditError> {
    if receiver == robot || receiver > case.count("teammates") {
        return Ok(());
    }
    let passes = actions_with(case, robot, (receiver as u8, true));
    if passes > actions_with(case, receiver, (robot as u8, false)) {
        let last = case.actions(receiver).len();
        case.add_action(receiver, last + 1, &ActionText::ReceiveBall(robot as u8))?;
    }
    Ok(())
}

/// Number of a robot's actions with this partner: passes to it (`true`), or receptions from it.
fn actions_with(case: &CaseText, robot: usize, partner: (u8, bool)) -> usize {
    case.actions(robot).iter().filter(|action| action.partner() == Some(partner)).count()
}

fn remove_robot(case: &mut CaseText, robot: usize) -> Result<(), EditError> {
    if case.count("teammates") < 2 {
        return Err(EditError::Count("a case has one robot at least"));
    }
    case.remove_entry("teammates", robot)?;
    for other in 1..=case.count("teammates") {
        for number in (1..=case.actions(other).len()).rev() {
            let action = case.action(other, number)?;
            match action.partner() {
                Some((partner, _)) if usize::from(partner) == robot => {
                    drop(case.remove_action(other, number)?);
                }
                Some((partner, passes)) if usize::from(partner) > robot => {
                    let partner = partner - 1;
                    let renumbered =
                        if passes { ActionText::PassBall(partner) } else { ActionText::ReceiveBall(partner) };
                    case.set_action(other, number, &renumbered)?;
                }
                _ => {}
            }
        }
    }
    Ok(())
}
