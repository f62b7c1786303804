//! `index`: message index at the end of an uncompressed log file.
//!
//! Its payload: an int64 offset from the file's start for each message, an int64 distance from the file's end
//! back to the index message's start, and `INDEXED`; big-endian. Its own offset is not in it, its time is 0.

use std::io::{self, Read, Seek, SeekFrom};

use super::reader::{fill, parse_header};
use super::{FILE_HEADER, MESSAGE_HEADER, MessageKind};

const MARK: &[u8; 7] = b"INDEXED";

/// Bytes after the offsets: the distance and the mark.
const TAIL_LEN: usize = 8 + MARK.len();

/// Content of a file's end.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Index {
    /// Start of each message, bytes from the file's start, rising.
    Whole(Vec<u64>),
    /// No index: it was not written, or the file is truncated.
    Absent,
    /// An invalid index, with the reason.
    Broken(&'static str),
}

impl Index {
    /// Searches an index at the end. Allocates no more bytes than the file has.
    pub fn read(file: &mut (impl Read + Seek)) -> io::Result<Self> {
        let length = file.seek(SeekFrom::End(0))?;
        if length < (FILE_HEADER + MESSAGE_HEADER + TAIL_LEN) as u64 {
            return Ok(Self::Absent);
        }
        file.seek(SeekFrom::End(-(TAIL_LEN as i64)))?;
        let mut tail = [0; TAIL_LEN];
        read_all(file, &mut tail)?;
        let [b0, b1, b2, b3, b4, b5, b6, b7, mark @ ..] = tail;
        if mark != *MARK {
            return Ok(Self::Absent);
        }
        let back = u64::from_be_bytes([b0, b1, b2, b3, b4, b5, b6, b7]);
        let least = (MESSAGE_HEADER + TAIL_LEN) as u64;
        let Some(start) = length.checked_sub(back).filter(|_| back >= least) else {
            return Ok(Self::Broken("it begins outside the file"));
        };
        if start < FILE_HEADER as u64 {
            return Ok(Self::Broken("it begins within the file's header"));
        }
        file.seek(SeekFrom::Start(start))?;
        let mut header = [0; MESSAGE_HEADER];
        read_all(file, &mut header)?;
        let (_, kind, size) = parse_header(&header);
        if kind != MessageKind::Index2021 || u64::try_from(size) != Ok(back - MESSAGE_HEADER as u64) {
            return Ok(Self::Broken("no index message where it should begin"));
        }
        let offsets = (back - least) as usize;
        if !offsets.is_multiple_of(8) {
            return Ok(Self::Broken("it ends within an offset"));
        }
        let mut bytes = vec![0; offsets];
        read_all(file, &mut bytes)?;
        let offsets: Vec<u64> = bytes.as_chunks().0.iter().map(|bytes| u64::from_be_bytes(*bytes)).collect();
        let mut last = FILE_HEADER as u64;
        for (number, offset) in offsets.iter().enumerate() {
            let rises = if number == 0 { *offset >= last } else { *offset >= last + MESSAGE_HEADER as u64 };
            if !rises || *offset + MESSAGE_HEADER as u64 > start {
                return Ok(Self::Broken("its offsets do not rise within the file"));
            }
            last = *offset;
        }
        Ok(Self::Whole(offsets))
    }

    /// The index's payload for messages that start at `offsets`.
    pub(super) fn payload(offsets: &[u64]) -> Vec<u8> {
        let mut payload = Vec::with_capacity(offsets.len() * 8 + TAIL_LEN);
        payload.extend(offsets.iter().flat_map(|offset| offset.to_be_bytes()));
        let back = (MESSAGE_HEADER + offsets.len() * 8 + TAIL_LEN) as u64;
        payload.extend(back.to_be_bytes());
        payload.extend(MARK);
        payload
    }
}

fn read_all(source: &mut impl Read, buffer: &mut [u8]) -> io::Result<()> {
    match fill(source, buffer) {
        Ok(bytes) if bytes == buffer.len() => Ok(()),
        Ok(_) => Err(io::ErrorKind::UnexpectedEof.into()),
        Err((_, error)) => Err(error),
    }
}
