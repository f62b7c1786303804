//! `figures`: figures of the motion benchmark, their budgets, and their table in firmware/motion/README.md.

use std::fmt::Write as _;

use workloads::motion::{Counted, TASKS, Work};

/// Counts of one workload over all tasks.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Figure {
    pub(crate) work: Work,
    /// Guest instructions.
    pub(crate) mean: u32,
    pub(crate) p99: u32,
    pub(crate) worst: u32,
    /// Mean on this machine; `None` where not counted.
    pub(crate) host: Option<u64>,
}

#[derive(Clone, Debug)]
pub(crate) struct Figures(pub(crate) Vec<Figure>);

impl Figures {
    pub(crate) fn of(counted: &[Counted], host: [Option<u64>; Work::ALL.len()]) -> Self {
        let figure = |(i, work): (usize, Work)| {
            let mut counts: Vec<u32> = counted.iter().map(|counted| counted.instructions[i]).collect();
            counts.sort_unstable();
            let at = |share: usize| counts.get((counts.len() - 1) * share / 100).copied().unwrap_or(0);
            let sum: u64 = counts.iter().map(|count| u64::from(*count)).sum();
            let mean = (sum / counts.len() as u64) as u32;
            Figure { work, mean, p99: at(99), worst: at(100), host: host[i] }
        };
        Self(Work::ALL.into_iter().enumerate().map(figure).collect())
    }

    pub(crate) fn broken(&self) -> Vec<String> {
        let mut broken = Vec::new();
        for Figure { work, mean, worst, host, .. } in &self.0 {
            let mut within = |what: &str, value: u64, limit: u64| {
                if value > limit {
                    broken.push(format!("{}: {what} {value} is over {limit}", work.label()));
                }
            };
            let Limits { mean: mean_limit, worst: worst_limit, host: host_limit } = limits(*work);
            within("the mean of guest instructions", u64::from(*mean), mean_limit);
            within("the worst of guest instructions", u64::from(*worst), worst_limit);
            within("the mean of this machine's instructions", host.unwrap_or(0), host_limit);
        }
        broken
    }

    pub(crate) fn table(&self) -> String {
        let mut text = format!("{HEAD}\n");
        for Figure { work, mean, p99, worst, host } in &self.0 {
            let host = host.map_or("–".into(), |mean| mean.to_string());
            let limits = limits(*work);
            let _ = writeln!(
                text,
                "| {} | {mean} / {p99} / {worst} | {} / {} | {host} | {} |",
                what(*work),
                limit_text(limits.mean),
                limit_text(limits.worst),
                limit_text(limits.host),
            );
        }
        text + &format!(
            "\n{TASKS} tasks; instructions of the robot's processor are exact, so they are the same anywhere.\n"
        )
    }
}

struct Limits {
    mean: u64,
    worst: u64,
    host: u64,
}

/// Budgets of docs/architecture.md §9 for a planned motion without drag, guest and host instructions, and
/// with drag.
const FREE_GUEST_MAX: u64 = 1_500;
const FREE_HOST_MAX: u64 = 2_500;
const DRAG_HOST_MAX: u64 = 6_000;

fn limits(work: Work) -> Limits {
    const NONE: u64 = u64::MAX;
    let limits = |mean, worst, host| Limits { mean, worst, host };
    match work {
        Work::FreeTime | Work::FreePlan => limits(FREE_GUEST_MAX, FREE_GUEST_MAX, FREE_HOST_MAX),
        Work::DragTime | Work::DragPlan => limits(NONE, NONE, DRAG_HOST_MAX),
        // Measured values with a margin: so that an increase is noticed.
        Work::FreeState => limits(250, 300, NONE),
        Work::Soonest | Work::Safest => limits(17_000, 120_000, NONE),
        Work::Avoid | Work::AvoidMoving => limits(12_000, 28_000, NONE),
    }
}

fn limit_text(limit: u64) -> String {
    if limit == u64::MAX { "–".into() } else { limit.to_string() }
}

fn what(work: Work) -> &'static str {
    match work {
        Work::FreeTime => "time, drag-free",
        Work::FreePlan => "motion, drag-free",
        Work::FreeState => "... its state at one time",
        Work::DragTime => "time, with drag",
        Work::DragPlan => "motion, with drag",
        Work::Soonest => "soonest interception, ball followed for 5 s",
        Work::Safest => "interception with most slack, 5 s",
        Work::Avoid => "a step around 12 discs and 4 shapes",
        Work::AvoidMoving => "... whose discs move",
    }
}

const HEAD: &str = "\
| what | thumbv7em: mean / 99 % / worst | budget: mean / worst | on the PC, mean | budget |
|---|---:|---:|---:|---:|";
