//! `error`: connection errors, and how to fix them.

use std::fmt;
use std::io;

/// One variant per cause that the operator can fix.
#[derive(Debug)]
pub enum LinkError {
    /// `udp://` names a host that cannot be resolved.
    UnknownHost {
        /// The address as configured.
        address: String,
        /// Error of the name's resolution.
        error: io::Error,
    },
    /// A socket could not be opened, or failed.
    Socket {
        /// The operation that failed.
        doing: String,
        /// The operating system's error.
        error: io::Error,
    },
    /// The serial line is not there.
    NoSuchLine {
        /// The device as configured.
        device: String,
        /// Names of the serial lines that exist.
        present: Vec<String>,
    },
    /// This user has no permission for the serial line.
    NotAllowed {
        /// The device as configured.
        device: String,
    },
    /// The serial line does not support this rate, or failed.
    Line {
        /// The device as configured.
        device: String,
        /// The operation that failed.
        doing: String,
        /// The operating system's error.
        error: io::Error,
    },
    /// A virtual robot could not be started.
    Start {
        /// Path of the program.
        program: String,
        /// The operating system's error.
        error: io::Error,
    },
    /// A virtual robot ended again and again.
    GivesUp {
        /// The robot's number in our team.
        robot: u8,
        /// Its last exit status.
        how: String,
        /// Number of exits in a row.
        times: u32,
    },
}

impl fmt::Display for LinkError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::UnknownHost { address, error } => {
                write!(f, "unknown host in `{address}` ({error}); give udp://HOST:PORT of the base station")
            }
            Self::Socket { doing, error } => write!(f, "cannot {doing}: {error}"),
            Self::NoSuchLine { device, present } if present.is_empty() => {
                write!(f, "there is no serial line {device}, nor any other; plug the base station in")
            }
            Self::NoSuchLine { device, present } => {
                write!(f, "there is no serial line {device}; there are: {}", present.join(", "))
            }
            Self::NotAllowed { device } => write!(
                f,
                "{device} may not be opened by you; on Linux join its group (`sudo usermod -aG dialout $USER`, then log in again)"
            ),
            Self::Line { device, doing, error } => write!(
                f,
                "cannot {doing} {device}: {error}; is the base station plugged in, and does it run at this rate \
                 (serial:{device}:BAUD)?"
            ),
            Self::Start { program, error } => {
                write!(f, "cannot start a virtual robot with {program}: {error}")
            }
            Self::GivesUp { robot, how, times } => write!(
                f,
                "virtual robot {robot} ended {times} times in a row ({how}); start it by hand to see why: \
                 `onetwo virtual-robot --help`"
            ),
        }
    }
}

impl std::error::Error for LinkError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::UnknownHost { error, .. }
            | Self::Socket { error, .. }
            | Self::Line { error, .. }
            | Self::Start { error, .. } => Some(error),
            Self::NoSuchLine { .. } | Self::NotAllowed { .. } | Self::GivesUp { .. } => None,
        }
    }
}
