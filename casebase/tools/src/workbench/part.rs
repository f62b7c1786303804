//! `part`: names of a case's parts that have a place: `ball`, `tm2`, `opp1`, `tm2.3` (the third action of the
//! second robot).

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

/// A part, by the numbers that findings print, from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum Part {
    /// The ball, written `ball`.
    Ball,
    /// A robot by its number: `tm1`.
    Robot(usize),
    /// An opponent by its number: `opp1`.
    Opponent(usize),
    /// A robot's action by their numbers: `tm1.2`.
    Action(usize, usize),
}

impl fmt::Display for Part {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Ball => f.write_str("ball"),
            Self::Robot(robot) => write!(f, "tm{robot}"),
            Self::Opponent(opponent) => write!(f, "opp{opponent}"),
            Self::Action(robot, number) => write!(f, "tm{robot}.{number}"),
        }
    }
}

impl FromStr for Part {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let part = match (text.strip_prefix("tm"), text.strip_prefix("opp")) {
            (Some(rest), _) => match rest.split_once('.') {
                None => number(rest).map(Self::Robot),
                Some((robot, action)) => number(robot).zip(number(action)).map(|(r, a)| Self::Action(r, a)),
            },
            (_, Some(rest)) => number(rest).map(Self::Opponent),
            _ => (text == "ball").then_some(Self::Ball),
        };
        part.ok_or_else(|| "expected a part such as ball, tm1, tm1.2 or opp1".to_owned())
    }
}

/// A number from 1 to 999.
fn number(text: &str) -> Option<usize> {
    text.parse().ok().filter(|number| (1..1000).contains(number))
}

impl TryFrom<String> for Part {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<Part> for String {
    fn from(part: Part) -> Self {
        part.to_string()
    }
}
