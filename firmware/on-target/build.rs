//! Build script: writes the linker's memory map; does nothing on the PC.

use std::path::PathBuf;
use std::{env, error::Error, fs};

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo:rerun-if-changed=build.rs");
    if env::var("CARGO_CFG_TARGET_OS").as_deref() != Ok("none") {
        return Ok(());
    }
    // The tests' attribute checks whether an editor analyses them.
    println!("cargo:rustc-check-cfg=cfg(rust_analyzer)");
    let out = PathBuf::from(env::var("OUT_DIR")?);
    fs::write(out.join("memory.x"), MEMORY)?;
    println!("cargo:rustc-link-search={}", out.display());
    println!("cargo:rustc-link-arg-tests=--nmagic");
    println!("cargo:rustc-link-arg-tests=-Tlink.x");
    // Keeps the list of tests in the ELF file.
    println!("cargo:rustc-link-arg-tests=-Tembedded-test.x");
    Ok(())
}

/// All of the board's first two memories: tests may be larger than a robot's firmware.
const MEMORY: &str = "MEMORY
{
  FLASH : ORIGIN = 0x00000000, LENGTH = 4M
  RAM : ORIGIN = 0x20000000, LENGTH = 4M
}
";
