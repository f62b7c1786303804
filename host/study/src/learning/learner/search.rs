//! `search`: new cases by search. For situations from play, plans over the case actions are tried in
//! situations like them, and the best of each becomes a proposal.
//!
//! A plan that is best in one situation alone is mostly lucky there: of plans rolled out 40 times from a
//! single situation, seeming 20 points better, none was better in the situations around it. So a plan is
//! judged where its case would be played from the start.

use super::judging::promise;
use super::{Candidate, LearnError, Run};
use crate::learning::aim::{Ground, Purpose};
use crate::learning::drafts::{choose, drafts, narrowed, without_demands};
use crate::learning::occasion::Occasion;
use crate::learning::proposals::{Kind, Proposal, kicks, weigh};
use crate::learning::variant::Variant;
use crate::learning::work::Player;

impl<P: Player> Run<'_, P> {
    /// Proposals of new cases for some of these occasions, best first.
    pub(super) fn search(
        &mut self,
        current: &Variant,
        occasions: &[Occasion],
        round: u32,
    ) -> Result<Vec<Proposal>, LearnError> {
        let seed = self.settings.seed;
        let ground = Ground::draw(occasions, Purpose::Search, self.sizes.screen, seed, round, current);
        let chosen = choose(occasions, self.sizes.situations, seed ^ (u64::from(round) << 32));
        let kicks = kicks(current);
        // Candidates with the number of their occasion.
        let mut open: Vec<(usize, Candidate)> = Vec::new();
        for (number, occasion) in chosen.iter().enumerate() {
            for edit in drafts(&occasion.situation, &kicks, &current.files.rules) {
                // A plan that the checks refuse, such as a pass beyond its reach, is no plan.
                let Ok(variant) = current.edited(&edit) else { continue };
                let proposal = Proposal { kind: Kind::New, edit, reason: String::new(), weight: 0.0 };
                let candidate = Candidate::new(proposal, variant, &ground);
                if candidate.touched.len() >= LEAST_SITUATIONS {
                    open.push((number, candidate));
                }
            }
        }
        let mut from = 0;
        for (to, keep) in STEPS {
            let (numbers, mut candidates): (Vec<_>, Vec<_>) = open.into_iter().unzip();
            self.try_situations(current, &ground, &mut candidates, from..to)?;
            open = numbers.into_iter().zip(candidates).collect();
            open.sort_by(|(i, a), (j, b)| {
                let better = promise(b).total_cmp(&promise(a));
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
        for (_, candidate) in open.into_iter().filter(|(_, candidate)| promise(candidate) > 0.0) {
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
    pub(super) fn recorded(&self, current: &Variant) -> Vec<Proposal> {
        let fits = |proposal: &&Proposal| proposal.edit.apply(&current.files).is_ok();
        let proposals = self.drafts.iter().filter(fits).cloned().collect();
        let mut proposals = weigh(proposals, current, &self.tried);
        proposals.truncate(self.sizes.proposals);
        proposals
    }
}

/// Pairs of a plan so far, and how many plans of an occasion go on.
const STEPS: [(usize, usize); 3] = [(8, 6), (20, 3), (48, 1)];
/// A plan that fewer of the drawn situations would play is none.
const LEAST_SITUATIONS: usize = 64;
