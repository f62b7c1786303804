//! `inspect`: inspection of a firmware image: its sections and symbols (ELF), and the source line behind
//! every instruction (DWARF).
//!
//! Needs an ELF file with debug information, as the profile `firmware` makes them. The bytes that are flashed
//! do not change with it.

mod budget;
mod panics;
mod size;

use addr2line::gimli::{self, EndianSlice, RunTimeEndian};
use object::{Object as _, ObjectSection as _, ObjectSymbol as _, SectionFlags, SectionKind, SymbolKind};

pub use budget::{Budget, Chip, OverBudget, STACK_BUDGET, STEP_BUDGET};
pub use panics::{Allowed, AllowedError, PanicSite, PanicVerdict, panic_sites};
pub use size::{SizePart, Sizes};

/// A firmware image, parsed.
pub struct Image<'a> {
    sections: Vec<Section>,
    symbols: Vec<Symbol>,
    soft_double: Option<String>,
    lines: addr2line::Context<Reader<'a>>,
}

type Reader<'a> = EndianSlice<'a, RunTimeEndian>;

#[derive(Clone, Debug)]
struct Section {
    address: u64,
    size: u64,
    /// Empty where the file holds no bytes for it (`.bss`).
    bytes: Vec<u8>,
    is_code: bool,
}

impl Section {
    fn is_ram(&self) -> bool {
        RAM.contains(&self.address)
    }
}

#[derive(Clone, Debug)]
struct Symbol {
    name: String,
    /// Address without the bit that marks "Thumb".
    address: u64,
    size: u64,
    is_code: bool,
}

/// Reason why a firmware image cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum ImageError {
    /// The image is no ELF file.
    #[error("no ELF file: {0}")]
    Elf(object::Error),
    /// The debug information is damaged.
    #[error("its debug information cannot be read: {0}")]
    Dwarf(gimli::Error),
}

impl<'a> Image<'a> {
    /// Reads an ELF file.
    pub fn parse(bytes: &'a [u8]) -> Result<Self, ImageError> {
        let file = object::File::parse(bytes).map_err(ImageError::Elf)?;
        let in_memory = |section: &object::Section<'_, '_>| match section.flags() {
            SectionFlags::Elf { sh_flags, .. } => sh_flags.0 & object::elf::SHF_ALLOC.0 != 0,
            _ => false,
        };
        let mut sections: Vec<_> = file
            .sections()
            .filter(|section| in_memory(section) && section.size() > 0)
            .map(|section| Section {
                address: section.address(),
                size: section.size(),
                bytes: if section.kind() == SectionKind::UninitializedData {
                    Vec::new()
                } else {
                    section.data().unwrap_or_default().to_vec()
                },
                is_code: section.kind() == SectionKind::Text,
            })
            .collect();
        sections.sort_by_key(|section| section.address);
        let mut symbols: Vec<_> = file
            .symbols()
            .filter(|symbol| {
                symbol.size() > 0 && matches!(symbol.kind(), SymbolKind::Text | SymbolKind::Data)
            })
            .map(|symbol| Symbol {
                name: format!("{:#}", rustc_demangle::demangle(symbol.name().unwrap_or("?"))),
                address: symbol.address() & !u64::from(symbol.kind() == SymbolKind::Text),
                size: symbol.size(),
                is_code: symbol.kind() == SymbolKind::Text,
            })
            .collect();
        symbols.sort_by(|a, b| (a.address, &a.name).cmp(&(b.address, &b.name)));
        // Before aliases are removed: the run-time ABI's names stand beside the compiler's own for the same
        // code.
        let mut names = symbols.iter().map(|symbol| &symbol.name);
        let soft_double = names.find(|name| SOFT_DOUBLE.contains(&name.as_str())).cloned();
        symbols.dedup_by_key(|symbol| symbol.address);
        Ok(Self { sections, symbols, soft_double, lines: lines_of(&file).map_err(ImageError::Dwarf)? })
    }

    /// Whether the image has contents at one of `len` addresses from `address` on.
    pub fn occupies(&self, address: u64, len: u64) -> bool {
        let end = address.saturating_add(len);
        self.sections
            .iter()
            .any(|section| section.address < end && address < section.address.saturating_add(section.size))
    }

    /// The names of all its symbols.
    pub fn symbol_names(&self) -> impl Iterator<Item = &str> {
        self.symbols.iter().map(|symbol| symbol.name.as_str())
    }

    /// The first function of double-precision arithmetic in software, if there is one: some 250 instructions
    /// an operation on a processor that has single precision only (run-time ABI for the Arm architecture,
    /// §5.1.2).
    pub fn soft_double(&self) -> Option<&str> {
        self.soft_double.as_deref()
    }
}

fn lines_of<'a>(file: &object::File<'a>) -> Result<addr2line::Context<Reader<'a>>, gimli::Error> {
    let endian = if file.is_little_endian() { RunTimeEndian::Little } else { RunTimeEndian::Big };
    let load = |id: gimli::SectionId| -> Result<Reader<'a>, gimli::Error> {
        let section = file.section_by_name(id.name());
        let bytes = section.and_then(|section| section.data().ok()).unwrap_or_default();
        Ok(EndianSlice::new(bytes, endian))
    };
    addr2line::Context::from_dwarf(gimli::Dwarf::load(load)?)
}

/// The crate a source file belongs to, as the compiler writes its path down.
fn crate_of(path: &str) -> &str {
    let segments: Vec<&str> = path.split('/').collect();
    let after = |name: &str| segments.iter().position(|segment| *segment == name);
    // The compiler's own: /rustc/HASH/library/core/src/…
    if let Some(at) =
        after("library").filter(|_| path.starts_with("/rustc/") || path.contains("/rustlib/src/"))
    {
        return segments.get(at + 1).copied().unwrap_or("core");
    }
    // A crate of the registry: …/registry/src/HOST/name-version/src/…
    if let Some(at) = after("registry") {
        let name = segments.get(at + 3).copied().unwrap_or("?");
        return name.rsplit_once('-').map_or(name, |(name, _)| name);
    }
    // Ours: the directory above `src`.
    let above = after("src").and_then(|at| segments.get(at.checked_sub(1)?).copied());
    match above {
        Some("library") => "case-library",
        Some(directory) => board_in(&segments, directory).unwrap_or(directory),
        None => "core",
    }
}

/// The package of the board in that directory, where it is one.
fn board_in(segments: &[&str], directory: &str) -> Option<&'static str> {
    let is_board = segments.windows(2).any(|pair| pair == ["boards", directory]);
    let board = crate::boards().iter().find(|board| is_board && board.name == directory)?;
    Some(&board.package)
}

const SOFT_DOUBLE: [&str; 12] = [
    "__aeabi_dadd",
    "__aeabi_dsub",
    "__aeabi_drsub",
    "__aeabi_dmul",
    "__aeabi_ddiv",
    "__aeabi_dcmplt",
    "__aeabi_dcmple",
    "__aeabi_dcmpgt",
    "__aeabi_dcmpge",
    "__aeabi_dcmpeq",
    "__aeabi_f2d",
    "__aeabi_d2f",
];
/// Address range of a Cortex-M's RAM.
const RAM: std::ops::Range<u64> = 0x2000_0000..0x4000_0000;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_source_file_reports_its_crate() {
        for (path, name) in [
            ("/rustc/59807616/library/core/src/num/f32.rs", "core"),
            ("/x/.cargo/registry/src/index-1949/embassy-sync-0.8.0/src/signal.rs", "embassy-sync"),
            ("/y/onetwo/firmware/brain/src/actuation/drivetrain.rs", "brain"),
            ("protocol/src/frame.rs", "protocol"),
            ("protocol/geometry/src/math.rs", "geometry"),
            ("firmware/boards/mps2/src/bin/../lockstep/ticks.rs", "board-mps2"),
            ("firmware/boards/stm32/src/robot/mod.rs", "board-stm32"),
            ("firmware/elsewhere/stm32/src/lib.rs", "stm32"),
            ("casebase/library/src/lib.rs", "case-library"),
        ] {
            assert_eq!(crate_of(path), name, "{path}");
        }
    }

    #[test]
    fn other_bytes_than_an_image_are_an_error() {
        let error = Image::parse(b"no image").err().map(|error| error.to_string());
        assert!(error.is_some_and(|error| error.starts_with("no ELF file")));
    }
}
