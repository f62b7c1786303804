//! `guest`: motion benchmark on the robot's processor. The bench's firmware image under QEMU, which counts
//! instructions.

use firmware_build::Program;
use firmware_build::count::CountingImage;
use workloads::motion::{Counted, SEED, TASKS, Tasks};

/// Counts for every task, in order; checked: the results equal this machine's, bit for bit.
pub(crate) fn counted() -> Result<Vec<Counted>, String> {
    let counted = CountingImage::new(Program::MotionBench)?.lines(&[], Counted::from_line, TASKS)?;
    for (number, (task, there)) in Tasks::new(SEED).zip(&counted).enumerate() {
        let here = Counted::of(&task, |work, task| (work.run(task), 0));
        if here.found != there.found {
            return Err(format!("task {number}: {} here, {} on the board", here.found, there.found));
        }
    }
    Ok(counted)
}
