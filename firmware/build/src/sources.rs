//! `sources`: a hash of the sources that a robot's image is built from: what robots report and their host
//! expects. The build script of `host/cli` has this file too.

use std::path::{Path, PathBuf};

/// The directories and files that an image's code comes from, from the workspace's root.
pub(crate) const SOURCES: [&str; 4] = ["Cargo.lock", "casebase", "firmware", "protocol"];
/// Directories in them that are in no image.
const LEFT_OUT: [&str; 6] = ["target", "tests", "examples", "tools", "ssl", "build"];

/// FNV-1a hash of paths and contents, 32 bits; `None` where the sources are not there.
pub(crate) fn source_hash(root: &Path) -> Option<u32> {
    let mut files = Vec::new();
    for source in SOURCES {
        collect(&root.join(source), &mut files)?;
    }
    files.sort();
    let mut hash = 0x811c_9dc5_u32;
    for file in files {
        let name = file.strip_prefix(root).ok()?.to_string_lossy().into_owned();
        for byte in name.bytes().chain(std::fs::read(&file).ok()?) {
            hash = (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193);
        }
    }
    Some(hash)
}

/// Every source below a place: code, manifests and cases.
fn collect(place: &Path, files: &mut Vec<PathBuf>) -> Option<()> {
    if place.is_dir() {
        for entry in std::fs::read_dir(place).ok()? {
            let entry = entry.ok()?;
            if !LEFT_OUT.iter().any(|name| entry.file_name() == *name) {
                collect(&entry.path(), files)?;
            }
        }
    } else if place.extension().is_some_and(|kind| ["rs", "toml", "lock", "x"].iter().any(|of| kind == *of)) {
        files.push(place.to_owned());
    }
    place.exists().then_some(())
}
