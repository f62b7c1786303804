//! `answer`: output format of answers. One JSON object a line, keys in the order of docs/case-format.md §5.1;
//! lengths in mm, similarity to four decimals and cost to two.

use std::io::{self, Write};

use casebase::{
    Case, CaseBase, CaseRobot, Match, PointMm, Problem, Retrieval, RetrievalSettings, adapted_position,
};
use protocol::RobotId;
use serde::{Serialize, Serializer};

use super::{Chosen, LibraryHandle};

/// The answer to one line of `cases retrieve`.
#[derive(Debug, Serialize)]
#[serde(untagged)]
pub enum Answer<'a> {
    /// The best case.
    Found(Found<'a>),
    /// No case fits.
    Nothing {
        /// Always `null`.
        case: (),
        /// Number of candidates: 0.
        candidates: u16,
        /// Settings that differ from retrieval's defaults.
        #[serde(skip_serializing_if = "<[_]>::is_empty", serialize_with = "as_object")]
        settings: &'a [(String, String)],
    },
    /// The line is not a valid problem.
    Malformed {
        /// `line 7: place: reason`.
        error: String,
    },
}

/// A retrieved case and the roles and places of the robots.
#[derive(Debug, Serialize)]
pub struct Found<'a> {
    case: &'a str,
    id: u16,
    symmetry: &'static str,
    similarity: f64,
    cost: f64,
    conditions: u8,
    teammates: u8,
    #[serde(rename = "match", serialize_with = "as_object")]
    roles: Vec<(u8, u8)>,
    #[serde(serialize_with = "as_object")]
    adapted: Vec<(u8, [i32; 2])>,
    candidates: u16,
    /// Settings that differ from retrieval's defaults, recorded with every result (docs/case-format.md §3.2);
    /// left out where nothing does.
    #[serde(skip_serializing_if = "<[_]>::is_empty", serialize_with = "as_object")]
    settings: &'a [(String, String)],
}

impl<'a> Answer<'a> {
    /// Answer of a retrieval from that library.
    pub fn new(
        library_handle: &'a LibraryHandle,
        base: &CaseBase<'_>,
        problem: &Problem,
        chosen: &'a Chosen,
        retrieval: &Retrieval,
    ) -> Self {
        let best = retrieval.best.as_ref().and_then(|best| Some((best, base.case(best.case)?)));
        let Some((best, case)) = best else {
            return Self::Nothing { case: (), candidates: retrieval.candidates, settings: &chosen.changed };
        };
        Self::Found(Found {
            case: library_handle.name(best.case),
            id: best.case.0,
            symmetry: case.symmetry().label(),
            similarity: similarity(best),
            cost: cost(best),
            conditions: best.conditions,
            teammates: best.teammates,
            roles: roles(best),
            adapted: adapted(&case, best, problem.ball, &chosen.settings),
            candidates: retrieval.candidates,
            settings: &chosen.changed,
        })
    }
}

/// Robot number of the case, from 1, with the id of the robot that plays it.
pub(super) fn roles(found: &Match) -> Vec<(u8, u8)> {
    (1..).zip(found.correspondence.iter().map(|robot| robot.number())).collect()
}

/// Robot id with its adapted start position, mm.
fn adapted(
    case: &Case<'_>,
    found: &Match,
    ball: PointMm,
    settings: &RetrievalSettings,
) -> Vec<(u8, [i32; 2])> {
    let place = |(robot, player): (CaseRobot, &RobotId)| {
        let PointMm { x, y } = adapted_position(case, robot, ball, settings);
        (player.number(), [x, y])
    };
    case.robots().zip(&found.correspondence).map(place).collect()
}

/// Rounds to four decimals.
pub(super) fn similarity(found: &Match) -> f64 {
    rounded(found.similarity, 1e4)
}

/// Rounds to two decimals, mm.
pub(super) fn cost(found: &Match) -> f64 {
    rounded(found.cost, 1e2)
}

/// Rounded to one in `parts`.
pub(super) fn rounded(value: f32, parts: f64) -> f64 {
    (f64::from(value) * parts).round() / parts
}

/// Pairs in their order as one JSON object; numbers become string keys, as JSON requires.
pub(super) fn as_object<K: Serialize, V: Serialize, S: Serializer>(
    pairs: &(impl AsRef<[(K, V)]> + ?Sized),
    serializer: S,
) -> Result<S::Ok, S::Error> {
    serializer.collect_map(pairs.as_ref().iter().map(|(key, value)| (key, value)))
}

/// One value on one line.
pub fn write_line(output: &mut impl Write, value: &impl Serialize) -> io::Result<()> {
    serde_json::to_writer(&mut *output, value)?;
    output.write_all(b"\n")
}
