//! `retrieval_bench`: retrieval benchmark on the target. Retrieves for every problem that lies in memory,
//! with the table beside them, three ways: `retrieve_best`, `retrieve`, the plain scan; an answer a line,
//! instructions included.
//!
//! Needs `-icount shift=6`. `cargo xtask bench retrieval` puts table and problems there and reads the lines.
#![allow(unsafe_code, reason = "registers, interrupts and flash are reached by address")]
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
#[path = "../robot/instructions.rs"]
mod instructions;

#[cfg(target_os = "none")]
mod measure {
    use core::hint::black_box;

    use casebase::{CaseBase, Settings, retrieve, retrieve_best};
    use cortex_m_semihosting::{debug, hprintln};
    use panic_semihosting as _;
    use retrieval_bench::{Answer, LEN_MAX, PROBLEMS_ADDRESS, TABLE_ADDRESS, behind_header, problems, scan};
    // For its functions of the run-time ABI.
    use runtime as _;

    use crate::instructions::{self, counted};

    #[cortex_m_rt::entry]
    fn main() -> ! {
        let core = cortex_m::Peripherals::take().expect("nobody took them before");
        instructions::start(core.SYST);
        let base = CaseBase::from_bytes(behind_header(memory(TABLE_ADDRESS))).expect("a table in memory");
        let settings = Settings::default();
        // What counting itself takes.
        let ((), idle) = counted(|| ());
        for problem in problems(memory(PROBLEMS_ADDRESS)) {
            let (best, first) = counted(|| retrieve_best(black_box(&base), black_box(&problem), &settings));
            let (all, second) = counted(|| retrieve(black_box(&base), black_box(&problem), &settings));
            let (plain, third) = counted(|| scan(black_box(&base), black_box(&problem)));
            let instructions = [first, second, third].map(|count| count.saturating_sub(idle));
            hprintln!("{}", Answer::new(best.as_ref(), &all, &plain, instructions));
        }
        loop {
            debug::exit(debug::EXIT_SUCCESS);
        }
    }

    fn memory(address: usize) -> &'static [u8] {
        // SAFETY: plain memory of the board that the image does not use (build.rs), and nobody writes after the start.
        unsafe { core::slice::from_raw_parts(address as *const u8, LEN_MAX) }
    }
}

#[cfg(not(target_os = "none"))]
fn main() {}
