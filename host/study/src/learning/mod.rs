//! `learning`: revise and retain: a case library made better by play (docs/learning.md).
//!
//! [`learn()`] takes a library's files and a [`Player`] of trials and returns a [`Learned`] library, with the
//! evidence for every change that was accepted and every one that was refused; [`learn_matches()`] does so
//! with matches of the Small Size League. They do no input or output themselves; [`JournalPlayer`] keeps what
//! was played in a directory, so that a run may be killed, resumed and sharded.

mod aim;
mod betting;
mod case_evidence;
mod collected;
mod competence;
mod diff;
mod drafts;
mod edit;
mod evidence;
mod goalkeeper;
mod journal;
mod judging;
mod matches;
mod null_control;
mod occasion;
mod page;
mod paired;
mod player;
mod plays;
mod proposals;
mod recorded;
mod refusals;
mod results;
mod run;
mod settings;
mod starts;
mod trial;
mod trial_recorder;
mod trials;
mod variant;
mod work;

pub use betting::{PairedDifference, Wager, threshold};
pub use case_evidence::{CaseEvidence, PlayCounts, ProposalNote, edit_in, proposals_in};
pub use collected::Collected;
pub use competence::{CaseStanding, Standing, standings};
pub use diff::diff;
pub use edit::{Change, Edit, EditError, RETRIEVAL};
pub use evidence::{CasePlay, Evidence, EvidenceCounts, EvidenceKey, Posterior, ScopeRing, world_of_trials};
pub use journal::JournalPlayer;
pub use matches::{
    LearningMatch, Mark, MarkKind, MatchDecision, MatchUnit, MatchWork, SCENE_MS, learn_matches,
};
pub use page::{html, json, summary};
pub use paired::{Pairs, WorldPairs};
pub use player::{PlayError, Playable, Player};
pub use plays::PlayToWatch;
pub use proposals::{Kind, Proposal, order_edits};
pub use recorded::{DraftError, RecordedDraft, draft};
pub use refusals::{REFUSALS, read_refusals, refusals_to_jsonl};
pub use results::{ChangeRecord, CurvePoint, Learned, Validation, Verdict};
pub use run::LearnError;
pub use settings::LearnSettings;
pub use starts::{KINDS, StartKind, StartPlan, StartStream, Worlds, kind_of};
pub use trial::{LearningTrial, Situation, TrialDecision};
pub use trial_recorder::TrialRecorder;
pub use trials::learn;
pub use variant::{Answer, Variant, VariantError};
pub use work::{Unit, Work};
