//! `case_library`: the built-in case libraries. The files under `cases/<league>/`, checked and encoded at
//! build time.
//!
//! Runs on robots and on the host. A robot links the table alone ([`four_legged`]); names and texts
//! ([`LEAGUES`]) are for output to users, and only programs that use them link them.
//!
//! **Invariants.** No I/O, no allocation, no decode step: a table is read in place.
#![cfg_attr(doctest, doc = include_str!("../README.md"))]
#![forbid(unsafe_code)]
#![no_std]

use casebase::CaseBase;

include!(concat!(env!("OUT_DIR"), "/leagues.rs"));

/// The cases of the four-legged league of 2007, the first paper's world.
///
/// The table was checked at build time; one that was damaged in flash gives the empty base, whose hash
/// differs from every teammate's, and the robots play their default behaviour.
pub fn four_legged() -> CaseBase<'static> {
    CaseBase::from_bytes(&FOUR_LEGGED_TABLE.0).unwrap_or_default()
}

/// The cases of division B of the Small Size League; as for [`four_legged`].
pub fn division_b() -> CaseBase<'static> {
    CaseBase::from_bytes(&DIVISION_B_TABLE.0).unwrap_or_default()
}

/// A built-in league. Lists have one entry per authored case, in the order of ids.
#[derive(Clone, Copy, Debug)]
pub struct League {
    /// Name of the league's directory.
    pub name: &'static str,
    /// The table, at a multiple of 4 bytes.
    pub table: &'static [u8],
    /// `region/name` of every authored case.
    pub names: &'static [&'static str],
    /// The names of the kick kinds, by [`casebase::KickId`].
    pub kicks: &'static [&'static str],
    /// The text of `league.toml`.
    pub rules: &'static str,
    /// The text of every case file.
    pub sources: &'static [&'static str],
}

impl League {
    /// The case base over the table; see [`four_legged`] for a damaged one.
    pub fn base(&self) -> CaseBase<'static> {
        CaseBase::from_bytes(self.table).unwrap_or_default()
    }
}

/// The league of that name, if it has built-in cases.
pub fn league(name: &str) -> Option<&'static League> {
    LEAGUES.iter().find(|league| league.name == name)
}

/// Bytes at a multiple of 4, as required for the start of a case base.
#[repr(C, align(4))]
struct Aligned<B: ?Sized>(B);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_league_can_be_read_and_has_a_name_and_a_text_for_each_authored_case() {
        for league in LEAGUES {
            let base = CaseBase::from_bytes(league.table).expect("checked when built");
            assert_eq!(base.len(), 4 * league.names.len(), "{}", league.name);
            assert_eq!(league.sources.len(), league.names.len());
            assert_eq!(league.kicks.len(), base.kicks());
            assert!(league.names.is_sorted_by(|a, b| a.as_bytes() < b.as_bytes()));
        }
        assert!(LEAGUES.iter().any(|league| league.base().hash() == four_legged().hash()));
    }

    #[test]
    fn a_stored_case_takes_at_most_96_bytes_on_average_with_the_index() {
        let bytes = four_legged().bytes_per_case();
        assert!(bytes <= 96.0, "{bytes} bytes a stored case");
    }

    #[test]
    fn cases_with_passes_take_a_quarter_more() {
        // Division B's have two and three robots that pass, and no single pushes; docs/architecture.md §9 is
        // about the 136 of the four-legged league.
        for league in LEAGUES.iter().filter(|league| !league.names.is_empty()) {
            let bytes = league.base().bytes_per_case();
            assert!(bytes <= 120.0, "{}: {bytes} bytes a stored case", league.name);
        }
    }
}
