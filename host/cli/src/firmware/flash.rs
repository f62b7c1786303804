//! `onetwo firmware flash`: writes a firmware image to a robot. By probe-rs, a separate program for debug
//! probes; without it, the error names what to install.
//!
//! Not tested with a debug probe: without hardware, only the arguments passed to probe-rs can be checked.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use clap::Args;
use firmware_build::{Board, Program, build_for_robot, workspace_root};

use super::build;
use super::failure::FirmwareError;
use crate::Failure;
use crate::args::parsers;
use crate::output::note;
use crate::robot_description::to_build;

/// What is flashed, and where.
#[derive(Debug, Args)]
pub(crate) struct FlashArgs {
    /// The board, by its directory's name: its image is built, and flashed.
    #[arg(long, value_name = "BOARD", default_value = "stm32", value_parser = parsers::real_board)]
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
    #[arg(long, value_name = "ADDRESS", value_parser = parsers::flash_address, requires = "page")]
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
        return Err(FirmwareError::NoFlasher(MISSING).into());
    }
    let image = match &args.elf {
        Some(file) => file.clone(),
        None => match &args.robot {
            None => build(Program::Board(args.board))?,
            Some(robot) => {
                let (source, name) = to_build(robot)?;
                build_for_robot(&workspace_root(), Program::Board(args.board), &source, &name)?
            }
        },
    };
    for arguments in downloads(args, &image) {
        let line = format!("{PROGRAM} {}", arguments.join(" "));
        note!("onetwo: {line}");
        match Command::new(PROGRAM).args(&arguments).status() {
            Ok(status) if status.success() => {}
            Ok(status) => {
                return Err(FirmwareError::Flasher(line, status).into());
            }
            Err(error) => return Err(FirmwareError::FlasherStart(line, error).into()),
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

const PROGRAM: &str = "probe-rs";
const MISSING: &str = "\
probe-rs is not installed; get it from https://probe.rs, or build it with `cargo install probe-rs-tools --locked` (some 30 minutes)";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_goes_first_and_to_its_address() {
        let args = FlashArgs {
            board: parsers::real_board("stm32").unwrap(),
            robot: None,
            elf: None,
            chip: None,
            page: Some("robot.page".into()),
            page_address: None,
            probe: None,
        };
        let lines: Vec<_> =
            downloads(&args, Path::new("image")).iter().map(|arguments| arguments.join(" ")).collect();
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
        assert_eq!((parsers::flash_address("0x10"), parsers::flash_address("10")), (Ok(16), Ok(10)));
        assert!(parsers::flash_address("flash").is_err());
    }
}
