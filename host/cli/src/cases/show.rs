//! `onetwo cases show`: the contents of a stored case (paper §2; docs/case-format.md §1–§3). As text; mm and
//! degrees, the case's own coordinates.

use std::io::{self, Write};
use std::process::ExitCode;

use arena::cases::LibraryHandle;
use casebase::{
    Action, Case, CaseBase, GoalEnd, KickAim, KickId, Leg, LegKind, PointMm, Presence, TurnTarget,
};
use clap::Args;
use protocol::CaseId;

use super::failure::NoCase;
use crate::Failure;
use crate::args::LibraryArgs;
use crate::output;

/// Arguments of `cases show`.
#[derive(Debug, Args)]
pub(crate) struct ShowArgs {
    /// `region/name` of a case (printed as authored), or the id of a stored case.
    #[arg(value_name = "NAME|ID")]
    case: String,
    #[command(flatten)]
    library: LibraryArgs,
}

pub(super) fn run(args: &ShowArgs) -> Result<ExitCode, Failure> {
    let library_handle = crate::library::open(&args.library)?;
    let case = find(&library_handle, &args.case).ok_or_else(|| unknown(&library_handle, &args.case))?;
    let mut output = output::lines();
    let written = write_case(&mut output, &library_handle, &case);
    written.and_then(|()| output.flush()).map_err(Failure::Output)?;
    Ok(ExitCode::SUCCESS)
}

pub(super) fn find<'a>(library_handle: &'a LibraryHandle, asked: &str) -> Option<Case<'a>> {
    match asked.parse() {
        Ok(id) => library_handle.base().case(CaseId(id)),
        Err(_) => library_handle.base().cases().find(|case| library_handle.name(case.id()) == asked),
    }
}

pub(super) fn unknown(library_handle: &LibraryHandle, asked: &str) -> NoCase {
    let base = library_handle.base();
    NoCase::Unknown {
        asked: asked.to_owned(),
        league: library_handle.league().to_owned(),
        stored: base.len(),
        near: near(&library_handle.names(), asked),
    }
}

/// The name most like `asked`, with or without its region.
fn near(names: &[String], asked: &str) -> Option<String> {
    let alike = |name: &String| {
        let short = name.rsplit('/').next().unwrap_or(name);
        [name, short]
            .map(|name| strsim::normalized_damerau_levenshtein(name, asked))
            .into_iter()
            .fold(0.0, f64::max)
    };
    let best = names.iter().map(|name| (alike(name), name)).max_by(|a, b| a.0.total_cmp(&b.0))?;
    (best.0 >= ALIKE_SHARE_MIN).then(|| best.1.clone())
}

/// Least share of letters in common for two names to be taken for a typing error.
const ALIKE_SHARE_MIN: f64 = 0.6;

fn write_case(output: &mut impl Write, library_handle: &LibraryHandle, case: &Case<'_>) -> io::Result<()> {
    let base = library_handle.base();
    writeln!(
        output,
        "{}  id {}, {}, {}",
        library_handle.name(case.id()),
        case.id(),
        case.symmetry().label(),
        library_handle.league()
    )?;
    if let Some(intent) = library_handle.intent(case.id()) {
        writeln!(output, "{intent}")?;
    }
    let (side, ball, scope) = (case.defending(), case.ball(), case.ball_scope());
    let towards = if side == GoalEnd::Negative { "+x" } else { "-x" };
    writeln!(output, "defending {}: attacks towards {towards}; mm and degrees, field frame", side.label())?;
    writeln!(output, "\n{:5} {:>14}  scope {} x {}", "ball", at(ball), scope.x, scope.y)?;
    for robot in case.robots() {
        let gameplay: Vec<_> =
            case.gameplay(robot).map(|action| action_text(action, library_handle, &base)).collect();
        writeln!(
            output,
            "{:5} {:>14}  {}",
            robot.to_string(),
            at(case.position(robot)),
            gameplay.join("; ")
        )?;
    }
    for (index, (opponent, scope)) in case.opponents().enumerate() {
        let presence = match case.presence(index) {
            Presence::Preferred => "",
            other => &format!(", {}", other.label()),
        };
        writeln!(
            output,
            "{:5} {:>14}  scope {} x {}{presence}",
            format!("opp{}", index + 1),
            at(opponent),
            scope.x,
            scope.y
        )?;
    }
    writeln!(output, "\npath of the ball")?;
    for (number, leg) in (1..).zip(case.legs(ball)) {
        writeln!(output, "leg {number} {}", reported_leg(&leg, library_handle, &base))?;
    }
    Ok(())
}

fn reported_leg(leg: &Leg, library_handle: &LibraryHandle, base: &CaseBase<'_>) -> String {
    let kind = match leg.kind {
        LegKind::Pass(receiver) => format!("{} passes to {receiver}", leg.robot),
        LegKind::Kick(kind) => format!("{} kicks {}", leg.robot, reported_kick(library_handle, base, kind)),
    };
    let ([x, y], [to_x, to_y]) = (leg.from.map(f64::from), leg.to.map(f64::from));
    let length = (to_x - x).hypot(to_y - y);
    let radii = format!("radius {:.0} to {:.0}", leg.r_min, leg.r_max);
    format!("{kind}: ({x:.0}, {y:.0}) to ({to_x:.0}, {to_y:.0}), {length:.0} mm, {radii}")
}

fn action_text(action: Action, library_handle: &LibraryHandle, base: &CaseBase<'_>) -> String {
    let label = action.label();
    match action {
        Action::Wait | Action::GetBall => label.to_owned(),
        Action::GoToPoint(point) | Action::DribbleTo(point) => format!("{label} {}", at(point)),
        Action::Turn(TurnTarget::HeadingDeg(degrees)) => format!("{label} to {}", heading(degrees)),
        Action::Turn(TurnTarget::Face(point)) => format!("{label} to face {}", at(point)),
        Action::PassBall(other) => format!("{label} to {other}"),
        Action::ReceiveBall(other) => format!("{label} from {other}"),
        Action::Kick(kind) => format!("{label} {}", reported_kick(library_handle, base, kind)),
    }
}

/// The kind's name in the league and what it does in this case: a mirrored case plays the kind's partner.
fn reported_kick(library_handle: &LibraryHandle, base: &CaseBase<'_>, kind: KickId) -> String {
    let does = base.kick(kind).map(|kick| match kick.aim {
        KickAim::Goal { offset_mm: 0 } => "at the goal".to_owned(),
        KickAim::Goal { offset_mm } => format!("at the goal, {} mm {}", offset_mm.abs(), side(offset_mm)),
        KickAim::Heading { degrees, length_mm } => format!("{length_mm} mm {}", heading(degrees)),
    });
    format!("{} ({})", library_handle.kick(kind), does.unwrap_or_default())
}

/// A heading relative to the direction of attack.
fn heading(degrees: i32) -> String {
    if degrees == 0 {
        "straight ahead".to_owned()
    } else {
        format!("{} deg {}", degrees.abs(), side(degrees))
    }
}

/// Left is positive, seen in attack.
fn side(signed: i32) -> &'static str {
    if signed > 0 { "left" } else { "right" }
}

fn at(point: PointMm) -> String {
    format!("({}, {})", point.x, point.y)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn misspelled_case_gets_a_suggestion() {
        let names = ["center/pass-around", "front/shot"].map(str::to_owned);
        assert_eq!(near(&names, "center/pas-around").as_deref(), Some("center/pass-around"));
        assert_eq!(near(&names, "shto").as_deref(), Some("front/shot"));
        assert_eq!(near(&names, "goalie"), None);
    }

    #[test]
    fn left_is_reported_as_left() {
        assert_eq!(heading(45), "45 deg left");
        assert_eq!(heading(-45), "45 deg right");
        assert_eq!(heading(0), "straight ahead");
    }
}
