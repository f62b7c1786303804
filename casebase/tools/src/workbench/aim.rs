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
            let mut nearest: Option<(f32, &String)> = None;
            for (kind, _) in &league.kicks {
                let case = case.mirrored(Symmetry::Identity, league);
                let kick =
                    league.kick_id(kind).map(|id| Instead { case, kicker, index, kick: Action::Kick(id) });
                let Some(end) = kick.and_then(|kick| end_of(&kick, league)) else { continue };
                let distance = square(end, to);
                if nearest.is_none_or(|(least, _)| distance < least) {
                    nearest = Some((distance, kind));
                }
            }
            ActionText::Kick(nearest?.1.clone())
        }
        _ => return None,
    };
    Some(Edit::SetAction { robot, number, action })
}

/// Squared distance of two points, mm².
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

/// End of that kick, mm, field frame.
fn end_of(script: &Instead<'_>, league: &CaseLeague) -> Option<[f32; 2]> {
    let mut end: Option<Spot> = None;
    let _ = plan_simulation(script, league, |step| {
        if let PlanStep::Leg { robot, action, to, .. } = step
            && (robot, action) == (script.kicker, script.index)
        {
            end = Some(to);
        }
    });
    end.map(|end| end.in_field(script.ball()))
}
