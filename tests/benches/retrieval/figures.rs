//! `figures`: figures of the retrieval benchmark, and their budgets.

use casebase::{CaseBase, Problem};
use workloads::retrieval::Answer;

/// Counts of one base and one set of problems.
#[derive(Clone, Debug)]
pub(crate) struct Figures {
    pub(crate) stored: usize,
    pub(crate) set: &'static str,
    pub(crate) problems: usize,
    pub(crate) bytes_per_case: f32,
    /// Number of cases whose scope contains the ball: mean and maximum.
    pub(crate) gated: [f64; 2],
    /// Guest instructions of `retrieve_best`, `retrieve` and the scan.
    pub(crate) guest: [Spread; 3],
    /// Instructions on this machine, mean a problem, the same three; `None` where not counted.
    pub(crate) host: Option<[u64; 3]>,
}

/// Median, 99th percentile, worst; and the mean.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Spread {
    pub(crate) median: u32,
    pub(crate) p99: u32,
    pub(crate) worst: u32,
    pub(crate) mean: f64,
}

impl Spread {
    pub(crate) fn of(counts: impl Iterator<Item = u32>) -> Self {
        let mut counts: Vec<u32> = counts.collect();
        counts.sort_unstable();
        let at = |share: f64| {
            let last = counts.len().saturating_sub(1);
            counts.get((last as f64 * share).round() as usize).copied().unwrap_or(0)
        };
        let mean = counts.iter().map(|count| f64::from(*count)).sum::<f64>() / counts.len().max(1) as f64;
        Self { median: at(0.5), p99: at(0.99), worst: at(1.0), mean }
    }
}

impl Figures {
    pub(crate) fn of(
        base: &CaseBase<'_>,
        set: &'static str,
        problems: &[Problem],
        answers: &[Answer],
        host: Option<[u64; 3]>,
    ) -> Self {
        let gated: Vec<usize> = problems.iter().map(|problem| inside_the_gate(base, problem)).collect();
        let sum: usize = gated.iter().sum();
        Self {
            stored: base.len(),
            set,
            problems: problems.len(),
            bytes_per_case: base.bytes_per_case(),
            gated: [
                sum as f64 / problems.len().max(1) as f64,
                gated.iter().copied().max().unwrap_or(0) as f64,
            ],
            guest: [0, 1, 2]
                .map(|method| Spread::of(answers.iter().map(|answer| answer.instructions[method]))),
            host,
        }
    }

    /// Budget of the mean instructions of a retrieval: a constant, plus an amount for each case that passes
    /// the test of the ball.
    pub(crate) fn mean_allowed(&self) -> f64 {
        f64::from(FIXED) + f64::from(PER_GATED) * self.gated[0]
    }

    /// Ratio of the scan's instructions to the retrieval's.
    pub(crate) fn ratio(&self) -> f64 {
        self.guest[2].mean / self.guest[0].mean
    }

    pub(crate) fn broken(&self) -> Vec<String> {
        let Self { stored, set, guest: [best, ..], .. } = self;
        let mut broken = Vec::new();
        let mut within = |what: &str, value: f64, limit: f64| {
            if value > limit {
                broken.push(format!("{stored} cases, {set} problems: {what} {value:.1} is over {limit:.1}"));
            }
        };
        let built_in = *stored == case_library::four_legged().len();
        if built_in && *set == PLAYED {
            within("median", f64::from(best.median), MEDIAN);
            within("worst", f64::from(best.worst), WORST);
        }
        // The same problems: random ones are reported, without a budget (casebase/README.md).
        if *stored >= LARGE && *set == PLAYED {
            within("mean", best.mean, self.mean_allowed());
            within("worst", f64::from(best.worst), LARGE_WORST);
        }
        if *stored >= LARGE {
            within("scan / retrieval, inverted,", 1.0 / self.ratio(), 1.0 / SCAN_RATIO);
        }
        if built_in {
            within("bytes a case", f64::from(self.bytes_per_case), BYTES);
        }
        broken
    }
}

/// Number of cases under the goal whose scope contains the ball.
fn inside_the_gate(base: &CaseBase<'_>, problem: &Problem) -> usize {
    let inside =
        |case: &casebase::Case<'_>| case.defending() == problem.defending && case.ball_in_scope(problem.ball);
    base.cases().filter(inside).count()
}

/// The set of problems that robots retrieved for.
pub(crate) const PLAYED: &str = "played";

// docs/architecture.md §9, guest instructions and bytes.
const MEDIAN: f64 = 1_500.0;
const WORST: f64 = 12_000.0;
const LARGE: usize = 10_000;
const FIXED: u32 = 400;
const PER_GATED: u32 = 60;
const LARGE_WORST: f64 = 60_000.0;
const SCAN_RATIO: f64 = 10.0;
const BYTES: f64 = 96.0;
