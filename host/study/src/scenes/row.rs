//! `row`: one played scene, and its line in a CSV file.

use serde::Serialize;

use super::{SceneKind, SceneOutcome};
use crate::matches::MatchTeam;

/// One scene, played by one team.
#[derive(Clone, Copy, Debug, Serialize)]
#[serde(into = "SceneLine")]
pub struct SceneRow {
    /// Kind of start.
    pub kind: SceneKind,
    /// The team against which it is played.
    pub opponent: MatchTeam,
    /// Number among those of its kind and opponent, from 0.
    pub number: u32,
    /// Random seed.
    pub seed: u64,
    /// The team that played it.
    pub team: MatchTeam,
    /// Outcome of the scene.
    pub outcome: SceneOutcome,
}

#[derive(Serialize)]
struct SceneLine {
    kind: SceneKind,
    opponent: MatchTeam,
    number: u32,
    seed: u64,
    team: MatchTeam,
    played: bool,
    shot: bool,
    goal: bool,
    shot_against: bool,
    goal_against: bool,
    planned: bool,
}

impl From<SceneRow> for SceneLine {
    fn from(row: SceneRow) -> Self {
        let SceneRow { kind, opponent, number, seed, team, outcome } = row;
        let SceneOutcome { played, shot, goal, shot_against, goal_against, planned } = outcome;
        Self { kind, opponent, number, seed, team, played, shot, goal, shot_against, goal_against, planned }
    }
}
