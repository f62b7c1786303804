//! `firmware_build`: building of the robot's firmware on this machine.
//!
//! Runs on the PC. `cargo xtask` and `onetwo` (`trial --backend qemu`, `firmware build`) use the same three
//! functions:
//!
//! * [`ensure_target`]: finds a compiler for the robot's processor.
//! * [`ensure_qemu`]: finds the emulator.
//! * [`build_image`]: returns the firmware, freshly built.
//!
//! [`inspect`] looks into an image: sizes, budgets, places that can panic. [`on_target`] runs an image of
//! tests, [`count`] counts instructions.
//!
//! A missing tool is fetched where that is allowed ([`Install`]), or the error names what to install. Slow
//! operations are reported on stderr.
#![forbid(unsafe_code)]

pub mod count;
mod image;
pub mod inspect;
pub mod on_target;
mod process;
mod qemu;
mod target;

use std::path::{Path, PathBuf};

pub use image::{BuildError, ImageBody, Program, SHIPPED_IMAGES, build_image, build_program, target_dir};
pub use qemu::{MACHINE, QEMU, QemuError, ensure_qemu};
pub use target::{TargetError, ThumbToolchain, ensure_target};

/// Which places a missing tool may be installed to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Install {
    /// Into the user's own directories only: rustup's targets. What a program may do unasked.
    ForUser,
    /// System packages as well, where we are root. For the test command, which promises to install what it
    /// needs.
    SystemWide,
}

/// The workspace these sources were compiled in. It may be gone when an installed program runs; then
/// [`build_image`] falls back to an existing build.
pub fn workspace_root() -> PathBuf {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    here.ancestors().nth(2).unwrap_or(here).to_path_buf()
}

/// The robots' processor: a Cortex-M4F, hard float.
pub const TARGET: &str = "thumbv7em-none-eabihf";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_workspace_holds_this_crate() {
        assert!(workspace_root().join("firmware/build/Cargo.toml").is_file());
        assert!(workspace_root().join("rust-toolchain.toml").is_file());
    }
}
