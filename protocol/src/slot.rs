//! `slot`: flash slot of a case library that is not built into the firmware, with a header of its own.
//!
//! `magic 4 | length 4 LE | table`, at a fixed place above the firmware; QEMU puts it there with `-device
//! loader`. An empty slot has no magic. The board reads it, the simulator's QEMU back end fills it.

/// Address of the slot; a multiple of 8, and so is the table's behind the header.
pub const ADDRESS: usize = 0x0030_0000;
/// Bytes of the slot: the last of the board's 4 MiB.
pub const LEN: usize = 0x0010_0000;
/// Bytes before the table.
pub const HEADER_LEN: usize = 8;

/// Address of the page with the robot's identity and keys ([`crate::provision`]), below the slot.
pub const PAGE_ADDRESS: usize = 0x002f_f000;
/// Address of the value that requests a fault on the emulated board.
pub const TRIAL_ADDRESS: usize = 0x002f_e000;

/// Address of the page with the robot's place in an IP network ([`crate::network_page`]).
pub const NETWORK_ADDRESS: usize = 0x002f_d000;
/// The emulated board's second memory, which takes a robot's journal ([`crate::journal`]), and its bytes.
pub const JOURNAL_ADDRESS: usize = 0x2100_0000;
/// Bytes of that memory.
pub const JOURNAL_LEN: usize = 0x0100_0000;

/// The header of a table of this many bytes; `None` if it does not fit.
pub fn header(table_len: usize) -> Option<[u8; HEADER_LEN]> {
    if table_len > LEN - HEADER_LEN {
        return None;
    }
    let [a, b, c, d] = (table_len as u32).to_le_bytes();
    let [m, a0, g, i] = MAGIC;
    Some([m, a0, g, i, a, b, c, d])
}

const MAGIC: [u8; 4] = *b"1-2T";
