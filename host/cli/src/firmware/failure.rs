//! `failure`: why the robots' image or its emulator cannot be had, for `onetwo firmware`.

use std::io;
use std::path::PathBuf;
use std::process::ExitStatus;

use firmware_build::inspect::ImageError;
use protocol::provision::ProvisionError;
use thiserror::Error;

/// Why the verb ends.
#[derive(Debug, Error)]
pub(super) enum FirmwareError {
    /// The emulator does not start.
    #[error("{0}")]
    Emulator(io::Error),
    /// The emulator ended with this status.
    #[error("QEMU ended with {0}")]
    Ended(ExitStatus),
    /// So many pages for robots on one serial line.
    #[error("{0} pages for one serial line; give one --page, or --udp for several robots")]
    OneLine(usize),
    /// `--udp` names no robot, or no longer all of them: what is wrong.
    #[error("{0}")]
    Team(String),
    /// A socket of the robots' radio or bodies cannot be opened.
    #[error("{0}: {1}")]
    Socket(String, io::Error),
    /// A file cannot be read or written.
    #[error("{}: {error}", .0.display(), error = .1)]
    File(PathBuf, io::Error),
    /// A file is no image.
    #[error("{}: {error}", .0.display(), error = .1)]
    Image(PathBuf, ImageError),
    /// No robot could read the key page in a file.
    #[error("{}: {error}", .0.display(), error = .1)]
    PageFile(PathBuf, ProvisionError),
    /// No robot could read the key page that was to be written.
    #[error("{0}")]
    Page(ProvisionError),
    /// No robot has this number.
    #[error("robot {0} is none of 0–15")]
    NoRobot(u8),
    /// There is no flashing program: how to install it.
    #[error("{0}")]
    NoFlasher(&'static str),
    /// The flashing program, called as written here, failed.
    #[error("`{0}` failed ({1}); its output is above")]
    Flasher(String, ExitStatus),
    /// The flashing program, called as written here, does not start.
    #[error("`{0}` does not start: {1}")]
    FlasherStart(String, io::Error),
}
