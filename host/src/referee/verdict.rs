//! `verdict`: result of a referee's packet, with its evidence. Times: µs.

use protocol::Duration;
use rules::state::{CommandVerdict, RefereeCommand};
use serde::Serialize;
use thiserror::Error;

use super::identity::SourceKey;

/// Numbers of packets by result. Serialized are those that a report of a log file has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct RefereeCounts {
    /// Packets in order, of the source that is followed.
    pub taken: u64,
    /// Commands among them, repeated ones too.
    pub commands: u64,
    /// Commands that were never received, by the counter.
    pub missed: u64,
    /// Packets that were overtaken by newer ones.
    pub old: u64,
    /// Copies of packets that were received just before.
    pub copies: u64,
    /// Packets of a source that is not followed; their HALT and STOP are obeyed.
    pub other_source: u64,
    /// Packets of a source that `--referee-source` excludes.
    #[serde(skip)]
    pub excluded: u64,
    /// Commands with an unknown number, taken for HALT.
    pub unknown: u64,
    /// Packets whose stamp or counter does not fit, other than [`RefereeCounts::old`].
    #[serde(skip)]
    pub doubted: u64,
    /// HALT and STOP out of order, which were obeyed: of [`RefereeCounts::old`] and
    /// [`RefereeCounts::doubted`].
    #[serde(skip)]
    pub restrained: u64,
    /// Steps of the referee's clock or counter that were followed.
    #[serde(skip)]
    pub steps: u64,
}

/// Result of a packet.
#[derive(Clone, Debug, PartialEq)]
pub enum RefereeVerdict {
    /// A packet that was taken as the newest state.
    Taken(Taken),
    /// A packet out of order.
    Doubted {
        /// The check that it failed.
        doubt: Doubt,
        /// Whether it is HALT or STOP, and restrains for [`HOLD`](super::HOLD) nevertheless.
        restrains: bool,
    },
    /// A packet that was received just before.
    Copy,
    /// Another source sent it than the one that is followed; if it is stricter, it is obeyed.
    OtherSource {
        /// The source that sent it.
        source: SourceKey,
    },
    /// `--referee-source` excludes its source.
    Excluded {
        /// The source that sent it.
        source: SourceKey,
    },
}

/// Why a packet is not in order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum Doubt {
    /// A stamp ahead of the packet's arrival.
    #[error("stamped {:.1} s ahead of their arrival", .0.as_secs_f32())]
    Ahead(Duration),
    /// A stamp behind the packet's arrival.
    #[error("stamped {:.1} s behind their arrival", .0.as_secs_f32())]
    Behind(Duration),
    /// A newer one came before it.
    #[error("{:.3} s older than the newest", .0.as_secs_f32())]
    Old(Duration),
    /// A counter that fell, or is unchanged though the command changed.
    #[error("counted backwards")]
    Counter,
}

/// Changes by a packet.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Taken {
    /// A command, and its effect.
    pub command: Option<(RefereeCommand, CommandVerdict)>,
    /// Commands that were never received, by the counter.
    pub missed: u32,
    /// The counter restarted: a new match, or another program.
    pub counter_restarted: bool,
    /// Step of the referee's clock, µs; negative: back.
    pub clock_stepped: Option<i64>,
    /// This source is followed from now on; inside: the one followed before, if any.
    pub new_source: Option<Option<SourceKey>>,
    /// The command's number, if it is unknown.
    pub unknown: Option<i32>,
}
