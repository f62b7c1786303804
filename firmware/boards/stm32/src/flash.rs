//! `flash`: flash storage besides the firmware: the key page, which only a probe writes, and the counter of
//! starts (RM0433, 2.3.2).
//!
//! | address | what |
//! |---|---|
//! | 0x0800_0000 | the firmware |
//! | 0x081a_0000, 0x081c_0000 | the two halves that count starts (`runtime::persistent_counter`), a sector each |
//! | 0x081e_0000 | the key page (`protocol::provision`), the last sector |

stm32_kit::flash!(counter: 0x001a_0000, page: 0x001e_0000, read: read_cell);

/// Reads a cell. One that was written while the power went may have wrong check bits, and reading it is a
/// fault: such a fault is tolerated here, and the bytes read are no valid cell.
fn read_cell(address: u32, bytes: &mut [u8; CELL_LEN]) {
    unfaulted(|| {
        for (byte, address) in bytes.iter_mut().zip(address..) {
            // SAFETY: flash behind the firmware (memory.x), written only by the counter.
            *byte = unsafe { (address as *const u8).read_volatile() };
        }
    });
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
