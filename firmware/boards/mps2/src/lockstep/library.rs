//! `library`: the case library of this robot: the table in the slot, or else the built-in one of its league.

use casebase::{CaseBase, TableError};

use protocol::slot;

/// The case base to use; a table in the slot is checked first.
pub(crate) fn case_base() -> Result<CaseBase<'static>, TableError> {
    table_in_slot().map_or_else(|| Ok(built_in()), CaseBase::from_bytes)
}

/// The built-in case base of the league this body plays in.
fn built_in() -> CaseBase<'static> {
    if cfg!(feature = "legged") { case_library::four_legged() } else { case_library::division_b() }
}

/// The table in the slot, if the slot's header is valid.
fn table_in_slot() -> Option<&'static [u8]> {
    // SAFETY: plain memory of the board above the firmware (build.rs), never written after the start.
    let slot: &'static [u8] = unsafe { core::slice::from_raw_parts(slot::ADDRESS as *const u8, slot::LEN) };
    let (header, rest) = slot.split_first_chunk::<{ slot::HEADER_LEN }>()?;
    let len = u32::from_le_bytes(*header.last_chunk()?) as usize;
    (slot::header(len) == Some(*header)).then(|| rest.get(..len))?
}
