//! Where do a robot's tasks meet? One inbox to the brain, one outbox and one slip of orders from it.

use core::sync::atomic::{AtomicU32, Ordering};

use embassy_sync::blocking_mutex::raw::CriticalSectionRawMutex;
use embassy_sync::channel::Channel;
use embassy_sync::signal::Signal;
use protocol::link::Packet;
use protocol::robot_io::{ActuatorFrame, SensorFrame};

/// Arrivals that may wait for the brain. When full, radio and senses wait with the next one: what is lost then, their
/// drivers count.
pub const INBOX_LEN: usize = 8;
/// Packets that may wait for the air: more than the brain says in one step. When full, the newest is dropped and counted.
pub const OUTBOX_LEN: usize = 8;

/// Something for the brain.
#[allow(
    clippy::large_enum_variant,
    reason = "a packet is hardly smaller than a picture, and there is no heap to box it on"
)]
#[derive(Clone, Debug, PartialEq)]
pub enum Arrival {
    /// A packet of the air.
    Packet(Packet),
    /// A picture of the world: the brain makes a step.
    Sensors(SensorFrame),
}

/// The channels between the tasks of one robot.
pub struct Mailboxes {
    pub(crate) inbox: Channel<CriticalSectionRawMutex, Arrival, INBOX_LEN>,
    pub(crate) outbox: Channel<CriticalSectionRawMutex, Packet, OUTBOX_LEN>,
    /// The latest word counts: a body never works off old orders.
    pub(crate) orders: Signal<CriticalSectionRawMutex, ActuatorFrame>,
    unsent: AtomicU32,
}

impl Mailboxes {
    /// All empty.
    pub const fn new() -> Self {
        Self {
            inbox: Channel::new(),
            outbox: Channel::new(),
            orders: Signal::new(),
            unsent: AtomicU32::new(0),
        }
    }

    /// How many packets the brain said that found the outbox full.
    pub fn unsent(&self) -> u32 {
        self.unsent.load(Ordering::Relaxed)
    }

    /// A packet for the air, or one more that is lost.
    pub(crate) fn post(&self, packet: Packet) {
        if self.outbox.try_send(packet).is_err() {
            self.unsent.fetch_add(1, Ordering::Relaxed);
        }
    }
}

impl Default for Mailboxes {
    fn default() -> Self {
        Self::new()
    }
}
