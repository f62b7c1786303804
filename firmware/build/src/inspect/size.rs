//! `size`: flash and RAM usage by crate and symbol.
//!
//! Crates by source line: an inlined instruction counts for the crate it was written in, not for the function
//! that contains it.

use std::collections::BTreeMap;

use super::{Image, crate_of};

/// Size of a firmware image, in bytes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Sizes {
    /// Flash: code, tables, and the starting values of RAM.
    pub flash: u64,
    /// RAM that is taken before the program starts; the stack has what is left.
    pub ram: u64,
    /// Sizes by crate, the largest first.
    pub crates: Vec<SizePart>,
    /// Sizes by symbol, the largest first.
    pub symbols: Vec<SizePart>,
}

/// Size of a crate or symbol, in bytes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SizePart {
    /// Name of the crate or symbol.
    pub name: String,
    /// Bytes of flash used.
    pub flash: u64,
    /// Bytes of RAM used.
    pub ram: u64,
}

impl Sizes {
    /// Sizes of `image`, by crate and by symbol.
    pub fn of(image: &Image<'_>) -> Self {
        let (mut flash, mut ram) = (0, 0);
        for section in &image.sections {
            flash += section.bytes.len() as u64;
            ram += if section.is_ram() { section.size } else { 0 };
        }
        let mut symbols: BTreeMap<&str, (u64, u64)> = BTreeMap::new();
        let mut crates: BTreeMap<&str, (u64, u64)> = BTreeMap::new();
        for symbol in &image.symbols {
            let Some(section) = image
                .sections
                .iter()
                .find(|section| (section.address..section.address + section.size).contains(&symbol.address))
            else {
                continue;
            };
            let flash = if section.bytes.is_empty() { 0 } else { symbol.size };
            let ram = if section.is_ram() { symbol.size } else { 0 };
            let entry = symbols.entry(&symbol.name).or_default();
            (entry.0, entry.1) = (entry.0 + flash, entry.1 + ram);
            // Code is attributed by its lines below.
            if !section.is_code {
                let entry = crates.entry(crate_of_symbol(&symbol.name)).or_default();
                (entry.0, entry.1) = (entry.0 + flash, entry.1 + ram);
            }
        }
        let mut code = 0;
        for section in image.sections.iter().filter(|section| section.is_code) {
            let range = section.address..section.address + section.size;
            // Without line information the bytes are attributed to no crate.
            let Ok(lines) = image.lines.find_location_range(range.start, range.end) else { continue };
            for (at, len, line) in lines {
                let Some(file) = line.file.filter(|_| range.contains(&at)) else { continue };
                let len = len.min(range.end - at);
                crates.entry(crate_of(file)).or_default().0 += len;
                code += len;
            }
        }
        let all_code: u64 = image.sections.iter().filter(|s| s.is_code).map(|s| s.size).sum();
        let attributed: u64 = crates.values().map(|(flash, _)| flash).sum();
        crates.insert(ASSEMBLY, (all_code.saturating_sub(code), 0));
        crates.insert(
            CONSTANTS,
            ((flash.saturating_sub(attributed)).saturating_sub(all_code - code.min(all_code)), 0),
        );
        Self { flash, ram, crates: sorted(crates), symbols: sorted(symbols) }
    }

    /// Statics: each of that many bytes or more, the largest first, after the crate it belongs to.
    pub fn pools(&self, least: u64) -> Vec<(&str, &SizePart)> {
        let mut pools: Vec<_> = self
            .symbols
            .iter()
            .filter(|part| part.ram >= least)
            .map(|part| (crate_of_symbol(&part.name), part))
            .collect();
        pools.sort_by(|(_, a), (_, b)| (b.ram, &a.name).cmp(&(a.ram, &b.name)));
        pools
    }
}

fn sorted(parts: BTreeMap<&str, (u64, u64)>) -> Vec<SizePart> {
    let parts = parts.into_iter().filter(|(_, (flash, ram))| flash + ram > 0);
    let mut parts: Vec<_> =
        parts.map(|(name, (flash, ram))| SizePart { name: name.to_owned(), flash, ram }).collect();
    parts.sort_by(|a, b| (b.flash + b.ram, &a.name).cmp(&(a.flash + a.ram, &b.name)));
    parts
}

/// The first segment of a value's path, which is its crate: `case_library::TABLE`, `<brain::X as
/// core::Y>::z`.
fn crate_of_symbol(name: &str) -> &str {
    let name = name.trim_start_matches(['<', '&']);
    let end = name.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(name.len());
    match &name[..end] {
        "" => CONSTANTS,
        name => name,
    }
}

/// Instructions without a source line: assembly, and the linker's padding between functions.
const ASSEMBLY: &str = "(assembly, padding)";
/// Values without a name: texts, tables of jumps, literals.
const CONSTANTS: &str = "(constants without a name)";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pools_are_the_large_statics_in_ram_the_largest_first() {
        let part = |name: &str, flash, ram| SizePart { name: name.into(), flash, ram };
        let symbols = vec![
            part("a::TABLE", 9_000, 0),
            part("b::SMALL", 0, 255),
            part("c::BOX", 0, 256),
            part("d::D", 0, 300),
        ];
        let sizes = Sizes { flash: 0, ram: 0, crates: vec![], symbols };
        let pools: Vec<_> = sizes.pools(256).into_iter().map(|(owner, part)| (owner, part.ram)).collect();
        assert_eq!(pools, [("d", 300), ("c", 256)]);
    }

    #[test]
    fn a_value_reports_its_crate() {
        assert_eq!(crate_of_symbol("case_library::FOUR_LEGGED_TABLE"), "case_library");
        assert_eq!(crate_of_symbol("<&brain::X as core::fmt::Debug>::fmt"), "brain");
        assert_eq!(crate_of_symbol(".Lanon.88b9"), CONSTANTS);
    }
}
