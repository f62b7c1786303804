//! `uart`: UART driver of the radio link. COBS bytes (`protocol::serial`), an interrupt each (CMSDK APB UART,
//! Arm DDI 0479).

use core::future::poll_fn;
use core::sync::atomic::{AtomicU32, Ordering};
use core::task::Poll;

use cortex_m::interrupt::InterruptNumber;
use cortex_m::peripheral::NVIC;
use cortex_m_rt::exception;
use embassy_sync::blocking_mutex::raw::CriticalSectionRawMutex;
use embassy_sync::pipe::Pipe;
use embassy_sync::waitqueue::AtomicWaker;
use protocol::link::Packet;
use protocol::serial::{Lines, line};
use runtime::ports::{RadioReceiver, RadioSender};

use super::register::Register;

/// Starts both directions; call once.
pub(crate) fn start() {
    BAUD_DIVIDER.write(DIVIDER_LEAST);
    CONTROL.write(TX_ON | RX_ON | TX_INTERRUPT | RX_INTERRUPT);
    // SAFETY: the interrupts only move a byte and wake a task.
    unsafe {
        NVIC::unmask(Irq(RX_IRQ));
        NVIC::unmask(Irq(TX_IRQ));
    }
}

/// Received bytes; twice the longest frame, so that none are lost during the brain's longest step at the
/// line's rate.
static CAME: Pipe<CriticalSectionRawMutex, 512> = Pipe::new();
/// Number of bytes that found it full, for a debugger to read.
static RX_DROPPED: AtomicU32 = AtomicU32::new(0);
static TX_SPACE_WAKER: AtomicWaker = AtomicWaker::new();

/// Only the line's two interrupts are enabled.
#[exception]
unsafe fn DefaultHandler(number: i16) {
    if number == RX_IRQ as i16 {
        // Cleared first: a byte that arrives after the last check must raise it again.
        INTERRUPTS.write(RX_INTERRUPT_BIT);
        while STATE.read() & RX_FULL != 0 {
            if CAME.try_write(&[DATA.read() as u8]).is_err() {
                RX_DROPPED.store(RX_DROPPED.load(Ordering::Relaxed).wrapping_add(1), Ordering::Relaxed);
            }
        }
    } else {
        INTERRUPTS.write(TX_INTERRUPT_BIT);
        TX_SPACE_WAKER.wake();
    }
}

pub(crate) struct UartReceiver(Lines);

impl UartReceiver {
    pub(crate) fn new() -> Self {
        Self(Lines::new())
    }
}

impl RadioReceiver for UartReceiver {
    async fn receive(&mut self) -> Packet {
        loop {
            let mut byte = [0];
            CAME.read(&mut byte).await;
            if let Some(packet) = self.0.push(byte[0]) {
                return packet;
            }
        }
    }
}

pub(crate) struct UartSender;

impl RadioSender for UartSender {
    async fn send(&mut self, packet: Packet) {
        for byte in &line(&packet) {
            poll_fn(|context| {
                TX_SPACE_WAKER.register(context.waker());
                if STATE.read() & TX_FULL == 0 { Poll::Ready(()) } else { Poll::Pending }
            })
            .await;
            DATA.write(u32::from(*byte));
        }
    }
}

#[derive(Clone, Copy)]
struct Irq(u16);

// SAFETY: the numbers below are those of the first UART on AN386, and they do not change.
unsafe impl InterruptNumber for Irq {
    fn number(self) -> u16 {
        self.0
    }
}

const fn register(offset: usize) -> Register {
    // SAFETY: every register below is one of this board's first UART (MPS2 AN386: at 0x4000_4000).
    unsafe { Register::at(0x4000_4000 + offset) }
}

const RX_IRQ: u16 = 0;
const TX_IRQ: u16 = 1;
const DATA: Register = register(0x00);
const STATE: Register = register(0x04);
const CONTROL: Register = register(0x08);
const INTERRUPTS: Register = register(0x0c);
const BAUD_DIVIDER: Register = register(0x10);
const TX_FULL: u32 = 1;
const RX_FULL: u32 = 1 << 1;
const TX_ON: u32 = 1;
const RX_ON: u32 = 1 << 1;
const TX_INTERRUPT: u32 = 1 << 2;
const RX_INTERRUPT: u32 = 1 << 3;
const TX_INTERRUPT_BIT: u32 = 1;
const RX_INTERRUPT_BIT: u32 = 1 << 1;
/// The fastest rate of the line; an emulated one has no other.
const DIVIDER_LEAST: u32 = 16;
