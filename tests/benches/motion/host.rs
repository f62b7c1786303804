//! `host`: motion benchmark on this machine. This program itself under callgrind, which counts instructions.
//!
//! It does all tasks once and then twice; the difference excludes everything that happens once.

use std::hint::black_box;

use firmware_build::count::callgrind;
use workloads::motion::{MotionTask, SEED, TASKS, Tasks, Work};

/// Mean instructions per task.
pub(crate) fn instructions(work: Work) -> Result<u64, String> {
    Ok(counted(work, 2)?.saturating_sub(counted(work, 1)?) / TASKS as u64)
}

fn counted(work: Work, rounds: u32) -> Result<u64, String> {
    callgrind(&["--work", work.label(), &rounds.to_string()])
}

/// The workload under callgrind: all tasks, `rounds` times.
pub(crate) fn work(label: &str, rounds: &str) -> Result<(), String> {
    let work = Work::ALL.into_iter().find(|work| work.label() == label).ok_or("no such work")?;
    let rounds: u32 = rounds.parse().map_err(|_| "rounds")?;
    let tasks: Vec<MotionTask> = Tasks::new(SEED).take(TASKS).collect();
    let mut found = 0;
    for _ in 0..rounds {
        for task in &tasks {
            found ^= work.run(black_box(task));
        }
    }
    println!("{found}");
    Ok(())
}
