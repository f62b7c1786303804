//! `warnings`: warnings about cases that are playable but doubtful; none stops retrieval
//! (docs/case-format.md §1.2).

use std::collections::HashMap;

use casebase::plan_simulation::{PlanStep, plan_simulation};
use casebase::{
    Action, Case, CaseBase, CaseRobot, PointMm, Presence, Problem, RetrievalSettings, Scope, Symmetry,
    TurnTarget, blocked_leg, retrieve_best,
};
use protocol::{CaseId, RobotId};

use crate::authored::{Authored, Opponent};
use crate::codes::code;
use crate::files::Files;
use crate::league::CaseLeague;
use crate::notes::Notes;
use crate::{plans, self_blocking};
use foreign::{Finding, Severity};

/// Every warning about cases that passed all checks; `report` is called with the number of cases done.
pub(crate) fn warnings(
    files: &Files,
    cases: &[Authored],
    base: &CaseBase<'_>,
    league: &CaseLeague,
    mut report: impl FnMut(usize),
) -> Vec<Finding> {
    let mut findings = Vec::new();
    if cases.is_empty() {
        let hint = "add cases at <region>/<name>.toml; until then every retrieval finds nothing";
        findings.push(files.rules.finding(
            Severity::Warning,
            code::EMPTY,
            1,
            "the library has no case",
            hint,
        ));
    }
    let twins = twins(base);
    for (authored, (file, case)) in files.cases.iter().zip(cases).enumerate() {
        let Some(stored) = base.case(CaseId(4 * authored as u16)) else { continue };
        report(authored + 1);
        let mut notes = Notes { file, findings: &mut findings };
        names(&mut notes, case);
        big_scopes(&mut notes, case);
        plans::doubts(&mut notes, case, &stored, league);
        gameplays(&mut notes, case, league);
        let path_is_free = scopes_in_path(&mut notes, case, &stored, base);
        if let Some(other) = twins.get(&authored) {
            let message = format!("retrieval cannot tell it from {}", files.cases[*other].name);
            notes.add(code::TWIN, &(0..0), message, "take one of the two out, or move one");
        } else if path_is_free {
            beaten(&mut notes, files, &stored, base);
        }
    }
    findings
}

/// Checks the file's name and its intent.
fn names(notes: &mut Notes<'_>, case: &Authored) {
    if case.intent.trim().is_empty() {
        notes.add(code::NO_INTENT, &(0..0), "the intent is blank", "say in a sentence what the case is for");
    }
    let odd = |c: &char| !(c.is_ascii_alphanumeric() || "-_./".contains(*c));
    if let Some(character) = notes.file.name.chars().find(odd) {
        let message = format!("the file's name holds {character:?}");
        notes.add(code::FILE_NAME, &(0..0), message, "rename it: letters, digits, - _ and . travel well");
    }
}

fn big_scopes(notes: &mut Notes<'_>, case: &Authored) {
    let opponents = case.opponents.iter().enumerate();
    let opponents = opponents.map(|(i, opponent)| (format!("opp{}", i + 1), opponent.scope, &opponent.span));
    for (whose, scope, span) in
        [("the ball".to_owned(), case.ball_scope, &case.ball_span)].into_iter().chain(opponents)
    {
        if scope.x > BIG_SCOPE.x || scope.y > BIG_SCOPE.y {
            let message =
                format!("the scope of {whose}, {} × {} mm, is a large part of the field", scope.x, scope.y);
            notes.add(code::BIG_SCOPE, span, message, "split the case, or keep scopes within 900 × 700 mm");
        }
    }
}

/// Checks the lists of actions alone.
fn gameplays(notes: &mut Notes<'_>, case: &Authored, league: &CaseLeague) {
    for (robot, teammate) in CaseRobot::first(case.teammates.len()).zip(&case.teammates) {
        if teammate.gameplay.iter().all(|(action, _)| *action == Action::Wait) {
            let hint = "leave it out of the case, or give it something to do";
            notes.add(code::BYSTANDER, &teammate.span, format!("{robot} only waits"), hint);
        }
        let mut holds_ball = false;
        for (action, span) in &teammate.gameplay {
            let point = match action {
                Action::GoToPoint(at) | Action::DribbleTo(at) | Action::Turn(TurnTarget::Face(at)) => {
                    Some(*at)
                }
                _ => None,
            };
            if let Some(at) = point.filter(|at| !league.field.contains(*at)) {
                let message =
                    format!("{robot} should {} [{}, {}], outside the lines", action.label(), at.x, at.y);
                notes.add(code::POINT_OUTSIDE, span, message, "move the point inside the field");
            }
            match action {
                Action::GetBall | Action::ReceiveBall(_) => holds_ball = true,
                Action::PassBall(_) | Action::Kick(_) => holds_ball = false,
                Action::GoToPoint(_) if holds_ball => {
                    let message =
                        format!("{robot} goes to a point while it holds the ball, which stays behind");
                    notes.add(code::LEAVES_BALL, span, message, "write dribble_to to take the ball along");
                }
                _ => {}
            }
        }
    }
    // The case passed the same simulation among the checks.
    let _ = plan_simulation(&case.mirrored(Symmetry::Identity, league), league, |step| {
        if let PlanStep::NeverReached { robot, action } = step {
            let (_, span) = &case.teammates[robot.index()].gameplay[action];
            let message = format!("no kick ever leaves the ball to this get_ball of {robot}");
            notes.add(code::NEVER_REACHED, span, message, "take it out, or let a kick come before it");
        }
    });
}

/// Warns of scopes that block the case's own path, with their centres or a good part of them; returns whether
/// the path is free of all centres.
fn scopes_in_path(notes: &mut Notes<'_>, case: &Authored, stored: &Case<'_>, base: &CaseBase<'_>) -> bool {
    let mut free = true;
    let present = |(_, opponent): &(usize, &Opponent)| opponent.presence != Presence::Excluded;
    for (i, opponent) in case.opponents.iter().enumerate().filter(present) {
        if let Some(blocked) =
            blocked_leg(stored, base, case.ball, &[opponent.at], &RetrievalSettings::default())
        {
            free = false;
            let message = format!(
                "the centre of opp{}'s scope lies {:.0} mm inside leg {} of the case's own ball path",
                i + 1,
                blocked.inside_mm,
                blocked.index + 1
            );
            notes.add(
                code::SCOPE_IN_PATH,
                &opponent.span,
                message,
                "lead the ball around it, or move the scope",
            );
            continue;
        }
        // A required scope says where the case applies, not what speaks for it: the path is tested apart.
        if opponent.presence == Presence::Required {
            continue;
        }
        let share = self_blocking::share(stored, base, opponent.at, opponent.scope);
        if share > self_blocking::WARNS_ABOVE {
            let message = format!(
                "in {:.0} % of opp{}'s scope the opponent blocks the case's own ball path",
                100.0 * share,
                i + 1
            );
            let hint = "make the scope smaller on that side, or lead the ball farther from it";
            notes.add(code::SELF_BLOCKING, &opponent.span, message, hint);
        }
    }
    free
}

/// Warns where another case is retrieved in the situation that this one describes.
fn beaten(notes: &mut Notes<'_>, files: &Files, stored: &Case<'_>, base: &CaseBase<'_>) {
    let players = RobotId::all().skip(1).zip(stored.robots()).map(|(id, robot)| (id, stored.position(robot)));
    let problem = Problem {
        ball: stored.ball(),
        defending: stored.defending(),
        teammates: players.collect(),
        opponents: (stored.opponents().enumerate())
            .filter(|(number, _)| stored.presence(*number) != Presence::Excluded)
            .map(|(_, (at, _))| at)
            .collect(),
    };
    let winner = retrieve_best(base, &problem, &RetrievalSettings::default());
    let winner = winner.and_then(|winner| base.case(winner.case));
    if let Some(winner) = winner.filter(|winner| winner.authored() != stored.authored()) {
        let name = &files.cases[winner.authored()].name;
        let message = format!("in its own situation {name} ({}) is retrieved instead", winner.symmetry());
        notes.add(code::BEATEN, &(0..0), message, "tell them apart by opponents, robots or the ball's scope");
    }
}

/// Authored cases that retrieval cannot distinguish from an earlier one, for any problem: in some symmetry
/// all data it uses is equal. Each with the earlier one.
fn twins(base: &CaseBase<'_>) -> HashMap<usize, usize> {
    let mut first: HashMap<Seen, usize> = HashMap::new();
    let mut twins = HashMap::new();
    for case in base.cases() {
        let earlier = *first.entry(seen(&case)).or_insert(case.authored());
        if earlier != case.authored() {
            twins.entry(case.authored()).or_insert(earlier);
        }
    }
    twins
}

/// All data that retrieval uses, in a canonical order.
type Seen = (bool, PointMm, Scope, Vec<PointMm>, Vec<(PointMm, (i32, i32), Presence)>, Vec<[u32; 6]>);

fn seen(case: &Case<'_>) -> Seen {
    let mut positions: Vec<_> = case.robots().map(|robot| case.position(robot)).collect();
    positions.sort_unstable();
    let mut opponents: Vec<_> = (case.opponents().enumerate())
        .map(|(number, (at, scope))| (at, (scope.x, scope.y), case.presence(number)))
        .collect();
    opponents.sort_unstable();
    // −0 and 0 are the same position.
    let bits = |[x, y]: [f32; 2]| [(x + 0.0).to_bits(), (y + 0.0).to_bits()];
    // Two positions of the ball distinguish a leg that moves with the ball from one that ends at a point of
    // the field.
    let elsewhere = case.ball().plus(PointMm::new(100, 100));
    let mut legs: Vec<_> = [case.ball(), elsewhere]
        .into_iter()
        .flat_map(|ball| case.legs(ball))
        .map(|leg| {
            let ([a, b], [c, d]) = (bits(leg.from), bits(leg.to));
            [a, b, c, d, leg.r_min.to_bits(), leg.r_max.to_bits()]
        })
        .collect();
    legs.sort_unstable();
    let positive = case.defending() == casebase::GoalEnd::Positive;
    (positive, case.ball(), case.ball_scope(), positions, opponents, legs)
}

/// Size above which a scope covers more than one situation, mm.
const BIG_SCOPE: Scope = Scope { x: 900, y: 700 };
