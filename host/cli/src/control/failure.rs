//! `failure`: why `onetwo control` cannot start, and how to fix it.

use std::io;
use std::path::PathBuf;

use foreign::printable_path;
use host::config::ConfigError;
use thiserror::Error;

/// Why the verb ends.
#[derive(Debug, Error)]
pub(super) enum ControlError {
    /// A file of settings cannot be read.
    #[error("{}: {error}", printable_path(.0), error = .1)]
    ConfigUnreadable(PathBuf, io::Error),
    /// A file of settings is faulty.
    #[error("{}: {error}", printable_path(.0), error = .1)]
    ConfigFile(PathBuf, ConfigError),
    /// The new settings file cannot be written.
    #[error("{}: {}", printable_path(.0), unwritten(.1))]
    Init(PathBuf, io::Error),
    /// `sim://` names no machine that is known.
    #[error("sim://{0}: no such machine; give sim://HOST or sim://HOST:PORT of a simulator")]
    UnknownSimulator(String),
    /// The recording with this stem cannot be begun.
    #[error("--record {}: {error}", .0.display(), error = .1)]
    Record(PathBuf, io::Error),
    /// The program of the team's own strategy cannot be started.
    #[error("--strategy: its program cannot be started: {0}")]
    Strategy(io::Error),
}

fn unwritten(error: &io::Error) -> String {
    if error.kind() == io::ErrorKind::AlreadyExists {
        return "exists already and is kept; name another file".to_owned();
    }
    error.to_string()
}
