//! `eth`: Ethernet driver for lockstep messages. One Ethernet frame each, through the board's controller
//! ([`lan9118`]).
//!
//! A frame is the 14-byte header with `protocol::lockstep::ETHERTYPE`, the length (u16 LE), and the message.
//! Frames that are not of that form are counted and skipped. QEMU needs about 100 µs for a round trip, 30
//! times less than through the UART.

use core::sync::atomic::{AtomicU32, Ordering};

use protocol::lockstep::{ETHERTYPE, MESSAGE_LEN_MAX};
use zerocopy::IntoBytes;

use super::lan9118::{self, CHECKSUM_LEN, FRAME_LEN_MIN};

/// Starts the controller: receiver and sender. Call once; `None` if there is no such controller.
pub(crate) fn start() -> Option<(Inlet, Outlet)> {
    if !lan9118::start() {
        return None;
    }
    Some((Inlet { frame: [0; FRAME_WORDS] }, Outlet { frame: [0; FRAME_WORDS] }))
}

/// Number of foreign or too long frames.
pub(crate) static STRANGE_FRAMES: AtomicU32 = AtomicU32::new(0);

/// Takes frames from the controller.
pub(crate) struct Inlet {
    frame: [u32; FRAME_WORDS],
}

impl Inlet {
    pub(crate) fn receive(&mut self) -> &[u8] {
        let message = loop {
            let len = self.next_frame();
            match message_in(self.frame.as_bytes().get(..len)) {
                Some(message) => break message,
                None => STRANGE_FRAMES.fetch_add(1, Ordering::Relaxed),
            };
        };
        self.frame.as_bytes().get(message).unwrap_or_default()
    }

    /// Fetches the next frame into the buffer; returns its length, which is more than the buffer's where it
    /// did not fit.
    fn next_frame(&mut self) -> usize {
        sleep_until(lan9118::has_frame);
        lan9118::take(&mut self.frame)
    }
}

/// Range of the message in a frame, if the frame is one of ours.
fn message_in(frame: Option<&[u8]>) -> Option<core::ops::Range<usize>> {
    let (header, rest) = frame?.split_first_chunk::<HEADER_LEN>()?;
    let (len, rest) = rest.split_first_chunk::<2>()?;
    let len = usize::from(u16::from_le_bytes(*len));
    let ours = header.last_chunk() == Some(&ETHERTYPE.to_be_bytes()) && len <= rest.len();
    ours.then_some(MESSAGE_AT..MESSAGE_AT + len)
}

/// Passes frames to the controller.
pub(crate) struct Outlet {
    frame: [u32; FRAME_WORDS],
}

impl Outlet {
    /// Sends the message that `write` puts into the buffer it is given; `write` returns its length.
    pub(crate) fn send(&mut self, write: impl FnOnce(&mut [u8]) -> usize) {
        let Some((header, rest)) = self.frame.as_mut_bytes().split_first_chunk_mut::<HEADER_LEN>() else {
            return;
        };
        let Some((len, message)) = rest.split_first_chunk_mut::<2>() else { return };
        let written = write(message).min(MESSAGE_LEN_MAX);
        *header = HEADER;
        *len = (written as u16).to_le_bytes();
        let frame_len = (MESSAGE_AT + written).max(FRAME_LEN_MIN);
        lan9118::put(&self.frame, frame_len);
    }
}

/// Sleeps until `ready`. Interrupts are masked around the check, so that none comes between a negative result
/// and the sleep; a masked one still ends it.
fn sleep_until(mut ready: impl FnMut() -> bool) {
    loop {
        let done = critical_section::with(|_| {
            let done = ready();
            if !done {
                cortex_m::asm::dsb();
                cortex_m::asm::wfi();
            }
            done
        });
        if done {
            return;
        }
    }
}

/// Destination (broadcast), source (a locally administered address), type.
const HEADER: [u8; HEADER_LEN] = {
    let [high, low] = ETHERTYPE.to_be_bytes();
    [0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0x02, 0, 0, 0, 0, 0x01, high, low]
};
const HEADER_LEN: usize = 14;
/// Offset of the message, behind header and length.
const MESSAGE_AT: usize = HEADER_LEN + 2;
const FRAME_WORDS: usize = (MESSAGE_AT + MESSAGE_LEN_MAX + CHECKSUM_LEN).div_ceil(4);
