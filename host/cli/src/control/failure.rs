//! `failure`: why `onetwo control` cannot start, and how to fix it.

use std::io;
use std::path::PathBuf;

use foreign::printable_path;
use host::config::ConfigError;
use thiserror::Error;

#[derive(Debug, Error)]
pub(super) enum ControlError {
    #[error("{}: {error}", printable_path(.0), error = .1)]
    ConfigUnreadable(PathBuf, io::Error),
    #[error("{}: {error}", printable_path(.0), error = .1)]
    ConfigFile(PathBuf, ConfigError),
    #[error("{}: {}", printable_path(.0), unwritten(.1))]
    Init(PathBuf, io::Error),
}

fn unwritten(error: &io::Error) -> String {
    if error.kind() == io::ErrorKind::AlreadyExists {
        return "exists already and is kept; name another file".to_owned();
    }
    error.to_string()
}
