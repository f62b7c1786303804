//! `radio_bench`: radio benchmark on the target. Counts the instructions of every work several times; a line
//! each: `number of the work, result, instructions`.
//!
//! Needs `-icount shift=6`. `cargo xtask bench radio` starts it and reads the lines.
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
    use workloads::radio::{Bench, ROUNDS, Work};
    // Links its functions of the run-time ABI.
    use runtime as _;

    use crate::instructions::{self, counted};

    #[cortex_m_rt::entry]
    fn main() -> ! {
        let core = cortex_m::Peripherals::take().expect("taken once, at start");
        instructions::start(core.SYST);
        // Instructions of the counting itself.
        let ((), idle) = counted(|| ());
        let mut bench = Bench::new();
        for _ in 0..ROUNDS {
            for (number, work) in Work::ALL.into_iter().enumerate() {
                let mut task = bench.task(work);
                let (gave, count) = counted(|| black_box(&mut task).run());
                hprintln!("{} {} {}", number, gave, count.saturating_sub(idle));
            }
        }
        loop {
            debug::exit(debug::EXIT_SUCCESS);
        }
    }
}

#[cfg(not(target_os = "none"))]
fn main() {}
