//! `new_board`: writes the crate of a new board: a skeleton that builds for its chip, with every part as one
//! that is not wired yet.
//!
//! The workspace takes every directory of `firmware/boards`, so nothing registers a board but its directory,
//! and one row of the table of crates in docs/architecture.md.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// A chip that there is a skeleton for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ChipTemplate {
    /// Name of the chip in options.
    pub name: &'static str,
    /// Name of the chip in text, with its article.
    pub full_name: &'static str,
    /// Name of the chip in `probe-rs chip list`.
    probe: &'static str,
    /// The target, a triple.
    pub target: &'static str,
    page: &'static str,
    /// Note on the page in the board's README.
    page_note: &'static str,
    dependencies: &'static str,
    init: &'static str,
    /// Memory map, the text of `memory.x`.
    memory: &'static str,
    /// Lines of `panics.allow` that its drivers need.
    panics: &'static str,
    /// Further files of `src`.
    sources: &'static [(&'static str, &'static str)],
}

/// The chips, by name.
pub const CHIPS: [ChipTemplate; 4] = [
    ChipTemplate {
        name: "nrf52840",
        full_name: "an nRF52840",
        probe: "nRF52840_xxAA",
        target: "thumbv7em-none-eabihf",
        page: "0x000f_f000",
        page_note: " but the last three pages",
        dependencies: "# The chip's drivers (MIT or Apache-2.0). Its clock counts 32,768 Hz, so this board has one of its own (src/clock.rs).\n\
            embassy-nrf = { version = \"0.11\", features = [\"nrf52840\", \"unstable-pac\"] }\n\
            embassy-time-driver.workspace = true\n\
            embassy-time-queue-utils.workspace = true\n\
            critical-section.workspace = true",
        init: "    let _chip = embassy_nrf::init(embassy_nrf::config::Config::default());\n    crate::clock::start();",
        memory: include_str!("../templates/nrf52840.x"),
        panics: include_str!("../templates/nrf52840.allow"),
        sources: &[("clock.rs", include_str!("../templates/nrf_clock.rs.in"))],
    },
    ChipTemplate {
        name: "rp2350",
        full_name: "an RP2350",
        probe: "RP235x",
        target: "thumbv8m.main-none-eabihf",
        page: "0x103f_f000",
        page_note: " but the last three sectors",
        dependencies: "# The chip's drivers (MIT or Apache-2.0).\n\
            embassy-rp = { version = \"0.10\", features = [\"rp235xa\", \"time-driver\"] }",
        init: "    let _chip = embassy_rp::init(embassy_rp::config::Config::default());",
        memory: include_str!("../templates/rp2350.x"),
        panics: include_str!("../templates/rp2350.allow"),
        sources: &[],
    },
    ChipTemplate {
        name: "stm32f407vg",
        full_name: "an STM32F407VG",
        probe: "STM32F407VGTx",
        target: "thumbv7em-none-eabihf",
        page: "0x080e_0000",
        page_note: " but the last three sectors",
        dependencies: "embassy-stm32 = { workspace = true, features = [\"stm32f407vg\", \"time-driver-tim5\"] }",
        init: STM32_INIT,
        memory: include_str!("../templates/stm32f407vg.x"),
        panics: "",
        sources: &[],
    },
    ChipTemplate {
        name: "stm32h743zi",
        full_name: "an STM32H743ZI",
        probe: "STM32H743ZITx",
        target: "thumbv7em-none-eabihf",
        page: "0x081e_0000",
        page_note: " but the last three sectors",
        dependencies: "embassy-stm32 = { workspace = true, features = [\"stm32h743zi\", \"time-driver-tim12\"] }",
        init: STM32_INIT,
        memory: include_str!("../templates/stm32h743zi.x"),
        panics: "",
        sources: &[],
    },
];

const STM32_INIT: &str = "    let _chip = embassy_stm32::init(embassy_stm32::Config::default());";

/// Files of a new board.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NewBoard {
    /// Directory of the board.
    pub directory: PathBuf,
    /// The other file in which it stands, and the line.
    pub registered: (PathBuf, String),
}

/// Writes the skeleton of a board with that chip into the workspace at `root`.
pub fn new_board(root: &Path, name: &str, chip: &str) -> Result<NewBoard, NewBoardError> {
    let fits = name.len() <= NAME_LEN_MAX
        && name.starts_with(|first: char| first.is_ascii_lowercase())
        && !name.ends_with('-')
        && name.chars().all(|letter| letter.is_ascii_lowercase() || letter.is_ascii_digit() || letter == '-');
    if !fits {
        return Err(NewBoardError::Name(name.to_owned()));
    }
    if RESERVED.contains(&name) {
        return Err(NewBoardError::Reserved(name.to_owned()));
    }
    let chip = CHIPS.iter().find(|known| known.name == chip);
    let chip = chip.ok_or(NewBoardError::Chip)?;
    let boards = root.join("firmware/boards");
    if !boards.is_dir() {
        return Err(NewBoardError::NoWorkspace(boards));
    }
    let table = root.join(TABLE);
    let text = fs::read_to_string(&table).map_err(|error| NewBoardError::File(table.clone(), error))?;
    let row = format!(
        "| `board-{name}` | firmware/boards/{name} | robot | a real robot's board, {}; [what is left to wire](../firmware/boards/{name}/README.md) |",
        chip.full_name.split_once(' ').map_or(chip.full_name, |(_, full_name)| full_name)
    );
    let text = with_row(&text, &row).ok_or_else(|| NewBoardError::NoTable(table.clone()))?;
    let directory = boards.join(name);
    // Fails where there is one, whatever it is.
    fs::create_dir(&directory).map_err(|error| match error.kind() {
        io::ErrorKind::AlreadyExists => NewBoardError::Exists(directory.clone()),
        _ => NewBoardError::File(directory.clone(), error),
    })?;
    for (file, content) in files(name, chip) {
        write(&directory.join(file), &content)?;
    }
    write(&table, &text)?;
    Ok(NewBoard { directory, registered: (table, row) })
}

fn write(file: &Path, content: &str) -> Result<(), NewBoardError> {
    let wrong = |error| NewBoardError::File(file.to_owned(), error);
    file.parent().map_or(Ok(()), fs::create_dir_all).map_err(wrong)?;
    fs::write(file, content).map_err(wrong)
}

fn files(name: &str, chip: &ChipTemplate) -> Vec<(String, String)> {
    let modules: String =
        chip.sources.iter().filter_map(|(file, _)| file.strip_suffix(".rs")).map(module).collect();
    let guard = if chip.sources.is_empty() {
        "#![forbid(unsafe_code)]"
    } else {
        "#![allow(unsafe_code, reason = \"an interrupt is enabled\")]"
    };
    let values = [
        ("@NAME@", name),
        ("@LABEL@", chip.full_name),
        ("@PROBE@", chip.probe),
        ("@TARGET@", chip.target),
        ("@PAGE@", chip.page),
        ("@PAGE_NOTE@", chip.page_note),
        ("@DEPENDENCIES@", chip.dependencies),
        ("@INIT@", chip.init),
        ("@PANICS@", chip.panics),
        ("@MODULES@", &modules),
        ("@UNSAFE@", guard),
    ];
    let common = COMMON.into_iter().map(|(file, template)| (file.to_owned(), filled(template, &values)));
    let memory = [("memory.x".to_owned(), chip.memory.to_owned())];
    let sources =
        chip.sources.iter().map(|(file, template)| (format!("src/{file}"), filled(template, &values)));
    common.chain(memory).chain(sources).collect()
}

/// A template with its marks replaced by their values.
fn filled(template: &str, values: &[(&str, &str)]) -> String {
    values.iter().fold(template.to_owned(), |text, (mark, value)| text.replace(mark, value))
}

fn module(name: &str) -> String {
    format!("#[cfg(target_os = \"none\")]\nmod {name};\n")
}

/// The table with this row behind its last board; `None` where there is no row of a board.
fn with_row(text: &str, row: &str) -> Option<String> {
    let last = text.lines().rev().find(|line| line.starts_with("| `board-"))?;
    let (before, after) = text.split_once(last)?;
    Some(format!("{before}{last}\n{row}{after}"))
}

/// Reason why there is no new board.
#[derive(Debug, thiserror::Error)]
pub enum NewBoardError {
    /// A name that no package or directory can have everywhere.
    #[error(
        "`{0}` is no name for a board: use small letters a–z, digits and hyphens, a letter first, {NAME_LEN_MAX} at most"
    )]
    Name(String),
    /// A name that options use for something else.
    #[error("`{0}` names something else in the options of `onetwo firmware`; take another name")]
    Reserved(String),
    /// A board, or something else, is in this directory already.
    #[error("{} is there already; take another name, or remove it", .0.display())]
    Exists(PathBuf),
    /// No skeleton for this chip.
    #[error("no skeleton for this chip; there are: {}", CHIPS.iter().map(|chip| chip.name).collect::<Vec<_>>().join(", "))]
    Chip,
    /// The sources are not here.
    #[error("{} is not here: run it in a clone of the project", .0.display())]
    NoWorkspace(PathBuf),
    /// This file has no table of crates.
    #[error("{} has no row `| `board-…` that a new one could stand behind", .0.display())]
    NoTable(PathBuf),
    /// A file or directory cannot be read or written.
    #[error("{}: {}", .0.display(), .1)]
    File(PathBuf, io::Error),
}

/// Files of every board.
const COMMON: [(&str, &str); 7] = [
    ("Cargo.toml", include_str!("../templates/Cargo.toml.in")),
    ("build.rs", include_str!("../templates/build.rs.in")),
    ("README.md", include_str!("../templates/README.md.in")),
    ("panics.allow", include_str!("../templates/panics.allow.in")),
    (".cargo/config.toml", include_str!("../templates/config.toml.in")),
    ("src/main.rs", include_str!("../templates/main.rs.in")),
    ("src/robot.rs", include_str!("../templates/robot.rs.in")),
];
/// The table of all crates.
const TABLE: &str = "docs/architecture.md";
/// Images that are no boards, and the crates' own.
const RESERVED: [&str; 4] = ["legged", "omni", "free", "kit"];
/// Length of a name.
const NAME_LEN_MAX: usize = 32;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Board;

    #[test]
    fn every_skeleton_describes_its_board_and_has_no_mark_left() {
        for chip in &CHIPS {
            let files = files("trial", chip);
            let manifest = &files.iter().find(|(file, _)| file == "Cargo.toml").unwrap().1;
            let board = Board::parse("trial", manifest).unwrap();
            assert_eq!((board.package.as_str(), board.target.as_str()), ("board-trial", chip.target));
            assert_eq!(board.firmware.unwrap().image, "onetwo-trial");
            for (file, content) in files {
                assert!(!content.contains('@'), "{}: {file}", chip.name);
            }
        }
        assert!(CHIPS.is_sorted_by_key(|chip| chip.name));
    }

    #[test]
    fn a_row_stands_behind_the_last_board() {
        let table = "| `board-a` | x |\n| `board-b` | y |\n| `other` | z |\n";
        let expected = "| `board-a` | x |\n| `board-b` | y |\nNEW\n| `other` | z |\n";
        assert_eq!(with_row(table, "NEW").as_deref(), Some(expected));
        assert_eq!(with_row("no table", "NEW"), None);
    }
}
