//! `problem`: naive parser of problem lines.
//!
//! The format of docs/case-format.md §5.1, read with `serde_json`'s generic values. Integers in mm, field
//! frame.

use std::fmt;

use serde::Deserialize;
use serde::de::{Deserializer, MapAccess, Visitor};
use serde_json::Value;

use super::library::{Case, Goal, Point};

/// A situation to find a case for.
#[derive(Clone, Debug)]
pub struct Problem {
    /// Position of the ball.
    pub ball: Point,
    /// The goal we defend.
    pub defending: Goal,
    /// Robots present, by id.
    pub teammates: Vec<(u8, Point)>,
    /// Positions of the opponents seen, mm.
    pub opponents: Vec<Point>,
}

/// Maximum number of robots of either team in a line.
const ROBOTS_MAX: usize = 11;

impl Problem {
    /// The case's own situation, as if nothing but the case were on the field: tm1 has id 1, tm2 id 2, …, and
    /// an opponent stands on the centre of each scope.
    pub fn own_situation(case: &Case) -> Self {
        Self {
            ball: case.ball,
            defending: case.defending,
            teammates: (1..).zip(&case.robots).map(|(id, robot)| (id, robot.at)).collect(),
            opponents: case.opponents.iter().map(|(centre, _)| *centre).collect(),
        }
    }

    /// The line for this problem, robots and opponents in the order they are listed.
    pub fn to_line(&self) -> String {
        let pair = |p: &Point| format!("[{},{}]", p.x, p.y);
        let robots: Vec<String> =
            self.teammates.iter().map(|(id, at)| format!("\"{id}\":{}", pair(at))).collect();
        let opponents: Vec<String> = self.opponents.iter().map(pair).collect();
        format!(
            r#"{{"ball":{},"defending":"{}","teammates":{{{}}},"opponents":[{}]}}"#,
            pair(&self.ball),
            self.defending.label(),
            robots.join(","),
            opponents.join(","),
        )
    }

    /// Reads one line; robots come out ascending by id.
    pub fn parse(line: &str) -> Result<Self, String> {
        let Pairs(pairs) = serde_json::from_str(line).map_err(|error| error.to_string())?;
        let (mut ball, mut defending, mut teammates, mut opponents) = (None, None, None, None);
        for (key, value) in pairs {
            let again = match key.as_str() {
                "ball" => ball.replace(point("ball", &value)?).is_some(),
                "defending" => defending.replace(goal(&value)?).is_some(),
                "teammates" => teammates.replace(robots(&value)?).is_some(),
                "opponents" => opponents.replace(points(&value)?).is_some(),
                _ => return Err(format!("{key}: unknown key")),
            };
            if again {
                return Err(format!("{key}: twice"));
            }
        }
        Ok(Self {
            ball: ball.ok_or("ball: missing")?,
            defending: defending.ok_or("defending: missing")?,
            teammates: teammates.ok_or("teammates: missing")?,
            opponents: opponents.ok_or("opponents: missing")?,
        })
    }
}

fn goal(value: &Node) -> Result<Goal, String> {
    match value {
        Node::Other(Value::String(label)) => Goal::from_label(label),
        _ => None,
    }
    .ok_or_else(|| "defending: expected \"yellow\" or \"cyan\"".to_owned())
}

fn robots(value: &Node) -> Result<Vec<(u8, Point)>, String> {
    let Node::Object(Pairs(pairs)) = value else { return Err("teammates: expected an object".to_owned()) };
    let mut robots: Vec<(u8, Point)> = Vec::new();
    for (id, value) in pairs {
        let place = format!("teammates.{id}");
        let id: u8 = match id.parse() {
            Ok(number @ 0..=15) => number,
            _ => return Err(format!("{place}: expected an id from 0 to 15")),
        };
        if robots.iter().any(|(other, _)| *other == id) {
            return Err(format!("{place}: twice"));
        }
        robots.push((id, point(&place, value)?));
    }
    if robots.len() > ROBOTS_MAX {
        return Err("teammates: more than 11".to_owned());
    }
    robots.sort_by_key(|(id, _)| *id);
    Ok(robots)
}

fn points(value: &Node) -> Result<Vec<Point>, String> {
    let Node::Other(Value::Array(list)) = value else { return Err("opponents: expected a list".to_owned()) };
    if list.len() > ROBOTS_MAX {
        return Err("opponents: more than 11".to_owned());
    }
    let entry = |(i, value): (usize, &Value)| point(&format!("opponents.{i}"), &Node::Other(value.clone()));
    list.iter().enumerate().map(entry).collect()
}

fn point(place: &str, value: &Node) -> Result<Point, String> {
    let coordinates: Option<Vec<i64>> = match value {
        Node::Other(Value::Array(list)) => list.iter().map(Value::as_i64).collect(),
        _ => None,
    };
    match coordinates.as_deref() {
        Some(&[x, y]) => Ok(Point { x, y }),
        _ => Err(format!("{place}: expected [x, y] in mm")),
    }
}

/// A JSON object with its keys in their order, so that a duplicate key is detected.
struct Pairs(Vec<(String, Node)>);

/// A value; only objects need their keys kept.
#[derive(Deserialize)]
#[serde(untagged)]
enum Node {
    Object(Pairs),
    Other(Value),
}

impl<'de> Deserialize<'de> for Pairs {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Keys;
        impl<'de> Visitor<'de> for Keys {
            type Value = Pairs;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("an object")
            }
            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Pairs, A::Error> {
                let mut pairs = Vec::new();
                while let Some(pair) = map.next_entry()? {
                    pairs.push(pair);
                }
                Ok(Pairs(pairs))
            }
        }
        deserializer.deserialize_map(Keys)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_printed_problem_reads_as_it_was() {
        let line = r#"{"ball":[-600,10],"defending":"cyan","teammates":{"1":[-700,0],"3":[2,8]},"opponents":[[4,5]]}"#;
        assert_eq!(Problem::parse(line).expect("well formed").to_line(), line);
    }

    #[test]
    fn the_error_of_a_malformed_line_names_the_place() {
        let cases = [
            (r#"{"ball":[0,0],"defending":"yellow","teammates":{"3":[1]},"opponents":[]}"#, "teammates.3"),
            (
                r#"{"ball":[0,0],"defending":"yellow","teammates":{"1":[1,1],"01":[2,2]},"opponents":[]}"#,
                "01: twice",
            ),
            (
                r#"{"ball":[0,0],"defending":"yellow","teammates":{"1":[1,1],"1":[2,2]},"opponents":[]}"#,
                "1: twice",
            ),
            (r#"{"ball":[0,0],"defending":"yellow","teammates":{"16":[1,1]},"opponents":[]}"#, "0 to 15"),
            (r#"{"ball":[0.5,0],"defending":"yellow","teammates":{},"opponents":[]}"#, "ball: expected"),
            (r#"{"ball":[0,0],"defending":"blue","teammates":{},"opponents":[]}"#, "defending"),
            (r#"{"ball":[0,0],"defending":"cyan","teammates":{}}"#, "opponents: missing"),
            (
                r#"{"ball":[0,0],"ball":[0,0],"defending":"cyan","teammates":{},"opponents":[]}"#,
                "ball: twice",
            ),
            (
                r#"{"ball":[0,0],"defending":"cyan","teammates":{},"opponents":[],"score":1}"#,
                "score: unknown",
            ),
            ("[1]", "object"),
        ];
        for (line, expected) in cases {
            let reason = Problem::parse(line).expect_err(line);
            assert!(reason.contains(expected), "{line}: {reason}");
        }
    }
}
