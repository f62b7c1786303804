//! Does this processor's mathematics give the PC's bits? Exit code 0 if the golden hash is the PC's, else 1. (DESIGN §2)
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
use panic_semihosting as _;

#[cfg(target_os = "none")]
#[cortex_m_rt::entry]
fn main() -> ! {
    use cortex_m_semihosting::{debug, hprintln};
    use geometry::math::{GOLDEN_HASH, GOLDEN_ROUNDS, golden_hash};

    let hash = golden_hash(GOLDEN_ROUNDS);
    hprintln!("{:#018x}", hash);
    loop {
        debug::exit(if hash == GOLDEN_HASH { debug::EXIT_SUCCESS } else { debug::EXIT_FAILURE });
    }
}

#[cfg(not(target_os = "none"))]
fn main() {}
