//! `sheet`: a case file as a person edits it: its text, findings, actions with what may be in their place,
//! and its geometry in all four symmetries. mm, field frame.

use casebase::plan_simulation::{PlanStep, Script, plan_simulation};
use casebase::{CaseRobot, LegKind, PointMm, Presence, Symmetry};
use serde::Serialize;

use super::action_text::ActionText;
use super::follow;
use crate::authored::Authored;
use crate::league::CaseLeague;
use foreign::Finding;

/// All that is shown of a case file. Lists are empty where it cannot be read.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Sheet {
    /// Name of the case, `region/name`.
    pub name: String,
    /// The whole text, TOML.
    pub text: String,
    /// Intent of the case.
    pub intent: String,
    /// The findings of `cases check` on this file, but for those of drawn problems.
    pub findings: Vec<FindingNote>,
    /// Findings on other files that this file brings about.
    pub elsewhere: Vec<FindingNote>,
    /// The robots' actions, as the file has them.
    pub robots: Vec<RobotSheet>,
    /// The case in all four symmetries, the file's own first.
    pub copies: Vec<CopySheet>,
}

/// A finding, as data.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct FindingNote {
    /// Code of its kind.
    pub code: &'static str,
    /// Severity, `error` or `warning`.
    pub severity: String,
    /// Name of the file.
    pub file: String,
    /// Line in the file, from 1.
    pub line: u32,
    /// Description of the fault.
    pub message: String,
    /// Advice how to fix it.
    pub hint: String,
}

impl FindingNote {
    /// A finding without its directory.
    pub fn of(finding: &Finding) -> Self {
        Self {
            code: finding.code,
            severity: finding.severity.to_string(),
            file: super::case_name(&finding.file),
            line: finding.line,
            message: finding.message.clone(),
            hint: finding.hint.clone(),
        }
    }
}

/// Actions of a robot, and those that it may have.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct RobotSheet {
    /// Actions in their order.
    pub actions: Vec<ActionText>,
    /// Actions that may be in the place of each, and behind the last, given those before.
    pub may_be: Vec<Vec<ActionText>>,
}

/// A case in one symmetry.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CopySheet {
    /// Name of the symmetry.
    pub symmetry: &'static str,
    /// Goal that is defended, `yellow` or `cyan`.
    pub defending: &'static str,
    /// Position and scope of the ball.
    pub ball: Scoped,
    /// Robots in their order.
    pub robots: Vec<PlacedRobot>,
    /// Opponents in their order.
    pub opponents: Vec<PlacedOpponent>,
    /// Legs of the ball's path.
    pub legs: Vec<LegSheet>,
}

/// A place with a scope.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Scoped {
    /// Position, mm, field frame.
    pub at: [i32; 2],
    /// The radii of its scope.
    pub scope: [i32; 2],
}

/// An opponent in one symmetry.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct PlacedOpponent {
    /// Position, mm, field frame.
    pub at: [i32; 2],
    /// The radii of its scope.
    pub scope: [i32; 2],
    /// Demand of the scope.
    pub presence: Presence,
}

/// A robot in one symmetry.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct PlacedRobot {
    /// Position, mm, field frame.
    pub at: [i32; 2],
    /// Actions in their order.
    pub actions: Vec<ActionText>,
}

/// A leg of the ball's path.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LegSheet {
    /// Number of the robot that passes or kicks.
    pub robot: u8,
    /// Number of its action.
    pub number: usize,
    /// Start of the leg, mm, field frame.
    pub from: [f32; 2],
    /// End of the leg, mm, field frame.
    pub to: [f32; 2],
    /// Radii at the start and at the end, mm.
    pub radii: [i32; 2],
    /// Kind of the leg, `pass` or `kick`.
    pub kind: &'static str,
}

pub(super) fn robots(case: &Authored, league: &CaseLeague) -> Vec<RobotSheet> {
    let all = CaseRobot::first(case.teammates.len()).zip(&case.teammates);
    all.map(|(robot, teammate)| RobotSheet {
        actions: teammate.gameplay.iter().map(|(action, _)| ActionText::of(*action, league)).collect(),
        may_be: (0..=teammate.gameplay.len())
            .map(|index| follow::may_be(case, league, robot, index))
            .collect(),
    })
    .collect()
}

/// The case in all four symmetries.
pub(super) fn copies(case: &Authored, league: &CaseLeague) -> Vec<CopySheet> {
    Symmetry::ALL.into_iter().map(|symmetry| copy(case, league, symmetry)).collect()
}

fn copy(case: &Authored, league: &CaseLeague, symmetry: Symmetry) -> CopySheet {
    let mirrored = case.mirrored(symmetry, league);
    let ball = mirrored.ball();
    let pair = |at: PointMm| [at.x, at.y];
    let robots = CaseRobot::first(case.teammates.len()).map(|robot| PlacedRobot {
        at: pair(mirrored.position(robot)),
        actions: (0..).map_while(|i| mirrored.action(robot, i)).map(|a| ActionText::of(a, league)).collect(),
    });
    let opponents = case.opponents.iter().map(|opponent| PlacedOpponent {
        at: pair(symmetry.point(opponent.at)),
        scope: [opponent.scope.x, opponent.scope.y],
        presence: opponent.presence,
    });
    let mut legs = Vec::new();
    // As far as the plan can be walked; the findings say what is amiss.
    let _ = plan_simulation(&mirrored, league, |step| {
        if let PlanStep::Leg { robot, action, from, to, radii, kind, .. } = step {
            legs.push(LegSheet {
                robot: robot.number(),
                number: action + 1,
                from: from.in_field(ball),
                to: to.in_field(ball),
                radii,
                kind: if matches!(kind, LegKind::Pass(_)) { "pass" } else { "kick" },
            });
        }
    });
    CopySheet {
        symmetry: symmetry.label(),
        defending: mirrored.defending().label(),
        ball: Scoped { at: pair(ball), scope: [case.ball_scope.x, case.ball_scope.y] },
        robots: robots.collect(),
        opponents: opponents.collect(),
        legs,
    }
}
