//! `judging`: what becomes of proposals in matches: scenes choose, scenes of fresh matches test, whole
//! matches validate.

use std::ops::Range;

use super::unit::OPPONENTS;
use super::value::{DIFFERENCE_MAX, value};
use super::{Candidate, LearningMatch, MatchPlayer, MatchUnit, MatchWork, Played, Run, Sizes, WHOLE_MS};
use crate::learning::betting::{Wager, threshold};
use crate::learning::edit::Edit;
use crate::learning::learner::LearnError;
use crate::learning::null_control;
use crate::learning::proposals::Proposal;
use crate::learning::results::{ChangeRecord, Validation, Verdict};
use crate::learning::starts::StartStream;
use crate::learning::variant::Variant;

impl<P: MatchPlayer> Run<'_, P> {
    /// Tries proposals in ever more scenes, fewer proposals each time; the best few go on.
    pub(super) fn screen(
        &mut self,
        current: &Variant,
        explored: &Played,
        proposals: Vec<Proposal>,
        round: u32,
    ) -> Result<Vec<Candidate>, LearnError> {
        let mut open = Vec::new();
        for proposal in proposals {
            let Ok(variant) = current.edited(&proposal.edit) else { continue };
            let candidate = Candidate::new(proposal, variant, explored);
            if candidate.touched.len() < LEAST_SCENES {
                self.note(round, &candidate, None, Verdict::Rare, None);
            } else {
                open.push(candidate);
            }
        }
        let mut from = 0;
        for (to, keep) in SCREENING {
            self.play_scenes(explored, &mut open, from..to)?;
            open.sort_by(|a, b| {
                promise(b).total_cmp(&promise(a)).then_with(|| a.proposal.edit.cmp(&b.proposal.edit))
            });
            for candidate in open.split_off(open.len().div_ceil(keep)) {
                self.note(round, &candidate, None, Verdict::ScreenedOut, None);
            }
            from = to;
        }
        if self.settings.dry_run {
            for candidate in open.drain(..) {
                self.note(round, &candidate, None, Verdict::Proposed, None);
            }
        }
        let good = |candidate: &Candidate| candidate.wager.z() >= FINALIST_Z;
        let (mut finalists, weak): (Vec<_>, Vec<_>) = open.into_iter().partition(good);
        for candidate in weak.iter().chain(&finalists.split_off(finalists.len().min(FINALISTS))) {
            self.note(round, candidate, None, Verdict::ScreenedOut, None);
        }
        Ok(finalists)
    }

    /// Plays some of the matches that each candidate may change, and bets on the scenes from where they
    /// change; a match that stays the same is an equal pair.
    pub(super) fn play_scenes(
        &mut self,
        played: &Played,
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
            let variant = &candidate.variant;
            units.extend(chosen.iter().map(|i| {
                let beside = Some((played.library, &played.matches[*i]));
                MatchUnit { variant, work: played.works[*i], beside }
            }));
        }
        let with = self.play(&units)?;
        let mut with = with.iter();
        for (candidate, chosen) in candidates.iter_mut().zip(&chosen) {
            for (i, with) in chosen.iter().zip(with.by_ref()) {
                let sign = self.sign(&candidate.proposal.edit, &played.works[*i]);
                let difference = with.same_until_s.map_or(0.0, |from_s| {
                    let value = |played: &LearningMatch| value(&played.marks, from_s * 1000);
                    value(with) - value(&played.matches[*i])
                });
                candidate.wager.add_difference(sign * difference, DIFFERENCE_MAX);
            }
        }
        Ok(())
    }

    /// −1 where chance swaps the sides of a pair of the null control; 1 in all other runs.
    pub(super) fn sign(&self, edit: &Edit, work: &MatchWork) -> f64 {
        if null_control::swaps(self.settings, edit, work.stream as u8, work.index) { -1.0 } else { 1.0 }
    }

    /// Tests the finalists in scenes of fresh matches that they share, each against the library with those
    /// accepted before it.
    pub(super) fn judge(
        &mut self,
        current: &Variant,
        finalists: Vec<Candidate>,
        round: u32,
    ) -> Result<Variant, LearnError> {
        let mut current = current.clone();
        // Matches of the present library; more are played when a test needs them.
        let mut blocks: Vec<Played> = Vec::new();
        for mut candidate in finalists {
            if self.tests >= self.settings.tries {
                self.note(round, &candidate, None, Verdict::ScreenedOut, None);
                continue;
            }
            let Ok(variant) = current.edited(&candidate.proposal.edit) else {
                self.note(round, &candidate, None, Verdict::Superseded, None);
                continue;
            };
            candidate.variant = variant;
            let needed = threshold(self.settings.error_rate, self.settings.tries, self.accepted);
            self.test(&current, &mut candidate, &mut blocks, needed)?;
            if candidate.wager.e_value() < needed {
                self.note(round, &candidate, Some(needed), Verdict::Unconfirmed, None);
                continue;
            }
            self.accepted += 1;
            if self.validate(&current, &candidate, needed, round)? {
                current = candidate.variant;
                blocks.clear();
            }
        }
        Ok(current)
    }

    /// The sequential test.
    fn test(
        &mut self,
        current: &Variant,
        candidate: &mut Candidate,
        blocks: &mut Vec<Played>,
        needed: f64,
    ) -> Result<(), LearnError> {
        self.tests += 1;
        candidate.wager = Wager::default();
        for look in 0..LOOKS {
            if blocks.len() == look {
                let Sizes { beginning_ms, look, .. } = self.sizes;
                blocks.push(self.fresh(current, StartStream::Confirmation, look, beginning_ms)?);
            }
            let block = &blocks[look];
            candidate.touched = block.touched(&candidate.proposal.edit);
            self.play_scenes(block, std::slice::from_mut(candidate), 0..usize::MAX)?;
            let hopeless = candidate.wager.z() < HOPELESS_Z + look as f64 * HOPELESS_STEP;
            if candidate.wager.e_value() >= needed || hopeless {
                break;
            }
        }
        Ok(())
    }

    /// Whether a confirmed change is taken over: whole matches are not lower against any opponent, and
    /// `cases check` has no new warning.
    fn validate(
        &mut self,
        current: &Variant,
        candidate: &Candidate,
        needed: f64,
        round: u32,
    ) -> Result<bool, LearnError> {
        let warnings = |variant: &Variant| variant.warnings().map_err(LearnError::Library);
        if !warnings(&candidate.variant)?.is_subset(&warnings(current)?) {
            self.note(round, candidate, Some(needed), Verdict::Warned, None);
            return Ok(false);
        }
        let without = self.fresh(current, StartStream::Validation, self.sizes.validate, WHOLE_MS)?;
        let variant = &candidate.variant;
        let units = without.works.iter().map(|work| MatchUnit { variant, work: *work, beside: None });
        let with = self.play(&units.collect::<Vec<_>>())?;
        let (mut all, mut against) = (Wager::default(), [Wager::default(); OPPONENTS.len()]);
        for ((work, with), without) in without.works.iter().zip(&with).zip(&without.matches) {
            let sign = self.sign(&candidate.proposal.edit, work);
            let difference = sign * (ahead(with) - ahead(without));
            all.add_difference(difference, GOALS_MAX);
            against[work.opponent()].add_difference(difference, GOALS_MAX);
        }
        let lowered = against.iter().any(|wager| wager.z() < LOWERED_Z);
        let verdict = if lowered { Verdict::Lowers } else { Verdict::Accepted };
        let named = OPPONENTS.iter().zip(against);
        let kinds = named.map(|(team, wager)| (team.label().to_owned(), wager)).collect();
        let validation = Validation { all, kinds, worlds: Vec::new() };
        self.note(round, candidate, Some(needed), verdict, Some(validation));
        Ok(!lowered)
    }

    fn note(
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

/// Goals ahead at the end.
fn ahead(played: &LearningMatch) -> f64 {
    let [ours, theirs] = played.goals;
    f64::from(ours) - f64::from(theirs)
}

/// What a candidate may give: its gain in scenes less a standard error, times the share of matches that have
/// one.
fn promise(candidate: &Candidate) -> f64 {
    let gain = candidate.wager.cautious_gain();
    // A pessimistic gain below zero is not made better by being rare.
    if gain > 0.0 { gain * candidate.share } else { gain }
}

/// A proposal that touches fewer of the explored matches is not tried.
const LEAST_SCENES: usize = 6;
/// Steps of screening: scenes of a proposal so far, and of how many proposals one goes on.
const SCREENING: [(usize, usize); 3] = [(12, 2), (36, 2), (96, 1)];
/// Most proposals of a round that are tested: each takes up to half of the budget.
const FINALISTS: usize = 3;
/// Least standard deviations in screening of a proposal that is tested.
const FINALIST_Z: f64 = 1.0;
/// Looks that decide whether a test goes on.
const LOOKS: usize = 8;
/// A test ends where the difference is below this, rising by the next a look.
const HOPELESS_Z: f64 = -0.5;
const HOPELESS_STEP: f64 = 0.25;
/// Matches against an opponent count as lowered from here on: p < 0.025 on one side.
const LOWERED_Z: f64 = -1.96;
/// Differences of whole matches beyond this count as this, goals.
const GOALS_MAX: f64 = 20.0;
