//! `description`: texts of roles, reasons, directives and actions. Short labels; places in m, field frame.

use arena::CycleEnd;
use casebase::{Action, Case, CaseRobot};
use host::strategy::{Flip, Order, OrderReason, Role};
use protocol::decision::Grounds;
use protocol::host::{Directive, KickOrder};
use protocol::quantized::WirePoint;
use protocol::team::{AbortReason, Closure, Decision, Progress};

/// `(1.20, −0.45)`.
pub(crate) fn place(at: impl Into<geometry::Point<geometry::Field>>) -> String {
    let at = at.into();
    format!("({:.2}, {:.2})", at.x(), at.y())
}

/// `FirstHalfPre` as `first half pre`; text in brackets stays.
pub fn spaced(name: &str) -> String {
    let mut out = String::new();
    let mut before = ' ';
    for letter in name.chars() {
        if letter.is_ascii_uppercase() && before.is_ascii_lowercase() {
            out.push(' ');
        }
        out.push(letter.to_ascii_lowercase());
        before = letter;
    }
    out
}

pub(crate) fn role(role: Role) -> String {
    match role {
        Role::Defender(n) => format!("defender {}", n + 1),
        Role::Support(n) => format!("support {}", n + 1),
        Role::Marker(n) => format!("marker {}", n + 1),
        other => spaced(&format!("{other:?}")),
    }
}

/// The reason of an order; with all actions and what each is worth, where it is the best of a rated list.
pub(crate) fn why(host: &host::Host, order: &Order) -> String {
    let why = reason(&order.why);
    let by_list = matches!(
        order.why,
        OrderReason::Chances { .. }
            | OrderReason::OfCase { .. }
            | OrderReason::PlaysCase { .. }
            | OrderReason::SoonestAtBall { .. }
    );
    match host.rated() {
        Some((who, list)) if by_list && who == order.robot && !list.is_empty() => {
            let list: Vec<_> = list.iter().map(ToString::to_string).collect();
            format!("{why}; rated: {}", list.join(", "))
        }
        _ => why,
    }
}

fn reason(why: &OrderReason) -> String {
    match why {
        OrderReason::Referee => "required by the referee's command".to_owned(),
        OrderReason::SoonestAtBall { seconds } => format!("soonest at the ball, in {seconds:.2} s"),
        OrderReason::OnBallLine { y } => {
            format!("between the ball and our goal; aims {y:.2} m off the goal centre")
        }
        OrderReason::ClearsArea { room } => format!("only the keeper may play it there; {room:.2} m of room"),
        OrderReason::FreePlace { worth } => format!("the best free place, worth {worth:.2}"),
        OrderReason::Marks { opponent } => {
            format!("opponent {} stands nearest to our goal unmarked", opponent.number())
        }
        OrderReason::BestTarget { room } => format!("the best target for the ball, {room:.2} m of room"),
        OrderReason::TooMany { allowed } => format!("the referee lets us have {allowed}"),
        OrderReason::Threat(_)
        | OrderReason::Uncovers
        | OrderReason::Challenges { .. }
        | OrderReason::Chances { .. }
        | OrderReason::OfCase { .. }
        | OrderReason::PlaysCase { .. }
        | OrderReason::Coerces { .. }
        | OrderReason::External
        | OrderReason::ExternalSilent
        | OrderReason::Test
        | OrderReason::ByHand
        | OrderReason::Coercing { .. } => why.to_string(),
        // Reasons without a label of their own are printed by their name.
        other => spaced(&format!("{other:?}")),
    }
}

pub(crate) fn directive(directive: &Directive) -> String {
    let at = |point: WirePoint| place(point);
    match directive {
        Directive::Stand => "stand".to_owned(),
        Directive::GoTo { pose } => format!("go to {}", at(pose.at)),
        Directive::GetBall { .. } => "get the ball".to_owned(),
        Directive::Kick { at: to, kick: how } => format!("kick at {}, {}", at(*to), kick(*how)),
        Directive::Pass { at: to, receiver, kick: how, ready } => {
            let wait = if *ready { "" } else { "; waits for it" };
            format!("pass to {} at {}, {}{wait}", receiver.number(), at(*to), kick(*how))
        }
        Directive::Receive { at: here, .. } => format!("have the pass at {}", at(*here)),
        Directive::Dribble { pose } => format!("carry the ball to {}", at(pose.at)),
        Directive::Block { from, to } => format!("block between {} and {}", at(*from), at(*to)),
        Directive::PlaceBall { at: there } => format!("place the ball at {}", at(*there)),
        Directive::Gameplay { hint: None } => "play cases with its teammates".to_owned(),
        Directive::Gameplay { hint: Some(_) } => "play the case that is proposed".to_owned(),
    }
}

fn kick(order: KickOrder) -> String {
    match order {
        KickOrder::Flat(speed) => format!("{:.1} m/s", f32::from(speed) * 0.01),
        KickOrder::Chip(speed) => format!("chipped, {:.1} m/s", f32::from(speed) * 0.01),
    }
}

/// Places that a robot goes to by its directive, and that it sends the ball to.
pub(super) fn aims(directive: &Directive) -> (Option<[f32; 2]>, Option<[f32; 2]>) {
    let to = |point: WirePoint| {
        let point: geometry::Point<geometry::Field> = point.into();
        Some([page::milli(point.x()), page::milli(point.y())])
    };
    match directive {
        Directive::GoTo { pose } => (to(pose.at), None),
        Directive::Dribble { pose } => (None, to(pose.at)),
        Directive::Kick { at, .. } | Directive::Pass { at, .. } | Directive::PlaceBall { at } => {
            (None, to(*at))
        }
        Directive::Receive { at, .. } => (to(*at), None),
        Directive::Stand
        | Directive::GetBall { .. }
        | Directive::Block { .. }
        | Directive::Gameplay { .. } => (None, None),
    }
}

/// The state of the reuse machine, and the step in it.
pub(super) fn progress(progress: Progress, case: Option<(&Case<'_>, CaseRobot)>) -> (String, String) {
    match progress {
        Progress::Idle => ("idle".to_owned(), String::new()),
        Progress::Adapt { arrived: false } => ("adapt".to_owned(), "on its way".to_owned()),
        Progress::Adapt { arrived: true } => ("adapt".to_owned(), "in place".to_owned()),
        Progress::Execute { done } => {
            let step = case
                .and_then(|(case, robot)| case.action(robot, done.into()))
                .map_or_else(|| format!("{done} actions done"), action);
            ("execute".to_owned(), step)
        }
        Progress::WaitEnd { finished: true } => ("wait end".to_owned(), "done".to_owned()),
        Progress::WaitEnd { finished: false } => ("wait end".to_owned(), String::new()),
    }
}

fn action(action: Action) -> String {
    let mm = |point: casebase::PointMm| place(geometry::Point::<geometry::Field>::from(point));
    match action {
        Action::PassBall(to) => format!("passes to case robot {}", to.number()),
        Action::ReceiveBall(from) => format!("receives from case robot {}", from.number()),
        Action::GetBall => "gets the ball".to_owned(),
        Action::DribbleTo(to) => format!("dribbles {}", mm(to)),
        Action::GoToPoint(to) => format!("goes {}", mm(to)),
        Action::Turn(_) => "turns".to_owned(),
        Action::Wait => "waits".to_owned(),
        Action::Kick(_) => "shoots".to_owned(),
    }
}

pub(super) fn decision(decision: &Decision) -> String {
    match decision {
        Decision::Undecided => "deciding".to_owned(),
        Decision::NoCase | Decision::Closed(Closure::NoCase) => "no case fits".to_owned(),
        Decision::Play(_) => "playing".to_owned(),
        Decision::Closed(Closure::Finished) => "finished".to_owned(),
        Decision::Closed(closure @ Closure::Aborted { by, .. }) => {
            format!("stopped by {}: {}", by.number(), end(CycleEnd::Closed(*closure)))
        }
    }
}

/// An end of a play, in the words that reports use: the same for the team's cycle, the time line and the
/// ledger of cases.
pub(super) fn end(end: CycleEnd) -> String {
    end.label().replace('-', " ")
}

/// The same with the robot that ended it, and its order now where that is why.
pub(super) fn end_by(host: &host::Host, end: CycleEnd) -> String {
    let words = self::end(end);
    let CycleEnd::Closed(Closure::Aborted { by, reason }) = end else { return words };
    let order = host.orders().iter().find(|order| order.robot == by);
    match order.filter(|_| reason == AbortReason::Reassigned) {
        Some(order) => format!("{words}: robot {}, now {}", by.number(), reassigned_to(host, order)),
        None => format!("{words}: robot {}", by.number()),
    }
}

fn reassigned_to(host: &host::Host, order: &Order) -> String {
    let what = directive(&order.task.directive(flip(host)));
    format!("{}, {what} ({})", role(order.role), reason(&order.why))
}

/// Why a decision is not simply retrieval's answer; empty where it is.
pub(super) fn grounds(grounds: Grounds) -> String {
    match grounds {
        Grounds::Retrieved => String::new(),
        Grounds::Holds(robot) => {
            format!("robot {} holds the ball, and the best case gives it to another: no case", robot.number())
        }
        Grounds::BallRolls => "the ball was rolling and no robot had it: not retrieved".to_owned(),
        Grounds::Proposed => "the host proposed the case".to_owned(),
        Grounds::ShootsSooner => "without a case it expected to shoot sooner: no case".to_owned(),
        Grounds::NoBall => "the coordinator saw no ball".to_owned(),
    }
}

/// The transform from the frame of a host's strategy to the field frame.
pub(crate) fn flip(host: &host::Host) -> Flip {
    let settings = host.settings();
    Flip::defending(host.game().own_goal(settings.us).unwrap_or(settings.defending))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_reported_in_words() {
        assert_eq!(spaced("FirstHalfPre"), "first half pre");
        assert_eq!(role(Role::Defender(0)), "defender 1");
        assert_eq!(role(Role::Keeper), "keeper");
        assert_eq!(reason(&OrderReason::NoBall), "no ball");
    }

    #[test]
    fn a_directive_says_where() {
        let at = WirePoint { x: 1200, y: -450 };
        let kick = Directive::Kick { at, kick: KickOrder::Flat(620) };
        assert_eq!(directive(&kick), "kick at (1.20, -0.45), 6.2 m/s");
        assert_eq!(aims(&kick), (None, Some([1.2, -0.45])));
    }
}
