//! `problem`: parser of problem lines (docs/case-format.md §5.1, `cases retrieve`).
//!
//! A problem is one JSON object with the keys `ball`, `defending`, `teammates` and `opponents`; integers in
//! mm, field frame. `unavailable` may name robots besides, as `teammates` does: they take no part in
//! retrieval. Strict: a missing, unknown or repeated key, a repeated robot or a number that is no integer is
//! malformed, and the error names its place, such as `teammates.3`. List places count from 1, as lines do.

use std::fmt;

use casebase::{GoalEnd, PROBLEM_OPPONENTS_MAX, PROBLEM_TEAMMATES_MAX, PointMm, Problem};
use foreign::excerpt;
use protocol::RobotId;
use serde::de::{Deserialize, Deserializer, MapAccess, Visitor};
use serde_json::value::RawValue;
use serde_json::{Value, json};

/// Parses the problem of a line.
pub fn parse(line: &str) -> Result<Problem, Malformed> {
    let Members(members) = serde_json::from_str(line).map_err(|error| not_an_object(&error))?;
    let (mut ball, mut defending, mut teammates, mut opponents) = (None, None, None, None);
    let mut unavailable = None;
    for (key, value) in members {
        match key.as_str() {
            "ball" => fill(&mut ball, &key, point(value, &key)?)?,
            "defending" => fill(&mut defending, &key, goal_end(value)?)?,
            "teammates" => fill(&mut teammates, &key, robots(value)?)?,
            "opponents" => fill(&mut opponents, &key, points(value)?)?,
            // Robots on the field that take no part in retrieval.
            "unavailable" => fill(&mut unavailable, &key, robots(value)?)?,
            _ => return Err(Malformed::at(&key, format!("unknown key; the keys are {KEYS}"))),
        }
    }
    let missing = |key: &str| Malformed::at(key, format!("missing; the keys are {KEYS}"));
    Ok(Problem {
        ball: ball.ok_or_else(|| missing("ball"))?,
        defending: defending.ok_or_else(|| missing("defending"))?,
        teammates: teammates.ok_or_else(|| missing("teammates"))?,
        opponents: opponents.ok_or_else(|| missing("opponents"))?,
    })
}

/// A problem as [`parse`] takes it.
pub fn value(problem: &Problem) -> Value {
    let mm = |at: &PointMm| [at.x, at.y];
    let teammates: serde_json::Map<String, Value> =
        problem.teammates.iter().map(|(id, at)| (id.number().to_string(), json!(mm(at)))).collect();
    json!({
        "ball": mm(&problem.ball),
        "defending": problem.defending.label(),
        "teammates": teammates,
        "opponents": problem.opponents.iter().map(mm).collect::<Vec<_>>(),
    })
}

/// Longest place that is printed, characters: a key of the line may be as long as the line.
const PLACE_LEN: usize = 60;

/// Refusal of a line that is not a valid problem.
#[derive(Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}{reason}", .place.as_ref().map(|place| format!("{place}: ")).unwrap_or_default())]
pub struct Malformed {
    /// Place in the line, if not all of it.
    place: Option<String>,
    /// Expected value.
    reason: String,
}

impl Malformed {
    /// At a place in the line.
    pub fn at(place: &str, reason: impl Into<String>) -> Self {
        Self { place: Some(excerpt(place, PLACE_LEN)), reason: reason.into() }
    }

    /// Refuses the whole line.
    pub fn line(reason: impl Into<String>) -> Self {
        Self { place: None, reason: reason.into() }
    }
}

fn not_an_object(error: &serde_json::Error) -> Malformed {
    if error.is_data() {
        return Malformed::line(format!("expected an object with {KEYS}"));
    }
    // serde_json counts lines too; ours is always its first.
    let column = error.column();
    let message = error.to_string();
    let what = message.strip_suffix(&format!(" at line 1 column {column}")).unwrap_or(&message);
    Malformed::at(&format!("column {column}"), format!("not JSON: {what}"))
}

fn fill<T>(slot: &mut Option<T>, key: &str, value: T) -> Result<(), Malformed> {
    match slot.replace(value) {
        None => Ok(()),
        Some(_) => Err(Malformed::at(key, "given twice")),
    }
}

fn goal_end(value: &RawValue) -> Result<GoalEnd, Malformed> {
    let label = serde_json::from_str::<String>(value.get()).ok();
    label
        .and_then(|label| GoalEnd::from_label(&label))
        .ok_or_else(|| Malformed::at("defending", "expected \"yellow\" or \"cyan\""))
}

fn robots(value: &RawValue) -> Result<heapless::Vec<(RobotId, PointMm), PROBLEM_TEAMMATES_MAX>, Malformed> {
    let Members(members) = serde_json::from_str(value.get()).map_err(|_| {
        Malformed::at("teammates", "expected an object of robot ids, each with its [x, y] in mm")
    })?;
    let mut robots = heapless::Vec::new();
    for (key, value) in members {
        let place = format!("teammates.{key}");
        let id = robot_id(&key).ok_or_else(|| Malformed::at(&place, "expected a robot id, 0 to 15"))?;
        if robots.iter().any(|(other, _)| *other == id) {
            return Err(Malformed::at(&place, format!("robot {id} given twice")));
        }
        let at = point(value, &place)?;
        robots.push((id, at)).map_err(|_| {
            Malformed::at("teammates", format!("expected at most {PROBLEM_TEAMMATES_MAX} robots"))
        })?;
    }
    Ok(robots)
}

/// Ids are compared as numbers: `"01"` is robot 1.
fn robot_id(key: &str) -> Option<RobotId> {
    let number = key.trim_start_matches('0');
    match number {
        "" if key.is_empty() => None,
        "" => RobotId::new(0),
        _ if number.bytes().all(|byte| byte.is_ascii_digit()) => RobotId::new(number.parse().ok()?),
        _ => None,
    }
}

fn points(value: &RawValue) -> Result<heapless::Vec<PointMm, PROBLEM_OPPONENTS_MAX>, Malformed> {
    let list: Vec<&RawValue> = serde_json::from_str(value.get())
        .map_err(|_| Malformed::at("opponents", "expected a list of [x, y] in mm"))?;
    let mut points = heapless::Vec::new();
    for (index, value) in list.into_iter().enumerate() {
        let at = point(value, &format!("opponents.{}", index + 1))?;
        points.push(at).map_err(|_| {
            Malformed::at("opponents", format!("expected at most {PROBLEM_OPPONENTS_MAX} robots"))
        })?;
    }
    Ok(points)
}

fn point(value: &RawValue, place: &str) -> Result<PointMm, Malformed> {
    let both: Option<[&RawValue; 2]> = serde_json::from_str(value.get()).ok();
    both.and_then(|[x, y]| Some(PointMm { x: integer(x)?, y: integer(y)? }))
        .ok_or_else(|| Malformed::at(place, "expected [x, y] in mm"))
}

/// A number written as an integer. One that does not fit an `i32` lies farther than 2,000 km away: it is
/// clamped, which decides no differently.
fn integer(value: &RawValue) -> Option<i32> {
    let text = value.get();
    let digits = text.strip_prefix('-').unwrap_or(text);
    if !digits.bytes().all(|byte| byte.is_ascii_digit()) {
        return None;
    }
    let limit = if text.starts_with('-') { i32::MIN } else { i32::MAX };
    Some(text.parse().unwrap_or(limit))
}

/// An object's members as they stand: in order, repeated keys and all, values still text.
struct Members<'a>(Vec<(String, &'a RawValue)>);

impl<'de> Deserialize<'de> for Members<'de> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Collect;
        impl<'de> Visitor<'de> for Collect {
            type Value = Members<'de>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("an object")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
                let mut members = Vec::new();
                while let Some(member) = map.next_entry()? {
                    members.push(member);
                }
                Ok(Members(members))
            }
        }
        deserializer.deserialize_map(Collect)
    }
}

const KEYS: &str = "ball, defending, teammates and opponents";

#[cfg(test)]
mod tests {
    use super::*;

    const GOOD: &str = r#"{"ball":[-600,10],"defending":"yellow","teammates":{"1":[-700,0],"3":[200,800]},"opponents":[[-150,40]]}"#;

    fn reason(line: &str) -> String {
        parse(line).map_or_else(|malformed| malformed.to_string(), |_| "no error".to_owned())
    }

    /// The good line with one of its parts replaced.
    fn with(part: &str, other: &str) -> String {
        assert!(GOOD.contains(part), "{part} is no part of the good line");
        GOOD.replacen(part, other, 1)
    }

    #[test]
    fn a_good_line_is_read_as_it_stands() {
        let problem = parse(GOOD).unwrap();
        assert_eq!(problem.ball, PointMm { x: -600, y: 10 });
        assert_eq!(problem.defending, GoalEnd::Negative);
        let robot = |id, x, y| (RobotId::new(id).unwrap(), PointMm { x, y });
        assert_eq!(problem.teammates.as_slice(), [robot(1, -700, 0), robot(3, 200, 800)]);
        assert_eq!(problem.opponents.as_slice(), [PointMm { x: -150, y: 40 }]);
    }

    #[test]
    fn the_order_of_keys_escapes_and_blanks_do_not_matter() {
        let line = " { \"opponents\" : [ ] , \"teammates\" : { } , \"defendin\\u0067\":\"cyan\",\t\"ball\":[-0 , 1]}\r";
        let problem = parse(line).unwrap();
        assert_eq!(problem.ball, PointMm { x: 0, y: 1 });
        assert_eq!(problem.defending, GoalEnd::Positive);
        assert!(problem.teammates.is_empty() && problem.opponents.is_empty());
    }

    #[test]
    fn every_key_must_be_there_once() {
        for key in ["ball", "defending", "teammates", "opponents"] {
            let renamed = with(&format!("\"{key}\""), "\"other\"");
            assert_eq!(reason(&renamed), format!("other: unknown key; the keys are {KEYS}"));
            let value = if key == "ball" {
                "[0,0]"
            } else if key == "defending" {
                "\"cyan\""
            } else {
                "{}"
            };
            let value = if key == "opponents" { "[]" } else { value };
            let twice = GOOD.replacen('{', &format!("{{\"{key}\":{value},"), 1);
            assert_eq!(reason(&twice), format!("{key}: given twice"));
        }
        assert_eq!(reason(&with("\"ball\":[-600,10],", "")), format!("ball: missing; the keys are {KEYS}"));
        assert_eq!(
            reason(&with(",\"opponents\":[[-150,40]]", "")),
            format!("opponents: missing; the keys are {KEYS}")
        );
    }

    #[test]
    fn only_integers_are_millimetres() {
        for number in ["1.0", "1e3", "1E3", "0.5", "-1.0", "null", "true", "\"1\"", "[1]", "{}"] {
            assert_eq!(reason(&with("-600", number)), "ball: expected [x, y] in mm", "{number}");
            assert_eq!(reason(&with("800", number)), "teammates.3: expected [x, y] in mm", "{number}");
            assert_eq!(reason(&with("-150", number)), "opponents.1: expected [x, y] in mm", "{number}");
        }
    }

    #[test]
    fn a_point_has_two_coordinates() {
        for shape in ["[1]", "[1,2,3]", "[]", "7", "null", "{\"x\":1,\"y\":2}", "\"1,2\"", "[[1,2]]"] {
            assert_eq!(reason(&with("[-600,10]", shape)), "ball: expected [x, y] in mm", "{shape}");
            assert_eq!(reason(&with("[200,800]", shape)), "teammates.3: expected [x, y] in mm", "{shape}");
        }
    }

    #[test]
    fn ids_are_compared_as_numbers() {
        assert_eq!(reason(&with("\"3\"", "\"1\"")), "teammates.1: robot 1 given twice");
        assert_eq!(reason(&with("\"3\"", "\"01\"")), "teammates.01: robot 1 given twice");
        assert_eq!(parse(&with("\"3\"", "\"000\"")).unwrap().teammates[1].0.number(), 0);
        assert_eq!(parse(&with("\"3\"", "\"15\"")).unwrap().teammates[1].0.number(), 15);
        for id in ["16", "256", "99999999999999999999", "-1", "+1", "1.0", "", " 1", "x", "٣"] {
            assert_eq!(
                reason(&with("\"3\"", &format!("\"{id}\""))),
                format!("teammates.{id}: expected a robot id, 0 to 15")
            );
        }
    }

    #[test]
    fn eleven_robots_a_side_are_the_most() {
        let robots = |n| (0..n).map(|id| format!("\"{id}\":[{id},0]")).collect::<Vec<_>>().join(",");
        let line = |n| with("\"1\":[-700,0],\"3\":[200,800]", &robots(n));
        assert_eq!(parse(&line(11)).unwrap().teammates.len(), 11);
        assert_eq!(reason(&line(12)), "teammates: expected at most 11 robots");
        let opponents = |n| with("[-150,40]", &vec!["[1,2]"; n].join(","));
        assert_eq!(parse(&opponents(11)).unwrap().opponents.len(), 11);
        assert_eq!(reason(&opponents(12)), "opponents: expected at most 11 robots");
    }

    #[test]
    fn a_wrong_shape_is_named_where_it_is() {
        let table = [
            ("\"yellow\"", "\"blue\"", "defending: expected \"yellow\" or \"cyan\""),
            ("\"yellow\"", "1", "defending: expected \"yellow\" or \"cyan\""),
            ("\"yellow\"", "\"Yellow\"", "defending: expected \"yellow\" or \"cyan\""),
            ("[[-150,40]]", "{}", "opponents: expected a list of [x, y] in mm"),
            ("[[-150,40]]", "[-150,40]", "opponents.1: expected [x, y] in mm"),
            (
                "{\"1\":[-700,0],\"3\":[200,800]}",
                "[]",
                "teammates: expected an object of robot ids, each with its [x, y] in mm",
            ),
        ];
        for (part, other, expected) in table {
            assert_eq!(reason(&with(part, other)), expected);
        }
    }

    #[test]
    fn what_is_no_object_is_distinguished_from_what_is_no_json() {
        for line in ["[]", "1", "null", "\"x\""] {
            assert_eq!(reason(line), format!("expected an object with {KEYS}"));
        }
        assert_eq!(reason("{"), "column 1: not JSON: EOF while parsing an object");
        let second = GOOD.len() + 2;
        assert_eq!(
            reason(&format!("{GOOD} {GOOD}")),
            format!("column {second}: not JSON: trailing characters")
        );
        for line in [
            "{]",
            "ball",
            "{\"ball\":[01,2]}",
            "{\"ball\":[+1,2]}",
            "{\"ball\":[NaN,2]}",
            "{'ball':1}",
            "{\"a\":1,}",
        ] {
            assert!(reason(line).contains("not JSON"), "{line}: {}", reason(line));
        }
    }

    #[test]
    fn deep_nesting_is_no_stack_overflow() {
        let deep = "[".repeat(1_000_000);
        assert!(reason(&with("[-600,10]", &deep)).contains("not JSON"));
        let closed = format!("{}{}", "[".repeat(100_000), "]".repeat(100_000));
        assert_eq!(reason(&with("[-600,10]", &closed)), "ball: expected [x, y] in mm");
    }

    #[test]
    fn what_lies_beyond_every_field_is_still_a_place() {
        let problem = parse(&with("-600", "-99999999999999999999")).unwrap();
        assert_eq!(problem.ball, PointMm { x: i32::MIN, y: 10 });
    }
}
