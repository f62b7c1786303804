//! `line_file`: a file of lines that one process appends to, so that a killed run goes on from there.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// Error that kept a file from being opened.
#[derive(Debug)]
pub(crate) enum OpenError {
    /// Another process appends to it.
    InUse,
    /// The operating system's error.
    File(io::Error),
}

/// A file of lines, locked against other processes.
#[derive(Debug)]
pub(crate) struct LineFile {
    file: File,
    path: PathBuf,
}

impl LineFile {
    /// Opens or creates a file of at most `len_max` bytes; returns it with what it holds.
    pub(crate) fn open(path: &Path, len_max: u64) -> Result<(Self, Vec<u8>), OpenError> {
        let opened = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path);
        let file = opened.map_err(OpenError::File)?;
        // If the file system has no locks, the user must not run two processes on one shard.
        if let Err(TryLockError::WouldBlock) = file.try_lock() {
            return Err(OpenError::InUse);
        }
        let bytes = foreign::read_from(&file, len_max).map_err(OpenError::File)?;
        Ok((Self { file, path: path.to_owned() }, bytes))
    }

    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Keeps the first `len` bytes, and appends from there on.
    pub(crate) fn cut(&mut self, len: u64) -> io::Result<()> {
        self.file.set_len(len)?;
        self.file.seek(SeekFrom::End(0)).map(|_| ())
    }

    /// Appends whole lines: once this returns, killing the process does not lose them.
    pub(crate) fn append(&mut self, lines: &[u8]) -> io::Result<()> {
        self.file.write_all(lines)
    }

    /// Hands everything to the disk, so that computers which share the directory over a network see it.
    pub(crate) fn sync(&self) -> io::Result<()> {
        self.file.sync_data()
    }
}

/// Length of the whole lines, bytes: a last line without its end was torn by an interrupt.
pub(crate) fn whole_len(bytes: &[u8]) -> usize {
    bytes.iter().rposition(|byte| *byte == b'\n').map_or(0, |end| end + 1)
}
