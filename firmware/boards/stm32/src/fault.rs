//! `fault`: fault handler: everything off, crash record kept and reported, restart
//! (docs/architecture.md §6.2).
//!
//! The record is kept in the calendar's backup registers: a reset leaves them alone, and unlike memory they
//! have no check bits that a power-up would leave wrong.

use core::panic::PanicInfo;

use cortex_m::peripheral::SCB;
use cortex_m_rt::{ExceptionFrame, exception};
use embassy_stm32::pac;
use runtime::ending::Ending;

use crate::off;

/// Record of the boot epochs before this one, since power-on.
#[derive(Clone, Copy, Debug)]
pub struct CrashContext {
    /// Starts since power-on, this one included.
    pub boots: u32,
    /// Panics and faults since then.
    pub panics: u32,
    /// Whether the watchdog ended the last boot epoch.
    pub bitten: bool,
    place: [u8; PLACE_LEN],
    place_len: usize,
}

impl CrashContext {
    /// File and line of the last panic.
    pub fn place(&self) -> &str {
        let place = self.place.get(..self.place_len).unwrap_or_default();
        core::str::from_utf8(place).unwrap_or("an unreadable place")
    }
}

/// Counts this start; must be called once, after the clocks are started.
pub fn crash_context() -> CrashContext {
    let reset = pac::RCC.rsr().read();
    pac::RCC.rsr().modify(|flags| flags.set_rmvf(true));
    open();
    if read(MAGIC_AT) != MAGIC {
        for register in 0..REGISTERS {
            write(register, 0);
        }
        write(MAGIC_AT, MAGIC);
    }
    write(BOOTS_AT, read(BOOTS_AT).wrapping_add(1));
    let mut place = [0; PLACE_LEN];
    for (register, label) in (PLACE_AT..).zip(place.as_chunks_mut::<4>().0) {
        *label = read(register).to_le_bytes();
    }
    CrashContext {
        boots: read(BOOTS_AT),
        panics: read(PANICS_AT),
        bitten: reset.iwdg1rstf(),
        place,
        place_len: read(LEN_AT) as usize,
    }
}

#[panic_handler]
fn panic(info: &PanicInfo<'_>) -> ! {
    off::everything();
    cortex_m::interrupt::disable();
    ended(Ending::Panic(info.location()))
}

#[exception]
unsafe fn HardFault(frame: &ExceptionFrame) -> ! {
    off::everything();
    ended(Ending::Fault(frame.pc()))
}

/// Keeps and prints the place, then restarts.
fn ended(how: Ending<'_>) -> ! {
    open();
    write(PANICS_AT, read(PANICS_AT).wrapping_add(1));
    let mut place = [0; PLACE_LEN];
    let len = how.write(&mut place);
    write(LEN_AT, len as u32);
    for (register, label) in (PLACE_AT..).zip(place.as_chunks::<4>().0) {
        write(register, u32::from_le_bytes(*label));
    }
    cortex_m::asm::dsb();
    // Last, because the log itself may be what failed.
    if let Ok(text) = core::str::from_utf8(place.get(..len).unwrap_or_default()) {
        defmt::error!("panic at {=str}; everything off, restarting", text);
    }
    SCB::sys_reset()
}

/// Enables writing of the registers.
fn open() {
    pac::PWR.cr1().modify(|power| power.set_dbp(true));
}

fn read(register: usize) -> u32 {
    pac::RTC.bkpr(register).read().bkp()
}

fn write(register: usize, label: u32) {
    pac::RTC.bkpr(register).write(|kept| kept.set_bkp(label));
}

/// Backup registers of the chip (RM0433, 46.6.20).
const REGISTERS: usize = 32;
const MAGIC_AT: usize = 0;
const BOOTS_AT: usize = 1;
const PANICS_AT: usize = 2;
const LEN_AT: usize = 3;
const PLACE_AT: usize = 4;
/// Bytes of a place that are kept.
const PLACE_LEN: usize = 4 * (REGISTERS - PLACE_AT);
const MAGIC: u32 = 0x0121_fe51;
