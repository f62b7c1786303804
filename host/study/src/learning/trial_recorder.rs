//! `trial_recorder`: what `onetwo trial --record` keeps: a trial's decisions as evidence, and its play where
//! it led to goal.

use arena::successful_plays::LeggedPlay;
use arena::{Moment, TrialReport, Watcher};

use crate::learning::collected::Collected;
use crate::learning::evidence::Evidence;
use crate::learning::trial::{LearningTrial, Recorder};
use crate::learning::variant::Variant;

/// Follows a trial, as a [`Watcher`].
#[derive(Clone, Debug, Default)]
pub struct TrialRecorder {
    recorder: Recorder,
    play: LeggedPlay,
    trial: Option<LearningTrial>,
}

impl TrialRecorder {
    /// Record once the trial is over: evidence of this library, world and opponents.
    pub fn collected(&self, library: &Variant, world: &str, opponents: &str) -> Collected {
        let mut evidence = Evidence::default();
        if let Some(trial) = &self.trial {
            evidence.add(library, world, opponents, trial);
        }
        Collected { evidence, plays: self.play.found().cloned().into_iter().collect() }
    }
}

impl Watcher for TrialRecorder {
    fn watch(&mut self, moment: &Moment<'_>) {
        self.recorder.watch(moment);
        self.play.watch(moment);
    }

    fn end(&mut self, moment: &Moment<'_>, report: &TrialReport) {
        self.recorder.end(moment, report);
        self.play.end(moment, report);
        self.trial = Some(std::mem::take(&mut self.recorder).trial(report));
    }
}
