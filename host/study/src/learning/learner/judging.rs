//! `judging`: what becomes of proposals: screening, the sequential test, validation.

use std::ops::Range;

use casebase::CaseBase;
use rayon::prelude::*;

use super::{Candidate, LearnError, Played, Run, group};
use crate::learning::aim::Ground;
use crate::learning::betting::{Wager, threshold};
use crate::learning::edit::Edit;
use crate::learning::null_control;
use crate::learning::occasion::Occasion;
use crate::learning::paired::{Objection, Pairs};
use crate::learning::proposals::Proposal;
use crate::learning::results::{ChangeRecord, Validation, Verdict};
use crate::learning::starts::{StartStream, kind_of};
use crate::learning::trial::LearningTrial;
use crate::learning::variant::Variant;
use crate::learning::work::{Player, Unit, Work};

impl<P: Player> Run<'_, P> {
    /// Tries proposals on ever more situations, fewer proposals each time; the best few go on.
    pub(super) fn screen(
        &mut self,
        current: &Variant,
        ground: &Ground,
        proposals: Vec<Proposal>,
        round: u32,
    ) -> Result<Vec<Candidate>, LearnError> {
        let mut open = Vec::new();
        for proposal in proposals {
            let Ok(variant) = current.edited(&proposal.edit) else { continue };
            let candidate = Candidate::new(proposal, variant, ground);
            if candidate.touched.len() < SCREENING[0].0 {
                self.note(round, &candidate, Verdict::Rare);
            } else {
                open.push(candidate);
            }
        }
        let mut from = 0;
        for (to, keep) in SCREENING {
            self.try_situations(current, ground, &mut open, from..to)?;
            open.sort_by(|a, b| {
                promise(b).total_cmp(&promise(a)).then_with(|| a.proposal.edit.cmp(&b.proposal.edit))
            });
            let kept = open.len().div_ceil(keep);
            for candidate in open.split_off(kept) {
                self.note(round, &candidate, Verdict::ScreenedOut);
            }
            from = to;
        }
        if self.settings.dry_run {
            for candidate in open.drain(..) {
                self.note(round, &candidate, Verdict::Proposed);
            }
        }
        let good = |candidate: &Candidate| candidate.wager.z() >= FINALIST_Z;
        let (mut finalists, weak): (Vec<_>, Vec<_>) = open.into_iter().partition(good);
        for candidate in weak.iter().chain(&finalists.split_off(finalists.len().min(FINALISTS))) {
            self.note(round, candidate, Verdict::ScreenedOut);
        }
        Ok(finalists)
    }

    /// Plays the pairs of candidates in some of the situations that each changes.
    pub(super) fn try_situations(
        &mut self,
        current: &Variant,
        ground: &Ground,
        candidates: &mut [Candidate],
        range: Range<usize>,
    ) -> Result<(), LearnError> {
        let chosen = |candidate: &Candidate| {
            let end = range.end.min(candidate.touched.len());
            candidate.touched[range.start.min(end)..end].to_vec()
        };
        let chosen: Vec<Vec<usize>> = candidates.iter().map(chosen).collect();
        let mut units = Vec::new();
        for (candidate, chosen) in candidates.iter().zip(&chosen) {
            for number in chosen {
                let Occasion { situation, profile, two_defenders, .. } = &ground.occasions[*number];
                let work = Work::Situation {
                    situation: situation.clone(),
                    profile: *profile,
                    two_defenders: *two_defenders,
                    first: *number as u32,
                    trials: 1,
                };
                for variant in [&candidate.variant, current] {
                    units.push(Unit { variant, work: work.clone() });
                }
            }
        }
        for unit in &units {
            self.spent += u64::from(self.situations.insert(unit.key()));
        }
        let played = self.player.play(&units)?;
        let to_goal: Vec<bool> = played.iter().flatten().map(LearningTrial::to_goal).collect();
        let mut pairs = to_goal.chunks_exact(2);
        drop(units);
        for (candidate, chosen) in candidates.iter_mut().zip(&chosen) {
            for (number, pair) in chosen.iter().zip(pairs.by_ref()) {
                let purpose = ground.purpose as u8 + PURPOSES_FROM;
                let swaps =
                    null_control::swaps(self.settings, &candidate.proposal.edit, purpose, *number as u32);
                let (with, without) = (pair[usize::from(swaps)], pair[usize::from(!swaps)]);
                candidate.wager.add(with, without);
                candidate.groups[group(&ground.occasions[*number])].add(with, without);
            }
        }
        Ok(())
    }

    /// Tests the finalists on starts that they share, each against the library with those accepted before it.
    pub(super) fn judge(
        &mut self,
        current: &Variant,
        finalists: Vec<Candidate>,
        round: u32,
    ) -> Result<Variant, LearnError> {
        let mut current = current.clone();
        // Blocks of starts as the present library plays them; more are played when a test needs them.
        let mut blocks: Vec<Played> = Vec::new();
        let mut validation = None;
        for mut candidate in finalists {
            if self.tests >= self.settings.tries {
                self.note(round, &candidate, Verdict::ScreenedOut);
                continue;
            }
            let Ok(variant) = current.edited(&candidate.proposal.edit) else {
                self.note(round, &candidate, Verdict::Superseded);
                continue;
            };
            candidate.variant = variant;
            candidate.wager = Wager::default();
            let needed = threshold(self.settings.error_rate, self.settings.tries, self.accepted);
            let mut changed = self.test(&current, &mut candidate, &mut blocks, needed)?;
            if candidate.wager.e_value() < needed {
                self.note_test(round, &candidate, needed, Verdict::Unconfirmed, None);
                continue;
            }
            self.accepted += 1;
            if self.validate(&current, &candidate, needed, round, &mut validation)? {
                for block in &blocks[changed.len()..] {
                    changed.push(self.whole_trials(&candidate, block)?.1);
                }
                for (block, changed) in blocks.iter_mut().zip(changed) {
                    for (i, trial) in changed {
                        block.renew(&candidate.variant, i, trial);
                    }
                }
                current = candidate.variant;
            }
        }
        Ok(current)
    }

    /// The sequential test; the trials that the candidate changes, by block.
    fn test(
        &mut self,
        current: &Variant,
        candidate: &mut Candidate,
        blocks: &mut Vec<Played>,
        needed: f64,
    ) -> Result<Vec<Vec<(usize, LearningTrial)>>, LearnError> {
        self.tests += 1;
        let mut changed = Vec::new();
        for look in 0..LOOKS {
            if blocks.len() == look as usize {
                blocks.push(self.fresh(current, StartStream::Confirmation, self.sizes.confirm / LOOKS)?);
            }
            let (pairs, trials) = self.whole_trials(candidate, &blocks[look as usize])?;
            candidate.wager.merge(&pairs.all);
            changed.push(trials);
            let hopeless = candidate.wager.z() < HOPELESS_Z + f64::from(look) * HOPELESS_STEP;
            if candidate.wager.e_value() >= needed || hopeless {
                break;
            }
        }
        Ok(changed)
    }

    /// Whether a confirmed change is taken over: it lowers no world and no kind of whole trials, raises no
    /// touches, and adds no warning.
    fn validate(
        &mut self,
        current: &Variant,
        candidate: &Candidate,
        needed: f64,
        round: u32,
        validation: &mut Option<Played>,
    ) -> Result<bool, LearnError> {
        let warnings = |variant: &Variant| variant.warnings().map_err(LearnError::Library);
        if !warnings(&candidate.variant)?.is_subset(&warnings(current)?) {
            self.note_test(round, candidate, needed, Verdict::Warned, None);
            return Ok(false);
        }
        let without = match validation {
            Some(played) => played,
            None => validation.insert(self.fresh(current, StartStream::Validation, self.sizes.validate)?),
        };
        let (pairs, changed) = self.whole_trials(candidate, without)?;
        let verdict = match pairs.objection() {
            Some(Objection::Lowers) => Verdict::Lowers,
            Some(Objection::Touches) => Verdict::Touches,
            None => Verdict::Accepted,
        };
        self.note_test(round, candidate, needed, verdict, Some((&pairs).into()));
        let accepted = verdict == Verdict::Accepted;
        if accepted {
            for (i, trial) in changed {
                without.renew(&candidate.variant, i, trial);
            }
        }
        Ok(accepted)
    }

    /// Plays a candidate on the starts of `without` that it can have an effect on; the others are equal
    /// pairs.
    fn whole_trials(
        &mut self,
        candidate: &Candidate,
        without: &Played,
    ) -> Result<(Pairs, Vec<(usize, LearningTrial)>), LearnError> {
        let Candidate { proposal: Proposal { edit, .. }, variant, .. } = candidate;
        let base = variant.base();
        let touches = |i: &usize| affects(edit, variant, &base, without, *i);
        let chosen: Vec<usize> = (0..without.trials.len()).into_par_iter().filter(touches).collect();
        let indices: Vec<u32> = chosen.iter().map(|i| without.indices[*i]).collect();
        let played = self.starts(variant, without.stream, &indices, true)?;
        let mut pairs = Pairs::default();
        for ((i, index), with) in chosen.iter().zip(&indices).zip(&played) {
            let pair = [with, &without.trials[*i]];
            let swaps = null_control::swaps(self.settings, edit, without.stream as u8, *index);
            pairs.add(kind_of(*index).0, pair[usize::from(swaps)], pair[usize::from(!swaps)]);
        }
        pairs.all.add_equal((without.trials.len() - chosen.len()) as u32);
        Ok((pairs, chosen.into_iter().zip(played).collect()))
    }

    fn note(&mut self, round: u32, candidate: &Candidate, verdict: Verdict) {
        self.record(round, candidate, None, verdict, None);
    }

    fn note_test(
        &mut self,
        round: u32,
        candidate: &Candidate,
        needed: f64,
        verdict: Verdict,
        validation: Option<Validation>,
    ) {
        self.record(round, candidate, Some(needed), verdict, validation);
    }

    fn record(
        &mut self,
        round: u32,
        candidate: &Candidate,
        needed: Option<f64>,
        verdict: Verdict,
        validation: Option<Validation>,
    ) {
        let Candidate { proposal, wager, share, .. } = candidate;
        let (proposal, wager, share) = (proposal.clone(), *wager, *share);
        self.changes.push(ChangeRecord { round, proposal, wager, share, needed, verdict, validation });
    }
}

/// What a candidate may give: its gain in the situations that it changes less a standard error, times their
/// share. Validation refuses what lowers one kind of starts, so in no group of situations may the gain be
/// below zero by more than a standard error.
pub(super) fn promise(candidate: &Candidate) -> f64 {
    let bound = |wager: &Wager, errors: f64| {
        let differ = f64::from(wager.raised) + f64::from(wager.lowered);
        let gain = f64::from(wager.raised) - f64::from(wager.lowered);
        (gain + errors * differ.sqrt()) / f64::from(wager.pairs.max(1))
    };
    let groups = candidate.groups.iter().filter(|wager| wager.pairs > 0);
    let worst = groups.map(|wager| bound(wager, 1.0)).fold(f64::INFINITY, f64::min);
    let gain = bound(&candidate.wager, -1.0).min(worst);
    // A pessimistic gain below zero is not made better by being rare.
    if gain > 0.0 { gain * candidate.share } else { gain }
}

/// Whether an edit can have changed trial `i`: its case was played, or retrieval answers a problem of the
/// trial otherwise.
fn affects(edit: &Edit, edited: &Variant, base: &CaseBase<'_>, played: &Played, i: usize) -> bool {
    let decisions = played.trials[i].decisions.iter().zip(&played.plays[i]);
    edit.changes_problems()
        || decisions.zip(&played.answers[i]).any(|((decision, plays), answer)| {
            plays.as_ref() == Some(&edit.case)
                || edited.answer(base, &decision.situation.problem()) != *answer
        })
}

/// Steps of screening: pairs of a proposal so far, and of how many proposals one goes on.
const SCREENING: [(usize, usize); 3] = [(24, 2), (72, 3), (144, 1)];
/// Most proposals of a round that are tested.
const FINALISTS: usize = 10;
/// Least standard deviations in screening of a proposal that is tested.
const FINALIST_Z: f64 = 1.3;
/// Looks that decide whether a test goes on.
const LOOKS: u32 = 16;
/// A test ends where the difference is below this, rising by the next a look.
const HOPELESS_Z: f64 = -1.0;
const HOPELESS_STEP: f64 = 0.2;
/// Names of purposes in the null control's chance lie behind those of streams of starts.
const PURPOSES_FROM: u8 = 16;

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::learning::edit::Change;

    fn played(variant: &Variant, record: bool) -> Vec<LearningTrial> {
        let stream = StartStream::Exploration;
        let work = Work::Starts { stream, indices: (0..96).collect(), record };
        Unit { variant, work }.play(9).unwrap()
    }

    #[test]
    fn trials_that_an_edit_is_said_not_to_touch_are_the_same_with_it() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let files = case_tools::Files::read(&root.join("../../casebase/library/cases/four-legged")).unwrap();
        let current = Variant::new(files).unwrap();
        let trials = played(&current, true);
        let without = Played::new(&current, StartStream::Exploration, (0..96).collect(), trials);
        let edit = |case: &str, change| Edit { case: case.to_owned(), change };
        let edits = [
            edit("center/close-in", Change::Forget),
            edit("center/walk-beside", Change::BallScope([900, 700])),
            edit("center/pass-across", Change::OpponentScope(0, [250, 200])),
            edit("retrieval", Change::Setting("lookahead".to_owned(), "0.5".to_owned())),
            edit("front/walk-on", Change::Action(0, 1, "{ kick = \"goal\" }".to_owned())),
        ];
        for edit in edits {
            let edited = current.edited(&edit).unwrap();
            let (mut same, mut touched, mut changed) = (0, 0, 0);
            for (i, with) in played(&edited, false).iter().enumerate() {
                let without_it = &without.trials[i];
                let equal = (with.outcome, with.touches) == (without_it.outcome, without_it.touches);
                if affects(&edit, &edited, &edited.base(), &without, i) {
                    touched += 1;
                    changed += usize::from(!equal);
                } else {
                    same += 1;
                    assert!(equal, "{edit}: trial {i}");
                }
            }
            // Where problems change, all trials may.
            let enough = if edit.changes_problems() { same == 0 } else { same >= 10 };
            assert!(enough && touched >= 5 && changed >= 1, "{edit}: {same}, {touched}, {changed}");
        }
    }
}
