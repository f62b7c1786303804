//! `config`: static configuration of a robot. Identity, abilities and the paper's alternatives.

use casebase::{GoalEnd, RetrievalSettings};
use protocol::{Duration, RobotId, TeamId};
use rules::League;
use serde::{Deserialize, Serialize};

/// A robot's configuration; travels in the lockstep set-up and is compiled or provisioned on a board.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BrainConfig {
    /// The robot's number in its team.
    pub robot: RobotId,
    /// The team that the robot plays for.
    pub team: TeamId,
    /// Boot epoch: rises with every boot.
    pub epoch: u32,
    /// The league, which determines field, robots and ball.
    pub league: League,
    /// The goal its team defends.
    pub defending: GoalEnd,
    /// Whether it is one of the k robots that may retrieve (paper §4.1).
    pub retriever: bool,
    /// When a case's actions start.
    pub positioning: Positioning,
    /// How it chooses its actions.
    pub approach: Approach,
    /// Settings of case retrieval (docs/case-format.md §3.2).
    pub settings: RetrievalSettings,
    /// Whether a host leads it: without frames of one it does nothing (docs/architecture.md §6.2).
    pub hosted: bool,
    /// Time for which robots stand still after every cycle (5 s in the paper's experiments with real robots;
    /// else 0).
    pub pause_after_cycle: Duration,
}

/// When the robots of a case start their actions (paper §4.2).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Positioning {
    /// As soon as the robot that gets the ball is at its place.
    #[default]
    Dependent,
    /// All robots are at their places.
    Independent,
}

/// Source of a robot's actions (paper §5).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Approach {
    /// Cases; the reactive behaviour where none fits.
    #[default]
    Cases,
    /// The reactive behaviour alone.
    Reactive,
    /// Both: cases, but the reactive behaviour where it is expected to shoot sooner.
    Hybrid,
}

impl BrainConfig {
    /// An attacker of the four-legged league towards +x with the paper's settings, able to retrieve.
    pub fn new(robot: RobotId, team: TeamId) -> Self {
        Self {
            robot,
            team,
            epoch: 1,
            league: League::FourLegged,
            defending: GoalEnd::Negative,
            retriever: true,
            positioning: Positioning::default(),
            approach: Approach::default(),
            settings: RetrievalSettings::default(),
            hosted: false,
            pause_after_cycle: Duration(0),
        }
    }

    /// A robot on wheels of that league, led by a host.
    pub fn hosted(robot: RobotId, team: TeamId, league: League) -> Self {
        Self { league, hosted: true, ..Self::new(robot, team) }
    }
}
