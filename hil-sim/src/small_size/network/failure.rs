//! `failure`: why a field cannot be served.

use std::io;
use std::net::SocketAddr;

use thiserror::Error;

use crate::small_size::referee::NoRules;

/// Why there is no field on the network.
#[derive(Debug, Error)]
pub enum NetworkError {
    /// A league without rules of the Small Size League.
    #[error(transparent)]
    NoRules(#[from] NoRules),
    /// The ports of the synchronous mode cannot be had.
    #[error("--sync {0}: {1}; it and the next port must be free")]
    Sync(SocketAddr, io::Error),
}
