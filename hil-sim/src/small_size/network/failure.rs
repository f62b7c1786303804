//! `failure`: why a field cannot be served.

use std::fmt;
use std::io;
use std::net::SocketAddr;

use crate::small_size::referee::NoRules;

/// Why there is no field on the network.
#[derive(Debug)]
pub enum NetworkError {
    /// A league without rules of the Small Size League.
    NoRules(NoRules),
    /// The ports of the synchronous mode cannot be had.
    Sync(SocketAddr, io::Error),
}

impl fmt::Display for NetworkError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoRules(error) => error.fmt(f),
            Self::Sync(blue, error) => {
                write!(f, "--sync {blue}: {error}; it and the next port must be free")
            }
        }
    }
}

impl std::error::Error for NetworkError {}

impl From<NoRules> for NetworkError {
    fn from(error: NoRules) -> Self {
        Self::NoRules(error)
    }
}
