//! `pairs`: trials with a change beside those without it: of single situations, and whole ones.

use std::ops::Range;

use casebase::CaseBase;
use rayon::prelude::*;

use super::{GROUPS, Played, Trials, group};
use crate::learning::aim::Ground;
use crate::learning::betting::Wager;
use crate::learning::edit::Edit;
use crate::learning::null_control;
use crate::learning::occasion::Occasion;
use crate::learning::paired::Pairs;
use crate::learning::player::Playable;
use crate::learning::proposals::Proposal;
use crate::learning::run::{Candidate, LearnResult, Run};
use crate::learning::starts::kind_of;
use crate::learning::trial::LearningTrial;
use crate::learning::variant::Variant;
use crate::learning::work::{Unit, Work};

impl Run<'_, Trials<'_>> {
    /// Plays the pairs of candidates in some of the situations that each changes.
    pub(super) fn try_situations(
        &mut self,
        ground: &Ground,
        tried: &mut [Candidate],
        range: Range<usize>,
    ) -> LearnResult<()> {
        let mut units = Vec::new();
        for candidate in &*tried {
            for number in candidate.chosen(&range) {
                let work = one_trial(&ground.occasions[number], number as u32);
                for variant in [&candidate.variant, &self.current] {
                    units.push(Unit { variant, work: work.clone() });
                }
            }
        }
        for unit in &units {
            self.spent += u64::from(self.asked.insert(unit.key()));
        }
        let played = self.world.player.play(&units)?;
        let to_goal: Vec<bool> = played.iter().flatten().map(LearningTrial::to_goal).collect();
        let mut pairs = to_goal.chunks_exact(2);
        drop(units);
        let purpose = ground.purpose as u8 + PURPOSES_FROM;
        for candidate in tried {
            candidate.groups.resize(GROUPS, Wager::default());
            for (number, pair) in candidate.chosen(&range).into_iter().zip(pairs.by_ref()) {
                let edit = &candidate.proposal.edit;
                let swaps = null_control::swaps(self.settings, edit, purpose, number as u32);
                let (with, without) = (pair[usize::from(swaps)], pair[usize::from(!swaps)]);
                candidate.wager.add(with, without);
                candidate.groups[group(&ground.occasions[number])].add(with, without);
            }
        }
        Ok(())
    }

    /// Plays a candidate on the starts of `without` that it can have an effect on; the others are equal
    /// pairs. Returns the trials that were played too, by their place in `without`.
    pub(super) fn whole_trials(
        &mut self,
        candidate: &Candidate,
        without: &Played,
    ) -> LearnResult<(Pairs, Vec<(usize, LearningTrial)>)> {
        let Candidate { proposal: Proposal { edit, .. }, variant, .. } = candidate;
        let base = variant.base();
        let all = (0..without.trials.len()).into_par_iter();
        let chosen: Vec<usize> = all.filter(|i| affects(edit, variant, &base, without, *i)).collect();
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
}

/// One trial from a situation, with this number of its seed.
fn one_trial(occasion: &Occasion, number: u32) -> Work {
    let Occasion { situation, profile, two_defenders, .. } = occasion;
    Work::Situation {
        situation: situation.clone(),
        profile: *profile,
        two_defenders: *two_defenders,
        first: number,
        trials: 1,
    }
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

/// Numbers of purposes in the null control's chance lie behind those of streams of starts.
const PURPOSES_FROM: u8 = 16;

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::learning::edit::Change;
    use crate::learning::starts::StartStream;

    fn played(variant: &Variant, record: bool) -> Vec<LearningTrial> {
        let stream = StartStream::Exploration;
        let work = Work::Starts { stream, indices: (0..96).collect(), record };
        Unit { variant, work }.play(9).unwrap()
    }

    #[test]
    fn an_edit_leaves_the_trials_equal_that_it_does_not_affect() {
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
