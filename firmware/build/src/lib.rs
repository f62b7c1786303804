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

mod board;
pub mod count;
mod image;
pub mod inspect;
mod new_board;
pub mod on_target;
mod process;
mod qemu;
mod sources;
mod target;

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

pub use board::{Board, BoardFirmware};
pub use image::{
    BuildError, ImageBody, Program, ROBOT, SHIPPED_IMAGES, build_for_robot, build_image, build_program,
    target_dir,
};
pub use new_board::{CHIPS, ChipTemplate, NewBoard, NewBoardError, new_board};
pub use qemu::{MACHINE, QEMU, QemuError, ensure_qemu};
pub use target::{TargetError, ThumbToolchain, ensure_target, ensure_target_of};

/// Places to which a missing tool may be installed.
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

/// All boards of the workspace, by name: those that were there when this was compiled, and those whose
/// directories were added since (`firmware new-board`).
pub fn boards() -> &'static [Board] {
    static BOARDS: OnceLock<Vec<Board>> = OnceLock::new();
    const MANIFESTS: &[(&str, &str)] = &include!(concat!(env!("OUT_DIR"), "/boards.rs"));
    BOARDS.get_or_init(|| {
        let known = MANIFESTS
            .iter()
            .map(|(name, manifest)| Board::parse(name, manifest).expect("the build script has read it"));
        let mut boards: Vec<Board> = known.collect();
        boards.extend(added_boards(&workspace_root().join("firmware/boards"), MANIFESTS));
        boards.sort_by(|a, b| a.name.cmp(&b.name));
        boards
    })
}

/// The boards of a directory that are none of `known`; what is no board is left out.
fn added_boards(directory: &Path, known: &[(&str, &str)]) -> Vec<Board> {
    let entries = std::fs::read_dir(directory).into_iter().flatten().flatten();
    let names = entries.filter_map(|entry| entry.file_name().into_string().ok());
    let added = names.filter(|name| known.iter().all(|(known, _)| known != name));
    let parsed = added.filter_map(|name| {
        let manifest = std::fs::read_to_string(directory.join(&name).join("Cargo.toml")).ok()?;
        Board::parse(&name, &manifest).ok()
    });
    parsed.collect()
}

/// The robots' processor: a Cortex-M4F, hard float. What all robots' crates are checked for; a board may
/// have a target of its own.
pub const TARGET: &str = "thumbv7em-none-eabihf";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_boards_are_the_directories_and_their_packages_and_images_are_distinct() {
        let names: Vec<_> = boards().iter().map(|board| board.name.as_str()).collect();
        assert!(names.contains(&"mps2") && names.contains(&"stm32"), "{names:?}");
        for (n, board) in boards().iter().enumerate() {
            let directory = workspace_root().join("firmware/boards").join(&board.name);
            assert!(directory.join("src/main.rs").is_file(), "{}", directory.display());
            assert_eq!(board.package, format!("board-{}", board.name));
            let Some(firmware) = &board.firmware else { continue };
            for other in boards()[..n].iter().filter_map(|other| other.firmware.as_ref()) {
                assert_ne!(firmware.image, other.image);
            }
        }
    }

    #[test]
    fn a_board_that_was_written_after_the_program_was_built_is_known_to_it() {
        let root = std::env::temp_dir().join(format!("onetwo-added-board-{}", std::process::id()));
        let tables = root.join("docs");
        std::fs::create_dir_all(root.join("firmware/boards/notes")).unwrap();
        std::fs::create_dir_all(&tables).unwrap();
        std::fs::copy(workspace_root().join("docs/architecture.md"), tables.join("architecture.md")).unwrap();
        for (name, chip) in [("mine", "stm32f407vg"), ("yours", "nrf52840")] {
            new_board(&root, name, chip).unwrap();
        }
        let mut added = added_boards(&root.join("firmware/boards"), &[("yours", "")]);
        let board = added.pop().unwrap();
        assert!(added.is_empty() && board.firmware.is_some());
        assert_eq!((board.name.as_str(), board.package.as_str()), ("mine", "board-mine"));
        assert!(added_boards(&root.join("nowhere"), &[]).is_empty());
        std::fs::remove_dir_all(root).unwrap();
    }

    #[test]
    fn the_workspace_holds_this_crate() {
        assert!(workspace_root().join("firmware/build/Cargo.toml").is_file());
        assert!(workspace_root().join("rust-toolchain.toml").is_file());
    }
}
