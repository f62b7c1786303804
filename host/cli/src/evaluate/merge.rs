//! `onetwo evaluate merge`: the shards of an evaluation, played anywhere, as one.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args;
use study::evaluation::Results;
use study::store::{EvaluationError, Kept, Row, Shard, merge, read};

use super::report::{self, ReportArgs};
use super::work;
use crate::Failure;
use crate::destination;

/// The shards to merge, and the output.
#[derive(Debug, Args)]
pub(super) struct MergeArgs {
    /// Directories that shards were written to.
    #[arg(value_name = "DIR", required = true)]
    folders: Vec<PathBuf>,
    /// The directory that the merged result is written to.
    #[arg(short, long, value_name = "DIR")]
    out: PathBuf,
    #[command(flatten)]
    report: ReportArgs,
}

pub(super) fn run(args: &MergeArgs) -> Result<ExitCode, Failure> {
    work::check_results(&args.out)?;
    let mut kept = Vec::new();
    for directory in &args.folders {
        kept.extend(shards(directory)?);
    }
    let (identity, rows) = merge(kept)?;
    destination::make_directory(&args.out)?;
    let results = Results::new(identity, rows)?;
    work::finish(&results, &args.out)?;
    report::write(&results, &args.out, &args.report)?;
    Ok(ExitCode::SUCCESS)
}

/// The files of shards in a directory, in the order of their names.
pub(super) fn shards<R: Row>(directory: &Path) -> Result<Vec<Kept<R>>, EvaluationError> {
    let failed = |error| EvaluationError::File(directory.to_owned(), error);
    let mut files = Vec::new();
    for entry in std::fs::read_dir(directory).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        let name = path.file_name().and_then(|name| name.to_str());
        if name.is_some_and(|name| Shard::from_file_name(name).is_some()) {
            files.push(path);
        }
    }
    files.sort();
    files.iter().filter_map(|file| read(file).transpose()).collect()
}
