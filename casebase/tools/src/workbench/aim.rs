//! `aim`: where a pass or a kick is dragged to: the robot, or the kind of kick, that leads the ball nearest
//! to there. mm, field frame.

use casebase::plan_simulation::{PlanStep, Script, Spot, plan_simulation};
use casebase::{Action, CaseRobot, PointMm, Symmetry};

use super::action_text::ActionText;
use super::edit::Edit;
use super::follow::Changed;
use super::part::Part;
use crate::authored::Authored;
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
                let Some(id) = league.kick_id(kind) else { continue };
                let changed =
                    Changed { case, place: (kicker, index), action: Action::Kick(id), is_cut: false };
                let Some(end) = end_of(&changed, league) else { continue };
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

/// End of that kick, mm, field frame.
fn end_of(script: &Changed<'_>, league: &CaseLeague) -> Option<[f32; 2]> {
    let mut end: Option<Spot> = None;
    let _ = plan_simulation(script, league, |step| {
        if let PlanStep::Leg { robot, action, to, .. } = step
            && (robot, action) == script.place
        {
            end = Some(to);
        }
    });
    end.map(|end| end.in_field(script.ball()))
}
