//! `failure`: why a host cannot be run, and how to fix it.

use std::io;
use std::path::PathBuf;

use thiserror::Error;

use super::identity::PublicKey;
use crate::shell::LinkError;
use crate::shell::key::KeyError;

/// Why a host does not run, or has kept no recording.
#[derive(Debug, Error)]
pub enum RunError {
    /// The team's key cannot be used.
    #[error(transparent)]
    Key(#[from] KeyError),
    /// Real robots and a key that is public.
    #[error(transparent)]
    PublicKey(#[from] PublicKey),
    /// `sim://` names no machine that is known.
    #[error("sim://{0}: no such machine; give sim://HOST or sim://HOST:PORT of a simulator")]
    UnknownSimulator(String),
    /// This program's own file is unknown, which robots in a simulator are started from.
    #[error("{0}")]
    Program(io::Error),
    /// The link to the robots cannot be opened.
    #[error(transparent)]
    Link(#[from] LinkError),
    /// The program of the team's own strategy cannot be started.
    #[error("--strategy: its program cannot be started: {0}")]
    Strategy(io::Error),
    /// The recording with this stem cannot be begun.
    #[error("--record {}: {error}", .0.display(), error = .1)]
    Record(PathBuf, io::Error),
    /// The recording ended before the match.
    #[error("cannot keep the recording: it is not whole: {0}")]
    NotWhole(io::Error),
}
