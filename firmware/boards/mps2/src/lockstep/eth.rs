//! `eth`: Ethernet driver for lockstep messages. One Ethernet frame each, through the board's LAN9118
//! controller (data sheet DS00002266).
//!
//! A frame is the 14-byte header with `protocol::lockstep::ETHERTYPE`, the length (u16 LE), and the message.
//! Frames that are not of that form are counted and skipped. QEMU needs about 100 µs for a round trip, 30
//! times less than through the UART.

use core::sync::atomic::{AtomicU32, Ordering};

use cortex_m::interrupt::InterruptNumber;
use cortex_m::peripheral::NVIC;
use protocol::lockstep::{ETHERTYPE, MESSAGE_LEN_MAX};
use zerocopy::IntoBytes;

use super::register::Register;

/// Starts the controller: receiver and sender. Call once; `None` if there is no such controller.
pub(crate) fn start() -> Option<(Inlet, Outlet)> {
    if BYTE_TEST.read() != BYTE_TEST_VALUE {
        return None;
    }
    MAC_CSR_DATA.write(MAC_CR_PROMISCUOUS | MAC_CR_TX_ON | MAC_CR_RX_ON);
    MAC_CSR_CMD.write(MAC_CSR_BUSY | MAC_CR_INDEX);
    while MAC_CSR_CMD.read() & MAC_CSR_BUSY != 0 {}
    TX_CFG.write(TX_CFG_ON);
    // One frame received is enough for an interrupt.
    FIFO_INT.write(FIFO_INT_RX_STATUS_ABOVE_0);
    RX_CFG.write(0);
    INT_STS.write(u32::MAX);
    INT_EN.write(INT_RX_STATUS_LEVEL);
    IRQ_CFG.write(IRQ_CFG_ENABLE | IRQ_CFG_ACTIVE_HIGH | IRQ_CFG_PUSH_PULL);
    // SAFETY: the interrupt only runs `acknowledge`; no other code relies on it being masked.
    unsafe { NVIC::unmask(EthernetIrq) }
    Some((Inlet { frame: [0; FRAME_DESCRIPTION] }, Outlet { frame: [0; FRAME_DESCRIPTION] }))
}

/// Handles the controller's interrupt; the frame itself is fetched outside.
pub(crate) fn acknowledge() {
    INT_STS.write(u32::MAX);
}

/// Number of foreign or too long frames.
pub(crate) static STRANGE_FRAMES: AtomicU32 = AtomicU32::new(0);

/// Takes frames from the controller.
pub(crate) struct Inlet {
    frame: [u32; FRAME_DESCRIPTION],
}

impl Inlet {
    /// The next message; sleeps until there is one.
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
        sleep_until(|| RX_FIFO_INF.read() >> 16 & 0xff != 0);
        let len = (RX_STATUS_FIFO.read() >> 16 & 0x3fff) as usize;
        for index in 0..len.div_ceil(4) {
            let label = RX_DATA_FIFO.read();
            if let Some(place) = self.frame.get_mut(index) {
                *place = label;
            }
        }
        len.saturating_sub(CHECKSUM_LEN)
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
    frame: [u32; FRAME_DESCRIPTION],
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
        TX_DATA_FIFO.write(frame_len as u32 | TX_FIRST | TX_LAST);
        TX_DATA_FIFO.write(frame_len as u32);
        for label in self.frame.iter().take(frame_len.div_ceil(4)) {
            TX_DATA_FIFO.write(*label);
        }
        // Transmission status is not used; the status queue must not fill up.
        while TX_FIFO_INF.read() >> 16 & 0xff != 0 {
            TX_STATUS_FIFO.read();
        }
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
/// Ethernet's shortest frame, without the checksum.
const FRAME_LEN_MIN: usize = 60;
const CHECKSUM_LEN: usize = 4;
const FRAME_DESCRIPTION: usize = (MESSAGE_AT + MESSAGE_LEN_MAX + CHECKSUM_LEN).div_ceil(4);

/// A register of the controller.
const fn register(offset: usize) -> Register {
    // SAFETY: every register below is one of this board's Ethernet controller (MPS2 AN386: at 0x4020_0000).
    unsafe { Register::at(0x4020_0000 + offset) }
}

const RX_DATA_FIFO: Register = register(0x00);
const TX_DATA_FIFO: Register = register(0x20);
const RX_STATUS_FIFO: Register = register(0x40);
const TX_STATUS_FIFO: Register = register(0x48);
const IRQ_CFG: Register = register(0x54);
const INT_STS: Register = register(0x58);
const INT_EN: Register = register(0x5c);
const BYTE_TEST: Register = register(0x64);
const FIFO_INT: Register = register(0x68);
const RX_CFG: Register = register(0x6c);
const TX_CFG: Register = register(0x70);
const RX_FIFO_INF: Register = register(0x7c);
const TX_FIFO_INF: Register = register(0x80);
const MAC_CSR_CMD: Register = register(0xa4);
const MAC_CSR_DATA: Register = register(0xa8);

const BYTE_TEST_VALUE: u32 = 0x8765_4321;
const MAC_CSR_BUSY: u32 = 1 << 31;
const MAC_CR_INDEX: u32 = 1;
const MAC_CR_PROMISCUOUS: u32 = 1 << 18;
const MAC_CR_TX_ON: u32 = 1 << 3;
const MAC_CR_RX_ON: u32 = 1 << 2;
const TX_CFG_ON: u32 = 1 << 1;
/// Interrupt levels: transmit data as after a reset, receive status 0.
const FIFO_INT_RX_STATUS_ABOVE_0: u32 = 0x4800_0000;
const INT_RX_STATUS_LEVEL: u32 = 1 << 3;
const IRQ_CFG_ENABLE: u32 = 1 << 8;
const IRQ_CFG_ACTIVE_HIGH: u32 = 1 << 4;
const IRQ_CFG_PUSH_PULL: u32 = 1;
const TX_FIRST: u32 = 1 << 13;
const TX_LAST: u32 = 1 << 12;

/// The controller's interrupt number.
#[derive(Clone, Copy)]
struct EthernetIrq;

// SAFETY: 13 is the number of the Ethernet interrupt on AN386, and it does not change.
unsafe impl InterruptNumber for EthernetIrq {
    fn number(self) -> u16 {
        13
    }
}
