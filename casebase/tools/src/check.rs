//! `check`: errors that make a case unplayable, beyond the syntax of its file (docs/case-format.md §1.2).

use casebase::plan_simulation::{PlanError, PlanStep, Script, plan_simulation};
use casebase::{CaseRobot, LegKind, Symmetry};

use crate::authored::Authored;
use crate::codes::code;
use crate::files::SourceFile;
use crate::league::CaseLeague;
use foreign::{Finding, Severity};

/// Every error of a case that was read without a fault.
pub(crate) fn errors(file: &SourceFile, case: &Authored, league: &CaseLeague) -> Vec<Finding> {
    let mut findings = Vec::new();
    let mut error = |code, span: &std::ops::Range<usize>, message: String, hint: &str| {
        findings.push(file.finding(Severity::Error, code, file.line(span.start), message, hint));
    };

    let balls = [("the ball".to_owned(), case.ball, &case.ball_span)];
    let robots = CaseRobot::first(4).zip(&case.teammates);
    let robots = robots.map(|(robot, teammate)| (robot.to_string(), teammate.at, &teammate.at_span));
    let opponents = case.opponents.iter().enumerate();
    let opponents = opponents.map(|(i, opponent)| (format!("opp{}", i + 1), opponent.at, &opponent.span));
    for (who, at, span) in balls.into_iter().chain(robots).chain(opponents) {
        if !league.field.contains(at) {
            let message = format!("{who} at [{}, {}] is outside the lines", at.x, at.y);
            error(code::OUTSIDE_FIELD, span, message, "move it inside the field of league.toml");
        }
    }

    let getters: Vec<_> = case.teammates.iter().filter(|teammate| teammate.is_getter()).collect();
    if getters.len() != 1 {
        let span = &getters.get(1).copied().unwrap_or(&case.teammates[0]).span;
        let message = format!("{} robots begin with get_ball", getters.len());
        error(code::ONE_GETTER, span, message, "let exactly one robot begin with \"get_ball\"");
        return findings;
    }

    let script = case.mirrored(Symmetry::Identity, league);
    let mut legs = Vec::new();
    if let Err(problem) = plan_simulation(&script, league, |step| legs.push(step)) {
        let (code, at, hint) = match problem {
            // The one getter was found above.
            PlanError::NoGetter => return findings,
            PlanError::NotHolding(robot, index) => (
                code::NOT_HOLDING,
                (robot, index),
                "give it the ball first: a pass it receives, or a get_ball after a kick",
            ),
            PlanError::PassUnanswered(robot, index) => (
                code::PASS_UNANSWERED,
                (robot, index),
                "let the other robot's next ball action be the receive_ball of this pass",
            ),
            PlanError::ReceiveUnanswered(robot, index) => (
                code::RECEIVE_UNANSWERED,
                (robot, index),
                "let the other robot pass to it, or take the receive_ball out",
            ),
            PlanError::UnknownKick(robot, index) => {
                (code::UNKNOWN_KICK, (robot, index), "add the kind to league.toml")
            }
        };
        let (robot, index) = at;
        let (_, span) = &case.teammates[robot.index()].gameplay[index];
        let label = script.action(robot, index).map_or("", |action| action.label());
        error(code, span, format!("{problem} ({label})"), hint);
    }
    for step in legs {
        let PlanStep::Leg { robot, action, from, to, kind, .. } = step else { continue };
        let (what, reach) = match kind {
            LegKind::Pass(_) => ("pass", league.pass_reach),
            LegKind::Kick(id) => ("kick", league.reach(id)),
        };
        let ([from_x, from_y], [to_x, to_y]) = (from.in_field(case.ball), to.in_field(case.ball));
        let length = (to_x - from_x).hypot(to_y - from_y);
        if let Some(reach) = reach.filter(|reach| length > *reach as f32) {
            let message = format!("the {what} ends {length:.0} mm away, and rolls {reach} mm");
            let (_, span) = &case.teammates[robot.index()].gameplay[action];
            let hint = "move the ball or the receiver nearer, or carry the ball there before";
            error(code::BEYOND_REACH, span, message, hint);
        }
    }
    findings
}
