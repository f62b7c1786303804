//! `sheet`: a case file as a person edits it: its text, findings, actions with what may be in their place,
//! and its geometry in all four symmetries. mm, field frame.

use casebase::plan_simulation::{PlanStep, Script, Spot, plan_simulation};
use casebase::{CaseRobot, LegKind, PointMm, Presence, Symmetry};
use serde::Serialize;

use super::action_text::ActionText;
use super::follow;
use crate::authored::Authored;
use crate::finding::Finding;
use crate::league::CaseLeague;

/// All that is shown of a case file. Lists are empty where it cannot be read.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Sheet {
    /// `region/name`.
    pub name: String,
    /// The whole text, TOML.
    pub text: String,
    /// What the case is for.
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
    /// `error` or `warning`.
    pub severity: String,
    /// The file's name.
    pub file: String,
    /// Its line, from 1.
    pub line: u32,
    /// What is wrong.
    pub message: String,
    /// How to fix it.
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

/// A robot's list.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct RobotSheet {
    /// Its actions.
    pub actions: Vec<ActionText>,
    /// What may be in the place of each, and behind the last, given the actions before.
    pub may_be: Vec<Vec<ActionText>>,
}

/// A case in one symmetry.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CopySheet {
    /// Name of the symmetry.
    pub symmetry: &'static str,
    /// The goal defended.
    pub defending: &'static str,
    /// The ball.
    pub ball: Scoped,
    /// The robots.
    pub robots: Vec<PlacedRobot>,
    /// The opponents.
    pub opponents: Vec<PlacedOpponent>,
    /// The ball's path.
    pub legs: Vec<LegSheet>,
}

/// A place with a scope.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Scoped {
    /// Its place.
    pub at: [i32; 2],
    /// The radii of its scope.
    pub scope: [i32; 2],
}

/// An opponent in one symmetry.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct PlacedOpponent {
    /// Its place.
    pub at: [i32; 2],
    /// The radii of its scope.
    pub scope: [i32; 2],
    /// What the scope demands.
    pub presence: Presence,
}

/// A robot in one symmetry.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct PlacedRobot {
    /// Its place.
    pub at: [i32; 2],
    /// Its actions.
    pub actions: Vec<ActionText>,
}

/// A leg of the ball's path.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LegSheet {
    /// Number of the robot that passes or kicks.
    pub robot: u8,
    /// Number of its action.
    pub number: usize,
    /// Where it begins.
    pub from: [f32; 2],
    /// Where it ends.
    pub to: [f32; 2],
    /// Its radii at the beginning and at the end.
    pub radii: [i32; 2],
    /// `pass` or `kick`.
    pub kind: &'static str,
}

/// The actions of every robot.
pub(super) fn robots(case: &Authored, league: &CaseLeague) -> Vec<RobotSheet> {
    let all = CaseRobot::first(case.teammates.len()).zip(&case.teammates);
    let sheet = |(robot, teammate): (CaseRobot, &crate::authored::Teammate)| RobotSheet {
        actions: teammate.gameplay.iter().map(|(action, _)| ActionText::of(*action, league)).collect(),
        may_be: (0..=teammate.gameplay.len())
            .map(|index| follow::may_be(case, league, robot, index))
            .collect(),
    };
    all.map(sheet).collect()
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
    let on_field = |spot: Spot| {
        let [x, y] = if spot.on_field { [0.0; 2] } else { ball.to_f32() };
        [spot.at[0] + x, spot.at[1] + y]
    };
    let mut legs = Vec::new();
    // As far as the plan can be walked; the findings say what is amiss.
    let _ = plan_simulation(&mirrored, league, |step| {
        if let PlanStep::Leg { robot, action, from, to, radii, kind, .. } = step {
            legs.push(LegSheet {
                robot: robot.number(),
                number: action + 1,
                from: on_field(from),
                to: on_field(to),
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
