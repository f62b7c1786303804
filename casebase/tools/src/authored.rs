//! `authored`: the contents of a case file (docs/case-format.md §1). Read key by key, so that every fault
//! names its line. mm, field frame.

use std::ops::Range;

use casebase::plan_simulation::Script;
use casebase::{
    Action, CaseRobot, GoalEnd, OPPONENTS_MAX, PointMm, Presence, Scope, Symmetry, TEAMMATES_MAX, TurnTarget,
};

use crate::codes::code;
use crate::document::{Reader, Table, Value};
use crate::files::SourceFile;
use crate::keys::{self, COORDINATES};
use crate::league::CaseLeague;
use foreign::{Finding, Severity};

/// A case as its author wrote it. Spans are byte ranges in its file.
#[derive(Clone, Debug)]
pub(crate) struct Authored {
    pub(crate) intent: String,
    pub(crate) defending: GoalEnd,
    pub(crate) ball: PointMm,
    pub(crate) ball_span: Range<usize>,
    pub(crate) ball_scope: Scope,
    pub(crate) teammates: Vec<Teammate>,
    pub(crate) opponents: Vec<Opponent>,
}

#[derive(Clone, Debug)]
pub(crate) struct Teammate {
    pub(crate) at: PointMm,
    pub(crate) at_span: Range<usize>,
    /// Byte range of its table.
    pub(crate) span: Range<usize>,
    pub(crate) gameplay: Vec<(Action, Range<usize>)>,
}

impl Teammate {
    /// Returns whether the first action is `get_ball`.
    pub(crate) fn is_getter(&self) -> bool {
        self.gameplay.first().is_some_and(|(action, _)| *action == Action::GetBall)
    }
}

#[derive(Clone, Debug)]
pub(crate) struct Opponent {
    pub(crate) at: PointMm,
    pub(crate) span: Range<usize>,
    pub(crate) scope: Scope,
    pub(crate) presence: Presence,
}

impl Authored {
    /// Reads a case file; without the league, kick kinds are not checked (the library is refused anyway).
    pub(crate) fn read(file: &SourceFile, league: Option<&CaseLeague>) -> (Option<Self>, Vec<Finding>) {
        let mut reader = Reader::new(file);
        let case = reader.parse().and_then(|root| read_case(&mut reader, &Table::root(&root), league));
        let faulty = reader.findings.iter().any(|finding| finding.severity == Severity::Error);
        (case.filter(|_| !faulty), reader.findings)
    }

    pub(crate) fn mirrored<'c>(&'c self, symmetry: Symmetry, league: &'c CaseLeague) -> Mirrored<'c> {
        Mirrored { case: self, symmetry, league }
    }
}

/// A case in one of the four symmetries.
#[derive(Clone, Copy)]
pub(crate) struct Mirrored<'c> {
    pub(crate) case: &'c Authored,
    pub(crate) symmetry: Symmetry,
    league: &'c CaseLeague,
}

impl Mirrored<'_> {
    fn action_under(&self, action: Action) -> Action {
        let point = |point| self.symmetry.point(point);
        let swaps = self.symmetry.swaps_sides();
        match action {
            Action::GoToPoint(at) => Action::GoToPoint(point(at)),
            Action::DribbleTo(at) => Action::DribbleTo(point(at)),
            Action::Turn(TurnTarget::Face(at)) => Action::Turn(TurnTarget::Face(point(at))),
            Action::Turn(TurnTarget::HeadingDeg(degrees)) if swaps => {
                Action::Turn(TurnTarget::HeadingDeg(-degrees))
            }
            Action::Kick(id) if swaps => Action::Kick(self.league.partner(id)),
            other => other,
        }
    }
}

impl Script for Mirrored<'_> {
    fn teammates(&self) -> usize {
        self.case.teammates.len()
    }
    fn defending(&self) -> GoalEnd {
        self.symmetry.goal(self.case.defending)
    }
    fn ball(&self) -> PointMm {
        self.symmetry.point(self.case.ball)
    }
    fn position(&self, robot: CaseRobot) -> PointMm {
        self.case
            .teammates
            .get(robot.index())
            .map_or(self.ball(), |teammate| self.symmetry.point(teammate.at))
    }
    fn action(&self, robot: CaseRobot, index: usize) -> Option<Action> {
        let (action, _) = self.case.teammates.get(robot.index())?.gameplay.get(index)?;
        Some(self.action_under(*action))
    }
}

fn read_case(reader: &mut Reader<'_>, root: &Table<'_, '_>, league: Option<&CaseLeague>) -> Option<Authored> {
    root.refuse_others(reader, keys::CASE);
    let intent = root.required(reader, "intent").and_then(|value| reader.text(value, "intent"));
    let defending = root.required(reader, "defending").and_then(|value| read_defending(reader, value));
    let ball = root.required(reader, "ball").and_then(|value| {
        let ball = reader.table(value, "ball")?;
        ball.refuse_others(reader, keys::BALL);
        let (at, scope) = (ball.point(reader, "at"), read_scope(reader, &ball));
        Some((at?, scope?))
    });
    let teammates = read_teammates(reader, root, league);
    let opponents = read_opponents(reader, root);
    let ((ball, ball_span), ball_scope) = ball?;
    let (teammates, opponents) = (teammates?, opponents?);
    Some(Authored {
        intent: intent?.to_owned(),
        defending: defending?,
        ball,
        ball_span,
        ball_scope,
        teammates,
        opponents,
    })
}

fn read_defending(reader: &mut Reader<'_>, value: Value<'_, '_>) -> Option<GoalEnd> {
    let label = reader.text(value, "defending")?;
    let goal = GoalEnd::from_label(label);
    if goal.is_none() {
        let hint = "write \"yellow\" (the goal at -x) or \"cyan\" (the goal at +x)";
        reader.error(code::BAD_DEFENDING, value.span(), format!("defending is {label:?}"), hint);
    }
    goal
}

fn read_scope(reader: &mut Reader<'_>, table: &Table<'_, '_>) -> Option<Scope> {
    let (PointMm { x, y }, span) = table.point(reader, "scope")?;
    if x > 0 && y > 0 {
        return Some(Scope { x, y });
    }
    let message = format!("{} is [{x}, {y}]", table.name_of("scope"));
    reader.error(code::BAD_SCOPE, span, message, "give both radii in mm, above 0");
    None
}

fn read_teammates(
    reader: &mut Reader<'_>,
    root: &Table<'_, '_>,
    league: Option<&CaseLeague>,
) -> Option<Vec<Teammate>> {
    let value = root.optional("teammates");
    let list = value.map_or(Some(Vec::new()), |value| reader.list(value, "teammates"))?;
    if list.is_empty() {
        let span = value.map_or(0..0, toml::Spanned::span);
        reader.error(
            code::NO_TEAMMATE,
            span,
            "the case has no teammate",
            "add [[teammates]] with at and gameplay",
        );
        return None;
    }
    if let Some(extra) = list.get(TEAMMATES_MAX) {
        let message = format!("{} teammates, at most {TEAMMATES_MAX} play a case", list.len());
        reader.error(code::TOO_MANY_TEAMMATES, extra.span(), message, "leave out who only watches");
        return None;
    }
    let count = list.len();
    // Every robot is read before one fault rejects the case, so that all faults are reported.
    let read: Vec<_> = list
        .into_iter()
        .zip(CaseRobot::first(count))
        .map(|(value, robot)| read_teammate(reader, value, robot, count, league))
        .collect();
    let teammates = read.into_iter().collect::<Option<Vec<_>>>()?;
    let actions: usize = teammates.iter().map(|teammate| teammate.gameplay.len()).sum();
    if actions > ACTIONS_MAX {
        let message = format!("{actions} actions, at most {ACTIONS_MAX} fit a case");
        reader.error(code::TOO_MANY_ACTIONS, teammates[0].span.clone(), message, "shorten the gameplays");
        return None;
    }
    Some(teammates)
}

fn read_teammate(
    reader: &mut Reader<'_>,
    value: Value<'_, '_>,
    robot: CaseRobot,
    count: usize,
    league: Option<&CaseLeague>,
) -> Option<Teammate> {
    let table = reader.table(value, robot.to_string())?;
    table.refuse_others(reader, keys::TEAMMATE);
    let at = table.point(reader, "at");
    let gameplay = table.required(reader, "gameplay").and_then(|value| {
        let list = reader.list(value, &table.name_of("gameplay"))?;
        let cast = Cast { robot, count, league };
        let read: Vec<_> =
            list.into_iter().map(|item| Some((read_action(reader, item, &cast)?, item.span()))).collect();
        read.into_iter().collect::<Option<Vec<_>>>()
    });
    let ((at, at_span), gameplay) = (at?, gameplay?);
    Some(Teammate { at, at_span, span: table.span(), gameplay })
}

/// The robot whose action is read, the number of robots, and the league.
struct Cast<'l> {
    robot: CaseRobot,
    count: usize,
    league: Option<&'l CaseLeague>,
}

fn read_action(reader: &mut Reader<'_>, value: Value<'_, '_>, cast: &Cast<'_>) -> Option<Action> {
    let whose = format!("an action of {}", cast.robot);
    if let Some(label) = value.get_ref().as_str() {
        return match label {
            "wait" => Some(Action::Wait),
            "get_ball" => Some(Action::GetBall),
            _ => {
                let message = format!("{whose} is {label:?}");
                reader.error(code::UNKNOWN_KEY, value.span(), message, ACTION_HINT);
                None
            }
        };
    }
    let table = reader.table(value, whose.as_str())?;
    let entries = table.entries();
    let [(label, span, argument)] = entries.as_slice() else {
        let message = format!("{whose} has {} keys", entries.len());
        reader.error(code::WRONG_TYPE, value.span(), message, ACTION_HINT);
        return None;
    };
    let name = format!("{label} of {}", cast.robot);
    match *label {
        "go_to_point" => reader.point(argument, &name).map(Action::GoToPoint),
        "dribble_to" => reader.point(argument, &name).map(Action::DribbleTo),
        "turn" => read_turn(reader, argument, &name).map(Action::Turn),
        "pass_ball" => read_robot(reader, argument, &name, cast).map(Action::PassBall),
        "receive_ball" => read_robot(reader, argument, &name, cast).map(Action::ReceiveBall),
        "kick" => read_kick(reader, argument, &name, cast),
        _ => {
            let message = format!("unknown key {label} in {whose}");
            reader.error(code::UNKNOWN_KEY, span.clone(), message, ACTION_HINT);
            None
        }
    }
}

fn read_turn(reader: &mut Reader<'_>, value: Value<'_, '_>, name: &str) -> Option<TurnTarget> {
    let table = reader.table(value, name)?;
    let entries = table.entries();
    match entries.as_slice() {
        [("heading_deg", _, degrees)] => {
            reader.whole(degrees, name, &COORDINATES).map(TurnTarget::HeadingDeg)
        }
        [("face", _, point)] => reader.point(point, name).map(TurnTarget::Face),
        _ => {
            let unknown = entries.iter().find(|(key, ..)| !keys::TURN.contains(key));
            let (code, span) = unknown
                .map_or((code::WRONG_TYPE, value.span()), |(_, span, _)| (code::UNKNOWN_KEY, span.clone()));
            let message = format!("{name} has {} keys", entries.len());
            reader.error(code, span, message, "write { heading_deg = D } or { face = [x, y] }");
            None
        }
    }
}

fn read_robot(
    reader: &mut Reader<'_>,
    value: Value<'_, '_>,
    name: &str,
    cast: &Cast<'_>,
) -> Option<CaseRobot> {
    // Any whole number is read, so that a wrong one is reported as no robot of this case.
    let number = reader.whole(value, name, &(i32::MIN..=i32::MAX))?;
    let robot = CaseRobot::first(cast.count).find(|robot| i32::from(robot.number()) == number);
    let message = match robot {
        None => format!("{name} names robot {number}, but the case has 1 to {}", cast.count),
        Some(robot) if robot == cast.robot => format!("{name} names {robot} itself"),
        Some(robot) => return Some(robot),
    };
    reader.error(code::ROBOT_NUMBER, value.span(), message, "name another robot of this case by its number");
    None
}

fn read_kick(reader: &mut Reader<'_>, value: Value<'_, '_>, name: &str, cast: &Cast<'_>) -> Option<Action> {
    let kind = reader.text(value, name)?;
    let league = cast.league?;
    let id = league.kick_id(kind);
    if id.is_none() {
        let known: Vec<_> = league.kicks.iter().map(|(name, _)| name.as_str()).collect();
        let message = format!("{name} is of kind {kind:?}, which league.toml does not have");
        let hint = format!("add [kicks.{kind}] or take one of: {}", known.join(", "));
        reader.error(code::UNKNOWN_KICK, value.span(), message, hint);
    }
    id.map(Action::Kick)
}

fn read_opponents(reader: &mut Reader<'_>, root: &Table<'_, '_>) -> Option<Vec<Opponent>> {
    let list =
        root.optional("opponents").map_or(Some(Vec::new()), |value| reader.list(value, "opponents"))?;
    if let Some(extra) = list.get(OPPONENTS_MAX) {
        let message = format!("{} opponents, at most {OPPONENTS_MAX} fit a case", list.len());
        reader.error(code::TOO_MANY_OPPONENTS, extra.span(), message, "keep those that justify the gameplay");
        return None;
    }
    let read: Vec<_> = list
        .into_iter()
        .enumerate()
        .map(|(i, value)| {
            let table = reader.table(value, format!("opp{}", i + 1))?;
            table.refuse_others(reader, keys::OPPONENT);
            let (at, scope) = (table.point(reader, "at"), read_scope(reader, &table));
            let presence = read_presence(reader, &table);
            let ((at, span), scope, presence) = (at?, scope?, presence?);
            Some(Opponent { at, span, scope, presence })
        })
        .collect();
    read.into_iter().collect()
}

fn read_presence(reader: &mut Reader<'_>, table: &Table<'_, '_>) -> Option<Presence> {
    let name = table.name_of("presence");
    let Some(value) = table.optional("presence") else { return Some(Presence::default()) };
    let label = reader.text(value, &name)?;
    let presence = Presence::from_label(label);
    if presence.is_none() {
        let known = Presence::ALL.map(|presence| format!("{:?}", presence.label())).join(", ");
        let message = format!("{name} is {label:?}");
        reader.error(code::BAD_VALUE, value.span(), message, format!("take one of: {known}"));
    }
    presence
}

/// Maximum number of actions of all robots of a case: the table counts them in a byte.
const ACTIONS_MAX: usize = 255;
const ACTION_HINT: &str = "write \"wait\", \"get_ball\" or one of { go_to_point = [x, y] }, { turn = … }, \
    { dribble_to = [x, y] }, { pass_ball = N }, { receive_ball = N }, { kick = \"KIND\" }";
