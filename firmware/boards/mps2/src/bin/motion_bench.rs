//! `motion_bench`: motion benchmark on the target. Counts the instructions of every work on every task of a
//! seed; a line a task.
//!
//! Needs `-icount shift=6`. `cargo xtask bench motion` starts it and reads the lines.
#![allow(unsafe_code, reason = "registers, interrupts and flash are reached by address")]
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
#[path = "../lockstep/instructions.rs"]
mod instructions;

#[cfg(target_os = "none")]
mod measure {
    use core::hint::black_box;

    use cortex_m_semihosting::{debug, hprintln};
    use panic_semihosting as _;
    use workloads::motion::{Counted, SEED, TASKS, Tasks};
    // Links its functions of the run-time ABI.
    use runtime as _;

    use crate::instructions::{self, counted};

    #[cortex_m_rt::entry]
    fn main() -> ! {
        let core = cortex_m::Peripherals::take().expect("taken once, at start");
        instructions::start(core.SYST);
        // Instructions of the counting itself.
        let ((), idle) = counted(|| ());
        for task in Tasks::new(SEED).take(TASKS) {
            let counts = Counted::of(&task, |work, task| {
                let (bits, count) = counted(|| work.run(black_box(task)));
                (black_box(bits), count.saturating_sub(idle))
            });
            hprintln!("{}", counts);
        }
        loop {
            debug::exit(debug::EXIT_SUCCESS);
        }
    }
}

#[cfg(not(target_os = "none"))]
fn main() {}
