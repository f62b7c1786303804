//! `onetwo firmware`: work with the robots' firmware. Build it, measure its resource usage, run it under
//! QEMU, flash it, and write the page that holds a robot's identity (docs/case-format.md §5).
//!
//! One file per verb: [`size`] (with [`measure`], which runs the firmware under QEMU), [`mod@run`],
//! [`flash`], [`provision`], [`mod@new_board`], and [`report`], which writes docs/firmware.md ([`failsafe`]
//! is its table). Runs on a PC.

mod failsafe;
mod failure;
mod flash;
mod measure;
mod new_board;
mod provision;
mod report;
mod run;
mod size;

use std::error::Error;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Args, Subcommand};
use firmware_build::inspect::{Image, Sizes};
use firmware_build::{Program, build_for_robot, build_program, workspace_root};

use crate::Failure;
use crate::args::parsers;
use crate::output::print_text;
use crate::robot_description::to_build;
use failure::FirmwareError;

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
    #[arg(long, value_parser = parsers::image)]
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

impl ImagesArgs {
    fn programs(&self) -> Vec<Program> {
        self.image.map_or_else(Program::images, |image| vec![image])
    }
}

pub(crate) fn run(verb: &FirmwareVerb) -> Result<ExitCode, Failure> {
    match verb {
        FirmwareVerb::Build(args) => {
            let mut text = String::new();
            let robot = args.robot.as_deref().map(to_build).transpose()?;
            for program in args.images.programs() {
                let path = match &robot {
                    None => build(program)?,
                    Some((source, name)) => build_for_robot(&workspace_root(), program, source, name)?,
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

/// A failure that concerns a file.
fn at<E: Error + Send + Sync + 'static>(path: &Path) -> impl Fn(E) -> Failure {
    move |error| FirmwareError::File(path.to_owned(), Box::new(error)).into()
}

fn build(program: Program) -> Result<PathBuf, Failure> {
    Ok(build_program(&workspace_root(), program)?)
}

/// Longest ELF file that is read, bytes: ours have 8 MB with debug information.
const IMAGE_LEN_MAX: u64 = 1 << 28;

fn sizes_of(path: &Path) -> Result<Sizes, Failure> {
    let bytes = foreign::read(path, IMAGE_LEN_MAX).map_err(at(path))?;
    let image = Image::parse(&bytes).map_err(at(path))?;
    Ok(Sizes::of(&image))
}
