//! `learner`: rounds of learning. Explore, propose, screen, confirm, validate.
//!
//! ```text
//! exploration starts ─► evidence ─► proposals ─► screening (halving) ─► finalists
//!         │                                          ▲                      │ fresh starts, sequential test
//!         └─► situations of play, moved a little ────┘                      ▼
//! held-out starts ◄── library ◄── accepted ◄── validation starts ◄──── confirmed
//! ```
//! Screening chooses and proves nothing: only whole trials on starts that no proposal was drawn from or
//! chosen by count in a test. Everything is a function of the files, the settings and the outcomes of trials.

mod judging;
mod search;

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

use arena::Profile;
use case_tools::Files;
use casebase::CaseBase;
use hil_sim::Configuration;
use rayon::prelude::*;

use crate::learning::aim::{Ground, Purpose};
use crate::learning::betting::Wager;
use crate::learning::collected::Collected;
use crate::learning::competence::standings;
use crate::learning::evidence::{Evidence, world_of_trials};
use crate::learning::null_control;
use crate::learning::occasion::Occasion;
use crate::learning::plays::plays_to_watch;
use crate::learning::proposals::{Kind, Proposal, Tried, from_evidence};
use crate::learning::recorded;
use crate::learning::results::{ChangeRecord, CurvePoint, Learned, note_tried};
use crate::learning::settings::LearnSettings;
use crate::learning::starts::{KINDS, StartKind, StartStream, kind_of};
use crate::learning::trial::LearningTrial;
use crate::learning::variant::{Answer, Variant, VariantError};
use crate::learning::work::{BATCH, PlayError, Player, Unit, Work};

/// Why learning ended without a result.
#[derive(Debug)]
pub enum LearnError {
    /// The library to learn from is refused.
    Library(VariantError),
    /// Trials could not be played.
    Play(PlayError),
}

impl From<PlayError> for LearnError {
    fn from(error: PlayError) -> Self {
        Self::Play(error)
    }
}

impl fmt::Display for LearnError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Library(VariantError::Edit(error)) => error.fmt(f),
            Self::Library(VariantError::Refused(findings)) => {
                f.write_str("the library is refused; correct it:")?;
                findings.iter().try_for_each(|finding| write!(f, "\n  {finding}"))
            }
            Self::Play(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for LearnError {}

/// Learns from a library's files and what was collected of earlier play, if anything.
pub fn learn(
    files: Files,
    earlier: Collected,
    settings: &LearnSettings,
    player: &mut impl Player,
) -> Result<Learned, LearnError> {
    let start = Variant::new(files).map_err(LearnError::Library)?;
    let new = settings.kinds.contains(&Kind::New);
    let mut run = Run {
        drafts: if new { recorded::proposals(&earlier.plays, &start.files.rules) } else { Vec::new() },
        sizes: Sizes::of(settings.budget),
        settings,
        player,
        evidence: earlier.evidence,
        libraries: vec![start.hash],
        tried: Tried::new(),
        spent: 0,
        situations: BTreeSet::new(),
        tests: 0,
        accepted: 0,
        used: BTreeMap::new(),
        changes: Vec::new(),
        curve: Vec::new(),
        held_out: [Vec::new(), Vec::new()],
    };
    let mut current = start.clone();
    run.measure(&current, 0)?;
    let mut idle = 0;
    for round in 1.. {
        let before = run.changes.len();
        let next = run.round(&current, round)?;
        if next.hash != current.hash {
            run.libraries.push(next.hash);
            run.measure(&next, round)?;
        } else if let Some(last) = run.curve.last().cloned() {
            run.curve.push(CurvePoint { round, spent: run.spent, ..last });
        }
        current = next;
        idle = if run.changes.len() == before { idle + 1 } else { 0 };
        let exhausted = idle == IDLE_ROUNDS || run.tests >= settings.tries;
        if settings.dry_run || exhausted || run.spent >= settings.budget {
            break;
        }
    }
    let Run { evidence, changes, curve, spent, tests, held_out: [before, after], .. } = run;
    let indices = settings.worlds.indices(0, before.len() as u32);
    let plays = plays_to_watch(settings.seed, &indices, &before, &after);
    Ok(Learned {
        settings: settings.clone(),
        start,
        end: current,
        evidence,
        changes,
        curve,
        plays,
        spent,
        tests,
        opponents: Vec::new(),
    })
}

/// Numbers of starts a round.
#[derive(Clone, Copy, Debug)]
struct Sizes {
    explore: u32,
    /// Situations that screening draws from.
    screen: u32,
    /// Starts of a test, at most.
    confirm: u32,
    validate: u32,
    held_out: u32,
    /// Proposals a kind that are screened.
    proposals: usize,
    /// Situations that plans are searched for.
    situations: u32,
}

impl Sizes {
    /// About eight rounds fit a large budget, and two the least.
    fn of(budget: u64) -> Self {
        let unit = u64::from(BATCH);
        let explore = (budget / 100 / unit * unit).clamp(8 * unit, 4096) as u32;
        Self {
            explore,
            screen: SCREEN_GROUND,
            confirm: (8 * explore).min(explore.max(CONFIRM_MAX)),
            validate: explore.max(VALIDATE_MIN.min(8 * explore)),
            held_out: explore,
            proposals: (explore as usize / 100).clamp(4, 10),
            situations: (explore / 64).clamp(4, 16),
        }
    }
}

/// Situations that are drawn to try proposals in: a change of one in a hundred finds 80.
const SCREEN_GROUND: u32 = 8192;
/// Most starts of a test, unless exploration has more: a change that plays in one of eight trials and raises
/// a tenth of them (1.2 points) is confirmed more often than not.
const CONFIRM_MAX: u32 = 8192;
/// Least number of validation starts where the budget allows for it: fewer show nothing of single kinds of
/// starts.
const VALIDATE_MIN: u32 = 1024;
/// Rounds without a proposal after which there is nothing left to try: drafts come from other situations each
/// round.
const IDLE_ROUNDS: u32 = 3;

struct Run<'r, P> {
    settings: &'r LearnSettings,
    sizes: Sizes,
    player: &'r mut P,
    evidence: Evidence,
    /// Drafts from plays of recordings.
    drafts: Vec<Proposal>,
    /// Hashes of the libraries so far, oldest first.
    libraries: Vec<u64>,
    tried: Tried,
    spent: u64,
    /// Units of single situations that were played: another proposal's pair may need the same.
    situations: BTreeSet<u64>,
    tests: u32,
    accepted: u32,
    /// Starts of each stream that were used up.
    used: BTreeMap<StartStream, u32>,
    changes: Vec<ChangeRecord>,
    curve: Vec<CurvePoint>,
    /// Whether each held-out start comes to goal, with the library at first and with the newest.
    held_out: [Vec<bool>; 2],
}

/// Trials of a library on starts of a stream, with what was played and what retrieval answered in each.
struct Played {
    stream: StartStream,
    /// Indices of their starts.
    indices: Vec<u32>,
    trials: Vec<LearningTrial>,
    /// Name of the case of every decision.
    plays: Vec<Vec<Option<String>>>,
    answers: Vec<Vec<Answer>>,
}

impl Played {
    fn new(variant: &Variant, stream: StartStream, indices: Vec<u32>, trials: Vec<LearningTrial>) -> Self {
        let base = variant.base();
        let plays = trials.iter().map(|trial| names(variant, trial)).collect();
        let answers = trials.par_iter().map(|trial| answers(variant, &base, trial)).collect();
        Self { stream, indices, trials, plays, answers }
    }

    /// Replaces a trial by that of a library which plays it otherwise.
    fn renew(&mut self, variant: &Variant, i: usize, trial: LearningTrial) {
        self.plays[i] = names(variant, &trial);
        self.answers[i] = answers(variant, &variant.base(), &trial);
        self.trials[i] = trial;
    }
}

fn names(variant: &Variant, trial: &LearningTrial) -> Vec<Option<String>> {
    let name = |id: u16| variant.names().get(usize::from(id / 4)).cloned();
    trial.decisions.iter().map(|decision| decision.case.and_then(name)).collect()
}

fn answers(variant: &Variant, base: &CaseBase<'_>, trial: &LearningTrial) -> Vec<Answer> {
    let problems = trial.decisions.iter().map(|decision| decision.situation.problem());
    problems.map(|problem| variant.answer(base, &problem)).collect()
}

/// A proposal that is tried.
struct Candidate {
    proposal: Proposal,
    variant: Variant,
    wager: Wager,
    /// The same by world and opponents, as [`group`] numbers them.
    groups: [Wager; GROUPS],
    /// Numbers of the situations that it changes what is played in, of those that were drawn.
    touched: Vec<usize>,
    /// Their share.
    share: f64,
}

/// Groups of situations that screening looks at one by one.
const GROUPS: usize = 3;

/// The group of a situation: defender and goalie or two defenders in the paper's simulator, or its robots.
fn group(occasion: &Occasion) -> usize {
    if occasion.profile == Profile::Robots { 2 } else { usize::from(occasion.two_defenders) }
}

impl Candidate {
    fn new(proposal: Proposal, variant: Variant, ground: &Ground) -> Self {
        let touched = ground.touched(&proposal.edit, &variant);
        let share = touched.len() as f64 / ground.occasions.len().max(1) as f64;
        let (wager, groups) = (Wager::default(), [Wager::default(); GROUPS]);
        Self { proposal, variant, wager, groups, touched, share }
    }
}

impl<P: Player> Run<'_, P> {
    fn round(&mut self, current: &Variant, round: u32) -> Result<Variant, LearnError> {
        let explored = self.fresh(current, StartStream::Exploration, self.sizes.explore)?;
        self.collect(current, &explored);
        let occasions = occasions(&explored);
        let proposals = self.propose(current, &explored, &occasions, round)?;
        let before = self.changes.len();
        let (seed, screen) = (self.settings.seed, self.sizes.screen);
        let ground = Ground::draw(&occasions, Purpose::Screening, screen, seed, round, current);
        let finalists = self.screen(current, &ground, proposals, round)?;
        if self.settings.dry_run {
            return Ok(current.clone());
        }
        let next = self.judge(current, finalists, round)?;
        note_tried(&mut self.tried, current, &self.changes[before..]);
        Ok(next)
    }

    /// Plays starts that no other step has seen, with their decisions.
    fn fresh(&mut self, variant: &Variant, stream: StartStream, count: u32) -> Result<Played, LearnError> {
        let used = self.used.entry(stream).or_default();
        let first = *used;
        *used += count;
        let indices = self.settings.worlds.indices(first, count);
        let trials = self.starts(variant, stream, &indices, true)?;
        Ok(Played::new(variant, stream, indices, trials))
    }

    fn starts(
        &mut self,
        variant: &Variant,
        stream: StartStream,
        indices: &[u32],
        record: bool,
    ) -> Result<Vec<LearningTrial>, LearnError> {
        self.spent += indices.len() as u64;
        let chunks = indices.chunks(BATCH as usize);
        let units: Vec<_> = chunks
            .map(|chunk| Unit { variant, work: Work::Starts { stream, indices: chunk.to_vec(), record } })
            .collect();
        Ok(self.player.play(&units)?.into_iter().flatten().collect())
    }

    /// Adds trials to the evidence; in the null control with the outcomes of other trials.
    fn collect(&mut self, current: &Variant, played: &Played) {
        let mut outcomes: Vec<_> = played.trials.iter().map(|trial| trial.outcome).collect();
        let first = played.indices.first().copied().unwrap_or_default();
        null_control::shuffle(self.settings, first, &mut outcomes);
        for ((index, trial), outcome) in played.indices.iter().zip(&played.trials).zip(outcomes) {
            let StartKind { profile, opponents, .. } = KINDS[kind_of(*index).0];
            let (world, trial) = (world_of_trials(profile), LearningTrial { outcome, ..trial.clone() });
            self.evidence.add(current, &world, opponents.label(), &trial);
        }
    }

    fn propose(
        &mut self,
        current: &Variant,
        played: &Played,
        occasions: &[Occasion],
        round: u32,
    ) -> Result<Vec<Proposal>, LearnError> {
        let known = standings(&self.evidence, &self.libraries);
        let mut proposals = Vec::new();
        for kind in self.settings.kinds.clone() {
            if kind == Kind::New {
                proposals.extend(self.search(current, occasions, round)?);
                proposals.extend(self.recorded(current));
            } else {
                let mut all = from_evidence(current, &known, kind, &self.tried);
                // Before others are left out for want of room.
                all.retain(|proposal| !self.settings.refused.contains(&proposal.edit));
                all.truncate(self.sizes.proposals);
                for proposal in all.iter_mut().filter(|proposal| proposal.kind == Kind::Forget) {
                    if let Ok(without) = current.edited(&proposal.edit) {
                        proposal.reason += &successors(&proposal.edit.case, &without, played);
                    }
                }
                proposals.extend(all);
            }
        }
        proposals.retain(|proposal| !self.settings.refused.contains(&proposal.edit));
        Ok(proposals)
    }

    fn measure(&mut self, variant: &Variant, round: u32) -> Result<(), LearnError> {
        let indices = self.settings.worlds.indices(0, self.sizes.held_out);
        let trials = self.starts(variant, StartStream::HeldOut, &indices, false)?;
        self.curve.push(CurvePoint::of(round, self.spent, &indices, &trials));
        let to_goal: Vec<bool> = trials.iter().map(LearningTrial::to_goal).collect();
        if self.held_out[0].is_empty() {
            self.held_out[0].clone_from(&to_goal);
        }
        self.held_out[1] = to_goal;
        Ok(())
    }
}

/// The decisions of trials in which retrieval alone answered.
fn occasions(played: &Played) -> Vec<Occasion> {
    let mut occasions = Vec::new();
    for (index, trial) in played.indices.iter().zip(&played.trials) {
        let StartKind { profile, opponents, .. } = KINDS[kind_of(*index).0];
        let two_defenders = opponents == Configuration::TwoDefenders;
        let retrieved = trial.decisions.iter().filter(|decision| decision.retrieved);
        occasions.extend(retrieved.map(|decision| Occasion {
            situation: decision.situation.clone(),
            profile,
            two_defenders,
            without_case: decision.case.is_none(),
        }));
    }
    occasions
}

/// What would take over from a case: the cases that are retrieved in its place, most often first.
fn successors(case: &str, without: &Variant, played: &Played) -> String {
    let base = without.base();
    let mut counts: BTreeMap<String, u32> = BTreeMap::new();
    let decisions = played.trials.iter().flat_map(|trial| &trial.decisions);
    for (decision, plays) in decisions.zip(played.plays.iter().flatten()) {
        if plays.as_ref().is_some_and(|name| name == case) {
            let answer = without.answer(&base, &decision.situation.problem());
            *counts.entry(answer.map_or_else(|| "no case".to_owned(), |(name, _, _)| name)).or_default() += 1;
        }
    }
    let mut counts: Vec<_> = counts.into_iter().collect();
    counts.sort_by(|a, b| b.1.cmp(&a.1).then_with(|| a.0.cmp(&b.0)));
    let of: u32 = counts.iter().map(|(_, count)| count).sum();
    let part =
        |(name, count): &(String, u32)| format!("{name} {:.0} %", 100.0 * f64::from(*count) / f64::from(of));
    let parts: Vec<_> = counts.iter().take(SUCCESSORS).map(part).collect();
    if parts.is_empty() { String::new() } else { format!("; in its place: {}", parts.join(", ")) }
}

/// Most successors of a case that a reason names.
const SUCCESSORS: usize = 3;
