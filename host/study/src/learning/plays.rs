//! `plays`: plays to watch: held-out starts that the learned library brings to goal and the one before does
//! not.

use serde::Serialize;

use crate::learning::starts::{StartPlan, StartStream, kind_of};

/// A trial that can be played and watched again.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct PlayToWatch {
    /// The scenario, as `onetwo trial --scenario` takes it.
    pub scenario: &'static str,
    /// The opponents, as `--opponents` takes them.
    pub opponents: &'static str,
    /// The world, as `--profile` takes it.
    pub profile: &'static str,
    /// The seed.
    pub seed: u64,
}

impl PlayToWatch {
    /// The command that shows it with a library in `directory`.
    pub fn command(&self, directory: &str) -> String {
        let Self { scenario, opponents, profile, seed } = self;
        format!(
            "onetwo trial --library {directory} --scenario {scenario} --opponents {opponents} --profile {profile} --seed {seed} --watch"
        )
    }
}

/// Starts that came to goal after learning and not before, of different kinds where there are; `before` and
/// `after` tell it of the held-out starts with these indices of a run with this seed.
pub(crate) fn plays_to_watch(
    seed: u64,
    indices: &[u32],
    before: &[bool],
    after: &[bool],
) -> Vec<PlayToWatch> {
    let pairs = || indices.iter().copied().zip(before.iter().zip(after));
    let raised = || pairs().filter(|(_, (before, after))| !**before && **after);
    let mut chosen: Vec<u32> = Vec::new();
    for of_new_kinds in [true, false] {
        for (index, _) in raised() {
            let known = chosen
                .iter()
                .any(|other| *other == index || (of_new_kinds && kind_of(*other).0 == kind_of(index).0));
            if chosen.len() < PLAYS_MAX && !known {
                chosen.push(index);
            }
        }
    }
    let plan = StartPlan::new(seed, StartStream::HeldOut);
    let starts = chosen.into_iter().filter_map(|index| plan.get(index));
    let plays = starts.map(|start| PlayToWatch {
        scenario: start.cell.scenario.label(),
        opponents: start.cell.configuration.label(),
        profile: start.cell.profile.label(),
        seed: start.seed,
    });
    plays.collect()
}

/// Plays that are listed.
const PLAYS_MAX: usize = 3;

#[cfg(test)]
mod tests {
    use super::*;

    fn plays_to_watch(seed: u64, before: &[bool], after: &[bool]) -> Vec<PlayToWatch> {
        let indices: Vec<u32> = (0..before.len() as u32).collect();
        super::plays_to_watch(seed, &indices, before, after)
    }

    #[test]
    fn plays_are_of_different_kinds_where_there_are_enough() {
        let before = [false, true, false, false, false, true, false, false, false, false];
        let after = [true, true, false, false, false, false, true, true, false, true];
        // Starts 0 and 6 are random ones against the same opponents, 7 and 9 are others.
        let plays = plays_to_watch(7, &before, &after);
        let plan = StartPlan::new(7, StartStream::HeldOut);
        let seeds: Vec<u64> =
            [0, 7, 9].into_iter().filter_map(|i| plan.get(i)).map(|start| start.seed).collect();
        assert_eq!(plays.iter().map(|play| play.seed).collect::<Vec<_>>(), seeds);
        let kinds: Vec<_> = plays.iter().map(|play| (play.scenario, play.opponents)).collect();
        assert!(kinds[0] != kinds[1] && kinds[1] != kinds[2], "{kinds:?}");
        // Where only one kind is raised, all of it is taken.
        let alike: Vec<bool> = (0..24).map(|i| i % 6 == 0).collect();
        assert_eq!(plays_to_watch(7, &[false; 24], &alike).len(), 3);
        assert!(plays_to_watch(7, &before, &before).is_empty());
        assert!(
            plays[0].command("four-legged").starts_with("onetwo trial --library four-legged --scenario ")
        );
    }
}
