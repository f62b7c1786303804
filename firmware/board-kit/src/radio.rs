//! `radio`: a radio modem on a serial line of any chip. COBS bytes (`protocol::serial`): a ring for received
//! bytes, so that none are lost during the brain's longest step, one line at a time for sending.

use core::sync::atomic::{AtomicU32, Ordering};

use embassy_time::{Duration, Timer};
use embedded_io_async::{Read, Write};
use protocol::link::Packet;
use protocol::serial::{LINE_LEN_MAX, Lines, line};
use rules::RobotSpec;
use runtime::ports::{RadioReceiver, RadioSender};

/// Receives frames from a line that buffers [`RING_LEN`] bytes or more, and decodes COBS lines.
pub struct UartReceiver<R> {
    rx: R,
    lines: Lines,
    received: [u8; READ_LEN_MAX],
    /// Range of `received` that is not yet decoded.
    rest: (usize, usize),
}

impl<R: Read> UartReceiver<R> {
    /// A receiver before its first byte.
    pub fn new(rx: R) -> Self {
        Self { rx, lines: Lines::new(), received: [0; READ_LEN_MAX], rest: (0, 0) }
    }

    /// Received bytes, as they arrive.
    pub async fn bytes(&mut self) -> &[u8] {
        let len = loop {
            if let Ok(len) = self.rx.read(&mut self.received).await {
                break len;
            }
            // An error of a line that is unplugged or set to another rate. Reception continues with the next
            // read, but endless noise must not take the other tasks' time.
            LINE_ERRORS.store(line_errors().wrapping_add(1), Ordering::Relaxed);
            Timer::after(ERROR_PAUSE).await;
        };
        self.received.get(..len).unwrap_or_default()
    }
}

impl<R: Read> RadioReceiver for UartReceiver<R> {
    async fn receive(&mut self) -> Packet {
        loop {
            let (from, to) = self.rest;
            let rest = self.received.get(from..to).unwrap_or_default();
            for (read, byte) in (from + 1..).zip(rest) {
                if let Some(packet) = self.lines.push(*byte) {
                    self.rest = (read, to);
                    return packet;
                }
            }
            self.rest = (0, self.bytes().await.len());
        }
    }

    fn faults(&self) -> u32 {
        line_errors()
    }
}

/// Sends frames, one COBS line at a time.
pub struct UartSender<W> {
    tx: W,
    /// From which the line sends: a static, where a DMA reads it.
    line: &'static mut [u8; LINE_LEN_MAX],
}

impl<W: Write> UartSender<W> {
    /// A line that is idle.
    pub fn new(tx: W, line: &'static mut [u8; LINE_LEN_MAX]) -> Self {
        Self { tx, line }
    }

    /// Sends bytes unchanged, at most a line's capacity.
    pub async fn send_bytes(&mut self, bytes: &[u8]) {
        let len = bytes.len().min(LINE_LEN_MAX);
        self.line.iter_mut().zip(bytes).for_each(|(to, from)| *to = *from);
        // Not `write_all`, which panics where a line takes nothing.
        let mut rest = self.line.get(..len).unwrap_or_default();
        while !rest.is_empty() {
            let taken = self.tx.write(rest).await.unwrap_or(0);
            if taken == 0 {
                LINE_ERRORS.store(line_errors().wrapping_add(1), Ordering::Relaxed);
                return;
            }
            rest = rest.get(taken..).unwrap_or_default();
        }
    }
}

impl<W: Write> RadioSender for UartSender<W> {
    async fn send(&mut self, packet: Packet) {
        let line = line(&packet);
        self.send_bytes(&line).await;
    }
}

/// Number of line errors: framing, overrun, line_errors.
pub fn line_errors() -> u32 {
    LINE_ERRORS.load(Ordering::Relaxed)
}

static LINE_ERRORS: AtomicU32 = AtomicU32::new(0);
/// Rate of the line to the radio, bit/s.
pub const BAUD: u32 = RobotSpec::OURS.parts.baud;
/// Bytes received in 5 ms; half of it raises the interrupt. The brain's longest step takes a fifth of a
/// millisecond at 400 MHz.
pub const RING_LEN: usize = 512;
/// Pause after a line error: shorter than that between two of the host's snapshots.
const ERROR_PAUSE: Duration = Duration::from_millis(1);
/// Bytes read in one call.
const READ_LEN_MAX: usize = 64;
