//! `failure`: why the robots' image or its emulator cannot be had, for `onetwo firmware`.

use std::error::Error;
use std::io;
use std::path::PathBuf;
use std::process::ExitStatus;

use thiserror::Error;

#[derive(Debug, Error)]
pub(super) enum FirmwareError {
    /// A file, and why it cannot be read, written or understood.
    #[error("{}: {error}", .0.display(), error = .1)]
    File(PathBuf, Box<dyn Error + Send + Sync>),
    #[error("{} has {len} bytes and is no robot's page; write one with `onetwo firmware provision`", .0.display(), len = .1)]
    NoPage(PathBuf, usize),
    #[error("{} is of team {team}, which no host commands; write it again with --team 1 or 2", .0.display(), team = .1)]
    PageTeam(PathBuf, u8),
    #[error(
        "--page-address {0:#010x} is no place for a page: give the begin of a sector of the flash that the image leaves free"
    )]
    PageAddress(u32),
    #[error("{} is no ELF file; give the image that `onetwo firmware build` names", .0.display())]
    NoImage(PathBuf),
    #[error("QEMU ended with {0}")]
    Ended(ExitStatus),
    #[error("{0} pages for one serial line; give one --page, or --udp for several robots")]
    OneLine(usize),
    /// `--udp` names no robot, or no longer all of them.
    #[error("{0}")]
    Team(String),
    #[error("{0}: {1}")]
    Socket(String, io::Error),
    #[error("robot {0} is none of 0–15")]
    NoRobot(u8),
    /// No flashing program: how to install it.
    #[error("{0}")]
    NoFlasher(&'static str),
    #[error("`{0}` failed ({1}); its output is above")]
    Flasher(String, ExitStatus),
    #[error("`{0}` does not start: {1}")]
    FlasherStart(String, io::Error),
}
