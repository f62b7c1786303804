//! `stream`: message framing on TCP. On TCP a varint length precedes each message; a datagram is one message.
//!
//! Sans-IO: the owner of the socket pushes the bytes it read, however split, and takes whole messages out.
//! The league's own code calls it "4 byte big endian" in a comment; on the wire it is an unsigned varint.

use prost::Message;

use crate::wire::VARINT_MAX;

/// Most bytes of a message on TCP that are accepted, length excluded. Those of the
/// controller have a few kB at most; a decoded message may need a hundred times its bytes.
pub const MESSAGE_MAX: usize = 256 * 1024;

/// Most bytes of a UDP datagram over IPv4: 65,535 less the headers.
pub const DATAGRAM_MAX: usize = 65_507;

/// Most bytes of a datagram that the league's own programs can receive (ssl-game-controller, ssl-go-tools:
/// 8192).
pub const LEAGUE_DATAGRAM_MAX: usize = 8192;

/// The message encoded for TCP: its length, then its bytes.
pub fn delimited(message: &impl Message) -> Vec<u8> {
    message.encode_length_delimited_to_vec()
}

/// Extracts whole messages from the pieces of a stream.
///
/// Holds at most the limit and one push more, if every push is followed by
/// [`next_message`](Self::next_message) until it has none.
#[derive(Debug)]
pub struct FrameReader {
    buffer: Vec<u8>,
    /// Number of bytes of `buffer` that were consumed already.
    taken: usize,
    limit: usize,
    lost: Option<StreamError>,
}

impl FrameReader {
    /// A reader that accepts messages up to `limit` bytes; [`MESSAGE_MAX`] suits the game controller.
    pub const fn new(limit: usize) -> Self {
        Self { buffer: Vec::new(), taken: 0, limit, lost: None }
    }

    /// Takes bytes read from the stream, in pieces of any size.
    pub fn push(&mut self, bytes: &[u8]) {
        if self.lost.is_none() {
            self.buffer.drain(..self.taken);
            self.taken = 0;
            self.buffer.extend_from_slice(bytes);
        }
    }

    /// The next whole message, or `None` until more is pushed.
    ///
    /// After an error the start of the next message is unknown: the error is returned again, and the
    /// connection must be reopened.
    pub fn next_message(&mut self) -> Result<Option<&[u8]>, StreamError> {
        if let Some(error) = self.lost {
            return Err(error);
        }
        let rest = &self.buffer[self.taken..];
        match length(rest, self.limit) {
            Ok(Some((header, length))) if rest.len() - header >= length => {
                let start = self.taken + header;
                self.taken = start + length;
                Ok(Some(&self.buffer[start..start + length]))
            }
            Ok(_) => Ok(None),
            Err(error) => {
                self.lost = Some(error);
                self.buffer = Vec::new();
                self.taken = 0;
                Err(error)
            }
        }
    }

    /// Bytes of an incomplete message. Not 0 when the peer closes: the message was truncated.
    pub fn pending(&self) -> usize {
        self.buffer.len() - self.taken
    }
}

/// A stream whose messages cannot be separated any more.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum StreamError {
    /// A message is longer than is accepted.
    #[error("a message of {length} bytes, {limit} are accepted; does the port speak the league's protocol?")]
    TooLong {
        /// Length of the message, bytes.
        length: u64,
        /// Largest accepted length, bytes.
        limit: usize,
    },
    /// The length has ten bytes without an end.
    #[error("no length before the message; does the port speak the league's protocol without TLS?")]
    EndlessLength,
}

/// Number of bytes of the length itself and the length, once it is complete.
fn length(bytes: &[u8], limit: usize) -> Result<Option<(usize, usize)>, StreamError> {
    let mut length = 0u64;
    for (at, byte) in bytes.iter().take(VARINT_MAX).enumerate() {
        // The tenth byte has one bit left.
        if at == VARINT_MAX - 1 && *byte > 1 {
            return Err(StreamError::EndlessLength);
        }
        length |= u64::from(byte & 0x7f) << (7 * at);
        if byte & 0x80 == 0 {
            return match usize::try_from(length) {
                Ok(length) if length <= limit => Ok(Some((at + 1, length))),
                _ => Err(StreamError::TooLong { length, limit }),
            };
        }
    }
    Ok(None)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::controller::TeamRegistration;

    fn registration(name: &str) -> TeamRegistration {
        TeamRegistration { team_name: name.into(), signature: None, team: None }
    }

    #[test]
    fn messages_come_whole_however_the_stream_is_torn() {
        let long = "x".repeat(300); // a length of two bytes
        let names = ["onetwo", "", &long];
        let bytes: Vec<u8> = names.iter().flat_map(|name| delimited(&registration(name))).collect();
        for piece in 1..=bytes.len() {
            let mut reader = FrameReader::new(MESSAGE_MAX);
            let mut received = Vec::new();
            for chunk in bytes.chunks(piece) {
                reader.push(chunk);
                while let Some(message) = reader.next_message().expect("a sound stream") {
                    received.push(TeamRegistration::decode(message).expect("decodes").team_name);
                }
            }
            assert_eq!(received, names, "in pieces of {piece}");
            assert_eq!(reader.pending(), 0);
        }
    }

    #[test]
    fn the_length_is_an_unsigned_varint() {
        let long = "x".repeat(300);
        let bytes = delimited(&registration(&long));
        // 303 bytes = 0b10_0101111: low seven bits first.
        assert_eq!(bytes[..2], [0b1010_1111, 0b10]);
        assert_eq!(bytes.len(), 2 + 303);
    }

    #[test]
    fn a_cut_message_is_pending() {
        let bytes = delimited(&registration("onetwo"));
        let mut reader = FrameReader::new(MESSAGE_MAX);
        reader.push(&bytes[..bytes.len() - 1]);
        assert_eq!(reader.next_message(), Ok(None));
        assert_eq!(reader.pending(), bytes.len() - 1);
    }

    #[test]
    fn a_length_over_the_limit_ends_the_stream_and_takes_no_memory() {
        let mut reader = FrameReader::new(16);
        let error = StreamError::TooLong { length: 17, limit: 16 };
        reader.push(&[17, 1, 2, 3]);
        assert_eq!(reader.next_message(), Err(error));
        reader.push(&[1; 1000]);
        assert_eq!(reader.next_message(), Err(error));
        assert_eq!(reader.pending(), 0);

        let mut largest = FrameReader::new(16);
        largest.push(&[16]);
        largest.push(&[7; 16]);
        assert_eq!(largest.next_message(), Ok(Some(&[7; 16][..])));
    }

    #[test]
    fn a_length_without_an_end_is_an_error() {
        for bytes in [[0x80; 11], [0xff; 11]] {
            let mut reader = FrameReader::new(MESSAGE_MAX);
            reader.push(&bytes);
            assert_eq!(reader.next_message(), Err(StreamError::EndlessLength));
        }
        let mut reader = FrameReader::new(MESSAGE_MAX);
        reader.push(&[0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 1]);
        assert_eq!(reader.next_message(), Err(StreamError::TooLong { length: u64::MAX, limit: MESSAGE_MAX }));
    }
}
