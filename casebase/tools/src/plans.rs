//! `plans`: checks of a case's joint plan. Warnings; none stops retrieval (docs/case-format.md §1.2).
//!
//! Everything is tested in the case's own situation: ball and robots at the file's positions. mm, field
//! frame.

use std::ops::Range;

use casebase::plan_simulation::plan_simulation;
use casebase::{Action, Case, CaseRobot, Leg, LegKind, PointMm, Presence, Symmetry};

use crate::authored::Authored;
use crate::codes::code;
use crate::league::CaseLeague;
use crate::notes::Notes;

/// Warns of robots at one position, of legs that are probably unintended, and of a ball that is never played.
pub(crate) fn doubts(notes: &mut Notes<'_>, case: &Authored, stored: &Case<'_>, league: &CaseLeague) {
    same_spot(notes, case);
    for (index, leg) in stored.legs(case.ball).enumerate() {
        let span = &case.teammates[leg.robot.index()].gameplay[leg.action].1;
        leg_doubts(notes, &leg, span, league);
        if index == 0 {
            teammates_on(notes, case, &leg, league);
        }
    }
    idle_ball(notes, case);
}

fn same_spot(notes: &mut Notes<'_>, case: &Authored) {
    let teammates = CaseRobot::first(case.teammates.len()).zip(&case.teammates);
    let teammates = teammates.map(|(robot, teammate)| (robot.to_string(), teammate.at, &teammate.at_span));
    let opponents = case.opponents.iter().enumerate();
    let opponents = opponents.filter(|(_, opponent)| opponent.presence != Presence::Excluded);
    let opponents = opponents.map(|(i, opponent)| (format!("opp{}", i + 1), opponent.at, &opponent.span));
    let all: Vec<_> = teammates.chain(opponents).collect();
    for (later, (who, at, span)) in all.iter().enumerate() {
        if let Some((other, ..)) = all[..later].iter().find(|(_, other, _)| is_near(*at, *other)) {
            let message = format!("{who} and {other} stand less than {ROOM_MM} mm apart");
            notes.add(code::SAME_SPOT, span, message, "move one of the two");
        }
    }
}

/// Returns whether two robots would overlap.
fn is_near(a: PointMm, b: PointMm) -> bool {
    let [dx, dy] = a.minus(b).to_f32();
    dx * dx + dy * dy < ROOM_MM * ROOM_MM
}

fn leg_doubts(notes: &mut Notes<'_>, leg: &Leg, span: &Range<usize>, league: &CaseLeague) {
    let [dx, dy] = [leg.to[0] - leg.from[0], leg.to[1] - leg.from[1]];
    match leg.kind {
        LegKind::Pass(to) if dx * dx + dy * dy < leg.r_min * leg.r_min => {
            let message = format!("the pass to {to} is shorter than r_min, {} mm", leg.r_min);
            notes.add(
                code::SHORT_PASS,
                span,
                message,
                "let the robot dribble, or the other stand farther off",
            );
        }
        LegKind::Kick(_) => {
            let end = PointMm::new(leg.to[0] as i32, leg.to[1] as i32);
            if !league.field.contains(end) {
                let message = format!("the kick ends at [{}, {}], outside the lines", end.x, end.y);
                notes.add(code::KICK_LEAVES, span, message, "take a shorter kind, or another heading");
            }
        }
        LegKind::Pass(_) => {}
    }
}

/// Teammates on the first leg, before any robot has moved, which are neither its kicker nor ever receive the
/// ball.
fn teammates_on(notes: &mut Notes<'_>, case: &Authored, leg: &Leg, league: &CaseLeague) {
    let mut takers = vec![leg.robot];
    // The case passed the same simulation among the checks.
    let _ = plan_simulation(&case.mirrored(Symmetry::Identity, league), league, |step| {
        takers.extend(step.hand_over().map(|hand_over| hand_over.to.0));
    });
    for (robot, teammate) in CaseRobot::first(case.teammates.len()).zip(&case.teammates) {
        let moves = teammate.gameplay.iter().any(|(action, _)| matches!(action, Action::GoToPoint(_)));
        let abreast = leg.abreast(teammate.at.to_f32());
        let stands_on = abreast.is_some_and(|place| place.across.abs() < ROOM_MM);
        if stands_on && !moves && !takers.contains(&robot) {
            let message = format!("{robot} stands on the ball's first leg");
            notes.add(code::TEAMMATE_IN_PATH, &teammate.at_span, message, "move it aside");
        }
    }
}

/// A robot that gets the ball should play it on; a pass received may end a gameplay, since the next case
/// starts with it.
fn idle_ball(notes: &mut Notes<'_>, case: &Authored) {
    for (robot, teammate) in CaseRobot::first(case.teammates.len()).zip(&case.teammates) {
        let last = teammate.gameplay.iter().rev().find(|(action, _)| *action != Action::Wait);
        if let Some((Action::GetBall, span)) = last {
            let message = format!("{robot} takes the ball and does nothing with it");
            notes.add(code::IDLE_BALL, span, message, "let it dribble_to, pass_ball or kick");
        }
    }
}

/// Distance below which two bodies overlap, mm. Both an AIBO and a robot of the SSL are 180 mm wide; the
/// slack is for an opponent that presses at the ball.
const ROOM_MM: f32 = 100.0;
