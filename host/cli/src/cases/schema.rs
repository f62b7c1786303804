//! `onetwo cases schema`: JSON schemas of case files and of `league.toml`. A JSON schema (draft 2020-12) from
//! the names and ranges the reader knows, for editors. It describes the form of a case file; whether a plan
//! is valid is checked by `cases check`.

use std::io::Write as _;
use std::ops::RangeInclusive;
use std::process::ExitCode;

use arena::cases::write_line;
use case_tools::keys;
use casebase::{
    GoalEnd, OPPONENTS_MAX, PROBLEM_OPPONENTS_MAX, PROBLEM_TEAMMATES_MAX, Presence, Primitive, TEAMMATES_MAX,
};
use clap::Args;
use serde_json::{Map, Value, json};

use crate::Failure;
use crate::output;

/// Arguments of `cases schema`.
#[derive(Debug, Args)]
pub(crate) struct SchemaArgs {
    /// Schema of league.toml instead of a case file.
    #[arg(long)]
    league_file: bool,
}

pub(super) fn run(args: &SchemaArgs) -> Result<ExitCode, Failure> {
    let mut schema = if args.league_file { league() } else { case() };
    schema["$schema"] = "https://json-schema.org/draft/2020-12/schema".into();
    schema["title"] = if args.league_file { "league.toml of onetwo" } else { "A case of onetwo" }.into();
    let mut output = output::lines();
    write_line(&mut output, &schema).and_then(|()| output.flush()).map_err(Failure::Output)?;
    Ok(ExitCode::SUCCESS)
}

fn case() -> Value {
    object(keys::CASE, |key| match key {
        "intent" => json!({ "type": "string", "description": "In a sentence, what the case is for." }),
        "defending" => json!({
            "enum": [GoalEnd::Negative.label(), GoalEnd::Positive.label()],
            "description": "yellow: the goal at -x (attacks towards +x); cyan: the goal at +x.",
        }),
        "ball" => scoped(keys::BALL),
        "teammates" => list(&teammate(), 1, TEAMMATES_MAX),
        _ => list(&scoped(keys::OPPONENT), 0, OPPONENTS_MAX),
    })
}

fn scoped(known: &[&'static str]) -> Value {
    object(known, |key| match key {
        "at" => point("[x, y] in mm, field frame."),
        "presence" => json!({
            "enum": Presence::ALL.map(Presence::label),
            "description": "Whether an opponent in the scope ranks the case higher, or must or must not be there.",
        }),
        _ => pair(&keys::POSITIVE, "Radii [x, y] in mm."),
    })
}

fn teammate() -> Value {
    object(keys::TEAMMATE, |key| match key {
        "at" => point("[x, y] in mm, field frame."),
        _ => json!({ "type": "array", "items": action() }),
    })
}

fn action() -> Value {
    let tables = keys::ACTIONS.iter().map(|label| {
        object(&[label], |key| match key {
            "turn" => any(keys::TURN.iter().map(|side| object(&[side], turn))),
            "pass_ball" | "receive_ball" => {
                json!({ "type": "integer", "minimum": 1, "maximum": TEAMMATES_MAX, "description": "Robot of the case." })
            }
            "kick" => json!({ "type": "string", "description": "A kind of kick of league.toml." }),
            _ => point("[x, y] in mm, field frame."),
        })
    });
    any(std::iter::once(json!({ "enum": keys::BARE_ACTIONS })).chain(tables))
}

fn turn(side: &str) -> Value {
    match side {
        "face" => point("[x, y] in mm, field frame."),
        _ => integer(&keys::COORDINATES, "Degrees from the direction of attack, left > 0."),
    }
}

fn league() -> Value {
    object(keys::LEAGUE, |key| match key {
        "field" => object(keys::FIELD, |key| match key {
            "length" | "width" => integer(&keys::SIDES, "mm"),
            "penalty_area" => object(keys::PENALTY_AREA, |_| integer(&keys::INNER, "mm")),
            _ => integer(&keys::INNER, "mm"),
        }),
        "pass" => object(keys::PASS, kick),
        "kicks" => {
            let kinds = [keys::KICK_AT_GOAL, keys::KICK_AHEAD];
            json!({ "type": "object", "additionalProperties": any(kinds.map(|kind| object(kind, kick))) })
        }
        _ => object(keys::PROBLEMS, |key| match key {
            "teammates" => list(&rectangle(), 1, PROBLEM_TEAMMATES_MAX),
            _ => {
                json!({ "type": "array", "items": list(&rectangle(), 0, PROBLEM_OPPONENTS_MAX), "minItems": 1 })
            }
        }),
    })
}

fn kick(key: &str) -> Value {
    match key {
        "aim" => json!({ "const": "goal" }),
        "offset" => integer(&keys::COORDINATES, "mm along the goal line, left > 0 seen in attack."),
        "primitive" => {
            // An unknown name is a warning of `cases check`, not an error.
            let known = Primitive::ALL.map(Primitive::label).into_iter().filter(|label| !label.is_empty());
            json!({ "type": "string", "examples": known.collect::<Vec<_>>() })
        }
        "heading_deg" => integer(&keys::DEGREES, "Degrees from the direction of attack, left > 0."),
        "length" => integer(&(0..=*keys::POSITIVE.end()), "mm"),
        "reach" => integer(&keys::POSITIVE, "How far it rolls, mm."),
        _ => integer(&keys::POSITIVE, "Radius in mm."),
    }
}

fn rectangle() -> Value {
    object(keys::RECTANGLE, |_| pair(&keys::COORDINATES, "[from, to] in mm, seen in attack towards +x."))
}

/// A table of these keys and no others.
fn object(known: &[&str], schema: impl Fn(&str) -> Value) -> Value {
    let properties: Map<_, _> = known.iter().map(|key| ((*key).to_owned(), schema(key))).collect();
    // The two lists of `[problems]` must both be there; a case may do without opponents.
    let optional = |key: &&&str| keys::OPTIONAL.contains(key) && known != keys::PROBLEMS;
    let required: Vec<_> = known.iter().filter(|key| !optional(key)).collect();
    json!({ "type": "object", "properties": properties, "required": required, "additionalProperties": false })
}

fn any(schemas: impl IntoIterator<Item = Value>) -> Value {
    json!({ "anyOf": schemas.into_iter().collect::<Vec<_>>() })
}

fn list(items: &Value, least: usize, most: usize) -> Value {
    json!({ "type": "array", "items": items, "minItems": least, "maxItems": most })
}

fn point(meaning: &str) -> Value {
    pair(&keys::COORDINATES, meaning)
}

fn pair(range: &RangeInclusive<i32>, meaning: &str) -> Value {
    json!({ "type": "array", "items": integer(range, "mm"), "minItems": 2, "maxItems": 2, "description": meaning })
}

fn integer(range: &RangeInclusive<i32>, meaning: &str) -> Value {
    json!({ "type": "integer", "minimum": range.start(), "maximum": range.end(), "description": meaning })
}
