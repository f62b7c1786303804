//! `flash`: flash storage besides the firmware: the key page, which only a probe writes, and the counter of
//! starts.
//!
//! | address | what |
//! |---|---|
//! | 0x0800_0000 | the firmware |
//! | 0x081a_0000, 0x081c_0000 | the two halves that count starts (`runtime::persistent_counter`), a sector each |
//! | 0x081e_0000 | the key page (`protocol::provision`), the last sector |

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

/// Why no epoch is available.
#[derive(Clone, Copy, Debug, PartialEq, Eq, defmt::Format)]
pub enum CounterError {
    /// All 2³² epochs are used.
    Full,
    /// The flash did not keep the written value in three attempts.
    Worn,
}

/// Records this start: its epoch, larger than all before. Up to two seconds where a half has to be erased,
/// once in 4,096 starts.
pub fn begin(flash: Peri<'static, FLASH>) -> Result<u32, CounterError> {
    let mut flash = Flash::new_blocking(flash);
    for _ in 0..TRIES {
        let plan = persistent_counter::plan(CELLS, read).ok_or(CounterError::Full)?;
        if plan.erase {
            let from = HALVES + SECTOR * plan.at.half as u32;
            if flash.blocking_erase(from, from + SECTOR).is_err() {
                defmt::warn!("the ledger's half {=usize} cannot be erased", plan.at.half);
            }
        }
        if write(&mut flash, plan.at, plan.epoch).is_ok() && read(plan.at) == CounterCell::Epoch(plan.epoch) {
            return Ok(plan.epoch);
        }
        defmt::warn!("cell {=usize} of the ledger does not keep what is written", plan.at.index);
    }
    Err(CounterError::Worn)
}

fn write(
    flash: &mut Flash<'static, Blocking>,
    at: CounterPlace,
    epoch: u32,
) -> Result<(), embassy_stm32::flash::Error> {
    flash.blocking_write(offset(at), &persistent_counter::cell(epoch))
}

/// The content of a cell. A cell that was written while the power went may have wrong check bits, and reading
/// it is a fault: such a fault is tolerated here, and the bytes read are no valid cell.
fn read(at: CounterPlace) -> CounterCell {
    let mut bytes = [0; CELL_LEN];
    let address = START + offset(at);
    unfaulted(|| {
        for (byte, address) in bytes.iter_mut().zip(address..) {
            // SAFETY: flash behind the firmware (memory.x), written only by `begin`.
            *byte = unsafe { (address as *const u8).read_volatile() };
        }
    });
    CounterCell::of(&bytes)
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
/// Number of cells in a half.
const CELLS: usize = SECTOR as usize / CELL_LEN;
/// Number of attempts: a cell that does not keep its value is skipped.
const TRIES: usize = 3;
