//! `writer`: writer of log files: `.log`, with an index at its end, and `.log.gz`.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

use flate2::Compression;
use flate2::write::GzEncoder;

use super::{FILE_HEADER, Index, MAGIC, MESSAGE_HEADER, MessageKind, PAYLOAD_MAX, VERSION};

/// Writes messages one after the other. [`finish`](Self::finish) it: without that there is no index, and the
/// last messages of a `.log.gz` may be missing.
#[derive(Debug)]
pub struct LogWriter<W: Write> {
    sink: W,
    at: u64,
    /// Start of each message; `None` where no index is wanted.
    offsets: Option<Vec<u64>>,
}

impl LogWriter<Sink> {
    /// A new file; one of a name that ends in `.gz` is gzipped, any other gets an index.
    pub fn create(path: &Path) -> io::Result<Self> {
        let file = BufWriter::new(File::create(path)?);
        if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("gz")) {
            // Compression 6 halves what 1 leaves, at 10 µs a message.
            Self::new(Sink::Gzip(GzEncoder::new(file, Compression::default())))
        } else {
            Self::indexed(Sink::Plain(file))
        }
    }

    /// Writes the index if there is one, and everything to the file.
    pub fn close(self) -> io::Result<()> {
        match self.finish()? {
            Sink::Plain(mut file) => file.flush(),
            Sink::Gzip(file) => file.finish()?.flush(),
        }
    }
}

impl<W: Write> LogWriter<W> {
    /// A writer without an index.
    pub fn new(sink: W) -> io::Result<Self> {
        Self::begin(sink, None)
    }

    /// A log with an index at the end; needs 8 bytes of memory a message.
    pub fn indexed(sink: W) -> io::Result<Self> {
        Self::begin(sink, Some(Vec::new()))
    }

    fn begin(mut sink: W, offsets: Option<Vec<u64>>) -> io::Result<Self> {
        sink.write_all(MAGIC)?;
        sink.write_all(&VERSION.to_be_bytes())?;
        Ok(Self { sink, at: FILE_HEADER as u64, offsets })
    }

    /// Writes a message received at `timestamp_ns` (ns, Unix time).
    pub fn write(&mut self, timestamp_ns: i64, kind: MessageKind, payload: &[u8]) -> io::Result<()> {
        if payload.len() > PAYLOAD_MAX {
            let message =
                format!("a message of {} bytes; a datagram has at most {PAYLOAD_MAX}", payload.len());
            return Err(io::Error::new(io::ErrorKind::InvalidInput, message));
        }
        if let Some(offsets) = &mut self.offsets {
            offsets.push(self.at);
        }
        self.put(timestamp_ns, kind, payload)
    }

    /// Writes the buffered bytes: they survive a crash in the file.
    pub fn flush(&mut self) -> io::Result<()> {
        self.sink.flush()
    }

    /// Writes the index, if one is wanted, and gives the sink back.
    pub fn finish(mut self) -> io::Result<W> {
        if let Some(offsets) = self.offsets.take() {
            self.put(0, MessageKind::Index2021, &Index::payload(&offsets))?;
        }
        self.sink.flush()?;
        Ok(self.sink)
    }

    fn put(&mut self, timestamp_ns: i64, kind: MessageKind, payload: &[u8]) -> io::Result<()> {
        let size = i32::try_from(payload.len()).map_err(|_| io::ErrorKind::InvalidInput)?;
        let mut header = [0; MESSAGE_HEADER];
        header[..8].copy_from_slice(&timestamp_ns.to_be_bytes());
        header[8..12].copy_from_slice(&kind.number().to_be_bytes());
        header[12..].copy_from_slice(&size.to_be_bytes());
        self.sink.write_all(&header)?;
        self.sink.write_all(payload)?;
        self.at += (MESSAGE_HEADER + payload.len()) as u64;
        Ok(())
    }
}

/// A file being written.
#[derive(Debug)]
pub enum Sink {
    /// An uncompressed file, written directly.
    Plain(BufWriter<File>),
    /// A gzipped file, compressed while it is written.
    Gzip(GzEncoder<BufWriter<File>>),
}

impl Write for Sink {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Self::Plain(file) => file.write(bytes),
            Self::Gzip(file) => file.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Self::Plain(file) => file.flush(),
            Self::Gzip(file) => file.flush(),
        }
    }
}
