//! `asked`: requests of the workbench.

use std::collections::BTreeMap;

use arena::Opposition;
use case_tools::workbench::Edit;
use casebase::Symmetry;
use serde::{Deserialize, Deserializer};
use serde_json::Value;

/// A request. Texts are those of case files.
#[derive(Debug, Deserialize)]
#[serde(tag = "do", rename_all = "snake_case")]
pub(super) enum Asked {
    /// The library's cases, and what can be done here.
    List {},
    /// A case of the library.
    Open {
        name: String,
    },
    Draft {
        problem: Value,
    },
    /// The sheet of a text.
    Look {
        name: String,
        text: String,
    },
    /// A change of a text, made in a symmetric copy.
    Edit {
        name: String,
        text: String,
        symmetry: SymmetryName,
        edit: Edit,
    },
    /// Everything that `cases check` finds.
    Check {
        name: String,
        text: String,
    },
    /// Rank and margins over a problem.
    Rank {
        name: String,
        text: String,
        problem: Value,
    },
    /// Problems of the match that it wins.
    Count {
        name: String,
        text: String,
    },
    /// Evidence and proposals of learning.
    Learned {
        name: String,
    },
    /// The change of it with these words is refused, or is proposed again.
    Refuse {
        name: String,
        words: String,
        refused: bool,
    },
    /// Changes by other settings of retrieval over the match's problems.
    Settings {
        values: BTreeMap<String, String>,
    },
    /// Attempts in the simulator.
    Rehearse {
        name: String,
        text: String,
        #[serde(deserialize_with = "trials")]
        trials: u32,
        #[serde(deserialize_with = "opposition")]
        opponents: Opposition,
        seed: u64,
    },
    /// Results so far.
    Rehearsal {},
    /// No further ones.
    Stop {},
    /// One of them, to be watched.
    Sample {
        number: u32,
    },
    /// Tries of a single skill in the simulator; without one: what can be tried, and how the last tries went.
    Tries {
        #[serde(default)]
        plan: Option<TriesPlan>,
    },
    /// No further tries.
    StopTries {},
    /// A moment played on with different seeds; without a plan: how the last tries went.
    PlayOn {
        #[serde(default)]
        plan: Option<PlayOnPlan>,
    },
    /// No further ones.
    StopPlayOn {},
    /// Writes the file; `over`: the text that it replaces.
    Save {
        name: String,
        text: String,
        over: Option<String>,
    },
}

impl Asked {
    /// True if it changes something, or takes the machine for long.
    pub(super) const fn needs_token(&self) -> bool {
        match self {
            Self::Rehearse { .. }
            | Self::Stop {}
            | Self::Save { .. }
            | Self::Check { .. }
            | Self::Refuse { .. }
            | Self::StopTries {}
            | Self::StopPlayOn {} => true,
            Self::Tries { plan } => plan.is_some(),
            Self::PlayOn { plan } => plan.is_some(),
            _ => false,
        }
    }
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TriesPlan {
    pub(super) skill: String,
    pub(super) world: String,
    #[serde(deserialize_with = "trials")]
    pub(super) tries: u32,
    pub(super) seed: u64,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PlayOnPlan {
    /// The moment, s of a recording.
    pub(super) at: f64,
    #[serde(deserialize_with = "trials")]
    pub(super) tries: u32,
    pub(super) seed: u64,
}

/// Most attempts of a rehearsal.
const TRIALS_MAX: u32 = 500;

fn trials<'de, D: Deserializer<'de>>(deserializer: D) -> Result<u32, D::Error> {
    let trials = u32::deserialize(deserializer)?;
    if (1..=TRIALS_MAX).contains(&trials) {
        return Ok(trials);
    }
    Err(serde::de::Error::custom("a rehearsal has 1 to 500 attempts, and a skill as many tries"))
}

fn opposition<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Opposition, D::Error> {
    let label = String::deserialize(deserializer)?;
    Opposition::from_label(&label)
        .ok_or_else(|| serde::de::Error::custom("opponents are standing or playing"))
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum SymmetryName {
    Identity,
    AcrossX,
    AcrossY,
    Both,
}

impl From<SymmetryName> for Symmetry {
    fn from(name: SymmetryName) -> Self {
        match name {
            SymmetryName::Identity => Self::Identity,
            SymmetryName::AcrossX => Self::AcrossX,
            SymmetryName::AcrossY => Self::AcrossY,
            SymmetryName::Both => Self::Both,
        }
    }
}
