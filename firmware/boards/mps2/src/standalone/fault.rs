//! `fault`: fault handler: motors off, crash record kept and reported, restart (docs/architecture.md §6.2).
//!
//! A record in memory that no start clears outlives the reset: the number of starts since power-on, and what
//! ended the last boot epoch.

use core::mem::MaybeUninit;
use core::panic::PanicInfo;
use core::sync::atomic::{AtomicBool, Ordering};

use cortex_m::peripheral::SCB;
use cortex_m_rt::{ExceptionFrame, exception};
use runtime::ending::Ending;

use super::console::print;
use crate::parts;

#[derive(Clone, Copy)]
pub(crate) struct CrashContext {
    /// Starts since power-on, this one included.
    pub(crate) boots: u32,
    /// Panics and faults since power-on.
    pub(crate) panics: u32,
    place: [u8; PLACE_LEN],
    place_len: usize,
    /// Not 0: the watchdog ended the last boot epoch. No `bool`, because uninitialized memory may hold any
    /// value.
    bitten: u32,
    magic: u32,
}

impl CrashContext {
    const FIRST: Self =
        Self { boots: 0, panics: 0, place: [0; PLACE_LEN], place_len: 0, bitten: 0, magic: MAGIC };

    /// File and line of the last panic.
    pub(crate) fn place(&self) -> &[u8] {
        self.place.get(..self.place_len).unwrap_or_default()
    }
}

/// Counts this start; must be called once, before anything else.
pub(crate) fn crash_context() -> CrashContext {
    let mut crash_context = with(|crash_context| *crash_context);
    if crash_context.magic != MAGIC {
        crash_context = CrashContext::FIRST;
    }
    crash_context.boots = crash_context.boots.wrapping_add(1);
    BITTEN.store(crash_context.bitten != 0, Ordering::Relaxed);
    let start = crash_context;
    // Reported once: the next boot epoch has its own end.
    crash_context.bitten = 0;
    with(|kept| *kept = crash_context);
    start
}

pub(crate) fn is_first_epoch() -> bool {
    with(|crash_context| crash_context.boots) == 1
}

pub(crate) fn was_bitten() -> bool {
    BITTEN.load(Ordering::Relaxed)
}

pub(crate) fn remember_bite() {
    with(|crash_context| crash_context.bitten = 1);
}

static BITTEN: AtomicBool = AtomicBool::new(false);

#[panic_handler]
fn panic(info: &PanicInfo<'_>) -> ! {
    parts::stop();
    cortex_m::interrupt::disable();
    ended(Ending::Panic(info.location()))
}

#[exception]
unsafe fn HardFault(frame: &ExceptionFrame) -> ! {
    parts::stop();
    ended(Ending::Fault(frame.pc()))
}

/// Keeps and prints the place, then restarts.
fn ended(how: Ending<'_>) -> ! {
    with(|crash_context| {
        crash_context.panics = crash_context.panics.wrapping_add(1);
        crash_context.place_len = how.write(&mut crash_context.place);
    });
    print(&[b"panic at ", with(|crash_context| *crash_context).place(), b"; motors off, restarting"]);
    SCB::sys_reset()
}

/// Access to the record. A panic never interrupts another access: the record is used at the start, in the
/// watchdog's NMI, and here.
fn with<T>(work: impl FnOnce(&mut CrashContext) -> T) -> T {
    #[unsafe(link_section = ".uninit.life")]
    static mut BOOT_EPOCH: MaybeUninit<CrashContext> = MaybeUninit::uninit();
    // SAFETY: one processor, and no two of its users run at the same time. The record consists of integers,
    // for which every bit pattern is valid; a start whose `magic` is wrong replaces all of it.
    unsafe { work(&mut *(&raw mut BOOT_EPOCH).cast::<CrashContext>()) }
}

/// Bytes of a place that are kept.
const PLACE_LEN: usize = 96;
const MAGIC: u32 = 0x0121_fe50;
