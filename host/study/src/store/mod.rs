//! `store`: experiments, and the crash-safe files that their rows are kept in: shards, identities, hashes.

mod csv_rows;
mod difference;
mod error;
mod experiment;
mod line_file;
mod row_file;
mod shard;

pub use csv_rows::{csv_hash, to_csv};
pub use difference::{Difference, in_words};
pub use error::{EvaluationError, LackingShard};
pub(crate) use experiment::job_seed;
pub use experiment::{Experiment, RunProgress, StoredExperiment, merge};
pub(crate) use line_file::{LineFile, OpenError, whole_len};
pub use row_file::{Kept, Row, read};
pub(crate) use shard::FileKind;
pub use shard::Shard;
