//! `flash`: flash storage besides the firmware: the key page, which only a probe writes, and the counter of
//! starts.
//!
//! | address | what |
//! |---|---|
//! | 0x0800_0000 | the firmware |
//! | 0x080a_0000, 0x080c_0000 | the two halves that count starts (`runtime::persistent_counter`), a sector each |
//! | 0x080e_0000 | the key page (`protocol::provision`), the last sector |

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

    /// This chip's flash has no check bits: half a cell reads as other content, never as a fault.
    fn read(&self, at: CounterPlace) -> CounterCell {
        let mut bytes = [0; CELL_LEN];
        let address = START + offset(at);
        for (byte, address) in bytes.iter_mut().zip(address..) {
            // SAFETY: flash behind the firmware (memory.x), written only by `write`.
            *byte = unsafe { (address as *const u8).read_volatile() };
        }
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

/// Offset of a cell from the flash's start, bytes.
fn offset(at: CounterPlace) -> u32 {
    HALVES + SECTOR * at.half as u32 + (CELL_LEN * at.index) as u32
}

/// The flash's start (RM0090, 3.3), then the offsets of the counter of starts and of the key page.
const START: u32 = 0x0800_0000;
const HALVES: u32 = 0x000a_0000;
const PAGE: u32 = 0x000e_0000;
const SECTOR: u32 = 0x0002_0000;
