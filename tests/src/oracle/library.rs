//! `library`: naive reader of case files.
//!
//! docs/case-format.md §1, §2 with the `toml` crate's generic values and nothing else of the project: every
//! stored case is computed in full (the authored one and its three mirrored copies), kicks resolved into aim
//! and radii. Field frame, mm, whole degrees. It assumes that the library is valid: what it cannot read is an
//! error, but it checks nothing else.

use std::collections::BTreeMap;
use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};

use toml::{Table, Value};

use super::walk;

/// One league's library, expanded: four stored cases for each authored one, in id order.
#[derive(Clone, Debug)]
pub struct Library {
    /// Length of the field, mm: the goal lines lie at ± half of it.
    pub length: i64,
    /// Width of the field, mm.
    pub width: i64,
    /// Radii of a pass.
    pub pass: Corridor,
    /// Stored cases; the index is the id.
    pub cases: Vec<Case>,
}

/// One stored case, computed in full.
#[derive(Clone, Debug)]
pub struct Case {
    /// `region/name` of the authored case.
    pub name: String,
    /// `identity`, `across-x`, `across-y` or `both`.
    pub symmetry: &'static str,
    /// The goal the case is listed under.
    pub defending: Goal,
    /// Position of the ball.
    pub ball: Point,
    /// Radii of the ball's scope, mm.
    pub scope: Radii,
    /// Robots of the case: tm1, tm2, …
    pub robots: Vec<Robot>,
    /// The opponents' scopes: centre and radii.
    pub opponents: Vec<(Point, Radii)>,
}

/// One robot of a case.
#[derive(Clone, Debug)]
pub struct Robot {
    /// Position in the case, mm.
    pub at: Point,
    /// Its actions, in order.
    pub gameplay: Vec<Action>,
}

/// One action of a gameplay; robots are counted from 0 here.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Action {
    /// `wait` and `turn`: no motion of ball or robot.
    Stay,
    /// `go_to_point`: the robot moves to this point.
    GoTo(Point),
    /// `get_ball`: the robot gets the ball.
    GetBall,
    /// `dribble_to`: robot and ball move to this point.
    DribbleTo(Point),
    /// `pass_ball`: to the robot of this number.
    Pass(usize),
    /// `receive_ball`: from the robot of this number.
    Receive(usize),
    /// `kick`: the ball leaves as this kick.
    Kick(Kick),
}

/// A kick, as this stored case makes it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kick {
    /// Along a heading, or at the goal.
    pub aim: Aim,
    /// Radii at the foot and at the end, mm.
    pub corridor: Corridor,
}

/// Aim of a kick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Aim {
    /// Along a heading (degrees, left > 0, 0 = direction of attack) for `length` mm.
    Heading {
        /// Degrees relative to the direction of attack.
        degrees: i64,
        /// Length of the kick, mm.
        length: i64,
    },
    /// To a point of the attacked goal line, mm to the left of its middle as seen in attack.
    Goal {
        /// Offset from the goal's middle, mm.
        offset: i64,
    },
}

/// Radii of a leg at its start and at its end, mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corridor {
    /// Radius at the start, mm.
    pub r_min: i64,
    /// Radius at the end, mm.
    pub r_max: i64,
}

/// A point of the field, mm.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Point {
    /// Along the field's length, mm.
    pub x: i64,
    /// Across the field, left > 0, mm.
    pub y: i64,
}

/// Radii of a scope, mm.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Radii {
    /// τx: radius along the length, mm.
    pub x: i64,
    /// τy: radius across the field, mm.
    pub y: i64,
}

/// The goal we defend.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Goal {
    /// At −x: we attack towards +x.
    Yellow,
    /// At +x: we attack towards −x.
    Cyan,
}

impl Goal {
    /// +1 where we attack towards +x.
    pub fn attack(self) -> i64 {
        match self {
            Self::Yellow => 1,
            Self::Cyan => -1,
        }
    }

    /// The goal of that label in files and problems.
    pub fn from_label(label: &str) -> Option<Self> {
        match label {
            "yellow" => Some(Self::Yellow),
            "cyan" => Some(Self::Cyan),
            _ => None,
        }
    }

    /// Its label in files and problems.
    pub fn label(self) -> &'static str {
        match self {
            Self::Yellow => "yellow",
            Self::Cyan => "cyan",
        }
    }

    fn mirrored(self, sign_x: i64) -> Self {
        match (self, sign_x) {
            (goal, 1) => goal,
            (Self::Yellow, _) => Self::Cyan,
            (Self::Cyan, _) => Self::Yellow,
        }
    }
}

/// A library that this reader cannot read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unreadable {
    /// The file or directory.
    pub file: PathBuf,
    /// What is wrong with it, as text.
    pub reason: String,
}

impl fmt::Display for Unreadable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.file.display(), self.reason)
    }
}

impl std::error::Error for Unreadable {}

impl Library {
    /// Reads one league's directory: `league.toml` and `<region>/<name>.toml`.
    pub fn read(dir: &Path) -> Result<Self, Unreadable> {
        let failed = |path: &Path, error: std::io::Error| Unreadable {
            file: path.to_path_buf(),
            reason: error.to_string(),
        };
        let text = |path: &Path| fs::read_to_string(path).map_err(|error| failed(path, error));
        let mut files = BTreeMap::new();
        for region in fs::read_dir(dir).map_err(|error| failed(dir, error))? {
            let region = region.map_err(|error| failed(dir, error))?;
            if !region.path().is_dir() {
                continue;
            }
            for file in fs::read_dir(region.path()).map_err(|error| failed(dir, error))? {
                let path = file.map_err(|error| failed(dir, error))?.path();
                if path.extension().is_some_and(|end| end == "toml") {
                    let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
                    let name = format!("{}/{stem}", region.file_name().to_string_lossy());
                    files.insert(name, text(&path)?);
                }
            }
        }
        let league = text(&dir.join("league.toml"))?;
        Self::from_texts(&league, &files)
    }

    /// The same from texts; a `BTreeMap` of `String`s is ordered by bytes, as docs/case-format.md §2 orders
    /// cases.
    pub fn from_texts(league: &str, files: &BTreeMap<String, String>) -> Result<Self, Unreadable> {
        let in_file = |name: &str| {
            let file = PathBuf::from(format!("{name}.toml"));
            move |reason: String| Unreadable { file: file.clone(), reason }
        };
        let league: Table = league.parse().map_err(|error| in_file("league")(format!("{error}")))?;
        let (field, pass, kinds) = read_league(&league).map_err(in_file("league"))?;
        let mut library = Self { length: field.x, width: field.y, pass, cases: Vec::new() };
        for (name, text) in files {
            let table: Table = text.parse().map_err(|error| in_file(name)(format!("{error}")))?;
            let authored = read_case(name, &table, &kinds).map_err(in_file(name))?;
            walk::legs(&library, &authored, authored.ball).map_err(in_file(name))?;
            library.cases.extend(SYMMETRIES.map(|(label, x, y)| authored.mirrored(label, x, y)));
        }
        Ok(library)
    }
}

/// The four symmetries of a case in id order, with the signs of x and y.
const SYMMETRIES: [(&str, i64, i64); 4] =
    [("identity", 1, 1), ("across-x", 1, -1), ("across-y", -1, 1), ("both", -1, -1)];

impl Case {
    fn mirrored(&self, symmetry: &'static str, sx: i64, sy: i64) -> Self {
        let point = |p: Point| Point { x: sx * p.x, y: sy * p.y };
        let turned = sx * sy;
        let action = |action: Action| match action {
            Action::GoTo(p) => Action::GoTo(point(p)),
            Action::DribbleTo(p) => Action::DribbleTo(point(p)),
            Action::Kick(Kick { aim, corridor }) => Action::Kick(Kick {
                corridor,
                aim: match aim {
                    Aim::Heading { degrees, length } => Aim::Heading { degrees: turned * degrees, length },
                    Aim::Goal { offset } => Aim::Goal { offset: turned * offset },
                },
            }),
            other => other,
        };
        let robot = |robot: &Robot| Robot {
            at: point(robot.at),
            gameplay: robot.gameplay.iter().copied().map(action).collect(),
        };
        Self {
            name: self.name.clone(),
            symmetry,
            defending: self.defending.mirrored(sx),
            ball: point(self.ball),
            scope: self.scope,
            robots: self.robots.iter().map(robot).collect(),
            opponents: self.opponents.iter().map(|(centre, radii)| (point(*centre), *radii)).collect(),
        }
    }
}

type Kinds = BTreeMap<String, Kick>;

fn read_league(league: &Table) -> Result<(Point, Corridor, Kinds), String> {
    let field = table(league, "field")?;
    let mut kinds = Kinds::new();
    for (kind, value) in table(league, "kicks")? {
        let value = value.as_table().ok_or_else(|| format!("kicks.{kind} is no table"))?;
        let aim = if value.contains_key("aim") {
            Aim::Goal { offset: value.get("offset").and_then(Value::as_integer).unwrap_or(0) }
        } else {
            Aim::Heading { degrees: integer(value, "heading_deg")?, length: integer(value, "length")? }
        };
        kinds.insert(kind.clone(), Kick { aim, corridor: corridor(value)? });
    }
    let field = Point { x: integer(field, "length")?, y: integer(field, "width")? };
    Ok((field, corridor(table(league, "pass")?)?, kinds))
}

fn read_case(name: &str, case: &Table, kinds: &Kinds) -> Result<Case, String> {
    let label = case.get("defending").and_then(Value::as_str).ok_or("defending is no word")?;
    let ball = table(case, "ball")?;
    let mut robots = Vec::new();
    for robot in tables(case, "teammates")? {
        let list = robot.get("gameplay").and_then(Value::as_array).ok_or("gameplay is no list")?;
        let gameplay = list.iter().map(|action| read_action(action, kinds)).collect::<Result<_, _>>()?;
        robots.push(Robot { at: point(robot, "at")?, gameplay });
    }
    let mut opponents = Vec::new();
    for opponent in tables(case, "opponents")? {
        opponents.push((point(opponent, "at")?, radii(opponent)?));
    }
    Ok(Case {
        name: name.to_owned(),
        symmetry: "identity",
        defending: Goal::from_label(label).ok_or_else(|| format!("defending = {label:?}"))?,
        ball: point(ball, "at")?,
        scope: radii(ball)?,
        robots,
        opponents,
    })
}

fn read_action(action: &Value, kinds: &Kinds) -> Result<Action, String> {
    match action.as_str() {
        Some("wait") => return Ok(Action::Stay),
        Some("get_ball") => return Ok(Action::GetBall),
        Some(label) => return Err(format!("unknown action {label:?}")),
        None => {}
    }
    let action = action.as_table().ok_or("an action is neither word nor table")?;
    let (verb, _) = action.iter().next().ok_or("an empty action")?;
    let robot = || match integer(action, verb)? {
        number @ 1..=4 => Ok(number as usize - 1),
        number => Err(format!("{verb} = {number}")),
    };
    match verb.as_str() {
        "go_to_point" => Ok(Action::GoTo(point(action, verb)?)),
        "dribble_to" => Ok(Action::DribbleTo(point(action, verb)?)),
        "turn" => Ok(Action::Stay),
        "pass_ball" => robot().map(Action::Pass),
        "receive_ball" => robot().map(Action::Receive),
        "kick" => {
            let kind = action[verb].as_str().ok_or("kick is no word")?;
            kinds.get(kind).copied().map(Action::Kick).ok_or_else(|| format!("unknown kick {kind:?}"))
        }
        other => Err(format!("unknown action {other:?}")),
    }
}

fn table<'t>(table: &'t Table, key: &str) -> Result<&'t Table, String> {
    table.get(key).and_then(Value::as_table).ok_or_else(|| format!("{key} is no table"))
}

/// A list of tables; none where the key is missing.
fn tables<'t>(table: &'t Table, key: &str) -> Result<Vec<&'t Table>, String> {
    let Some(value) = table.get(key) else { return Ok(Vec::new()) };
    let list = value.as_array().ok_or_else(|| format!("{key} is no list"))?;
    list.iter().map(|entry| entry.as_table().ok_or_else(|| format!("{key} holds no tables"))).collect()
}

fn integer(table: &Table, key: &str) -> Result<i64, String> {
    table.get(key).and_then(Value::as_integer).ok_or_else(|| format!("{key} is no integer"))
}

fn pair(table: &Table, key: &str) -> Result<(i64, i64), String> {
    let list: Vec<i64> = match table.get(key).and_then(Value::as_array) {
        Some(list) => list.iter().filter_map(Value::as_integer).collect(),
        None => Vec::new(),
    };
    match list[..] {
        [x, y] => Ok((x, y)),
        _ => Err(format!("{key} is no pair of integers")),
    }
}

fn point(table: &Table, key: &str) -> Result<Point, String> {
    pair(table, key).map(|(x, y)| Point { x, y })
}

fn radii(table: &Table) -> Result<Radii, String> {
    pair(table, "scope").map(|(x, y)| Radii { x, y })
}

fn corridor(table: &Table) -> Result<Corridor, String> {
    Ok(Corridor { r_min: integer(table, "r_min")?, r_max: integer(table, "r_max")? })
}
