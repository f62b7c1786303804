//! `firmware`: why the robots' image or its emulator cannot be had, for `onetwo firmware` and `onetwo trial`.

use std::fmt;
use std::io;
use std::path::PathBuf;
use std::process::ExitStatus;

use arena::game::GameError;
use firmware_build::inspect::ImageError;
use firmware_build::{BuildError, NewBoardError, QemuError};
use hil_sim::McuError;
use host::shell::key::KeyError;
use protocol::provision::ProvisionError;

/// Why the verb ends.
#[derive(Debug)]
pub(crate) enum FirmwareError {
    /// The image cannot be built.
    Build(BuildError),
    /// There is no new board.
    NewBoard(NewBoardError),
    /// There is no emulator.
    Qemu(QemuError),
    /// The emulator does not start.
    Emulator(io::Error),
    /// The emulator ended with this status.
    Ended(ExitStatus),
    /// So many pages for robots on one serial line.
    OneLine(usize),
    /// `--udp` names no robot, or no longer all of them: what is wrong.
    Team(String),
    /// A socket of the robots' radio or bodies cannot be opened.
    Socket(String, io::Error),
    /// The emulated robot refuses the library.
    Library(McuError),
    /// A match to measure the image in.
    Game(GameError),
    /// A file cannot be read or written.
    File(PathBuf, io::Error),
    /// A file is no image.
    Image(PathBuf, ImageError),
    /// No robot could read the key page in a file.
    PageFile(PathBuf, ProvisionError),
    /// No robot could read the key page that was to be written.
    Page(ProvisionError),
    /// The team's key cannot be used.
    Key(KeyError),
    /// No robot has this number.
    NoRobot(u8),
    /// There is no flashing program: how to install it.
    NoFlasher(&'static str),
    /// The flashing program, called as written here, failed.
    Flasher(String, ExitStatus),
    /// The flashing program, called as written here, does not start.
    FlasherStart(String, io::Error),
    /// Figures cannot be written as JSON.
    Json(serde_json::Error),
}

impl fmt::Display for FirmwareError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Build(error) => write!(f, "{error}"),
            Self::NewBoard(error) => write!(f, "{error}"),
            Self::Qemu(error) => write!(f, "{error}"),
            Self::Emulator(error) => write!(f, "{error}"),
            Self::Ended(status) => write!(f, "QEMU ended with {status}"),
            Self::OneLine(pages) => {
                write!(f, "{pages} pages for one serial line; give one --page, or --udp for several robots")
            }
            Self::Team(what) => f.write_str(what),
            Self::Socket(what, error) => write!(f, "{what}: {error}"),
            Self::Library(error) => write!(f, "{error}"),
            Self::Game(error) => write!(f, "{error}"),
            Self::File(path, error) => write!(f, "{}: {error}", path.display()),
            Self::Image(path, error) => write!(f, "{}: {error}", path.display()),
            Self::PageFile(path, error) => write!(f, "{}: {error}", path.display()),
            Self::Page(error) => write!(f, "{error}"),
            Self::Key(error) => write!(f, "{error}"),
            Self::NoRobot(number) => write!(f, "robot {number} is none of 0–15"),
            Self::NoFlasher(remedy) => f.write_str(remedy),
            Self::Flasher(line, status) => {
                write!(f, "`{line}` failed ({status}); its output is above")
            }
            Self::FlasherStart(line, error) => write!(f, "`{line}` does not start: {error}"),
            Self::Json(error) => write!(f, "{error}"),
        }
    }
}

/// Where the error alone names what failed.
macro_rules! from {
    ($($variant:ident($error:ty)),*) => {
        $(impl From<$error> for FirmwareError {
            fn from(error: $error) -> Self {
                Self::$variant(error)
            }
        })*
    };
}

from!(
    Build(BuildError),
    NewBoard(NewBoardError),
    Qemu(QemuError),
    Library(McuError),
    Game(GameError),
    Key(KeyError),
    Json(serde_json::Error)
);
