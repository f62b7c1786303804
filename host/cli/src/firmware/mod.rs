//! `onetwo firmware`: work with the robots' firmware. Build it, measure its resource usage, run it under
//! QEMU, flash it, and write the page that holds a robot's identity (docs/case-format.md §5).
//!
//! One file per verb: [`size`] (with [`measure`], which runs the firmware under QEMU), [`mod@run`],
//! [`flash`], [`provision`], [`mod@new_board`], and [`report`], which writes docs/firmware.md ([`failsafe`]
//! is its table). Runs on a PC.

mod failsafe;
mod flash;
mod measure;
mod new_board;
mod provision;
mod report;
mod run;
mod size;

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Args, Subcommand};
use firmware_build::inspect::{Image, Sizes};
use firmware_build::{ImageBody, Program, boards, build_for_robot, build_program, workspace_root};

use crate::Failure;
use crate::failure::FirmwareError;
use crate::output::print_text;

/// What to do with the firmware.
#[derive(Debug, Subcommand)]
pub(crate) enum FirmwareVerb {
    /// Build firmware images and print their paths.
    Build(BuildArgs),
    /// Measure firmware: flash and RAM by crate and symbol, stack and worst step under QEMU, and shares of
    /// robots' computers.
    Size(size::SizeArgs),
    /// Run a robot under QEMU by its own clock, its radio on a serial line; Ctrl-C ends it.
    Run(run::RunArgs),
    /// Put the firmware, or the page of `provision`, into a robot's flash with probe-rs.
    Flash(flash::FlashArgs),
    /// Write the crate of a new board, a skeleton that builds for its chip (docs/boards.md).
    NewBoard(new_board::NewBoardArgs),
    /// Write the page with a robot's number, team and key.
    Provision(provision::ProvisionArgs),
    /// Print the resource usage of the firmware, and what robots do when something breaks, as in
    /// docs/firmware.md.
    Report(report::ReportArgs),
}

/// Which firmware images.
#[derive(Debug, Args)]
pub(crate) struct ImagesArgs {
    /// The firmware image: legged, omni, free, udp, a board's name, or the name of another of its programs;
    /// all of them by default.
    #[arg(long, value_parser = image)]
    image: Option<Program>,
}

/// Which firmware images, and for which robot.
#[derive(Debug, Args)]
pub(crate) struct BuildArgs {
    #[command(flatten)]
    images: ImagesArgs,
    /// The robot's description, a file or a built-in name (docs/robots.md); by default what this program is
    /// built for.
    #[arg(long, value_name = "FILE")]
    robot: Option<String>,
}

/// The firmware image of that name: `legged` and `omni`, which the simulator steps tick by tick, `free`,
/// which runs by its own clock, `udp`, which does so on a network, each real board by its directory's name,
/// and its other programs by theirs.
fn image(name: &str) -> Result<Program, String> {
    match name {
        "legged" => Ok(Program::Robot(ImageBody::Legged)),
        "omni" => Ok(Program::Robot(ImageBody::Omni)),
        "free" => Ok(Program::Free),
        "udp" => Ok(Program::Udp),
        _ => Program::of_board(name).or_else(|| more(name)).ok_or_else(|| {
            let real = boards().iter().filter(|board| board.firmware.is_some());
            let real: Vec<_> = real.map(|board| board.name.as_str()).collect();
            format!("expected legged, omni, free, udp, or a board: {}", real.join(", "))
        }),
    }
}

/// Another program of a real board, by its binary's name.
fn more(name: &str) -> Option<Program> {
    Program::images()
        .into_iter()
        .find(|program| matches!(program, Program::More(_, _)) && program.name() == name)
}

impl ImagesArgs {
    fn programs(&self) -> Vec<Program> {
        self.image.map_or_else(Program::images, |image| vec![image])
    }
}

/// Runs the verb.
pub(crate) fn run(verb: &FirmwareVerb) -> Result<ExitCode, Failure> {
    match verb {
        FirmwareVerb::Build(args) => {
            let mut text = String::new();
            let robot = args.robot.as_deref().map(crate::robot::to_build).transpose()?;
            for program in args.images.programs() {
                let path = match &robot {
                    None => build(program)?,
                    Some((source, name)) => {
                        build_for_robot(&workspace_root(), program, source, name).map_err(failed)?
                    }
                };
                let sizes = sizes_of(&path)?;
                let _ = writeln!(text, "{}: {} B flash, {} B RAM", path.display(), sizes.flash, sizes.ram);
            }
            print_text(&text)?;
        }
        FirmwareVerb::Size(args) => size::run(args)?,
        FirmwareVerb::Run(args) => run::run(args)?,
        FirmwareVerb::Flash(args) => flash::run(args)?,
        FirmwareVerb::NewBoard(args) => new_board::run(args)?,
        FirmwareVerb::Provision(args) => provision::run(args)?,
        FirmwareVerb::Report(args) => report::run(args)?,
    }
    Ok(ExitCode::SUCCESS)
}

fn failed(error: impl Into<FirmwareError>) -> Failure {
    Failure::Firmware(error.into())
}

/// A failure that concerns a file.
fn at<E>(path: &Path, what: impl Fn(PathBuf, E) -> FirmwareError) -> impl Fn(E) -> Failure {
    move |error| Failure::Firmware(what(path.to_owned(), error))
}

fn build(program: Program) -> Result<PathBuf, Failure> {
    build_program(&workspace_root(), program).map_err(failed)
}

/// Longest ELF file that is read, bytes: ours have 8 MB with debug information.
const IMAGE_LEN_MAX: u64 = 1 << 28;

fn sizes_of(path: &Path) -> Result<Sizes, Failure> {
    let bytes = foreign::read(path, IMAGE_LEN_MAX).map_err(at(path, FirmwareError::File))?;
    let image = Image::parse(&bytes).map_err(at(path, FirmwareError::Image))?;
    Ok(Sizes::of(&image))
}
