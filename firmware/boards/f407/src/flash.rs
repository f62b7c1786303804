//! `flash`: flash storage besides the firmware: the key page, which only a probe writes, and the counter of
//! starts (RM0090, 3.3).
//!
//! | address | what |
//! |---|---|
//! | 0x0800_0000 | the firmware |
//! | 0x080a_0000, 0x080c_0000 | the two halves that count starts (`runtime::persistent_counter`), a sector each |
//! | 0x080e_0000 | the key page (`protocol::provision`), the last sector |

stm32_kit::flash!(counter: 0x000a_0000, page: 0x000e_0000, read: read_cell);

/// Reads a cell. This chip's flash has no check bits: half a cell reads as other content, never as a fault.
fn read_cell(address: u32, bytes: &mut [u8; CELL_LEN]) {
    for (byte, address) in bytes.iter_mut().zip(address..) {
        // SAFETY: flash behind the firmware (memory.x), written only by the counter.
        *byte = unsafe { (address as *const u8).read_volatile() };
    }
}
