//! `socket`: the server's side of a WebSocket (RFC 6455): handshake, frames, messages of a greatest length.

use std::io;
use std::time::Instant;

use crate::http::{Answer, Head, Status, Wire};

/// The longest payload of a control frame, bytes.
const CONTROL_MAX: usize = 125;

/// Opcodes of frames (RFC 6455 §5.2).
const OPCODE_CONTINUATION: u8 = 0x0;
const OPCODE_TEXT: u8 = 0x1;
const OPCODE_CLOSE: u8 = 0x8;
const OPCODE_PING: u8 = 0x9;
const OPCODE_PONG: u8 = 0xA;
/// Bit of the last frame of a message.
const FIN: u8 = 0x80;
/// Bit of a masked payload: every viewer's is.
const MASKED: u8 = 0x80;

/// Message of a viewer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Received {
    Text(String),
    /// Answered with the same bytes.
    Ping(Vec<u8>),
    Pong,
    Close,
}

/// Answer that makes a socket of a connection; the error is the answer that refuses it.
pub(crate) fn handshake(head: &Head) -> Result<Answer, Answer> {
    let refused = |text: &'static str| Answer::text(Status::BAD_REQUEST, text);
    if !head.has_token("connection", "upgrade") || !head.has_token("upgrade", "websocket") {
        let answer = Answer::text(Status::UPGRADE_REQUIRED, "a WebSocket is served here");
        return Err(answer.with("upgrade", "websocket").with("connection", "upgrade"));
    }
    if head.one("sec-websocket-version") != Ok(Some("13")) {
        return Err(refused("version 13 of WebSocket is served").with("sec-websocket-version", "13"));
    }
    let Ok(Some(key)) = head.one("sec-websocket-key") else {
        return Err(refused("one Sec-WebSocket-Key is needed"));
    };
    let answer = Answer { status: Status::SWITCHING, headers: Vec::new(), body: Vec::new().into() };
    Ok(answer
        .with("connection", "upgrade")
        .with("upgrade", "websocket")
        .with("sec-websocket-accept", accept(key)))
}

/// Value of `sec-websocket-accept`, which proves to a viewer that its key was understood.
fn accept(key: &str) -> String {
    let mut digest = sha1_smol::Sha1::new();
    digest.update(key.as_bytes());
    digest.update(b"258EAFA5-E914-47DA-95CA-C5AB0DC85B11");
    base64(&digest.digest().bytes())
}

/// RFC 4648, with padding.
fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::new();
    for three in bytes.chunks(3) {
        let at = |i: usize| u32::from(three.get(i).copied().unwrap_or(0));
        let bits = at(0) << 16 | at(1) << 8 | at(2);
        for i in 0..4 {
            let digit = DIGITS[(bits >> (18 - 6 * i) & 63) as usize];
            text.push(if i <= three.len() { char::from(digit) } else { '=' });
        }
    }
    text
}

/// A frame that carries a whole text.
pub(crate) fn text(text: &str) -> Vec<u8> {
    frame(OPCODE_TEXT, text.as_bytes())
}

/// A frame that answers a ping.
pub(crate) fn pong(payload: &[u8]) -> Vec<u8> {
    frame(OPCODE_PONG, payload)
}

/// A frame that ends the socket.
pub(crate) fn close() -> Vec<u8> {
    frame(OPCODE_CLOSE, &[])
}

fn frame(kind: u8, payload: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(payload.len() + 10);
    bytes.push(FIN | kind);
    match payload.len() {
        short @ ..=CONTROL_MAX => bytes.push(short as u8),
        middle @ ..=0xFFFF => {
            bytes.push(126);
            bytes.extend_from_slice(&(middle as u16).to_be_bytes());
        }
        long => {
            bytes.push(127);
            bytes.extend_from_slice(&(long as u64).to_be_bytes());
        }
    }
    bytes.extend_from_slice(payload);
    bytes
}

/// Waits for a message of at most `most` bytes. Control frames may come between the frames of a text, whose
/// beginning stands in `begun`. An error ends the socket: time, the end of the stream, or what the standard
/// does not allow.
pub(crate) fn receive(
    wire: &mut Wire,
    begun: &mut Option<Vec<u8>>,
    most: usize,
    by: Instant,
) -> io::Result<Received> {
    loop {
        let frame = loop {
            if let Some((frame, length)) = parse(&mut wire.received, most)? {
                wire.received.drain(..length);
                break frame;
            }
            if wire.receive(by)? == 0 {
                return Err(io::ErrorKind::UnexpectedEof.into());
            }
        };
        match (frame.kind, begun.take()) {
            (OPCODE_PING, before) => {
                *begun = before;
                return Ok(Received::Ping(frame.payload));
            }
            (OPCODE_PONG, before) => {
                *begun = before;
                return Ok(Received::Pong);
            }
            (OPCODE_CLOSE, _) => return Ok(Received::Close),
            (OPCODE_TEXT, None) => *begun = Some(frame.payload),
            (OPCODE_CONTINUATION, Some(mut before)) if before.len() + frame.payload.len() <= most => {
                before.extend_from_slice(&frame.payload);
                *begun = Some(before);
            }
            _ => return Err(invalid("neither a text nor what goes on with one, or too long")),
        }
        if frame.last
            && let Some(bytes) = begun.take()
        {
            return String::from_utf8(bytes).map(Received::Text).map_err(|_| invalid("a text is UTF-8"));
        }
    }
}

fn invalid(why: &'static str) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, why)
}

struct Frame {
    kind: u8,
    last: bool,
    payload: Vec<u8>,
}

/// The frame that these bytes begin with, unmasked, and its length; none where it is not complete.
fn parse(bytes: &mut [u8], most: usize) -> io::Result<Option<(Frame, usize)>> {
    let &mut [first, second, ..] = bytes else { return Ok(None) };
    let (kind, last) = (first & 0x0F, first & FIN != 0);
    if first & 0x70 != 0 || second & MASKED == 0 {
        return Err(invalid("extensions are not agreed on, and viewers mask"));
    }
    let short = u64::from(second & !MASKED);
    let (length, at) = match short {
        126 => match bytes.get(2..4).and_then(|two| two.try_into().ok()) {
            Some(two) => (u64::from(u16::from_be_bytes(two)), 4),
            None => return Ok(None),
        },
        127 => match bytes.get(2..10).and_then(|eight| eight.try_into().ok()) {
            Some(eight) => (u64::from_be_bytes(eight), 10),
            None => return Ok(None),
        },
        short => (short, 2),
    };
    let control = kind & 0x8 != 0;
    if length > most as u64 || control && (!last || length > CONTROL_MAX as u64) {
        return Err(invalid("too long, or a control frame in parts"));
    }
    let end = at + 4 + length as usize;
    let Some(frame) = bytes.get(at..end) else { return Ok(None) };
    let (mask, masked) = frame.split_at(4);
    let payload = masked.iter().zip(mask.iter().cycle()).map(|(byte, mask)| byte ^ mask).collect();
    Ok(Some((Frame { kind, last, payload }, end)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As a viewer sends it.
    fn masked(first: u8, payload: &[u8]) -> Vec<u8> {
        let mut bytes = frame(first & 0x0F, payload);
        bytes[0] = first;
        bytes[1] |= MASKED;
        let at = bytes.len() - payload.len();
        let mask = [0x37, 0xfa, 0x21, 0x3d];
        bytes[at..].iter_mut().zip(mask.iter().cycle()).for_each(|(byte, mask)| *byte ^= mask);
        bytes.splice(at..at, mask);
        bytes
    }

    /// Kind, whether it is the last of its message, payload and length.
    type Parts = (u8, bool, Vec<u8>, usize);

    fn read(bytes: &[u8]) -> io::Result<Option<Parts>> {
        let parsed = parse(&mut bytes.to_vec(), 1000)?;
        Ok(parsed.map(|(frame, length)| (frame.kind, frame.last, frame.payload, length)))
    }

    #[test]
    fn the_examples_of_the_standards() {
        // RFC 6455 §1.3 and §5.7; RFC 4648 §10.
        assert_eq!(accept("dGhlIHNhbXBsZSBub25jZQ=="), "s3pPLMBiTxaQ9kYGzzhZRbK+xOo=");
        assert_eq!(text("Hello"), [0x81, 0x05, 0x48, 0x65, 0x6c, 0x6c, 0x6f]);
        let hello = [0x81, 0x85, 0x37, 0xfa, 0x21, 0x3d, 0x7f, 0x9f, 0x4d, 0x51, 0x58];
        assert_eq!(read(&hello).unwrap(), Some((OPCODE_TEXT, true, b"Hello".to_vec(), hello.len())));
        assert_eq!(frame(OPCODE_TEXT, &[0; 256])[..4], [0x81, 0x7E, 0x01, 0x00]);
        assert_eq!(frame(OPCODE_TEXT, &vec![0; 65536])[..10], [0x81, 0x7F, 0, 0, 0, 0, 0, 1, 0, 0]);
        for (bytes, digits) in
            [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foob", "Zm9vYg==")]
        {
            assert_eq!(base64(bytes.as_bytes()), digits);
        }
    }

    #[test]
    fn every_length_comes_back_and_half_a_frame_waits() {
        for length in [0, 1, 125, 126, 1000] {
            let bytes = masked(FIN | OPCODE_TEXT, &vec![7; length]);
            assert_eq!(read(&bytes).unwrap(), Some((OPCODE_TEXT, true, vec![7; length], bytes.len())));
            for cut in 0..bytes.len().min(12) {
                assert_eq!(read(&bytes[..cut]).unwrap(), None, "{length} {cut}");
            }
        }
    }

    #[test]
    fn what_the_standard_forbids_ends_the_socket() {
        assert!(read(&text("unmasked")).is_err());
        assert!(read(&masked(FIN | 0x40 | OPCODE_TEXT, b"extended")).is_err());
        assert!(read(&masked(OPCODE_PING, b"in parts")).is_err());
        assert!(read(&masked(FIN | OPCODE_PING, &[0; 126])).is_err());
        assert!(read(&masked(FIN | OPCODE_TEXT, &[0; 1001])).is_err());
        // A length that fills the memory is refused before anything of it has come.
        assert!(read(&[FIN | OPCODE_TEXT, MASKED | 127, 0x7F, 0, 0, 0, 0, 0, 0, 0]).is_err());
    }
}
