//! `follow`: actions that may follow those before them in a robot's list: those that the simulation of the
//! plan allows (docs/case-format.md §3.1). mm, field frame.

use casebase::plan_simulation::{PlanError, PlanStep, Script, plan_simulation};
use casebase::{Action, CaseRobot, GoalEnd, KickId, PointMm, Symmetry};

use super::action_text::{ActionText, TurnText};
use crate::authored::{Authored, Mirrored};
use crate::league::CaseLeague;

/// Distance of a new point ahead of the robot, mm.
const AHEAD_MM: i32 = 600;

/// Actions that the robot may have at that index, given those before it; its list ends there.
pub(super) fn may_be(
    case: &Authored,
    league: &CaseLeague,
    robot: CaseRobot,
    index: usize,
) -> Vec<ActionText> {
    let mut choices = choices(case, league, robot, index);
    choices.retain(|choice| {
        choice.action(league).is_some_and(|action| allowed(case, league, robot, index, action))
    });
    choices
}

/// Every action that there is, with points ahead of the robot's place.
fn choices(case: &Authored, league: &CaseLeague, robot: CaseRobot, index: usize) -> Vec<ActionText> {
    let teammate = &case.teammates[robot.index()];
    let before = teammate.gameplay.iter().take(index).rev();
    let place = before.clone().find_map(|(action, _)| match action {
        Action::GoToPoint(at) | Action::DribbleTo(at) => Some(*at),
        Action::GetBall => Some(case.ball),
        _ => None,
    });
    let ahead = place.unwrap_or(teammate.at).plus(PointMm::new(case.defending.attack_sign() * AHEAD_MM, 0));
    let ahead = league.field.clamp(ahead);
    let ahead = [ahead.x, ahead.y];
    let others =
        CaseRobot::first(case.teammates.len()).filter(|other| *other != robot).map(CaseRobot::number);
    let mut choices = vec![
        ActionText::GetBall,
        ActionText::Wait,
        ActionText::GoToPoint(ahead),
        ActionText::DribbleTo(ahead),
        ActionText::Turn(TurnText::Face([case.ball.x, case.ball.y])),
    ];
    choices.extend(others.clone().map(ActionText::PassBall));
    choices.extend(others.map(ActionText::ReceiveBall));
    choices.extend(league.kicks.iter().map(|(name, _)| ActionText::Kick(name.clone())));
    choices
}

fn allowed(case: &Authored, league: &CaseLeague, robot: CaseRobot, index: usize, action: Action) -> bool {
    let cut = |action| {
        let case = case.mirrored(Symmetry::Identity, league);
        Changed { case, place: (robot, index), action, is_cut: true }
    };
    match action {
        Action::Wait | Action::Turn(_) | Action::GoToPoint(_) => true,
        // One robot alone begins with the ball.
        Action::GetBall if index == 0 => !CaseRobot::first(case.teammates.len())
            .any(|other| other != robot && case.teammates[other.index()].is_getter()),
        Action::GetBall | Action::ReceiveBall(_) => cut(action).simulate(league).received,
        // A robot that could kick holds the ball. The receiver's part of a pass comes with it.
        Action::DribbleTo(_) | Action::Kick(_) | Action::PassBall(_) => {
            let last = cut(Action::Kick(KickId(0))).simulate(league);
            last.played || last.outcome == Err(PlanError::UnknownKick(robot, index))
        }
    }
}

/// Findings of the simulation about the last action of a cut list.
struct LastAction {
    outcome: Result<(), PlanError>,
    /// The ball is passed or kicked by it.
    played: bool,
    /// The ball is handed to it.
    received: bool,
}

impl Changed<'_> {
    fn simulate(&self, league: &CaseLeague) -> LastAction {
        let here = self.place;
        let (mut played, mut received) = (false, false);
        let outcome = plan_simulation(self, league, |step| match step {
            PlanStep::Leg { robot, action, .. } => played |= (robot, action) == here,
            PlanStep::HandOver(hand_over) => received |= hand_over.to == here,
            PlanStep::NeverReached { .. } => {}
        });
        LastAction { outcome, played, received }
    }
}

/// A case with another action in the place of one; where it is cut, that robot's list ends there.
pub(super) struct Changed<'c> {
    pub(super) case: Mirrored<'c>,
    /// The robot, and the index in its list.
    pub(super) place: (CaseRobot, usize),
    pub(super) action: Action,
    pub(super) is_cut: bool,
}

impl Script for Changed<'_> {
    fn teammates(&self) -> usize {
        self.case.teammates()
    }
    fn defending(&self) -> GoalEnd {
        self.case.defending()
    }
    fn ball(&self) -> PointMm {
        self.case.ball()
    }
    fn position(&self, robot: CaseRobot) -> PointMm {
        self.case.position(robot)
    }
    fn action(&self, robot: CaseRobot, index: usize) -> Option<Action> {
        if (robot, index) == self.place {
            return Some(self.action);
        }
        let is_behind = self.is_cut && robot == self.place.0 && index > self.place.1;
        if is_behind { None } else { self.case.action(robot, index) }
    }
}
