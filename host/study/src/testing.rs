//! `testing`: fixtures that several modules' tests share.

use std::fs;
use std::ops::ControlFlow;
use std::path::PathBuf;

use crate::store::{RunProgress, Shard};

/// Progress callback that lets a run go on.
pub(crate) const GO_ON: &(dyn Fn(RunProgress) -> ControlFlow<()> + Sync) = &|_| ControlFlow::Continue(());

/// A directory of a test's own, removed at the end of the test.
pub(crate) struct Directory(pub(crate) PathBuf);

impl Directory {
    pub(crate) fn new(name: &str) -> Self {
        let directory = std::env::temp_dir().join(format!("onetwo-study-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&directory);
        fs::create_dir_all(&directory).unwrap();
        Self(directory)
    }

    pub(crate) fn file(&self, shard: Shard) -> PathBuf {
        self.0.join(shard.file_name())
    }
}

impl Drop for Directory {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Runs `work` on a pool of this many threads.
pub(crate) fn on_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(work)
}
