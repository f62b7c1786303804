//! `failure`: why `onetwo simulate` cannot start, and how to fix it.

use rules::League;
use thiserror::Error;

/// Why the verb ends.
#[derive(Debug, Error)]
pub(super) enum SimulateError {
    /// `--assistant` or `--autoref` beside the internal referee.
    #[error(
        "--assistant and --autoref serve a game controller elsewhere, and the internal referee needs neither; add \
         --referee none, or the ADDRESS:PORT of its packets"
    )]
    InternalReferee,
    /// A league without wheels.
    #[error("{} is not played on wheels", .0.name())]
    NotOnWheels(League),
}
