//! `onetwo firmware new-board`: writes the crate of a new board, a skeleton to wire.

use std::fmt::Write as _;

use clap::Args;
use firmware_build::{CHIPS, workspace_root};

use crate::Failure;
use crate::output::print_text;

/// Which board.
#[derive(Debug, Args)]
pub(crate) struct NewBoardArgs {
    /// The board's name: small letters, digits, hyphens.
    name: String,
    /// The chip; an unknown one prints those that are known.
    #[arg(long, value_name = "CHIP")]
    chip: String,
}

/// Writes it, and says what to do next.
pub(super) fn run(args: &NewBoardArgs) -> Result<(), Failure> {
    let NewBoardArgs { name, chip } = args;
    let written = firmware_build::new_board(&workspace_root(), name, chip)?;
    let (file, _) = written.registered;
    let mut text = String::new();
    let _ = writeln!(text, "wrote {}, and a row in {}", written.directory.display(), file.display());
    let _ = writeln!(text, "it builds as it is, with no part wired: onetwo firmware build --image {name}");
    let _ =
        writeln!(text, "what is left to wire, in order: {}", written.directory.join("README.md").display());
    if let Some(target) = CHIPS.iter().find(|known| known.name == chip).map(|known| known.target) {
        let _ = writeln!(text, "its target is fetched when it is built: {target}");
    }
    print_text(&text)
}
