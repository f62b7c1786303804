//! `onetwo firmware flash`: writes a firmware image to a robot. By probe-rs, a separate program for debug
//! probes; without it, the error names what to install.
//!
//! Not tested with a debug probe: without hardware, only the arguments passed to probe-rs can be checked.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use clap::Args;
use firmware_build::inspect::Image;
use firmware_build::{Board, Program, build_for_robot, workspace_root};
use protocol::provision::{PAGE_LEN, read};

use super::failure::FirmwareError;
use super::{IMAGE_LEN_MAX, at, build};
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
    // All of it before the firmware is built.
    let there = Command::new(PROGRAM).arg("--version").stdout(Stdio::null()).status();
    if there.is_err_and(|error| error.kind() == ErrorKind::NotFound) {
        return Err(FirmwareError::NoFlasher(MISSING).into());
    }
    check(args)?;
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

/// Refuses a page that no robot could read, a place where none can be, and an image that is none.
fn check(args: &FlashArgs) -> Result<(), Failure> {
    let image = match &args.elf {
        Some(file) => {
            let bytes = foreign::read(file, IMAGE_LEN_MAX).map_err(at(file))?;
            if !bytes.starts_with(ELF) {
                return Err(FirmwareError::NoImage(file.clone()).into());
            }
            bytes
        }
        None => Vec::new(),
    };
    let Some(file) = &args.page else { return Ok(()) };
    let page = foreign::read(file, PAGE_FILE_LEN_MAX).map_err(at(file))?;
    if page.len() != PAGE_LEN {
        return Err(FirmwareError::NoPage(file.clone(), page.len()).into());
    }
    let who = read(&page, false).map_err(at(file))?;
    parsers::radio_team(&who.team.0.to_string())
        .map_err(|_| FirmwareError::PageTeam(file.clone(), who.team.0))?;
    if let Some(address) = args.page_address {
        let in_image =
            Image::parse(&image).is_ok_and(|image| image.occupies(address.into(), PAGE_LEN as u64));
        // Every Cortex-M has its RAM from there on; the vectors stand at the flash's begin.
        let is_place =
            address < RAM_BEGIN && address % SECTOR_LEN_MIN == 0 && !FLASH_BEGINS.contains(&address);
        if in_image || !is_place {
            return Err(FirmwareError::PageAddress(address).into());
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

/// First bytes of an ELF file.
const ELF: &[u8] = b"\x7fELF";
/// Longest file of a page that is read, bytes: more than a page, to tell a wrong one's length.
const PAGE_FILE_LEN_MAX: u64 = 1 << 20;
/// First address of the RAM.
const RAM_BEGIN: u32 = 0x2000_0000;
/// First addresses of the flash, of an nRF, an STM32 and an RP2350.
const FLASH_BEGINS: [u32; 3] = [0, 0x0800_0000, 0x1000_0000];
/// Length of the smallest sector that is erased for a page, bytes.
const SECTOR_LEN_MIN: u32 = 0x800;
const PROGRAM: &str = "probe-rs";
const MISSING: &str = "\
probe-rs is not installed; get it from https://probe.rs, or build it with `cargo install probe-rs-tools --locked` (some 30 minutes)";

#[cfg(test)]
mod tests {
    use super::*;

    fn with_page(page: impl Into<PathBuf>) -> FlashArgs {
        FlashArgs {
            board: parsers::real_board("stm32").unwrap(),
            robot: None,
            elf: None,
            chip: None,
            page: Some(page.into()),
            page_address: None,
            probe: None,
        }
    }

    #[test]
    fn the_page_goes_first_and_to_its_address() {
        let args = with_page("robot.page");
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
    fn what_is_no_page_and_no_place_for_one_is_refused_before_anything_is_built() {
        use protocol::frame::TeamKey;
        use protocol::provision::{Provision, page};
        use protocol::{RobotId, TeamId};

        let directory = std::env::temp_dir().join(format!("onetwo-flash-{}", std::process::id()));
        std::fs::create_dir_all(&directory).unwrap();
        let robot = RobotId::new(3).unwrap();
        let page_of = |team| {
            let keys = TeamKey([7; 16]).of_robot(robot);
            page(&Provision { robot, team: TeamId(team), league: rules::League::DivisionB, keys }).to_vec()
        };
        let file = directory.join("robot.page");
        let mut args = with_page(&file);
        let good = page_of(1);
        let mut damaged = good.clone();
        damaged[20] ^= 1;
        let bad: [Vec<u8>; 8] = [
            b"000102030405060708090a0b0c0d0e0f\n".to_vec(),
            Vec::new(),
            vec![0; 64],
            vec![0xff; 64],
            damaged,
            good[..63].to_vec(),
            [&good[..], &[0xff]].concat(),
            page_of(3),
        ];
        for bytes in bad {
            std::fs::write(&file, &bytes).unwrap();
            assert!(check(&args).is_err(), "{} bytes: {:?}", bytes.len(), &bytes[..bytes.len().min(8)]);
        }
        std::fs::write(&file, &good).unwrap();
        check(&args).unwrap();
        for (address, taken) in
            [(0x081e_0000, true), (0x080e_0000, true), (0x103f_f000, true), (0x000f_f000, true)]
                .into_iter()
                .chain(
                    [0, 3, 0x0800_0000, 0x081e_0001, 0x1000_0000, 0x2000_0000, u32::MAX]
                        .map(|at| (at, false)),
                )
        {
            args.page_address = Some(address);
            assert_eq!(check(&args).is_ok(), taken, "{address:#x}");
        }
        args.page_address = None;
        // The page is no image, either.
        args.elf = Some(file);
        assert!(check(&args).is_err());
        args.elf = Some(directory.join("none.elf"));
        assert!(check(&args).is_err());
        std::fs::remove_dir_all(directory).unwrap();
    }

    #[test]
    fn an_address_is_hexadecimal_or_decimal() {
        assert_eq!((parsers::flash_address("0x10"), parsers::flash_address("10")), (Ok(16), Ok(10)));
        assert!(parsers::flash_address("flash").is_err());
    }
}
