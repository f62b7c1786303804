//! Build script: the manifests of all boards, so that an installed program knows them, too. A manifest
//! without a right table ends the build.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, error::Error, fs};

#[path = "src/board.rs"]
#[allow(dead_code, unreachable_pub, reason = "here a board is only checked")]
mod board;

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rerun-if-changed=src/board.rs");
    let boards = Path::new(&env::var("CARGO_MANIFEST_DIR")?).join("../boards");
    // It names every package: a new board changes it, a board's sources do not.
    println!("cargo:rerun-if-changed={}", boards.join("../../Cargo.lock").display());
    let mut manifests: Vec<PathBuf> =
        fs::read_dir(&boards)?.flatten().map(|entry| entry.path().join("Cargo.toml")).collect();
    manifests.retain(|manifest| manifest.is_file());
    manifests.sort();
    let mut list = String::from("[\n");
    for manifest in &manifests {
        println!("cargo:rerun-if-changed={}", manifest.display());
        let directory = manifest.parent().and_then(Path::file_name).unwrap_or_default();
        let text = fs::read_to_string(manifest)?;
        board::Board::parse(&directory.to_string_lossy(), &text)?;
        let _ = writeln!(list, "({:?}, {text:?}),", directory.to_string_lossy());
    }
    fs::write(PathBuf::from(env::var("OUT_DIR")?).join("boards.rs"), list + "]\n")?;
    Ok(())
}
