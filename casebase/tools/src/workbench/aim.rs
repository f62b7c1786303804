//! `aim`: where a pass or a kick is dragged to: the robot, or the kind of kick, that leads the ball nearest
//! to there. mm, field frame.

use casebase::plan_simulation::{PlanStep, Script, Spot, plan_simulation};
use casebase::{Action, CaseRobot, GoalEnd, PointMm, Symmetry};

use super::action_text::ActionText;
use super::edit::Edit;
use super::part::Part;
use crate::authored::{Authored, Mirrored};
use crate::league::CaseLeague;

/// The change of a pass or a kick whose end is moved; none where something else is.
pub(super) fn aimed(case: &Authored, league: &CaseLeague, edit: &Edit) -> Option<Edit> {
    let Edit::Move { part: Part::Action(robot, number), to } = *edit else { return None };
    let index = number.checked_sub(1)?;
    let kicker = CaseRobot::new(robot.checked_sub(1)?)?;
    let to = PointMm::new(to[0], to[1]);
    let (action, _) = case.teammates.get(kicker.index())?.gameplay.get(index)?;
    let action = match action {
        Action::PassBall(_) => {
            let others = CaseRobot::first(case.teammates.len()).filter(|other| *other != kicker);
            let far = |other: &CaseRobot| square(case.teammates[other.index()].at.to_f32(), to);
            let nearest = others.min_by(|a, b| far(a).total_cmp(&far(b)))?;
            ActionText::PassBall(nearest.number())
        }
        Action::Kick(_) => {
            let end = |kind: &str| {
                let kick = Action::Kick(league.kick_id(kind)?);
                end_of(
                    &Instead { case: case.mirrored(Symmetry::Identity, league), kicker, index, kick },
                    league,
                )
            };
            let ends = league.kicks.iter().filter_map(|(kind, _)| Some((kind, square(end(kind)?, to))));
            ActionText::Kick(ends.min_by(|a, b| a.1.total_cmp(&b.1))?.0.clone())
        }
        _ => return None,
    };
    Some(Edit::SetAction { robot, number, action })
}

/// Squared distance, mm².
fn square(at: [f32; 2], to: PointMm) -> f32 {
    let [x, y] = to.to_f32();
    (at[0] - x) * (at[0] - x) + (at[1] - y) * (at[1] - y)
}

/// A case with another kick in the place of one action.
struct Instead<'c> {
    case: Mirrored<'c>,
    kicker: CaseRobot,
    index: usize,
    kick: Action,
}

impl Script for Instead<'_> {
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
        let replaced = (robot, index) == (self.kicker, self.index);
        if replaced { Some(self.kick) } else { self.case.action(robot, index) }
    }
}

/// Where that kick ends.
fn end_of(script: &Instead<'_>, league: &CaseLeague) -> Option<[f32; 2]> {
    let mut end: Option<Spot> = None;
    let _ = plan_simulation(script, league, |step| {
        if let PlanStep::Leg { robot, action, to, .. } = step
            && (robot, action) == (script.kicker, script.index)
        {
            end = Some(to);
        }
    });
    let end = end?;
    let [x, y] = if end.on_field { [0.0; 2] } else { script.ball().to_f32() };
    Some([end.at[0] + x, end.at[1] + y])
}
