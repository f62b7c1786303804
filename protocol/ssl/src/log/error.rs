//! `error`: errors of opening a log file. Each error states the cause and the fix.

use std::fmt;
use std::io;
use std::path::PathBuf;

/// A file that cannot be read from its first message on.
#[derive(Debug)]
pub enum LogError {
    /// The file cannot be opened.
    Open {
        /// Path of the file.
        path: PathBuf,
        /// Cause of the failure.
        error: io::Error,
    },
    /// Its first bytes cannot be read (or gunzipped).
    Read(io::Error),
    /// The file ends within its header.
    Short {
        /// Number of the header's 16 bytes that the file has.
        bytes: usize,
    },
    /// It does not start like a log file.
    NotALog {
        /// Its first bytes, for the message.
        begins: Vec<u8>,
    },
    /// It is of the league's first logger, with Qt's strings and compression.
    LegacyQt,
    /// Its version is unknown.
    Version(i32),
}

impl fmt::Display for LogError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Open { path, error } => {
                write!(f, "{}: {error}", foreign::printable(&path.to_string_lossy()))
            }
            Self::Read(error) => write!(f, "not readable: {error}; copy the file again"),
            Self::Short { bytes } => {
                write!(f, "ends within its header, after {bytes} of 16 bytes; copy the file again")
            }
            Self::NotALog { begins } => write!(
                f,
                "begins with `{}`, not with SSL_LOG_FILE; give a .log or .log.gz of the league's recorder",
                begins.escape_ascii()
            ),
            Self::LegacyQt => write!(
                f,
                "version 0, of the league's first Qt logger; convert it with the league's `logplayer` (ssl-logtools) \
                 and its `logrecorder`, which write version 1"
            ),
            Self::Version(version) => {
                write!(f, "version {version}; only version 1 is known: is there a newer onetwo?")
            }
        }
    }
}

impl std::error::Error for LogError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Open { error, .. } | Self::Read(error) => Some(error),
            _ => None,
        }
    }
}
