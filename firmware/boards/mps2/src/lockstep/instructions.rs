//! `instructions`: instruction counter, read from the system timer where the emulator counts instructions.
//!
//! QEMU with `-icount shift=6` lets each guest instruction take 2⁶ = 64 ns of virtual time; the timer ticks
//! at 25 MHz, once in 40 ns. So a count is exact, up to the timer's 24 bits: 10.4 million instructions.
//! Without `-icount` it is noise.

use cortex_m::peripheral::SYST;
use cortex_m::peripheral::syst::SystClkSource;

/// Starts the timer; call once.
pub(crate) fn start(mut timer: SYST) {
    timer.set_clock_source(SystClkSource::Core);
    timer.set_reload(TIMER_MASK);
    timer.clear_current();
    timer.enable_counter();
}

/// Runs the work; returns its result, and the number of instructions.
pub(crate) fn counted<T>(work: impl FnOnce() -> T) -> (T, u32) {
    let before = SYST::get_current();
    let result = work();
    // The timer counts down.
    let ticks = before.wrapping_sub(SYST::get_current()) & TIMER_MASK;
    let nanoseconds = u64::from(ticks) * TICK_NS;
    (result, ((nanoseconds + INSTRUCTION_NS / 2) / INSTRUCTION_NS) as u32)
}

const TIMER_MASK: u32 = 0x00ff_ffff;
/// Length of a timer tick at 25 MHz, ns.
const TICK_NS: u64 = 40;
/// Time of an instruction with `-icount shift=6`, ns.
const INSTRUCTION_NS: u64 = 1 << 6;
