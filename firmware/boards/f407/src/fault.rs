//! `fault`: fault handler: everything off, crash record kept and reported, restart
//! (docs/architecture.md §6.2).

use core::panic::PanicInfo;

use board_kit::crash::{CrashRecord, KeptPlace};
use cortex_m::peripheral::SCB;
use cortex_m_rt::{ExceptionFrame, exception};
use embassy_stm32::pac;
use runtime::ending::Ending;
use stm32_kit::words::BackupRegisters;

use crate::off;

/// Counts this start; must be called once, after the clocks are started.
pub fn crash_record() -> CrashRecord {
    let reset = pac::RCC.csr().read();
    pac::RCC.csr().modify(|flags| flags.set_rmvf(true));
    CrashRecord::begin(&mut BackupRegisters::<REGISTERS>::open(), reset.wdgrstf())
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
    let kept = KeptPlace::keep(&mut BackupRegisters::<REGISTERS>::open(), how);
    cortex_m::asm::dsb();
    // Last, because the log itself may be what failed.
    defmt::error!("panic at {=str}; everything off, restarting", kept.text());
    SCB::sys_reset()
}

/// Backup registers of the chip (RM0090, 26.6.20).
const REGISTERS: usize = 20;
