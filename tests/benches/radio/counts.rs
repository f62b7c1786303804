//! `counts`: figures of the radio benchmark, and their budgets. The firmware image's counts; its answers are
//! compared with this machine's.

use std::fmt::Write as _;

use firmware_build::Program;
use firmware_build::count::CountingImage;
use workloads::radio::{Bench, ROUNDS, Work};

/// One workload over all rounds.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Count {
    pub(crate) work: Work,
    /// Length of the frame.
    pub(crate) bytes: u32,
    /// Guest instructions of the most expensive round.
    pub(crate) worst: u32,
}

/// Counts of every workload; checked: the radio's results in the image equal those here.
pub(crate) fn counted() -> Result<Vec<Count>, String> {
    let lines = CountingImage::new(Program::RadioBench)?.lines(&[], numbers, ROUNDS * Work::ALL.len())?;
    let mut bench = Bench::new();
    let mut counts: Vec<Count> = Vec::new();
    for (line, (number, work)) in
        lines.iter().zip((0..ROUNDS).flat_map(|_| Work::ALL.into_iter().enumerate()))
    {
        let here = bench.task(work).run();
        if line[..2] != [number as u32, here] {
            return Err(format!("{}: {here} here, {} on the board", work.label(), line[1]));
        }
        match counts.get_mut(number) {
            Some(count) => count.worst = count.worst.max(line[2]),
            None => counts.push(Count { work, bytes: here % 1_000, worst: line[2] }),
        }
    }
    Ok(counts)
}

fn numbers(line: &str) -> Option<[u32; 3]> {
    let numbers: Vec<u32> = line.split(' ').map_while(|number| number.parse().ok()).collect();
    numbers.try_into().ok()
}

/// Budgets of docs/architecture.md §9, guest instructions for a frame to 32 B, and to 64 B.
const SHORT_FRAME_MAX: u32 = 1_300;
const LONG_FRAME_MAX: u32 = 2_400;

/// Maximum guest instructions for a frame of `bytes` bytes.
fn limit(bytes: u32) -> Option<u32> {
    match bytes {
        0..=32 => Some(SHORT_FRAME_MAX),
        33..=64 => Some(LONG_FRAME_MAX),
        // Worlds arrive at a robot a few hundred times a second; docs/architecture.md §9 names no budget for
        // them.
        _ => None,
    }
}

pub(crate) fn broken(counts: &[Count]) -> Vec<String> {
    let over = counts.iter().filter_map(|Count { work, bytes, worst }| {
        let limit = limit(*bytes).filter(|limit| worst > limit)?;
        Some(format!("{} ({bytes} B): {worst} instructions are over {limit}", work.label()))
    });
    over.collect()
}

pub(crate) fn table(counts: &[Count]) -> String {
    let mut text = "| what | frame, B | instructions | budget |\n|---|---:|---:|---:|\n".to_owned();
    for Count { work, bytes, worst } in counts {
        let limit = limit(*bytes).map_or("–".into(), |limit| limit.to_string());
        let _ = writeln!(text, "| {} | {bytes} | {worst} | {limit} |", work.label());
    }
    text
}
