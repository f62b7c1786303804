//! `judging`: what becomes of proposals: screening, the sequential test, validation.

use std::ops::Range;

use casebase::CaseBase;
use hil_sim::{Fnv, Stream};
use rayon::prelude::*;

use super::{Candidate, LearnError, Played, Run};
use crate::betting::{Wager, threshold};
use crate::edit::Edit;
use crate::proposals::Proposal;
use crate::results::{ChangeRecord, Verdict};
use crate::starts::{StartStream, cell};
use crate::variant::Variant;
use crate::work::{BATCH, Player, Unit, Work};

impl<P: Player> Run<'_, P> {
    /// Tries proposals on ever more of the explored starts, the better third each time; the best few go on.
    pub(super) fn screen(
        &mut self,
        current: &Variant,
        explored: &Played,
        proposals: Vec<Proposal>,
        round: u32,
    ) -> Result<Vec<Candidate>, LearnError> {
        let mut open: Vec<Candidate> = (proposals.into_iter())
            .filter_map(|proposal| {
                let variant = current.edited(&proposal.edit).ok()?;
                Some(Candidate::new(proposal, variant))
            })
            .collect();
        let all = explored.trials.len();
        let mut from = 0;
        for (to, keep) in [(all / 8, 2), (all / 2, 3), (all, 1)] {
            self.pairs(current, explored, &mut open, from..to)?;
            open.sort_by(|a, b| {
                b.wager.z().total_cmp(&a.wager.z()).then_with(|| a.proposal.edit.cmp(&b.proposal.edit))
            });
            let kept = open.len().div_ceil(keep);
            for candidate in open.split_off(kept) {
                self.note(round, &candidate, Verdict::ScreenedOut);
            }
            from = to;
        }
        let kept = open.iter().filter(|candidate| candidate.wager.z() >= FINALIST_Z).count().min(FINALISTS);
        let rest = if self.settings.dry_run { 0 } else { kept };
        for candidate in open.split_off(rest) {
            let verdict = if self.settings.dry_run { Verdict::Proposed } else { Verdict::ScreenedOut };
            self.note(round, &candidate, verdict);
        }
        Ok(open)
    }

    /// Plays the pairs of candidates on some of the starts that `without` was played on: those that a
    /// candidate can have an effect on; the others are equal pairs.
    fn pairs(
        &mut self,
        current: &Variant,
        without: &Played,
        candidates: &mut [Candidate],
        range: Range<usize>,
    ) -> Result<(), LearnError> {
        let chosen: Vec<Vec<usize>> = (candidates.iter())
            .map(|candidate| {
                let base = candidate.variant.base();
                let Candidate { proposal, variant, .. } = candidate;
                let touches = |i: &usize| affects(&proposal.edit, current, variant, &base, without, *i);
                range.clone().into_par_iter().filter(touches).collect()
            })
            .collect();
        let mut units = Vec::new();
        for (candidate, chosen) in candidates.iter().zip(&chosen) {
            self.spent += chosen.len() as u64;
            for chunk in chosen.chunks(BATCH as usize) {
                let indices = chunk.iter().map(|i| without.first + *i as u32).collect();
                let work = Work::Starts { stream: without.stream, indices, record: false };
                units.push(Unit { variant: &candidate.variant, work });
            }
        }
        let mut played = self.player.play(&units)?.into_iter().flatten();
        drop(units);
        for (candidate, chosen) in candidates.iter_mut().zip(&chosen) {
            for (i, with) in chosen.iter().zip(played.by_ref()) {
                let edit = &candidate.proposal.edit;
                let (mut a, mut b) = (with.to_goal(), without.trials[*i].to_goal());
                if self.settings.shuffle && self.coin(edit, without.stream, without.first + *i as u32) {
                    (a, b) = (b, a);
                }
                candidate.wager.add(a, b);
                candidate.cells[cell(without.first + *i as u32).0].add(a, b);
            }
            candidate.wager.add_equal((range.len() - chosen.len()) as u32);
        }
        Ok(())
    }

    /// Chance for a pair of the null control.
    fn coin(&self, edit: &Edit, stream: StartStream, index: u32) -> bool {
        let mut hash = Fnv::default();
        hash.add(&[stream as u8]);
        hash.add(&self.settings.seed.to_le_bytes());
        hash.add(edit.to_string().as_bytes());
        hash.add(&index.to_le_bytes());
        Stream::new(hash.value(), "coin").chance(0.5)
    }

    /// The sequential test, on fresh starts that the finalists share.
    pub(super) fn confirm(
        &mut self,
        current: &Variant,
        finalists: Vec<Candidate>,
        round: u32,
    ) -> Result<Vec<(Candidate, f64)>, LearnError> {
        let first = {
            let used = self.used.entry(StartStream::Confirmation).or_default();
            let first = *used;
            *used += if finalists.is_empty() { 0 } else { self.sizes.confirm };
            first
        };
        let step = self.sizes.confirm / STEPS;
        let mut without: Vec<Played> = Vec::new();
        let mut confirmed = Vec::new();
        for mut candidate in finalists {
            if self.tests >= self.settings.tries {
                self.note(round, &candidate, Verdict::ScreenedOut);
                continue;
            }
            self.tests += 1;
            let needed = threshold(self.settings.error_rate, self.settings.tries, self.accepted);
            candidate = Candidate::new(candidate.proposal, candidate.variant);
            for number in 0..STEPS {
                if without.len() == number as usize {
                    let played =
                        self.recorded(current, StartStream::Confirmation, first + number * step, step)?;
                    without.push(played);
                }
                let all = without[number as usize].trials.len();
                let one = std::slice::from_mut(&mut candidate);
                self.pairs(current, &without[number as usize], one, 0..all)?;
                let hopeless = candidate.wager.z() < HOPELESS_Z + f64::from(number) * HOPELESS_STEP;
                if candidate.wager.e_value() >= needed || hopeless {
                    break;
                }
            }
            if candidate.wager.e_value() >= needed {
                self.accepted += 1;
                confirmed.push((candidate, needed));
            } else {
                self.note_test(round, &candidate, needed, Verdict::Unconfirmed, None);
            }
        }
        Ok(confirmed)
    }

    /// Takes a confirmed change over unless it lowers a kind of start, or adds a warning.
    pub(super) fn validate(
        &mut self,
        current: Variant,
        candidate: &Candidate,
        needed: f64,
        round: u32,
    ) -> Result<Variant, LearnError> {
        let Ok(variant) = current.edited(&candidate.proposal.edit) else {
            self.note_test(round, candidate, needed, Verdict::Superseded, None);
            return Ok(current);
        };
        let warnings = |variant: &Variant| variant.warnings().map_err(LearnError::Library);
        if !warnings(&variant)?.is_subset(&warnings(&current)?) {
            self.note_test(round, candidate, needed, Verdict::Warned, None);
            return Ok(current);
        }
        let without = self.fresh(&current, StartStream::Validation, self.sizes.validate)?;
        let mut again = [Candidate::new(candidate.proposal.clone(), variant)];
        self.pairs(&current, &without, &mut again, 0..without.trials.len())?;
        let [Candidate { variant, wager, cells, .. }] = again;
        let lowered = wager.z() < ALL_LOWERED_Z || cells.iter().any(|cell| cell.z() < LOWERED_Z);
        let verdict = if lowered { Verdict::Lowers } else { Verdict::Accepted };
        self.note_test(round, candidate, needed, verdict, Some((wager, cells.to_vec())));
        Ok(if lowered { current } else { variant })
    }

    fn note(&mut self, round: u32, candidate: &Candidate, verdict: Verdict) {
        let Candidate { proposal, wager, .. } = candidate;
        let (proposal, screening) = (proposal.clone(), *wager);
        self.changes.push(ChangeRecord {
            round,
            proposal,
            wager: screening,
            needed: None,
            verdict,
            validation: None,
        });
    }

    fn note_test(
        &mut self,
        round: u32,
        candidate: &Candidate,
        needed: f64,
        verdict: Verdict,
        validation: Option<(Wager, Vec<Wager>)>,
    ) {
        let Candidate { proposal, wager, .. } = candidate;
        let (proposal, wager, needed) = (proposal.clone(), *wager, Some(needed));
        self.changes.push(ChangeRecord { round, proposal, wager, needed, verdict, validation });
    }
}

/// Whether an edit can have changed trial `i`: its case was played, or retrieval answers a problem of the
/// trial otherwise.
fn affects(
    edit: &Edit,
    current: &Variant,
    edited: &Variant,
    base: &CaseBase<'_>,
    played: &Played,
    i: usize,
) -> bool {
    let decisions = &played.trials[i].decisions;
    decisions.iter().zip(&played.answers[i]).any(|(decision, answer)| {
        let plays = decision.case.and_then(|id| current.names().get(usize::from(id / 4)));
        plays.is_some_and(|name| *name == edit.case)
            || edited.answer(base, &decision.situation.problem()) != *answer
    })
}

/// Most proposals of a round that are tested.
const FINALISTS: usize = 6;
/// Least standard deviations in screening of a proposal that is tested.
const FINALIST_Z: f64 = 1.3;
/// Looks that decide whether a test goes on.
const STEPS: u32 = 16;
/// A test ends where the difference is below this, rising by the next a look.
const HOPELESS_Z: f64 = -1.0;
const HOPELESS_STEP: f64 = 0.2;
/// All validation starts together count as lowered from here on.
const ALL_LOWERED_Z: f64 = -1.0;
/// A kind of starts counts as lowered from here on: p < 0.025 on one side.
const LOWERED_Z: f64 = -1.96;

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::edit::Change;
    use crate::trial::LearningTrial;

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
        let base = current.base();
        let trials = played(&current, true);
        let answers = trials.iter().map(|trial| {
            let problems = trial.decisions.iter().map(|decision| decision.situation.problem());
            problems.map(|problem| current.answer(&base, &problem)).collect()
        });
        let answers = answers.collect();
        let without = Played { stream: StartStream::Exploration, first: 0, trials, answers };
        let edit = |case: &str, change| Edit { case: case.to_owned(), change };
        let edits = [
            edit("center/close-in", Change::Forget),
            edit("center/walk-beside", Change::BallScope([900, 700])),
            edit("center/pass-across", Change::OpponentScope(0, [250, 200])),
            edit("front/walk-on", Change::Action(0, 1, "{ kick = \"goal\" }".to_owned())),
        ];
        for edit in edits {
            let edited = current.edited(&edit).unwrap();
            let (mut same, mut touched, mut changed) = (0, 0, 0);
            for (i, with) in played(&edited, false).iter().enumerate() {
                let without_it = &without.trials[i];
                let equal = (with.outcome, with.touches) == (without_it.outcome, without_it.touches);
                if affects(&edit, &current, &edited, &edited.base(), &without, i) {
                    touched += 1;
                    changed += usize::from(!equal);
                } else {
                    same += 1;
                    assert!(equal, "{edit}: trial {i}");
                }
            }
            assert!(same >= 10 && touched >= 5 && changed >= 1, "{edit}: {same}, {touched}, {changed}");
        }
    }
}
