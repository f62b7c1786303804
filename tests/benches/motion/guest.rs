//! `guest`: motion benchmark on the robot's processor. The bench's firmware image under QEMU, which counts
//! instructions.

use std::process::{Command, Stdio};

use firmware_build::{Install, MACHINE, Program, build_program, ensure_qemu, workspace_root};
use motion_bench::{Counted, SEED, TASKS, Tasks};

/// Counts for every task, in order; checked: the results equal this machine's, bit for bit.
pub(crate) fn counted() -> Result<Vec<Counted>, String> {
    let qemu = ensure_qemu(Install::ForUser).map_err(|error| error.to_string())?;
    let image = build_program(&workspace_root(), Program::MotionBench).map_err(|error| error.to_string())?;
    let output = Command::new(&qemu)
        .args(["-machine", MACHINE, "-display", "none", "-monitor", "none", "-serial", "none"])
        .args(["-icount", "shift=6,align=off", "-semihosting-config", "enable=on,target=native"])
        .arg("-kernel")
        .arg(&image)
        .stdin(Stdio::null())
        .output()
        .map_err(|error| format!("{} does not start: {error}", qemu.display()))?;
    let said = String::from_utf8_lossy(&output.stdout);
    let counted: Vec<Counted> = said.lines().filter_map(Counted::from_line).collect();
    if !output.status.success() || counted.len() != TASKS {
        let words = String::from_utf8_lossy(&output.stderr);
        return Err(format!(
            "the image ended with {} after {} of {TASKS} tasks: {words}",
            output.status,
            counted.len()
        ));
    }
    for (number, (task, there)) in Tasks::new(SEED).zip(&counted).enumerate() {
        let here = Counted::of(&task, |work, task| (work.run(task), 0));
        if here.found != there.found {
            return Err(format!("task {number}: {} here, {} on the board", here.found, there.found));
        }
    }
    Ok(counted)
}
