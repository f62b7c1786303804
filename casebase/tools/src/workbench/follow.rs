//! `follow`: what a robot may do after the actions before: those that the walk of the plan allows
//! (docs/case-format.md §3.1). mm, field frame.

use casebase::plan_simulation::{PlanError, PlanStep, Script, plan_simulation};
use casebase::{Action, CaseRobot, GoalEnd, KickId, PointMm, Symmetry};

use super::action_text::{ActionText, TurnText};
use crate::authored::{Authored, Mirrored};
use crate::league::CaseLeague;

/// How far ahead of the robot a new point lies, mm.
const AHEAD_MM: i32 = 600;

/// What may be the action of that index, given those before it; its list ends there.
pub(super) fn may_be(
    case: &Authored,
    league: &CaseLeague,
    robot: CaseRobot,
    index: usize,
) -> Vec<ActionText> {
    let choices = choices(case, league, robot, index);
    let fits = |choice: &ActionText| {
        choice.action(league).is_some_and(|action| allowed(case, league, robot, index, action))
    };
    choices.into_iter().filter(fits).collect()
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
    let here = (robot, index);
    // What the walk says of the list up to here with that action at its end.
    let walk = |last: Action| {
        let script = Cut { case: case.mirrored(Symmetry::Identity, league), robot, index, last };
        let (mut played, mut received) = (false, false);
        let outcome = plan_simulation(&script, league, |step| match step {
            PlanStep::Leg { robot, action, .. } => played |= (robot, action) == here,
            PlanStep::HandOver(hand_over) => received |= hand_over.to == here,
            PlanStep::NeverReached { .. } => {}
        });
        (outcome, played, received)
    };
    match action {
        Action::Wait | Action::Turn(_) | Action::GoToPoint(_) => true,
        Action::GetBall if index == 0 => {
            let begins = |other: &CaseRobot| {
                let first = case.teammates[other.index()].gameplay.first();
                *other != robot && first.is_some_and(|(first, _)| *first == Action::GetBall)
            };
            // One robot alone begins with the ball.
            !CaseRobot::first(case.teammates.len()).any(|other| begins(&other))
        }
        Action::GetBall | Action::ReceiveBall(_) => walk(action).2,
        // Whoever could kick holds the ball. Its receiver's part of a pass comes with it.
        Action::DribbleTo(_) | Action::Kick(_) | Action::PassBall(_) => {
            let (outcome, played, _) = walk(Action::Kick(KickId(0)));
            played || outcome == Err(PlanError::UnknownKick(robot, index))
        }
    }
}

/// A case in which one robot's list is cut, and ends with another action.
struct Cut<'c> {
    case: Mirrored<'c>,
    robot: CaseRobot,
    index: usize,
    last: Action,
}

impl Script for Cut<'_> {
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
        if robot != self.robot || index < self.index {
            return self.case.action(robot, index);
        }
        (index == self.index).then_some(self.last)
    }
}
