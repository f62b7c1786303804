//! `serial`: framing on a serial line: frames are COBS-encoded, a zero byte after each; a receiver
//! synchronises at the next zero (docs/architecture.md §6.1).
//!
//! COBS finds the next frame after any garbage and nothing more; the frame's tag verifies the bytes.

use cobs::{DecodeResult, DecoderState};

use crate::frame::FRAME_LEN_MAX;
use crate::link::Packet;

/// The longest frame on a line: one byte of stuffing before it (254 would need two), the zero after it.
pub const LINE_LEN_MAX: usize = FRAME_LEN_MAX + 2;

/// An encoded frame for a line, its zero included.
pub type Line = heapless::Vec<u8, LINE_LEN_MAX>;

/// The line that carries `packet`; empty for one longer than [`FRAME_LEN_MAX`], a single zero for an empty
/// one.
pub fn line(packet: &[u8]) -> Line {
    let mut line = Line::new();
    if packet.len() <= FRAME_LEN_MAX && line.resize_default(LINE_LEN_MAX).is_ok() {
        // The last byte stays free for the zero.
        let room = line.get_mut(..LINE_LEN_MAX - 1);
        let stuffed = room.and_then(|room| cobs::try_encode(packet, room).ok()).unwrap_or(0);
        line.truncate(stuffed);
        let _room = line.push(0);
    }
    line
}

/// Takes bytes from a line and returns frames; garbage is dropped up to the next zero, and counted.
#[derive(Debug)]
pub struct Lines {
    stuffing: DecoderState,
    frame: Packet,
    /// More bytes than a frame can have were received: skip to the next zero.
    overlong: bool,
    dropped: u32,
}

impl Default for Lines {
    fn default() -> Self {
        Self { stuffing: DecoderState::Idle, frame: Packet::new(), overlong: false, dropped: 0 }
    }
}

impl Lines {
    /// A line on which nothing was received yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Takes the next byte of the line; returns a frame when it was the last of one.
    pub fn push(&mut self, byte: u8) -> Option<Packet> {
        let whole = match self.stuffing.feed(byte) {
            Ok(DecodeResult::DataContinue(byte)) => {
                self.overlong |= self.frame.push(byte).is_err();
                return None;
            }
            Ok(DecodeResult::NoData) => return None,
            Ok(DecodeResult::DataComplete) => !self.overlong,
            // A zero in the middle of a frame: the next one starts behind it.
            Err(_) => false,
        };
        self.overlong = false;
        let frame = core::mem::take(&mut self.frame);
        if whole {
            return Some(frame);
        }
        self.dropped = self.dropped.saturating_add(1);
        None
    }

    /// Number of byte sequences between two zeros that were no frame.
    pub fn dropped(&self) -> u32 {
        self.dropped
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frames(lines: &mut Lines, bytes: &[u8]) -> heapless::Vec<Packet, 8> {
        bytes.iter().filter_map(|byte| lines.push(*byte)).collect()
    }

    #[test]
    fn a_line_has_one_zero_and_it_is_the_last() {
        for len in 1..=FRAME_LEN_MAX {
            let mut packet = Packet::new();
            packet.resize(len, 0).unwrap();
            for fill in [0, 1, 255] {
                packet.iter_mut().step_by(3).for_each(|byte| *byte = fill);
                let line = line(&packet);
                assert_eq!(line.iter().position(|byte| *byte == 0), Some(len + 1), "{packet:?}");
                assert_eq!(line.len(), len + 2);
                assert_eq!(frames(&mut Lines::new(), &line)[..], [packet.clone()]);
            }
        }
        assert!(line(&[0; FRAME_LEN_MAX + 1]).is_empty());
    }

    #[test]
    fn after_garbage_of_any_length_the_frame_behind_the_next_zero_is_whole() {
        let packet = Packet::from_slice(&[7, 0, 0, 9, 1]).unwrap();
        let (mut lines, good) = (Lines::new(), line(&packet));
        for garbage in 1..300 {
            let dropped = lines.dropped();
            for n in 0..garbage {
                assert_eq!(lines.push((n % 255) as u8 + 1), None);
            }
            lines.push(0);
            assert!(lines.dropped() <= dropped + 1);
            assert_eq!(
                &frames(&mut lines, &good)[..],
                core::slice::from_ref(&packet),
                "after {garbage} bytes"
            );
        }
        assert!(lines.dropped() > 200, "{}", lines.dropped());
        // Cut in the middle of a frame, then the next.
        assert!(frames(&mut lines, &good[3..]).len() <= 1);
        assert_eq!(frames(&mut lines, &good)[..], [packet]);
    }

    #[test]
    fn zeros_in_a_row_are_silence() {
        let mut lines = Lines::new();
        assert!(frames(&mut lines, &[0, 0, 0]).is_empty());
        assert_eq!(lines.dropped(), 0);
    }

    #[test]
    fn random_bytes_never_panic() {
        let (mut lines, mut state, mut frames) = (Lines::new(), 7_u64, 0);
        for _ in 0..1_000_000 {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            // Few distinct bytes, so that frames and zeros are frequent.
            let byte = (state >> 59) as u8;
            frames += usize::from(lines.push(byte).is_some());
        }
        assert!(frames > 100 && lines.dropped() > 100, "{frames} frames, {} dropped", lines.dropped());
    }
}
