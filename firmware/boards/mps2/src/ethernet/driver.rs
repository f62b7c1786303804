//! `driver`: the board's Ethernet controller as the network stack asks for it (`embassy_net_driver`).

use core::task::Context;

use embassy_net_driver::{Capabilities, Driver, HardwareAddress, LinkState, RxToken, TxToken};
use embassy_sync::waitqueue::AtomicWaker;
use protocol::RobotId;
use zerocopy::IntoBytes;

use super::lan9118::{self, CHECKSUM_LEN, FRAME_LEN_MIN};

/// Wakes the stack's task when a frame was received.
static RECEIVED: AtomicWaker = AtomicWaker::new();

pub(crate) fn interrupt() {
    lan9118::acknowledge();
    RECEIVED.wake();
}

pub(crate) struct Ethernet {
    address: [u8; 6],
    frame: [u32; FRAME_WORDS],
}

impl Ethernet {
    /// Starts it with a locally administered address that only this robot has in its team; `None` if there
    /// is no such controller.
    pub(crate) fn start(robot: RobotId) -> Option<Self> {
        let address = [0x02, 0, 0, 0, 0, robot.number() + 1];
        lan9118::start().then_some(Self { address, frame: [0; FRAME_WORDS] })
    }
}

impl Driver for Ethernet {
    type RxToken<'a> = Received<'a>;
    type TxToken<'a> = Sender;

    fn receive(&mut self, context: &mut Context<'_>) -> Option<(Received<'_>, Sender)> {
        // Registered before the look: a frame that comes after it wakes the task.
        RECEIVED.register(context.waker());
        let mut len = usize::MAX;
        // A frame that did not fit is none of ours: robots and their host send no longer ones.
        while len > FRAME_WORDS * 4 {
            if !lan9118::has_frame() {
                return None;
            }
            len = lan9118::take(&mut self.frame);
        }
        self.frame.as_mut_bytes().get_mut(..len).map(|frame| (Received(frame), Sender))
    }

    fn transmit(&mut self, _context: &mut Context<'_>) -> Option<Sender> {
        // The emulated controller sends what it is given at once.
        Some(Sender)
    }

    fn link_state(&mut self, _context: &mut Context<'_>) -> LinkState {
        LinkState::Up
    }

    fn capabilities(&self) -> Capabilities {
        let mut capabilities = Capabilities::default();
        capabilities.max_transmission_unit = FRAME_LEN_MAX;
        capabilities
    }

    fn hardware_address(&self) -> HardwareAddress {
        HardwareAddress::Ethernet(self.address)
    }
}

pub(crate) struct Received<'a>(&'a mut [u8]);

impl RxToken for Received<'_> {
    fn consume<R, F: FnOnce(&mut [u8]) -> R>(self, work: F) -> R {
        work(self.0)
    }
}

/// Permission to send a frame.
pub(crate) struct Sender;

impl TxToken for Sender {
    fn consume<R, F: FnOnce(&mut [u8]) -> R>(self, len: usize, work: F) -> R {
        let mut frame = [0_u32; FRAME_WORDS];
        // The stack keeps to the unit of `capabilities`.
        let len = len.min(FRAME_LEN_MAX);
        let result = work(frame.as_mut_bytes().get_mut(..len).unwrap_or_default());
        lan9118::put(&frame, len.max(FRAME_LEN_MIN));
        result
    }
}

/// Ethernet's header, and the shortest packet that every IPv4 network carries whole: the longest of ours,
/// a sensor frame of everything, has less than 300 bytes.
const FRAME_LEN_MAX: usize = 14 + 576;
const FRAME_WORDS: usize = (FRAME_LEN_MAX + CHECKSUM_LEN).div_ceil(4);
