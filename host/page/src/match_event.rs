//! `match_event`: time-line events. One entry of the time line, reported once and kept.

use serde::{Deserialize, Serialize};

use crate::request::PageTeam;

/// An event of the time line.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MatchEvent {
    /// Seconds since the start.
    pub t: f64,
    /// Kind of event, for its symbol and filter.
    pub kind: MatchEventKind,
    /// The team, if the event belongs to one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub team: Option<PageTeam>,
    /// A short text for the time line.
    #[serde(rename = "words")]
    pub description: String,
    /// Place of the event, m, field frame.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at: Option<[f32; 2]>,
    /// The situation that was retrieved with, as `onetwo cases explain` takes it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub problem: Option<serde_json::Value>,
    /// The decision made in it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub decided: Option<DecisionNote>,
}

/// Decision of a team's coordinator on a problem.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct DecisionNote {
    /// The problem is the coordinator's own, as it reported it; else the host has rebuilt it from its own
    /// view, and the decision may have rested on another.
    pub reported: bool,
    /// Number of the coordinator.
    pub by: u8,
    /// The team's number of the cycle.
    pub cycle: u32,
    /// Id of the stored case that is played; none where no case is.
    pub id: Option<u16>,
    /// Reason for which the decision is not simply retrieval's answer to the problem; empty where it is.
    pub grounds: String,
    /// The problem, as `onetwo cases explain` takes it; none where the coordinator knew of no ball.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub problem: Option<serde_json::Value>,
}

impl MatchEvent {
    /// A fault at `t` seconds since the start, of no team and no place.
    pub fn fault(t: f64, description: String) -> Self {
        Self::new(t, MatchEventKind::Fault, None, description)
    }

    /// An event without a place or a problem; `t` in s since the start.
    pub fn new(t: f64, kind: MatchEventKind, team: Option<PageTeam>, description: String) -> Self {
        Self { t, kind, team, description, at: None, problem: None, decided: None }
    }
}

/// Kinds of events; the time line has a row for each.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum MatchEventKind {
    /// A goal that counts.
    Goal,
    /// A command of the referee.
    Command,
    /// A part of the match started.
    Stage,
    /// An offence or a card.
    Foul,
    /// Another event of the referee.
    Event,
    /// A cycle started or ended without a case.
    Cycle,
    /// A case was chosen.
    Case,
    /// A pass or a shot.
    Kick,
    /// A fault of a robot or the radio.
    Fault,
}
