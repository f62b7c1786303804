//! `lan9118`: driver of the board's Ethernet controller LAN9118 (data sheet DS00002266): start, interrupt,
//! frames in and out.
//!
//! Frames are words of four bytes, in the order of memory, without their check sum.

use cortex_m::interrupt::InterruptNumber;
use cortex_m::peripheral::NVIC;

use super::register::Register;

/// Starts receiver and sender, and the interrupt that a received frame raises; call once. Whether there is
/// such a controller.
pub(crate) fn start() -> bool {
    if BYTE_TEST.read() != BYTE_TEST_VALUE {
        return false;
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
    // SAFETY: the interrupt only runs what the board's handler does with `acknowledge`; no other code relies
    // on it being masked.
    unsafe { NVIC::unmask(EthernetIrq) }
    true
}

/// Handles the controller's interrupt; the frame itself is fetched outside.
pub(crate) fn acknowledge() {
    INT_STS.write(u32::MAX);
}

pub(crate) fn has_frame() -> bool {
    RX_FIFO_INF.read() >> 16 & 0xff != 0
}

/// Fetches the frame that waits into `frame`, as far as it fits; returns its length in bytes, which is more
/// than the buffer's where it did not fit.
pub(crate) fn take(frame: &mut [u32]) -> usize {
    let len = (RX_STATUS_FIFO.read() >> 16 & 0x3fff) as usize;
    for index in 0..len.div_ceil(4) {
        let word = RX_DATA_FIFO.read();
        if let Some(place) = frame.get_mut(index) {
            *place = word;
        }
    }
    len.saturating_sub(CHECKSUM_LEN)
}

/// Sends the first `len` bytes of `frame`.
pub(crate) fn put(frame: &[u32], len: usize) {
    TX_DATA_FIFO.write(len as u32 | TX_FIRST | TX_LAST);
    TX_DATA_FIFO.write(len as u32);
    for word in frame.iter().take(len.div_ceil(4)) {
        TX_DATA_FIFO.write(*word);
    }
    // Transmission status is not used; the status queue must not fill up.
    while TX_FIFO_INF.read() >> 16 & 0xff != 0 {
        TX_STATUS_FIFO.read();
    }
}

/// Ethernet's shortest frame, without the checksum.
pub(crate) const FRAME_LEN_MIN: usize = 60;
/// Bytes of a frame's checksum, which the controller hands over with it.
pub(crate) const CHECKSUM_LEN: usize = 4;

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
