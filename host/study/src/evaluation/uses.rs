//! `uses`: use of each case. How often it was retrieved, how its plays ended, and how the trials ended in
//! which it was played.
//!
//! One line a case and kind of trial (profile, opponents, approach), cases that were never retrieved among
//! them: `cases.csv`.

use brain::Approach;
use hil_sim::{Configuration, TrialOutcome};

use super::row::TrialRow;
use arena::{CycleEnd, Profile, approach_label};

/// A case in all trials of a kind.
#[derive(Clone, Debug, PartialEq)]
pub struct CaseUse {
    /// The world of these trials.
    pub profile: Profile,
    /// Opponents in these trials.
    pub configuration: Configuration,
    /// Approach of the attackers.
    pub approach: Approach,
    /// Name of the case, `region/name`.
    pub case: String,
    /// Number of times it was played.
    pub retrieved: u32,
    /// Counts of the ends of these plays, in the order of [`CycleEnd::LABELS`].
    pub ends: [u32; CycleEnd::LABELS.len()],
    /// Trials in which it was played.
    pub trials: u32,
    /// Counts of the outcomes, in the order of [`OUTCOMES`].
    pub outcomes: [u32; OUTCOMES.len()],
}

/// All outcomes, in the order of tables.
pub const OUTCOMES: [TrialOutcome; 5] =
    [TrialOutcome::Goal, TrialOutcome::Close, TrialOutcome::Block, TrialOutcome::Out, TrialOutcome::Timeout];

/// The uses of `cases` (`region/name`), by kind of trial as the rows come, then in the order of `cases`.
pub fn uses(rows: &[TrialRow], cases: &[String]) -> Vec<CaseUse> {
    let mut kinds: Vec<(Profile, Configuration, Approach)> = Vec::new();
    let mut uses: Vec<CaseUse> = Vec::new();
    for row in rows.iter().filter(|row| row.approach != Approach::Reactive) {
        let kind = (row.profile, row.configuration, row.approach);
        let place = kinds.iter().position(|known| *known == kind).unwrap_or_else(|| {
            kinds.push(kind);
            uses.extend(cases.iter().map(|case| CaseUse::new(kind, case)));
            kinds.len() - 1
        });
        let own = &mut uses[place * cases.len()..][..cases.len()];
        let mut seen = vec![false; cases.len()];
        for play in row.plays.split_whitespace() {
            let Some((name, end)) = play.rsplit_once(':') else { continue };
            let Some(case) = cases.iter().position(|case| case == name) else { continue };
            own[case].count(end);
            seen[case] = true;
        }
        for (case, _) in own.iter_mut().zip(seen).filter(|(_, seen)| *seen) {
            case.trials += 1;
            let ends = OUTCOMES.iter().zip(&mut case.outcomes);
            ends.filter(|(outcome, _)| **outcome == row.outcome).for_each(|(_, count)| *count += 1);
        }
    }
    uses
}

impl CaseUse {
    fn new((profile, configuration, approach): (Profile, Configuration, Approach), case: &str) -> Self {
        let case = case.to_owned();
        let (ends, outcomes) = ([0; CycleEnd::LABELS.len()], [0; OUTCOMES.len()]);
        Self { profile, configuration, approach, case, retrieved: 0, ends, trials: 0, outcomes }
    }

    fn count(&mut self, end: &str) {
        self.retrieved += 1;
        let ends = CycleEnd::LABELS.iter().zip(&mut self.ends);
        ends.filter(|(label, _)| **label == end).for_each(|(_, count)| *count += 1);
    }

    /// Number of plays in which every robot completed its part.
    pub const fn finished(&self) -> u32 {
        self.ends[0]
    }
}

/// The uses as the text of `cases.csv`, one line a case and kind of trial.
pub fn uses_to_csv(uses: &[CaseUse]) -> Result<Vec<u8>, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let columns = ["profile", "configuration", "approach", "case", "retrieved"].into_iter();
    let outcomes = OUTCOMES.iter().map(|outcome| outcome.label());
    let outcomes = outcomes.map(|outcome| format!("trials_{outcome}"));
    let header = columns.chain(CycleEnd::LABELS).chain(["trials"]).map(str::to_owned).chain(outcomes);
    writer.write_record(header)?;
    for case in uses {
        let CaseUse { profile, configuration, approach, case, retrieved, ends, trials, outcomes } = case;
        let labels = [profile.label(), configuration.label(), approach_label(*approach), case];
        let counts = [retrieved].into_iter().chain(ends).chain([trials]).chain(outcomes);
        writer.write_record(labels.map(str::to_owned).into_iter().chain(counts.map(u32::to_string)))?;
    }
    writer.into_inner().map_err(|error| error.into_error().into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluation::row::tests::row;

    #[test]
    fn a_play_counts_for_its_case_and_a_trial_once() {
        let trial = |outcome, plays: &str| TrialRow { outcome, plays: plays.to_owned(), ..row() };
        let rows = [
            trial(TrialOutcome::Goal, "a/x:finished a/x:timeout b/y:opponent-on-ball"),
            trial(TrialOutcome::Out, "a/x:finished"),
            trial(TrialOutcome::Out, ""),
        ];
        let names = ["a/x", "b/y", "c/z"].map(str::to_owned);
        let uses = uses(&rows, &names);
        let counts: Vec<_> =
            uses.iter().map(|u| (u.retrieved, u.finished(), u.trials, u.outcomes[0])).collect();
        assert_eq!(counts, [(3, 2, 2, 1), (1, 0, 1, 1), (0, 0, 0, 0)]);
        let csv = String::from_utf8(uses_to_csv(&uses).unwrap()).unwrap();
        let mut lines = csv.lines();
        assert_eq!(
            lines.next(),
            Some(
                "profile,configuration,approach,case,retrieved,finished,ball-out-of-scope,path-blocked,robot-lost,\
                 action-failed,opponent-on-ball,ball-at-rest,timeout,no-decision,unknown-case,reassigned,game-stopped,\
                 superseded,trial-over,\
                 trials,trials_goal,trials_close,trials_block,trials_out,trials_timeout"
            )
        );
        assert_eq!(lines.next(), Some("simulated,dg,cbr,a/x,3,2,0,0,0,0,0,0,1,0,0,0,0,0,0,2,1,0,0,1,0"));
    }

    #[test]
    fn every_end_is_counted_by_its_label() {
        let reactive = TrialRow { approach: Approach::Reactive, plays: "a/x:finished".to_owned(), ..row() };
        assert!(uses(&[reactive], &["a/x".to_owned()]).is_empty());
        for label in CycleEnd::LABELS {
            let row = TrialRow { plays: format!("a/x:{label}"), ..row() };
            assert_eq!(uses(&[row], &["a/x".to_owned()])[0].ends.iter().sum::<u32>(), 1, "{label}");
        }
    }
}
