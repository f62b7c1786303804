//! `search`: new cases by search. For situations from play, plans over the case actions are tried in
//! situations like them, and the best of each becomes a proposal.
//!
//! A plan that is best in one situation alone is mostly lucky there: of plans rolled out 40 times from a
//! single situation, seeming 20 points better, none was better in the situations around it. So a plan is
//! judged where its case would be played from the start.

use super::Trials;
use crate::learning::aim::Purpose;
use crate::learning::drafts::{choose, drafts, narrowed, without_demands};
use crate::learning::occasion::Occasion;
use crate::learning::proposals::{Kind, Proposal, kicks, weigh};
use crate::learning::run::{Candidate, LearnResult, Run};

impl Run<'_, Trials<'_>> {
    /// Proposals of new cases for some of these occasions, best first.
    pub(super) fn search(&mut self, occasions: &[Occasion]) -> LearnResult<Vec<Proposal>> {
        let ground = self.draw(occasions, Purpose::Search);
        let seed = self.settings.seed ^ (u64::from(self.round) << 32);
        let chosen = choose(occasions, self.world.sizes.situations, seed);
        let kicks = kicks(&self.current);
        // Candidates with the number of their occasion.
        let mut open: Vec<(usize, Candidate)> = Vec::new();
        for (number, occasion) in chosen.iter().enumerate() {
            for edit in drafts(&occasion.situation, &kicks, &self.current.files.rules) {
                // A plan that the checks refuse, such as a pass beyond its reach, is no plan.
                let Ok(variant) = self.current.edited(&edit) else { continue };
                let proposal = Proposal { kind: Kind::New, edit, reason: String::new(), weight: 0.0 };
                let touched = ground.touched(&proposal.edit, &variant);
                if touched.len() >= TOUCHED_MIN {
                    let candidate = Candidate::new(proposal, variant, (touched, ground.occasions.len()));
                    open.push((number, candidate));
                }
            }
        }
        let mut from = 0;
        for (to, keep) in STEPS {
            let (numbers, mut candidates): (Vec<_>, Vec<_>) = open.into_iter().unzip();
            self.try_situations(&ground, &mut candidates, from..to)?;
            open = numbers.into_iter().zip(candidates).collect();
            open.sort_by(|(i, a), (j, b)| {
                let better = b.promise().total_cmp(&a.promise());
                i.cmp(j).then(better).then_with(|| a.proposal.edit.cmp(&b.proposal.edit))
            });
            let mut place = (0, 0);
            open.retain(|(number, _)| {
                place = if place.0 == *number { (*number, place.1 + 1) } else { (*number, 1) };
                place.1 <= keep
            });
            from = to;
        }
        let mut proposals = Vec::new();
        for (_, candidate) in open.into_iter().filter(|(_, candidate)| candidate.promise() > 0.0) {
            let Candidate { proposal, wager, share, .. } = candidate;
            let reason = format!(
                "best of the plans tried in {} situations like one of play: {:+.0} points there",
                wager.pairs,
                wager.gain()
            );
            let weight = share * wager.gain();
            let proposed = |edit| Proposal { kind: Kind::New, edit, reason: reason.clone(), weight };
            proposals.extend(narrowed(&proposal.edit).map(&proposed));
            proposals.extend(without_demands(&proposal.edit).map(&proposed));
            proposals.push(proposed(proposal.edit));
        }
        proposals.sort_by(|a, b| b.weight.total_cmp(&a.weight).then_with(|| a.edit.cmp(&b.edit)));
        Ok(proposals)
    }

    /// Drafts from recordings that were not tried as often as others may be, heaviest first, as many as of
    /// other kinds.
    pub(super) fn recorded(&self) -> Vec<Proposal> {
        let fits = |proposal: &&Proposal| proposal.edit.apply(&self.current.files).is_ok();
        let proposals = self.world.drafts.iter().filter(fits).cloned().collect();
        let mut proposals = weigh(proposals, &self.current, &self.tried);
        proposals.truncate(self.world.sizes.proposals);
        proposals
    }
}

/// Pairs of a plan so far, and how many plans of an occasion go on.
const STEPS: [(usize, usize); 3] = [(8, 6), (20, 3), (48, 1)];
/// A plan that fewer of the drawn situations would play is none.
const TOUCHED_MIN: usize = 64;
