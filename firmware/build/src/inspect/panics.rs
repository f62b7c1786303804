//! `panics`: panic locations of a firmware image. Every call of a panic function, located by its source line,
//! against a list of those that are known to be impossible or wanted (`panics.allow`).
//!
//! The list may only shrink: a site that is gone has to be removed from it, and one of the crates that read
//! external input, or of the brain ([`NEVER_PANICS`]), must not be on it.

use std::collections::BTreeMap;
use std::fmt;

use super::{Image, Section, Symbol, crate_of};

/// A call of a panic function, with its number of occurrences in the firmware.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct PanicSite {
    /// The crate it is written in.
    pub crate_name: String,
    /// The file's name and the function, without the types it was made for.
    pub function: String,
}

impl fmt::Display for PanicSite {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.crate_name, self.function)
    }
}

/// All of a firmware image, each with a source line for the report.
pub fn panic_sites(image: &Image<'_>) -> BTreeMap<PanicSite, Vec<String>> {
    let mut sites: BTreeMap<PanicSite, Vec<String>> = BTreeMap::new();
    for symbol in image.symbols.iter().filter(|symbol| symbol.is_code && !panics(&symbol.name)) {
        let Some(section) =
            image.sections.iter().find(|section| section.is_code && holds(section, symbol.address))
        else {
            continue;
        };
        for (from, to) in calls(section, symbol.address, symbol.size) {
            if symbol_at(image, to).is_some_and(|callee| panics(&callee.name)) {
                let (site, line) = written_at(image, from, &symbol.name);
                sites.entry(site).or_default().push(line);
            }
        }
    }
    sites
}

/// The function or value that contains an address.
fn symbol_at<'i>(image: &'i Image<'_>, address: u64) -> Option<&'i Symbol> {
    let at = image.symbols.partition_point(|symbol| symbol.address <= address).checked_sub(1)?;
    Some(&image.symbols[at]).filter(|symbol| address < symbol.address + symbol.size)
}

/// Comparison of a firmware image with the list.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PanicVerdict {
    /// Sites that are not allowed, with their source lines.
    pub unknown: Vec<(PanicSite, Vec<String>)>,
    /// Entries that no firmware image has any more.
    pub gone: Vec<PanicSite>,
}

/// The list of sites that may stay.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Allowed(Vec<PanicSite>);

/// Errors of the list.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum AllowedError {
    /// A line that is not `crate function  # reason`.
    #[error("line {0}: expected `crate function  # reason`")]
    Malformed(usize),
    /// A crate that may not panic at all.
    #[error("line {0}: this crate may not panic at all; remove the panic")]
    Never(usize),
}

impl Allowed {
    /// Reads the list: `crate function  # reason` a line; empty lines and lines of comment are skipped.
    pub fn parse(text: &str) -> Result<Self, AllowedError> {
        let mut sites = Vec::new();
        for (number, line) in (1..).zip(text.lines()) {
            if line.trim().is_empty() || line.starts_with('#') {
                continue;
            }
            let (site, reason) = line.split_once('#').ok_or(AllowedError::Malformed(number))?;
            let (name, function) = site.trim().split_once(' ').ok_or(AllowedError::Malformed(number))?;
            if reason.trim().is_empty() {
                return Err(AllowedError::Malformed(number));
            }
            if NEVER_PANICS.contains(&name) {
                return Err(AllowedError::Never(number));
            }
            sites.push(PanicSite { crate_name: name.to_owned(), function: function.trim().to_owned() });
        }
        Ok(Self(sites))
    }

    /// Compares the sites of all firmware images together with this list.
    pub fn judge(&self, sites: &BTreeMap<PanicSite, Vec<String>>) -> PanicVerdict {
        let unknown = sites.iter().filter(|(site, _)| !self.0.contains(site));
        PanicVerdict {
            unknown: unknown.map(|(site, lines)| (site.clone(), lines.clone())).collect(),
            gone: self.0.iter().filter(|site| !sites.contains_key(site)).cloned().collect(),
        }
    }
}

/// The innermost line that is not the standard library's own, or else the innermost.
fn written_at(image: &Image<'_>, address: u64, symbol: &str) -> (PanicSite, String) {
    let mut innermost = None;
    let mut found: Option<(PanicSite, String)> = None;
    if let Ok(mut frames) = image.lines.find_frames(address).skip_all_loads() {
        while let Ok(Some(frame)) = frames.next() {
            let Some(location) = frame.location else { continue };
            let Some(file) = location.file else { continue };
            let name = frame.function.as_ref().and_then(|f| Some(demangled(f.raw_name().ok()?.as_ref())));
            let name = name.unwrap_or_else(|| symbol.to_owned());
            // Line 0 is code that the compiler made; the file beside it is any that was merged with it, the
            // name is right.
            let crate_name = match (location.line, name.split_once("::")) {
                (None | Some(0), Some((named, _))) if !named.contains('<') => named.replace('_', "-"),
                _ => crate_of(file).to_owned(),
            };
            let site = PanicSite { crate_name, function: plain(&name) };
            let line = format!("{file}:{}", location.line.unwrap_or(0));
            let is_std = STANDARD.contains(&site.crate_name.as_str());
            innermost.get_or_insert((site.clone(), line.clone()));
            match &mut found {
                // The function it was inlined into may be the one to fix.
                Some((_, lines)) => *lines = format!("{lines} in {}", plain(&name)),
                None if is_std => {}
                None => found = Some((site, line)),
            }
        }
    }
    found.or(innermost).unwrap_or_else(|| {
        (PanicSite { crate_name: "?".into(), function: plain(symbol) }, format!("{address:#x}"))
    })
}

fn demangled(name: &str) -> String {
    format!("{:#}", rustc_demangle::demangle(name))
}

/// A path without its generic arguments, so that it stays the same from build to build: the last two of its
/// segments.
fn plain(name: &str) -> String {
    let (mut depth, mut text) = (0_usize, String::new());
    for c in name.chars() {
        match c {
            '<' => depth += 1,
            '>' => depth = depth.saturating_sub(1),
            c if depth == 0 && !c.is_whitespace() => text.push(c),
            _ => {}
        }
    }
    let segments: Vec<&str> = text.split("::").filter(|s| !s.is_empty() && !s.starts_with('{')).collect();
    let last = segments.len().saturating_sub(2);
    segments[last..].join("::")
}

/// Returns whether the function only panics.
fn panics(name: &str) -> bool {
    let of_core = [
        "core::panicking::",
        "core::cell::panic_",
        "core::slice::index::slice_",
        "core::str::slice_error_fail",
    ];
    of_core.iter().any(|start| name.starts_with(start))
        || ["unwrap_failed", "expect_failed", "len_mismatch_fail"].iter().any(|end| name.ends_with(end))
}

fn holds(section: &Section, address: u64) -> bool {
    (section.address..section.address + section.bytes.len() as u64).contains(&address)
}

/// Calls and jumps of 32 bits in a function (Armv7-M ARM, A7.7.18 BL and A7.7.12 B, T4): source and target.
///
/// Tables of literals between instructions are read as instructions too; a literal that equals a call of a
/// panic function would be a false positive, never a missed one.
fn calls(section: &Section, address: u64, size: u64) -> Vec<(u64, u64)> {
    let mut found = Vec::new();
    let mut at = address;
    while at + 1 < address + size {
        let Some(first) = half_word(section, at) else { break };
        // 0b111 and one of 01, 10, 11 next start an instruction of 32 bits.
        if first >> 11 < 0b11101 {
            at += 2;
            continue;
        }
        if let Some(second) = half_word(section, at + 2)
            && first >> 11 == 0b11110
            && matches!(second >> 12, 0b1001 | 0b1011 | 0b1101 | 0b1111)
        {
            found.push((at, target(at, first, second)));
        }
        at += 4;
    }
    found
}

/// The 16 bits of a section at an address.
fn half_word(section: &Section, address: u64) -> Option<u16> {
    let index = usize::try_from(address - section.address).ok()?;
    Some(u16::from_le_bytes(*section.bytes.get(index..)?.first_chunk()?))
}

/// Target address of a BL or B.W at `at`.
fn target(at: u64, first: u16, second: u16) -> u64 {
    let bit = |half: u16, n: u32| u32::from(half >> n) & 1;
    let s = bit(first, 10);
    let (i1, i2) = (1 ^ (bit(second, 13) ^ s), 1 ^ (bit(second, 11) ^ s));
    let offset =
        s << 24 | i1 << 23 | i2 << 22 | (u32::from(first) & 0x3ff) << 12 | (u32::from(second) & 0x7ff) << 1;
    // 25 bits with a sign, from the instruction after the next.
    let offset = i64::from((offset << 7).cast_signed() >> 7);
    at.wrapping_add(4).wrapping_add_signed(offset)
}

/// Crates that may not panic at all: those that read the radio, compute, or decide.
const NEVER_PANICS: [&str; 6] = ["brain", "protocol", "casebase", "motion", "rules", "geometry"];
/// A panic in one of these is the fault of its caller.
const STANDARD: [&str; 5] = ["core", "alloc", "std", "compiler-builtins", "heapless"];

#[cfg(test)]
mod tests {
    use super::*;

    fn site(crate_name: &str, function: &str) -> PanicSite {
        PanicSite { crate_name: crate_name.into(), function: function.into() }
    }

    #[test]
    fn calls_are_decoded_as_the_manual_says() {
        // From the firmware's own disassembly: 63d6 is bl to 2a120 in both directions, b.w likewise.
        for (at, first, second, to) in [
            (0x8e16_u64, 0xf001_u16, 0xf97f_u16, 0xa118_u64),
            (0x2000, 0xf7ff, 0xfffe, 0x2000),
            (0x2000, 0xf000, 0xb800, 0x2004),
        ] {
            assert_eq!(target(at, first, second), to, "{at:#x}");
        }
    }

    #[test]
    fn the_comparison_lists_new_sites_and_gone_ones() {
        let list =
            Allowed::parse("# of embassy\n\nembassy-sync Channel::lock  # one thread\nx y # gone\n").unwrap();
        let sites = BTreeMap::from([
            (site("embassy-sync", "Channel::lock"), vec!["a.rs:1".to_owned()]),
            (site("runtime", "tasks::brain"), vec!["b.rs:2".to_owned()]),
        ]);
        let verdict = list.judge(&sites);
        assert_eq!(verdict.unknown, [(site("runtime", "tasks::brain"), vec!["b.rs:2".to_owned()])]);
        assert_eq!(verdict.gone, [site("x", "y")]);
    }

    #[test]
    fn no_entry_goes_without_a_reason_and_none_excuses_the_brain() {
        assert_eq!(Allowed::parse("runtime x"), Err(AllowedError::Malformed(1)));
        assert_eq!(Allowed::parse("runtime x #"), Err(AllowedError::Malformed(1)));
        assert_eq!(Allowed::parse("\nbrain x # why not"), Err(AllowedError::Never(2)));
    }

    #[test]
    fn a_function_is_named_without_its_type_parameters() {
        assert_eq!(plain("embassy_sync::channel::Channel<M,T,N>::lock"), "Channel::lock");
        assert_eq!(plain("runtime::tasks::brain::{{closure}}"), "tasks::brain");
    }
}
