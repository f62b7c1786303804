//! `error`: connection errors, and how to fix them.

use std::io;

/// One variant per cause that the operator can fix.
#[derive(Debug, thiserror::Error)]
pub enum LinkError {
    /// `udp://` names a host that cannot be resolved.
    #[error("unknown host in `{address}` ({error}); give udp://HOST:PORT of the base station")]
    UnknownHost {
        /// The address as configured.
        address: String,
        /// Error of the name's resolution.
        #[source]
        error: io::Error,
    },
    /// A socket could not be opened, or failed.
    #[error("cannot {doing}: {error}")]
    Socket {
        /// The operation that failed.
        doing: String,
        /// The operating system's error.
        #[source]
        error: io::Error,
    },
    /// The serial line is not there.
    #[error("there is no serial line {device}{}", other_lines(present))]
    NoSuchLine {
        /// The device as configured.
        device: String,
        /// Names of the serial lines that exist.
        present: Vec<String>,
    },
    /// This user has no permission for the serial line.
    #[error(
        "{device} may not be opened by you; on Linux join its group (`sudo usermod -aG dialout $USER`, then log in again)"
    )]
    NotAllowed {
        /// The device as configured.
        device: String,
    },
    /// The serial line does not support this rate, or failed.
    #[error(
        "cannot {doing} {device}: {error}; is the base station plugged in, and does it run at this rate \
         (serial:{device}:BAUD)?"
    )]
    Line {
        /// The device as configured.
        device: String,
        /// The operation that failed.
        doing: String,
        /// The operating system's error.
        #[source]
        error: io::Error,
    },
    /// A virtual robot could not be started.
    #[error("cannot start a virtual robot with {program}: {error}")]
    Start {
        /// Path of the program.
        program: String,
        /// The operating system's error.
        #[source]
        error: io::Error,
    },
    /// A virtual robot ended again and again.
    #[error(
        "virtual robot {robot} ended {times} times in a row ({how}); start it by hand to see why: \
         `onetwo virtual-robot --help`"
    )]
    GivesUp {
        /// The robot's number in our team.
        robot: u8,
        /// Last exit status of its process.
        how: String,
        /// Number of exits in a row.
        times: u32,
    },
}

/// End of the message on a serial line that is not there: the lines that are.
fn other_lines(present: &[String]) -> String {
    if present.is_empty() {
        ", nor any other; plug the base station in".to_owned()
    } else {
        format!("; there are: {}", present.join(", "))
    }
}
