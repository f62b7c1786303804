//! `progress`: task supervision: the watchdog is fed only when every task has reported
//! (docs/architecture.md §1.1: runtime).

use core::sync::atomic::{AtomicU32, Ordering};

/// Parts that have to report that they run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RobotPart {
    /// The control loop of the wheels.
    Control = 1,
    /// The radio receiver, whether it receives something or not.
    Radio = 1 << 1,
    /// The brain: it has run.
    Brain = 1 << 2,
}

/// Parts that have run since the watchdog was fed last.
#[derive(Debug, Default)]
pub struct TaskProgress(AtomicU32);

impl TaskProgress {
    /// A record in which no part has reported yet.
    pub const fn new() -> Self {
        Self(AtomicU32::new(0))
    }

    /// Records that this part runs.
    pub fn mark(&self, part: RobotPart) {
        // Load and store, not a swap: all tasks of a robot run on one executor.
        self.0.store(self.0.load(Ordering::Relaxed) | part as u32, Ordering::Relaxed);
    }

    /// Returns whether all parts have run since the last time this was true.
    pub fn all(&self) -> bool {
        let all = self.0.load(Ordering::Relaxed) == ALL_PARTS;
        if all {
            self.0.store(0, Ordering::Relaxed);
        }
        all
    }
}

const ALL_PARTS: u32 = RobotPart::Control as u32 | RobotPart::Radio as u32 | RobotPart::Brain as u32;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_all_parts_together_count_and_only_once() {
        let progress = TaskProgress::new();
        for missing in [RobotPart::Control, RobotPart::Radio, RobotPart::Brain] {
            for part in [RobotPart::Control, RobotPart::Radio, RobotPart::Brain, RobotPart::Brain] {
                if part != missing {
                    progress.mark(part);
                }
            }
            assert!(!progress.all(), "{missing:?} is missing");
            progress.mark(missing);
            assert!(progress.all());
            assert!(!progress.all());
        }
    }
}
