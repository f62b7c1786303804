//! `onetwo firmware flash`: writes a firmware image to a robot. By probe-rs, a separate program for debug
//! probes; without it, the error names what to install.
//!
//! Not tested with a debug probe: without hardware, only the arguments passed to probe-rs can be checked.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use clap::Args;
use firmware_build::{Board, Program, boards, build_for_robot, workspace_root};

use super::{build, failed};
use crate::Failure;
use crate::failure::FirmwareError;
use crate::output::note;

/// What is flashed, and where.
#[derive(Debug, Args)]
pub(crate) struct FlashArgs {
    /// The board, by its directory's name: its image is built, and flashed.
    #[arg(long, value_name = "BOARD", default_value = "stm32", value_parser = real)]
    board: &'static Board,
    /// The robot's description, a file or a built-in name (docs/robots.md); by default what this program is
    /// built for.
    #[arg(long, value_name = "FILE", conflicts_with = "elf")]
    robot: Option<String>,
    /// The firmware image: any other ELF file.
    #[arg(long, value_name = "FILE", requires = "chip")]
    elf: Option<PathBuf>,
    /// The chip, as `probe-rs chip list` names it; by default that board's.
    #[arg(long, value_name = "CHIP")]
    chip: Option<String>,
    /// The page that `provision` wrote.
    #[arg(long, value_name = "FILE")]
    page: Option<PathBuf>,
    /// Address of the page in the chip's flash; by default as the board's manifest says.
    #[arg(long, value_name = "ADDRESS", value_parser = address, requires = "page")]
    page_address: Option<u32>,
    /// Which probe, where there are several (`probe-rs list`).
    #[arg(long, value_name = "PROBE")]
    probe: Option<String>,
}

/// Flashes firmware and page, if given.
pub(super) fn run(args: &FlashArgs) -> Result<(), Failure> {
    // Checked before the firmware is built.
    let there = Command::new(PROGRAM).arg("--version").stdout(Stdio::null()).status();
    if there.is_err_and(|error| error.kind() == ErrorKind::NotFound) {
        return Err(failed(FirmwareError::NoFlasher(MISSING)));
    }
    let image = match &args.elf {
        Some(file) => file.clone(),
        None => match &args.robot {
            None => build(Program::Board(args.board))?,
            Some(robot) => {
                let (source, name) = crate::robot::to_build(robot)?;
                build_for_robot(&workspace_root(), Program::Board(args.board), &source, &name)
                    .map_err(failed)?
            }
        },
    };
    for description in downloads(args, &image) {
        let line = format!("{PROGRAM} {}", description.join(" "));
        note!("onetwo: {line}");
        match Command::new(PROGRAM).args(&description).status() {
            Ok(status) if status.success() => {}
            Ok(status) => {
                return Err(failed(FirmwareError::Flasher(line, status)));
            }
            Err(error) => return Err(failed(FirmwareError::FlasherStart(line, error))),
        }
    }
    Ok(())
}

/// The arguments of each call of probe-rs; the page first, so that a robot never starts its new firmware
/// without its key.
fn downloads(args: &FlashArgs, image: &Path) -> Vec<Vec<String>> {
    let chip = args.chip.as_deref().unwrap_or(&args.board.chip);
    let call = |file: &Path, more: &[&str]| {
        let mut arguments = vec!["download".to_owned(), "--chip".to_owned(), chip.to_owned()];
        if let Some(probe) = &args.probe {
            arguments.extend(["--probe".to_owned(), probe.clone()]);
        }
        arguments.extend(more.iter().map(|argument| (*argument).to_owned()));
        arguments.push(file.display().to_string());
        arguments
    };
    let page_address = args.board.firmware.as_ref().map_or(0, |firmware| firmware.page);
    let page = args.page.as_deref().map(|file| {
        let address = format!("{:#010x}", args.page_address.unwrap_or(page_address));
        call(file, &["--verify", "--binary-format", "bin", "--base-address", &address])
    });
    page.into_iter().chain([call(image, &["--verify", "--preverify"])]).collect()
}

/// A board that can be flashed.
fn real(name: &str) -> Result<&'static Board, String> {
    let mut real = boards().iter().filter(|board| board.firmware.is_some());
    real.clone().find(|board| board.name == name).ok_or_else(|| {
        let first = real.next().map_or("", |board| &board.name);
        let names = real.fold(first.to_owned(), |names, board| names + ", " + &board.name);
        format!("no such board; there are: {names}")
    })
}

/// `0x081e0000`, or decimal.
fn address(text: &str) -> Result<u32, String> {
    let parsed = match text.strip_prefix("0x") {
        Some(digits) => u32::from_str_radix(&digits.replace('_', ""), 16),
        None => text.parse(),
    };
    parsed.map_err(|_| "expected an address such as 0x081e0000".to_owned())
}

const PROGRAM: &str = "probe-rs";
const MISSING: &str = "\
probe-rs is not installed; get it from https://probe.rs, or build it with `cargo install probe-rs-tools --locked` (some 30 minutes)";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_goes_first_and_to_its_address() {
        let args = FlashArgs {
            board: real("stm32").unwrap(),
            robot: None,
            elf: None,
            chip: None,
            page: Some("robot.page".into()),
            page_address: None,
            probe: None,
        };
        let lines: Vec<_> =
            downloads(&args, Path::new("image")).iter().map(|description| description.join(" ")).collect();
        assert_eq!(
            lines,
            [
                "download --chip STM32H743ZITx --verify --binary-format bin --base-address 0x081e0000 robot.page",
                "download --chip STM32H743ZITx --verify --preverify image",
            ]
        );
    }

    #[test]
    fn an_address_is_hexadecimal_or_decimal() {
        assert_eq!((address("0x10"), address("10")), (Ok(16), Ok(10)));
        assert!(address("flash").is_err());
    }
}
