//! `error`: errors of opening a log file. Each error states the cause and the fix.

use std::io;
use std::path::PathBuf;

/// A file that cannot be read from its first message on.
#[derive(Debug, thiserror::Error)]
pub enum LogError {
    /// The file cannot be opened.
    #[error("{}: {error}", foreign::printable(&path.to_string_lossy()))]
    Open {
        /// Path of the file.
        path: PathBuf,
        /// Cause of the failure.
        #[source]
        error: io::Error,
    },
    /// The first bytes cannot be read (or gunzipped).
    #[error("not readable: {0}; copy the file again")]
    Read(#[source] io::Error),
    /// The file ends within its header.
    #[error("ends within its header, after {bytes} of 16 bytes; copy the file again")]
    Short {
        /// Number of the header's 16 bytes that the file has.
        bytes: usize,
    },
    /// The file does not start like a log file.
    #[error("begins with `{}`, not with SSL_LOG_FILE; give a .log or .log.gz of the league's recorder", begins.escape_ascii())]
    NotALog {
        /// First bytes of the file, for the message.
        begins: Vec<u8>,
    },
    /// The file is of the league's first logger, with Qt's strings and compression.
    #[error(
        "version 0, of the league's first Qt logger; convert it with the league's `logplayer` (ssl-logtools) \
         and its `logrecorder`, which write version 1"
    )]
    LegacyQt,
    /// The version is unknown.
    #[error("version {0}; only version 1 is known: is there a newer onetwo?")]
    Version(i32),
}
