//! `open`: opening of a log file, by its first bytes, independent of its file name.

use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom};
use std::path::Path;

use flate2::bufread::MultiGzDecoder;

use super::reader::{FILE_BEGIN, fill, parse_header};
use super::{Index, LogError, LogReader, MESSAGE_HEADER};

/// The bytes of an opened file.
#[derive(Debug)]
pub enum Source {
    /// An uncompressed file, as it is.
    Plain(BufReader<File>),
    /// A gzipped file, decompressed while it is read.
    Gzip(Box<MultiGzDecoder<BufReader<File>>>),
}

impl Read for Source {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        match self {
            Self::Plain(file) => file.read(buffer),
            Self::Gzip(file) => file.read(buffer),
        }
    }
}

/// Method by which [`open_at`] found its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// Found by the index: a few reads.
    Index,
    /// Found by all headers before it, without their payloads; with the reason why the index could not be
    /// used.
    Headers(Option<&'static str>),
    /// Found by reading all before it: the file is gzipped.
    Unzipped,
}

/// Opens a `.log` or `.log.gz` at its first message.
pub fn open(path: &Path) -> Result<LogReader<Source>, LogError> {
    LogReader::new(source(path)?)
}

/// Opens a file at its first message of `timestamp_ns` (ns, Unix time) or later; at its end if there is none.
///
/// "First" is in the order of the file, with either search method: times may step back (README, trap 6), and
/// with an index a step back is detected over [`BACK_STEP_MESSAGES`] messages.
pub fn open_at(path: &Path, timestamp_ns: i64) -> Result<(LogReader<Source>, Place), LogError> {
    let mut reader = open(path)?;
    let Source::Plain(mut file) = source(path)? else {
        reader.skip_to(timestamp_ns);
        return Ok((reader, Place::Unzipped));
    };
    let index = Index::read(&mut file).map_err(LogError::Read)?;
    let (at, place) = match index {
        Index::Whole(offsets) => match search(&mut file, &offsets, timestamp_ns).map_err(LogError::Read)? {
            Some(at) => (at, Place::Index),
            None => (scan(&mut file, reader.position(), timestamp_ns)?, Place::Headers(Some(NOT_ITS_OWN))),
        },
        Index::Absent => (scan(&mut file, reader.position(), timestamp_ns)?, Place::Headers(None)),
        Index::Broken(why) => (scan(&mut file, reader.position(), timestamp_ns)?, Place::Headers(Some(why))),
    };
    file.seek(SeekFrom::Start(at)).map_err(LogError::Read)?;
    Ok((LogReader::from_message(Source::Plain(file), at), place))
}

/// Number of messages checked before the one found by bisection, because times step back. The league's
/// recorder steps back by half a millisecond, in which it receives one or two messages.
pub const BACK_STEP_MESSAGES: usize = 64;

const NOT_ITS_OWN: &str = "its offsets lead to no messages";

fn source(path: &Path) -> Result<Source, LogError> {
    let opened = |error| LogError::Open { path: path.to_owned(), error };
    let mut file = BufReader::new(foreign::open(path).map_err(opened)?);
    let mut magic = [0; 2];
    let bytes = fill(&mut file, &mut magic).map_err(|(_, error)| opened(error))?;
    file.rewind().map_err(opened)?;
    let gzip = bytes == 2 && magic == [0x1f, 0x8b];
    Ok(if gzip { Source::Gzip(Box::new(MultiGzDecoder::new(file))) } else { Source::Plain(file) })
}

/// Time of a message of the index, ns, and whether it ends before the next one begins.
fn message_at(file: &mut BufReader<File>, offsets: &[u64], at: usize) -> io::Result<(i64, bool)> {
    let (time, size) = header_at(file, offsets[at])?;
    let length = u64::try_from(size).unwrap_or(u64::MAX).saturating_add(MESSAGE_HEADER as u64);
    // The next message may be farther on: blanks between them need no offset.
    let next = offsets.get(at + 1);
    Ok((time, next.is_none_or(|next| offsets[at].saturating_add(length) <= *next)))
}

/// Bisects the index; `None` where an offset leads outside the file's messages.
fn search(file: &mut BufReader<File>, offsets: &[u64], timestamp_ns: i64) -> io::Result<Option<u64>> {
    let mut low = 0;
    let mut high = offsets.len();
    let mut plausible = true;
    while low < high {
        let middle = usize::midpoint(low, high);
        let (time, is_plausible) = message_at(file, offsets, middle)?;
        plausible &= is_plausible;
        if time >= timestamp_ns { high = middle } else { low = middle + 1 }
    }
    let mut found = low;
    for earlier in (low.saturating_sub(BACK_STEP_MESSAGES)..low).rev() {
        let (time, is_plausible) = message_at(file, offsets, earlier)?;
        plausible &= is_plausible;
        if time >= timestamp_ns {
            found = earlier;
        }
    }
    if !plausible {
        return Ok(None);
    }
    match (offsets.get(found), offsets.last()) {
        (Some(at), _) => Ok(Some(*at)),
        (None, Some(last)) => {
            let (_, size) = header_at(file, *last)?;
            Ok(Some(last + MESSAGE_HEADER as u64 + u64::try_from(size).unwrap_or(0)))
        }
        (None, None) => Ok(None),
    }
}

fn header_at(file: &mut BufReader<File>, at: u64) -> io::Result<(i64, i32)> {
    file.seek(SeekFrom::Start(at))?;
    let mut header = [0; MESSAGE_HEADER];
    fill(file, &mut header).map_err(|(_, error)| error)?;
    let (time, _, size) = parse_header(&header);
    Ok((time, size))
}

/// Walks over the headers from `at` on; where they end or break, the reader that follows reports how.
fn scan(file: &mut BufReader<File>, mut at: u64, timestamp_ns: i64) -> Result<u64, LogError> {
    use super::MessageKind::{Blank, Index2021};
    file.seek(SeekFrom::Start(at)).map_err(LogError::Read)?;
    loop {
        let mut header = [0; MESSAGE_HEADER];
        let bytes = fill(file, &mut header).map_err(|(_, error)| LogError::Read(error))?;
        if header == *FILE_BEGIN {
            at += MESSAGE_HEADER as u64;
            continue;
        }
        let (time, kind, size) = parse_header(&header);
        let is_message = !matches!(kind, Blank | Index2021);
        if bytes < MESSAGE_HEADER || size < 0 || (is_message && time >= timestamp_ns) {
            return Ok(at);
        }
        file.seek_relative(i64::from(size)).map_err(LogError::Read)?;
        at += (MESSAGE_HEADER as u64) + size as u64;
    }
}
