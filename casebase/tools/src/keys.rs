//! `keys`: the keys of case files and of `league.toml` (docs/case-format.md §1). The reader refuses all
//! others, and the JSON schema for editors is made from them. mm, whole degrees.

use std::ops::RangeInclusive;

/// Keys of a case file, top level.
pub const CASE: &[&str] = &["intent", "defending", "ball", "teammates", "opponents"];
/// `ball` of a case: a position and a scope.
pub const BALL: &[&str] = &["at", "scope"];
/// An opponent of a case.
pub const OPPONENT: &[&str] = &["at", "scope", "presence"];
/// A robot of a case.
pub const TEAMMATE: &[&str] = &["at", "gameplay"];
/// Actions without an argument, written as a string.
pub const BARE_ACTIONS: &[&str] = &["wait", "get_ball"];
/// Actions that are a table of one key.
pub const ACTIONS: &[&str] = &["go_to_point", "turn", "dribble_to", "pass_ball", "receive_ball", "kick"];
/// Directions of a `turn`, one of them.
pub const TURN: &[&str] = &["heading_deg", "face"];
/// Tables of `league.toml`, top level.
pub const LEAGUE: &[&str] = &["field", "pass", "kicks", "problems"];
/// Keys of `[field]` in `league.toml`.
pub const FIELD: &[&str] = &["length", "width", "margin", "goal_width", "penalty_area"];
/// Keys of `penalty_area` of `[field]`.
pub const PENALTY_AREA: &[&str] = &["depth", "width"];
/// Keys of `[pass]` in `league.toml`.
pub const PASS: &[&str] = &["r_min", "r_max", "reach"];
/// `[kicks.KIND]` at the goal.
pub const KICK_AT_GOAL: &[&str] = &["aim", "offset", "r_min", "r_max", "reach", "primitive"];
/// `[kicks.KIND]` along a heading.
pub const KICK_AHEAD: &[&str] = &["heading_deg", "length", "r_min", "r_max", "primitive"];
/// Keys of `[problems]` in `league.toml`.
pub const PROBLEMS: &[&str] = &["teammates", "opponents"];
/// A rectangle of `[problems]`.
pub const RECTANGLE: &[&str] = &["x", "y"];
/// Optional keys, in any table.
pub const OPTIONAL: &[&str] =
    &["opponents", "presence", "margin", "offset", "primitive", "kicks", "problems", "reach"];

/// Coordinates and radii in files, mm: a kilometre in either direction, so that no sum of a few of them
/// overflows.
pub const COORDINATES: RangeInclusive<i32> = -1_000_000..=1_000_000;
/// Values that must be above 0, mm.
pub const POSITIVE: RangeInclusive<i32> = 1..=1_000_000;
/// Sides of a field, mm: the range of the table's positions.
pub const SIDES: RangeInclusive<i32> = 1..=30_000;
/// Dimensions within a field, mm.
pub const INNER: RangeInclusive<i32> = 0..=30_000;
/// Headings of kicks: several turns in either direction.
pub const DEGREES: RangeInclusive<i32> = -3600..=3600;
