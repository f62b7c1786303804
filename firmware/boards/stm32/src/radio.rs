//! `radio`: UART driver of the radio. COBS bytes (`protocol::serial`), carried by the DMA: a ring for
//! received bytes, so that none are lost during the brain's longest step, one line at a time for sending.

use core::sync::atomic::{AtomicU32, Ordering};

use embassy_stm32::gpio::Pull;
use embassy_stm32::mode::Async;
use embassy_stm32::usart::{self, RingBufferedUartRx, Uart, UartTx};
use embassy_stm32::{bind_interrupts, dma, peripherals};
use embassy_time::{Duration, Timer};
use protocol::link::Packet;
use protocol::serial::{LINE_LEN_MAX, Lines, line};
use runtime::ports::{RadioReceiver, RadioSender};
use static_cell::StaticCell;

use crate::pins;

bind_interrupts!(struct Interrupts {
    USART2 => usart::InterruptHandler<peripherals::USART2>;
    DMA1_STREAM0 => dma::InterruptHandler<peripherals::DMA1_CH0>;
    DMA1_STREAM1 => dma::InterruptHandler<peripherals::DMA1_CH1>;
});

/// Both directions of the line; `None` where the line cannot have this rate. Call once.
pub fn open(parts: pins::Radio) -> Option<(UartSender, UartReceiver)> {
    static RING: StaticCell<[u8; RING_LEN]> = StaticCell::new();
    static LINE: StaticCell<[u8; LINE_LEN_MAX]> = StaticCell::new();
    let mut config = usart::Config::default();
    config.baudrate = BAUD;
    // Where no radio is plugged in, the line is idle.
    config.rx_pull = Pull::Up;
    let line =
        Uart::new(parts.line, parts.rx, parts.tx, parts.tx_dma, parts.rx_dma, Interrupts, config).ok()?;
    let (tx, rx) = line.split();
    let rx = rx.into_ring_buffered(RING.init([0; RING_LEN]));
    Some((UartSender { tx, line: LINE.init([0; LINE_LEN_MAX]) }, UartReceiver::new(rx)))
}

/// Receives frames by DMA into a ring, and decodes COBS lines.
pub struct UartReceiver {
    rx: RingBufferedUartRx<'static>,
    lines: Lines,
    came: [u8; CHUNK],
    /// Range of `came` that is not yet decoded.
    rest: (usize, usize),
}

impl UartReceiver {
    fn new(rx: RingBufferedUartRx<'static>) -> Self {
        Self { rx, lines: Lines::new(), came: [0; CHUNK], rest: (0, 0) }
    }

    /// Received bytes, as they arrive.
    pub async fn bytes(&mut self) -> &[u8] {
        let len = loop {
            if let Ok(len) = self.rx.read(&mut self.came).await {
                break len;
            }
            // An error of a line that is unplugged or set to another rate. Reception continues with the next
            // read, but endless noise must not take the other tasks' time.
            NOISE.store(noise().wrapping_add(1), Ordering::Relaxed);
            Timer::after(REST).await;
        };
        self.came.get(..len).unwrap_or_default()
    }
}

impl RadioReceiver for UartReceiver {
    async fn receive(&mut self) -> Packet {
        loop {
            let (from, to) = self.rest;
            let rest = self.came.get(from..to).unwrap_or_default();
            for (read, byte) in (from + 1..).zip(rest) {
                if let Some(packet) = self.lines.push(*byte) {
                    self.rest = (read, to);
                    return packet;
                }
            }
            self.rest = (0, self.bytes().await.len());
        }
    }
}

/// Sends frames by DMA, one COBS line at a time.
pub struct UartSender {
    tx: UartTx<'static, Async>,
    /// Buffer from which the DMA sends.
    line: &'static mut [u8; LINE_LEN_MAX],
}

impl UartSender {
    /// Sends bytes unchanged, at most a line's capacity.
    pub async fn send_bytes(&mut self, bytes: &[u8]) {
        let len = bytes.len().min(LINE_LEN_MAX);
        self.line.iter_mut().zip(bytes).for_each(|(to, from)| *to = *from);
        if let Some(whole) = self.line.get(..len)
            && self.tx.write(whole).await.is_err()
        {
            NOISE.store(noise().wrapping_add(1), Ordering::Relaxed);
        }
    }
}

impl RadioSender for UartSender {
    async fn send(&mut self, packet: Packet) {
        let line = line(&packet);
        self.send_bytes(&line).await;
    }
}

/// Number of line errors: framing, overrun, noise.
pub fn noise() -> u32 {
    NOISE.load(Ordering::Relaxed)
}

static NOISE: AtomicU32 = AtomicU32::new(0);
/// The host's usual rate for serial links (`host::config`).
const BAUD: u32 = 1_000_000;
/// Bytes received in 5 ms; half of it raises the interrupt. The brain's longest step takes a fifth of a
/// millisecond.
const RING_LEN: usize = 512;
/// After an error, before it listens again: shorter than the pause between two of the host's snapshots.
const REST: Duration = Duration::from_millis(1);
/// Bytes read in one call.
const CHUNK: usize = 64;
