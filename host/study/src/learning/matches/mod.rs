//! `matches`: the same cycle for libraries of the Small Size League, whose play is matches.
//!
//! ```text
//! beginnings of matches ─► evidence ─► proposals ─► scenes (halving) ─► finalists
//!                                                                          │ scenes of fresh matches, e-values
//! library ◄── accepted ◄── whole matches, paired by seed ◄── confirmed ◄───┘
//! ```
//! A match is a function of its seed and of the cases that our host and robots retrieve. So a match with an
//! edited library is, tick by tick, that with the library before, up to the first decision that the edit
//! touches, and the scenes from there on are a pair from an equal start, robots in motion. Opponents take
//! turns.

mod judging;
mod unit;
mod value;

use std::collections::{BTreeMap, BTreeSet};

use arena::CycleEnd;
use case_tools::Files;
use hil_sim::small_size::worlds::WorldChoice;

use crate::learning::betting::Wager;
use crate::learning::collected::Collected;
use crate::learning::competence::standings;
use crate::learning::edit::{Change, Edit};
use crate::learning::evidence::{CasePlay, Evidence};
use crate::learning::journal::{JournalPlayer, Playable};
use crate::learning::learner::LearnError;
use crate::learning::null_control;
use crate::learning::proposals::{Kind, Proposal, Tried, from_evidence};
use crate::learning::results::{ChangeRecord, Learned, note_tried};
use crate::learning::settings::LearnSettings;
use crate::learning::starts::StartStream;
use crate::learning::variant::Variant;
use crate::learning::work::PlayError;

pub use unit::{LearningMatch, Mark, MarkKind, MatchDecision, MatchUnit, MatchWork, SCENE_MS};

/// Plays matches, or knows what became of them.
pub trait MatchPlayer {
    /// The match of every unit, in order.
    fn play_matches(&mut self, units: &[MatchUnit<'_>]) -> Result<Vec<LearningMatch>, PlayError>;
}

impl MatchPlayer for JournalPlayer<'_, LearningMatch> {
    fn play_matches(&mut self, units: &[MatchUnit<'_>]) -> Result<Vec<LearningMatch>, PlayError> {
        Ok(self.play_all(units)?.into_iter().flatten().collect())
    }
}

/// Learns from the files of a library of the Small Size League and what was collected of earlier play. Its
/// `budget` is of scenes: parts of matches of [`SCENE_MS`].
pub fn learn_matches(
    files: Files,
    earlier: Collected,
    settings: &LearnSettings,
    player: &mut impl MatchPlayer,
) -> Result<Learned, LearnError> {
    let start = Variant::new(files).map_err(LearnError::Library)?;
    let mut run = Run {
        sizes: Sizes::of(settings.budget),
        settings,
        player,
        evidence: earlier.evidence,
        libraries: vec![start.hash],
        tried: Tried::new(),
        asked: BTreeSet::new(),
        spent: 0,
        tests: 0,
        accepted: 0,
        used: BTreeMap::new(),
        changes: Vec::new(),
    };
    let mut current = start.clone();
    for round in 1.. {
        let before = run.changes.len();
        let next = run.round(&current, round)?;
        if next.hash != current.hash {
            run.libraries.push(next.hash);
        }
        current = next;
        let idle = run.changes.len() == before;
        let exhausted = idle || run.tests >= settings.tries;
        if settings.dry_run || exhausted || run.spent >= settings.budget {
            break;
        }
    }
    let Run { evidence, changes, spent, tests, .. } = run;
    Ok(Learned {
        settings: settings.clone(),
        start,
        end: current,
        evidence,
        changes,
        curve: Vec::new(),
        plays: Vec::new(),
        spent,
        tests,
        opponents: unit::OPPONENTS.map(|team| team.label().to_owned()).to_vec(),
    })
}

/// Numbers of matches a round.
#[derive(Clone, Copy, Debug)]
struct Sizes {
    /// Length of a beginning, simulated ms.
    beginning_ms: u32,
    /// Beginnings that evidence and scenes are taken from.
    explore: u32,
    /// Fresh beginnings of a look of a test.
    look: u32,
    /// Whole matches of a validation.
    validate: u32,
    /// Proposals a kind that are screened.
    proposals: usize,
}

impl Sizes {
    /// A sixth of the budget explores; one test takes up to two thirds of it, a validation an eighth. Every
    /// opponent is met as often from both ends.
    fn of(budget: u64) -> Self {
        let beginning = u64::from(BEGINNING_MS).div_ceil(SCENE_MS.into());
        let turns = |matches: u64, most: u64| (matches.clamp(TURN, most) / TURN * TURN) as u32;
        let explore = turns(budget / 6 / beginning, 600);
        Self {
            beginning_ms: BEGINNING_MS,
            explore,
            look: turns(u64::from(explore) / 2, 300),
            validate: turns(budget / 8 / WHOLE_SCENES / 2, 120),
            proposals: (explore as usize / 24).clamp(3, 10),
        }
    }
}

/// Length of a beginning, simulated ms: three or four cases are played in it, and what goes before a scene
/// is played again with every edited library.
const BEGINNING_MS: u32 = 90_000;
/// A whole match, simulated ms.
const WHOLE_MS: u32 = 600_000;
/// Scenes that a whole match counts as.
const WHOLE_SCENES: u64 = (WHOLE_MS / SCENE_MS) as u64;
/// Matches after which opponents and ends repeat.
const TURN: u64 = 6;

struct Run<'r, P> {
    settings: &'r LearnSettings,
    sizes: Sizes,
    player: &'r mut P,
    evidence: Evidence,
    /// Hashes of the libraries so far, oldest first.
    libraries: Vec<u64>,
    tried: Tried,
    /// Units that were played: the same unit is not played again.
    asked: BTreeSet<u64>,
    spent: u64,
    tests: u32,
    accepted: u32,
    /// Matches of each stream that were used up.
    used: BTreeMap<StartStream, u32>,
    changes: Vec<ChangeRecord>,
}

/// Matches of a library.
struct Played {
    /// Hash of the library.
    library: u64,
    works: Vec<MatchWork>,
    matches: Vec<LearningMatch>,
    /// Names of the cases that were among the actions, by match.
    listed: Vec<BTreeSet<String>>,
}

impl Played {
    fn new(variant: &Variant, works: Vec<MatchWork>, matches: Vec<LearningMatch>) -> Self {
        let name = |number: &u16| variant.names().get(usize::from(*number)).cloned();
        let listed = matches.iter().map(|played| played.listed.iter().filter_map(name).collect()).collect();
        Self { library: variant.hash, works, matches, listed }
    }

    /// The matches that an edit may change, by number: those in which its case was among the actions; of a
    /// scope that may hold more than before, all.
    fn touched(&self, edit: &Edit) -> Vec<usize> {
        let all = matches!(edit.change, Change::BallScope(_) | Change::OpponentScope(..));
        (0..self.matches.len()).filter(|i| all || self.listed[*i].contains(&edit.case)).collect()
    }
}

/// A proposal that is tried.
struct Candidate {
    proposal: Proposal,
    variant: Variant,
    wager: Wager,
    /// Numbers of the matches that it may change.
    touched: Vec<usize>,
    /// Their share.
    share: f64,
}

impl Candidate {
    fn new(proposal: Proposal, variant: Variant, played: &Played) -> Self {
        let touched = played.touched(&proposal.edit);
        let share = touched.len() as f64 / played.matches.len().max(1) as f64;
        Self { proposal, variant, wager: Wager::default(), touched, share }
    }
}

impl<P: MatchPlayer> Run<'_, P> {
    fn round(&mut self, current: &Variant, round: u32) -> Result<Variant, LearnError> {
        let Sizes { beginning_ms, explore, .. } = self.sizes;
        let explored = self.fresh(current, StartStream::Exploration, explore, beginning_ms)?;
        self.collect(current, &explored);
        let proposals = self.propose(current);
        let before = self.changes.len();
        let finalists = self.screen(current, &explored, proposals, round)?;
        if self.settings.dry_run {
            return Ok(current.clone());
        }
        let next = self.judge(current, finalists, round)?;
        note_tried(&mut self.tried, current, &self.changes[before..]);
        Ok(next)
    }

    /// Plays matches of a stream that no other step has seen.
    fn fresh(
        &mut self,
        variant: &Variant,
        stream: StartStream,
        count: u32,
        until_ms: u32,
    ) -> Result<Played, LearnError> {
        let used = self.used.entry(stream).or_default();
        let first = *used;
        *used += count;
        let works: Vec<_> =
            (first..first + count).map(|index| MatchWork { stream, index, until_ms }).collect();
        let units = works.iter().map(|work| MatchUnit { variant, work: *work, beside: None });
        let matches = self.play(&units.collect::<Vec<_>>())?;
        Ok(Played::new(variant, works, matches))
    }

    fn play(&mut self, units: &[MatchUnit<'_>]) -> Result<Vec<LearningMatch>, LearnError> {
        let played = self.player.play_matches(units)?;
        for (unit, played) in units.iter().zip(&played) {
            if self.asked.insert(unit.key()) {
                self.spent += unit.counts(std::slice::from_ref(played));
            }
        }
        Ok(played)
    }

    /// Adds the plays of cases to the evidence, as recorded matches are; in the null control with the goals
    /// of other plays.
    fn collect(&mut self, current: &Variant, played: &Played) {
        let world = WorldChoice::default().to_string();
        let decisions = played.matches.iter().flat_map(|played| &played.decisions);
        let plays: Vec<_> = decisions.filter(|decision| decision.end.is_some()).collect();
        let mut goals: Vec<bool> = plays.iter().map(|decision| decision.goal).collect();
        let first = played.works.first().map_or(0, |work| work.index);
        null_control::shuffle(self.settings, first, &mut goals);
        for (decision, goal) in plays.into_iter().zip(goals) {
            let end = decision.end.and_then(|end| CycleEnd::DESCRIPTION.get(usize::from(end)).copied());
            let situation = &decision.situation;
            let play = CasePlay { situation, case: Some(decision.case), to_goal: goal, end };
            self.evidence.add_play(current, &world, &situation.opponents.len().to_string(), &play);
        }
    }

    /// Proposals of the kinds that matches can try. Hosts retrieve with the usual settings, so no order is
    /// tried; demands on a goalkeeper are for the four-legged league's opponents.
    fn propose(&self, current: &Variant) -> Vec<Proposal> {
        let known = standings(&self.evidence, &self.libraries);
        let kinds = [Kind::Scopes, Kind::Actions, Kind::Forget];
        let kinds = kinds.into_iter().filter(|kind| self.settings.kinds.contains(kind));
        let proposals = kinds.flat_map(|kind| {
            let mut all = from_evidence(current, &known, kind, &self.tried);
            all.retain(|Proposal { edit, .. }| {
                !matches!(edit.change, Change::AddOpponent(..)) && !self.settings.refused.contains(edit)
            });
            all.truncate(self.sizes.proposals);
            all
        });
        proposals.collect()
    }
}

#[cfg(test)]
mod tests;
