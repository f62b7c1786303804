//! `retrieval_bench`: retrieval benchmark on the target. Retrieves for every problem in memory, with the
//! table beside them, by three methods: `retrieve_best`, `retrieve`, the plain scan; one line per answer,
//! instructions included.
//!
//! Needs `-icount shift=6`. `cargo xtask bench retrieval` puts table and problems into memory and reads the
//! lines.
#![allow(unsafe_code, reason = "registers, interrupts and flash are reached by address")]
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
#[path = "../lockstep/instructions.rs"]
mod instructions;

#[cfg(target_os = "none")]
mod measure {
    use core::hint::black_box;

    use casebase::{CaseBase, RetrievalSettings, retrieve, retrieve_best};
    use cortex_m_semihosting::{debug, hprintln};
    use panic_semihosting as _;
    use workloads::retrieval::{
        Answer, LEN_MAX, PROBLEMS_ADDRESS, TABLE_ADDRESS, behind_header, problems, scan,
    };
    // Links its functions of the run-time ABI.
    use runtime as _;

    use crate::instructions::{self, counted};

    #[cortex_m_rt::entry]
    fn main() -> ! {
        let core = cortex_m::Peripherals::take().expect("taken once, at start");
        instructions::start(core.SYST);
        let base = CaseBase::from_bytes(behind_header(memory(TABLE_ADDRESS))).expect("a table in memory");
        let settings = RetrievalSettings::default();
        // Instructions of the counting itself.
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
        // SAFETY: plain memory of the board that the firmware does not use (build.rs), never written after
        // the start.
        unsafe { core::slice::from_raw_parts(address as *const u8, LEN_MAX) }
    }
}

#[cfg(not(target_os = "none"))]
fn main() {}
