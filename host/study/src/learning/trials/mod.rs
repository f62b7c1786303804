//! `trials`: learning from trials of the four-legged league.
//!
//! ```text
//! exploration starts ─► evidence ─► proposals ─► screening
//!         │                                          ▲
//!         └─► situations of play, moved a little ────┘
//! ```
//! Screening compares in such situations, tests and validation in whole trials.

mod pairs;
mod search;

use std::collections::BTreeMap;
use std::ops::Range;

use arena::Profile;
use case_tools::Files;
use casebase::CaseBase;
use hil_sim::Configuration;
use rayon::prelude::*;

use crate::learning::aim::{Ground, Purpose};
use crate::learning::collected::Collected;
use crate::learning::competence::standings;
use crate::learning::edit::Edit;
use crate::learning::evidence::world_of_trials;
use crate::learning::null_control;
use crate::learning::occasion::Occasion;
use crate::learning::paired::Objection;
use crate::learning::player::Player;
use crate::learning::plays::{PlayToWatch, plays_to_watch};
use crate::learning::proposals::{Kind, Proposal, from_evidence};
use crate::learning::recorded;
use crate::learning::results::{CurvePoint, Learned, Validation, Verdict};
use crate::learning::run::{Candidate, LearnError, LearnResult, Run, Screening, Testing, World};
use crate::learning::settings::LearnSettings;
use crate::learning::starts::{KINDS, StartKind, StartStream, kind_of};
use crate::learning::trial::LearningTrial;
use crate::learning::variant::{Answer, Variant};
use crate::learning::work::{BATCH, Unit, Work};

/// Learns from a library's files and what was collected of earlier play, if anything.
pub fn learn(
    files: Files,
    earlier: Collected,
    settings: &LearnSettings,
    player: &mut impl for<'u> Player<Unit<'u>>,
) -> Result<Learned, LearnError> {
    let start = Variant::new(files).map_err(LearnError::Library)?;
    let mut world = Trials {
        sizes: Sizes::of(settings.budget),
        player,
        drafts: Vec::new(),
        held_out: Default::default(),
    };
    if settings.kinds.contains(&Kind::New) {
        world.drafts = recorded::proposals(&earlier.plays, &start.files.rules);
    }
    Run::new(world, start, earlier.evidence, settings).learn()
}

/// Numbers of starts a round.
#[derive(Clone, Copy, Debug)]
struct Sizes {
    explore: u32,
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
    /// Largest number of starts of a test, unless exploration has more: a change that plays in one of eight
    /// trials and raises a tenth of them (1.2 points) is confirmed more often than not.
    const CONFIRM_MAX: u32 = 8192;
    /// Least number of validation starts where the budget allows for it: fewer show nothing of single kinds
    /// of starts.
    const VALIDATE_MIN: u32 = 1024;

    /// About eight rounds fit a large budget, and two the least.
    fn of(budget: u64) -> Self {
        let unit = u64::from(BATCH);
        let explore = (budget / 100 / unit * unit).clamp(8 * unit, 4096) as u32;
        Self {
            explore,
            confirm: (8 * explore).min(explore.max(Self::CONFIRM_MAX)),
            validate: explore.max(Self::VALIDATE_MIN.min(8 * explore)),
            held_out: explore,
            proposals: (explore as usize / 100).clamp(4, 10),
            situations: (explore / 64).clamp(4, 16),
        }
    }

    fn of_stream(self, stream: StartStream) -> u32 {
        match stream {
            StartStream::Exploration => self.explore,
            StartStream::Confirmation => self.confirm / LOOKS as u32,
            StartStream::Validation => self.validate,
            StartStream::HeldOut => self.held_out,
        }
    }
}

/// Situations that are drawn to try proposals in: a change of one in a hundred finds 80.
const SCREENED_SITUATIONS: u32 = 8192;
const LOOKS: usize = 16;

/// The world of trials, and who plays them.
pub(super) struct Trials<'r> {
    sizes: Sizes,
    player: &'r mut dyn for<'u> Player<Unit<'u>>,
    /// Drafts from plays of recordings.
    drafts: Vec<Proposal>,
    /// Whether each held-out start comes to goal, with the library at first and with the newest.
    held_out: [Vec<bool>; 2],
}

/// Trials of a library on starts of a stream, with what was played and what retrieval answered in each.
pub(super) struct Played {
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

    /// Replaces trials by those of a library which plays them otherwise.
    fn renew(&mut self, variant: &Variant, changed: Vec<(usize, LearningTrial)>) {
        for (i, trial) in changed {
            self.plays[i] = names(variant, &trial);
            self.answers[i] = answers(variant, &variant.base(), &trial);
            self.trials[i] = trial;
        }
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

impl World for Trials<'_> {
    type Played = Played;
    type Ground = Ground;
    /// Trials by their place in the block.
    type Changed = Vec<(usize, LearningTrial)>;
    const SCREENING: Screening =
        Screening { touched_min: 24, steps: [(24, 2), (72, 3), (144, 1)], finalists: 10, finalist_z: 1.3 };
    const TESTING: Testing = Testing { looks: LOOKS, hopeless_z: -1.0, hopeless_step: 0.2 };
    /// Drafts come from other situations each round.
    const IDLE_ROUNDS: u32 = 3;

    fn fresh(run: &mut Run<'_, Self>, stream: StartStream) -> LearnResult<Played> {
        let count = run.world.sizes.of_stream(stream);
        let indices = run.settings.worlds.indices(run.take(stream, count), count);
        let current = run.current.clone();
        let trials = run.starts(&current, stream, &indices, true)?;
        Ok(Played::new(&current, stream, indices, trials))
    }

    fn collect(run: &mut Run<'_, Self>, played: &Played) {
        let mut outcomes: Vec<_> = played.trials.iter().map(|trial| trial.outcome).collect();
        let first = played.indices.first().copied().unwrap_or_default();
        null_control::shuffle(run.settings, first, &mut outcomes);
        for ((index, trial), outcome) in played.indices.iter().zip(&played.trials).zip(outcomes) {
            let StartKind { profile, opponents, .. } = KINDS[kind_of(*index).0];
            let (world, trial) = (world_of_trials(profile), LearningTrial { outcome, ..trial.clone() });
            run.evidence.add(&run.current, &world, opponents.label(), &trial);
        }
    }

    fn propose(run: &mut Run<'_, Self>, played: &Played) -> LearnResult<Vec<Proposal>> {
        let known = standings(&run.evidence, &run.libraries);
        let LearnSettings { kinds, refused, .. } = run.settings;
        let mut proposals = Vec::new();
        for kind in kinds {
            if *kind == Kind::New {
                proposals.extend(run.search(&occasions(played))?);
                proposals.extend(run.recorded());
                continue;
            }
            let mut of_kind = from_evidence(&run.current, &known, *kind, &run.tried);
            // Before others are left out for want of room.
            of_kind.retain(|proposal| !refused.contains(&proposal.edit));
            of_kind.truncate(run.world.sizes.proposals);
            for proposal in of_kind.iter_mut().filter(|proposal| proposal.kind == Kind::Forget) {
                if let Ok(without) = run.current.edited(&proposal.edit) {
                    proposal.reason += &successors(&proposal.edit.case, &without, played);
                }
            }
            proposals.extend(of_kind);
        }
        proposals.retain(|proposal| !refused.contains(&proposal.edit));
        Ok(proposals)
    }

    fn ground(run: &Run<'_, Self>, played: Played) -> Ground {
        run.draw(&occasions(&played), Purpose::Screening)
    }

    fn touched(ground: &Ground, edit: &Edit, edited: &Variant) -> (Vec<usize>, usize) {
        (ground.touched(edit, edited), ground.occasions.len())
    }

    fn play_pairs(
        run: &mut Run<'_, Self>,
        ground: &Ground,
        tried: &mut [Candidate],
        range: Range<usize>,
    ) -> LearnResult<()> {
        run.try_situations(ground, tried, range)
    }

    fn look(
        run: &mut Run<'_, Self>,
        candidate: &mut Candidate,
        block: &Played,
    ) -> LearnResult<Self::Changed> {
        let (pairs, changed) = run.whole_trials(candidate, block)?;
        candidate.wager.merge(&pairs.all);
        Ok(changed)
    }

    /// A change lowers no world and no kind of whole trials, and raises no touches.
    fn validate(
        run: &mut Run<'_, Self>,
        candidate: &Candidate,
        kept: &mut Option<Played>,
    ) -> LearnResult<(Verdict, Validation)> {
        let without = match kept {
            Some(played) => played,
            None => kept.insert(Self::fresh(run, StartStream::Validation)?),
        };
        let (pairs, changed) = run.whole_trials(candidate, without)?;
        let verdict = match pairs.objection() {
            Some(Objection::Lowers) => Verdict::Lowers,
            Some(Objection::Touches) => Verdict::Touches,
            None => Verdict::Accepted,
        };
        if verdict == Verdict::Accepted {
            without.renew(&candidate.variant, changed);
        }
        Ok((verdict, (&pairs).into()))
    }

    fn renew(
        run: &mut Run<'_, Self>,
        candidate: &Candidate,
        blocks: &mut Vec<Played>,
        mut changed: Vec<Self::Changed>,
    ) -> LearnResult<()> {
        for block in &blocks[changed.len()..] {
            changed.push(run.whole_trials(candidate, block)?.1);
        }
        for (block, changed) in blocks.iter_mut().zip(changed) {
            block.renew(&candidate.variant, changed);
        }
        Ok(())
    }

    fn measure(run: &mut Run<'_, Self>) -> LearnResult<()> {
        let indices = run.settings.worlds.indices(0, run.world.sizes.held_out);
        let trials = run.starts(&run.current.clone(), StartStream::HeldOut, &indices, false)?;
        run.curve.push(CurvePoint::of(run.round, run.spent, &indices, &trials));
        let to_goal: Vec<bool> = trials.iter().map(LearningTrial::to_goal).collect();
        let [first, newest] = &mut run.world.held_out;
        if first.is_empty() {
            first.clone_from(&to_goal);
        }
        *newest = to_goal;
        Ok(())
    }

    fn plays_to_watch(run: &Run<'_, Self>) -> Vec<PlayToWatch> {
        let [before, after] = &run.world.held_out;
        let indices = run.settings.worlds.indices(0, before.len() as u32);
        plays_to_watch(run.settings.seed, &indices, before, after)
    }
}

impl Run<'_, Trials<'_>> {
    /// Plays starts of a stream, with the decisions where `record` is set.
    fn starts(
        &mut self,
        variant: &Variant,
        stream: StartStream,
        indices: &[u32],
        record: bool,
    ) -> LearnResult<Vec<LearningTrial>> {
        self.spent += indices.len() as u64;
        let works = indices.chunks(BATCH as usize).map(|chunk| Work::Starts {
            stream,
            indices: chunk.to_vec(),
            record,
        });
        let units: Vec<_> = works.map(|work| Unit { variant, work }).collect();
        Ok(self.world.player.play(&units)?.into_iter().flatten().collect())
    }

    /// Situations like these occasions, for the present round.
    fn draw(&self, occasions: &[Occasion], purpose: Purpose) -> Ground {
        Ground::draw(occasions, purpose, SCREENED_SITUATIONS, self.settings.seed, self.round, &self.current)
    }
}

/// Number of groups of situations that screening looks at one by one.
const GROUPS: usize = 3;

/// The group of a situation: defender and goalie or two defenders in the paper's simulator, or its robots.
fn group(occasion: &Occasion) -> usize {
    if occasion.profile == Profile::Robots { 2 } else { usize::from(occasion.two_defenders) }
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

/// Successors of a case: the cases that are retrieved in its place, most often first.
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
    let all: u32 = counts.iter().map(|(_, count)| count).sum();
    let mut parts = Vec::new();
    for (name, count) in counts.iter().take(SUCCESSORS_MAX) {
        parts.push(format!("{name} {:.0} %", 100.0 * f64::from(*count) / f64::from(all)));
    }
    if parts.is_empty() { String::new() } else { format!("; in its place: {}", parts.join(", ")) }
}

/// Largest number of successors of a case that a reason names.
const SUCCESSORS_MAX: usize = 3;
