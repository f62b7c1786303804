//! `judging`: what becomes of proposals: screening, the sequential test, validation.

use crate::learning::betting::{Wager, threshold};
use crate::learning::proposals::Proposal;
use crate::learning::results::{ChangeRecord, Validation, Verdict};
use crate::learning::run::{Candidate, LearnError, LearnResult, Run, World};
use crate::learning::starts::StartStream;
use crate::learning::variant::Variant;

impl<W: World> Run<'_, W> {
    /// Tries proposals in ever more pairs, fewer proposals each time; the best few go on.
    pub(super) fn screen(
        &mut self,
        ground: &W::Ground,
        proposals: Vec<Proposal>,
    ) -> LearnResult<Vec<Candidate>> {
        let mut open = Vec::new();
        for proposal in proposals {
            let Ok(variant) = self.current.edited(&proposal.edit) else { continue };
            let touched = W::touched(ground, &proposal.edit, &variant);
            let candidate = Candidate::new(proposal, variant, touched);
            if candidate.touched.len() < W::SCREENING.touched_min {
                self.note(&candidate, None, Verdict::Rare, None);
            } else {
                open.push(candidate);
            }
        }
        let mut from = 0;
        for (to, keep) in W::SCREENING.steps {
            W::play_pairs(self, ground, &mut open, from..to)?;
            open.sort_by(|a, b| {
                b.promise().total_cmp(&a.promise()).then_with(|| a.proposal.edit.cmp(&b.proposal.edit))
            });
            for candidate in open.split_off(open.len().div_ceil(keep)) {
                self.note(&candidate, None, Verdict::ScreenedOut, None);
            }
            from = to;
        }
        if self.settings.dry_run {
            for candidate in open.drain(..) {
                self.note(&candidate, None, Verdict::Proposed, None);
            }
        }
        let (mut finalists, weak): (Vec<_>, Vec<_>) =
            open.into_iter().partition(|candidate| candidate.wager.z() >= W::SCREENING.finalist_z);
        let beyond = finalists.split_off(finalists.len().min(W::SCREENING.finalists));
        for candidate in weak.iter().chain(&beyond) {
            self.note(candidate, None, Verdict::ScreenedOut, None);
        }
        Ok(finalists)
    }

    /// Tests the finalists on starts that they share, each against the library with those accepted before it.
    pub(super) fn judge(&mut self, finalists: Vec<Candidate>) -> LearnResult<()> {
        // Blocks of starts as the newest library plays them; more are played when a test needs them.
        let mut blocks: Vec<W::Played> = Vec::new();
        let mut validation = None;
        for mut candidate in finalists {
            if self.tests >= self.settings.tries {
                self.note(&candidate, None, Verdict::ScreenedOut, None);
                continue;
            }
            let Ok(variant) = self.current.edited(&candidate.proposal.edit) else {
                self.note(&candidate, None, Verdict::Superseded, None);
                continue;
            };
            candidate.variant = variant;
            candidate.wager = Wager::default();
            let needed = threshold(self.settings.error_rate, self.settings.tries, self.accepted);
            let changed = self.test(&mut candidate, &mut blocks, needed)?;
            if candidate.wager.e_value() < needed {
                self.note(&candidate, Some(needed), Verdict::Unconfirmed, None);
                continue;
            }
            self.accepted += 1;
            if self.validate(&candidate, needed, &mut validation)? {
                W::renew(self, &candidate, &mut blocks, changed)?;
                self.current = candidate.variant;
            }
        }
        Ok(())
    }

    /// The sequential test; what each look at it has left.
    fn test(
        &mut self,
        candidate: &mut Candidate,
        blocks: &mut Vec<W::Played>,
        needed: f64,
    ) -> LearnResult<Vec<W::Changed>> {
        self.tests += 1;
        let mut changed = Vec::new();
        for look in 0..W::TESTING.looks {
            if blocks.len() == look {
                blocks.push(W::fresh(self, StartStream::Confirmation)?);
            }
            changed.push(W::look(self, candidate, &blocks[look])?);
            let hopeless_z = W::TESTING.hopeless_z + look as f64 * W::TESTING.hopeless_step;
            if candidate.wager.e_value() >= needed || candidate.wager.z() < hopeless_z {
                break;
            }
        }
        Ok(changed)
    }

    /// Whether a confirmed change is taken over: the world does not object, and `cases check` has no new
    /// warning.
    fn validate(
        &mut self,
        candidate: &Candidate,
        needed: f64,
        kept: &mut Option<W::Played>,
    ) -> LearnResult<bool> {
        let warnings = |variant: &Variant| variant.warnings().map_err(LearnError::Library);
        if !warnings(&candidate.variant)?.is_subset(&warnings(&self.current)?) {
            self.note(candidate, Some(needed), Verdict::Warned, None);
            return Ok(false);
        }
        let (verdict, validation) = W::validate(self, candidate, kept)?;
        self.note(candidate, Some(needed), verdict, Some(validation));
        Ok(verdict == Verdict::Accepted)
    }

    /// Records what became of a candidate; `needed` is the e-value that its test had to reach.
    fn note(
        &mut self,
        candidate: &Candidate,
        needed: Option<f64>,
        verdict: Verdict,
        validation: Option<Validation>,
    ) {
        let Candidate { proposal, wager, share, .. } = candidate;
        let (round, proposal, wager, share) = (self.round, proposal.clone(), *wager, *share);
        self.changes.push(ChangeRecord { round, proposal, wager, share, needed, verdict, validation });
    }
}
