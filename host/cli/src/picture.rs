//! `picture`: figures written as SVG or PNG. A PNG is equal on every machine: its letters come from the font
//! in `fonts`, never from what is installed.

#[cfg(feature = "png")]
mod png;

use std::ffi::OsStr;
use std::io;
use std::path::{Path, PathBuf};

use crate::Failure;
use crate::destination::{self, FileKind};

/// Writes the SVG, or its PNG when the name ends in `.png`.
pub(crate) fn write(file: &Path, svg: &str) -> Result<(), Failure> {
    let bytes = bytes(file, svg).map_err(|error| Unwritten { file: file.to_owned(), error })?;
    Ok(destination::write(file, kind(file), &bytes)?)
}

/// Kind of the file that [`write()`] makes of that name.
pub(crate) fn kind(file: &Path) -> FileKind {
    if has_extension(file, "png") { FileKind::Png } else { FileKind::Svg }
}

#[cfg(feature = "png")]
fn bytes(file: &Path, svg: &str) -> Result<Vec<u8>, SnapshotError> {
    if has_extension(file, "png") { png::png(svg).map_err(SnapshotError::Png) } else { Ok(svg.into()) }
}

#[cfg(not(feature = "png"))]
fn bytes(file: &Path, svg: &str) -> Result<Vec<u8>, SnapshotError> {
    if has_extension(file, "png") { Err(SnapshotError::WithoutPng) } else { Ok(svg.into()) }
}

/// For clap: `--png`, which is refused before any work is done where this program cannot write one.
pub(crate) fn flag(text: &str) -> Result<bool, SnapshotError> {
    match text {
        "true" if cfg!(feature = "png") => Ok(true),
        "true" => Err(SnapshotError::WithoutPng),
        _ => Ok(false),
    }
}

/// Why a figure is not written.
#[derive(Debug, thiserror::Error)]
pub(crate) enum SnapshotError {
    /// The name ends in none of these.
    #[error("expected a name that ends in .{}", .0.join(" or ."))]
    Name(&'static [&'static str]),
    /// The file cannot be written.
    #[error("{0}")]
    Write(io::Error),
    /// The drawing cannot be turned into pixels.
    #[cfg(feature = "png")]
    #[error("{0}")]
    Png(png::PngError),
    /// This program writes SVG alone.
    #[error(
        "this program was built without PNG; take SVG, or rebuild it: cargo build --release --features png"
    )]
    WithoutPng,
}

/// A file that cannot be written, and why.
#[derive(Debug, thiserror::Error)]
#[error("cannot write the picture {}: {error}", foreign::printable_path(file))]
pub(crate) struct Unwritten {
    /// The output file.
    pub(crate) file: PathBuf,
    /// Why.
    pub(crate) error: SnapshotError,
}

/// For clap: the name of a figure, of one of these kinds.
pub(crate) fn named(text: &str, kinds: &'static [&'static str]) -> Result<PathBuf, SnapshotError> {
    let file = PathBuf::from(text);
    if !kinds.iter().any(|kind| has_extension(&file, kind)) {
        return Err(SnapshotError::Name(kinds));
    }
    if has_extension(&file, "png") && !cfg!(feature = "png") {
        return Err(SnapshotError::WithoutPng);
    }
    Ok(file)
}

/// Whether the name has this extension, in upper or lower case.
pub(crate) fn has_extension(file: &Path, wanted: &str) -> bool {
    file.extension().and_then(OsStr::to_str).is_some_and(|extension| extension.eq_ignore_ascii_case(wanted))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_extension_of_a_figure_names_its_format() {
        assert!(named("a.svg", &["svg", "png"]).is_ok());
        assert_eq!(named("a.PNG", &["svg", "png"]).is_ok(), cfg!(feature = "png"));
        let refused = named("a.jpg", &["svg", "png"]).unwrap_err().to_string();
        assert_eq!(refused, "expected a name that ends in .svg or .png");
        assert!(named("svg", &["svg"]).is_err());
    }
}
