//! `flash`: flash storage besides the firmware: the key page, which only a probe writes, and the counter of
//! starts.
//!
//! | address | what |
//! |---|---|
//! | 0x0800_0000 | the firmware |
//! | 0x081a_0000, 0x081c_0000 | the two halves that count starts (`runtime::persistent_counter`), a sector each |
//! | 0x081e_0000 | the key page (`protocol::provision`), the last sector |

use board_kit::ledger::LedgerFlash;
use embassy_stm32::Peri;
use embassy_stm32::flash::{Blocking, Flash};
use embassy_stm32::peripherals::FLASH;
use protocol::provision::PAGE_LEN;
use runtime::persistent_counter::{self, CELL_LEN, CounterCell, CounterPlace};

/// The provisioned page with keys and identity, unchecked; erased flash reads as 0xff.
pub fn page() -> &'static [u8] {
    // SAFETY: flash behind the firmware (memory.x), of a sector that this program never writes.
    unsafe { core::slice::from_raw_parts((START + PAGE) as *const u8, PAGE_LEN) }
}

/// The two halves of the counter of starts.
#[allow(missing_debug_implementations, reason = "the chip's driver has none")]
pub struct Ledger(Flash<'static, Blocking>);

impl Ledger {
    /// The counter in this flash.
    pub fn new(flash: Peri<'static, FLASH>) -> Self {
        Self(Flash::new_blocking(flash))
    }
}

impl LedgerFlash for Ledger {
    const CELLS: usize = SECTOR as usize / CELL_LEN;

    /// A cell that was written while the power went may have wrong check bits, and reading it is a fault:
    /// such a fault is tolerated here, and the bytes read are no valid cell.
    fn read(&self, at: CounterPlace) -> CounterCell {
        let mut bytes = [0; CELL_LEN];
        let address = START + offset(at);
        unfaulted(|| {
            for (byte, address) in bytes.iter_mut().zip(address..) {
                // SAFETY: flash behind the firmware (memory.x), written only by `write`.
                *byte = unsafe { (address as *const u8).read_volatile() };
            }
        });
        CounterCell::of(&bytes)
    }

    /// Up to two seconds.
    fn erase(&mut self, half: usize) -> bool {
        let from = HALVES + SECTOR * half as u32;
        self.0.blocking_erase(from, from + SECTOR).is_ok()
    }

    fn write(&mut self, at: CounterPlace, epoch: u32) -> bool {
        self.0.blocking_write(offset(at), &persistent_counter::cell(epoch)).is_ok()
    }
}

/// Runs `work` with faults of data accesses ignored (Armv7-M, B3.2.8: BFHFNMIGN at the priority that
/// FAULTMASK gives).
fn unfaulted(work: impl FnOnce()) {
    const BFHFNMIGN: u32 = 1 << 8;
    // SAFETY: one bit of the core's own register, which no other code changes, and no interrupt comes
    // between: FAULTMASK holds all of them back. Both are put back at once.
    unsafe {
        core::arch::asm!("cpsid f");
        (*cortex_m::peripheral::SCB::PTR).ccr.modify(|ccr| ccr | BFHFNMIGN);
        cortex_m::asm::dsb();
        cortex_m::asm::isb();
    }
    work();
    // SAFETY: as above.
    unsafe {
        cortex_m::asm::dsb();
        (*cortex_m::peripheral::SCB::PTR).ccr.modify(|ccr| ccr & !BFHFNMIGN);
        core::arch::asm!("cpsie f");
    }
}

/// Offset of a cell from the flash's start, bytes.
fn offset(at: CounterPlace) -> u32 {
    HALVES + SECTOR * at.half as u32 + (CELL_LEN * at.index) as u32
}

/// The flash's start (RM0433, 2.3.2), then the offsets of the counter of starts and of the key page.
const START: u32 = 0x0800_0000;
const HALVES: u32 = 0x001a_0000;
const PAGE: u32 = 0x001e_0000;
const SECTOR: u32 = 0x0002_0000;
