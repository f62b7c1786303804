//! `mailboxes`: mailboxes between a robot's tasks: one inbox to the brain, one outbox of packets and one
//! signal of orders from it.

use core::cell::Cell;
use core::future::poll_fn;
use core::sync::atomic::{AtomicBool, AtomicU32, Ordering};

use embassy_sync::blocking_mutex::Mutex;
use embassy_sync::blocking_mutex::raw::CriticalSectionRawMutex;
use embassy_sync::channel::Channel;
use embassy_sync::signal::Signal;
use protocol::Instant;
use protocol::link::Packet;
use protocol::parts::PartsReport;
use protocol::robot_io::{ActuatorFrame, SensorFrame};

use crate::progress::{RobotPart, TaskProgress};

/// Inputs that may wait for the brain. When full, radio and sensors wait with the next one: their drivers
/// count what is lost then.
pub const INBOX_LEN: usize = 8;
/// Packets that may wait for the radio: more than the brain sends in one step. When full, the newest is
/// dropped and counted.
pub const OUTBOX_LEN: usize = 8;

/// Something for the brain.
#[allow(
    clippy::large_enum_variant,
    reason = "a packet is hardly smaller than a sensor frame, and there is no heap to box it on"
)]
#[derive(Clone, Debug, PartialEq)]
pub enum Arrival {
    /// A packet received by radio.
    Packet(Packet),
    /// A sensor frame: the brain makes a step.
    Sensors(SensorFrame),
}

/// The channels between the tasks of one robot.
pub struct Mailboxes {
    pub(crate) inbox: Channel<CriticalSectionRawMutex, Arrival, INBOX_LEN>,
    pub(crate) outbox: Channel<CriticalSectionRawMutex, Packet, OUTBOX_LEN>,
    /// Only the latest orders count: a body never executes old ones.
    pub(crate) orders: Signal<CriticalSectionRawMutex, ActuatorFrame>,
    /// Parts that have run, for the watchdog.
    pub(crate) progress: TaskProgress,
    /// The newest report of the robot's parts.
    pub(crate) parts: Mutex<CriticalSectionRawMutex, Cell<PartsReport>>,
    /// The host's ball contradicts the break-beam sensor.
    pub(crate) beam_doubted: AtomicBool,
    /// The radio's faults, and when the last came, ms of the robot's clock, wrapping; 0: none came.
    radio_faults: (AtomicU32, AtomicU32),
    unsent: AtomicU32,
    undelivered: AtomicU32,
}

impl Mailboxes {
    /// Mailboxes without any message; const, for a static.
    pub const fn new() -> Self {
        Self {
            inbox: Channel::new(),
            outbox: Channel::new(),
            orders: Signal::new(),
            progress: TaskProgress::new(),
            parts: Mutex::new(Cell::new(PartsReport::new())),
            beam_doubted: AtomicBool::new(false),
            radio_faults: (AtomicU32::new(0), AtomicU32::new(0)),
            unsent: AtomicU32::new(0),
            undelivered: AtomicU32::new(0),
        }
    }

    /// Number of packets of the brain that were dropped because the outbox was full.
    pub fn unsent(&self) -> u32 {
        self.unsent.load(Ordering::Relaxed)
    }

    /// Number of arrivals that found the inbox full: none, as long as all tasks of a robot run on one
    /// executor.
    pub fn undelivered(&self) -> u32 {
        self.undelivered.load(Ordering::Relaxed)
    }

    /// Delivers a received packet on a board without a radio; returns whether there was room for it.
    pub fn receive(&self, packet: Packet) -> bool {
        self.inbox.try_send(Arrival::Packet(packet)).is_ok()
    }

    /// Returns whether the next arrival has to wait.
    pub fn is_full(&self) -> bool {
        self.inbox.is_full()
    }

    /// Takes the number of faults that the radio has counted since its start.
    pub fn note_radio(&self, now: Instant, faults: u32) {
        if self.radio_faults.0.swap(faults, Ordering::Relaxed) != faults {
            self.radio_faults.1.store(ms(now).max(1), Ordering::Relaxed);
        }
    }

    /// Whether break-beam sensor and radio are doubted now.
    pub(crate) fn doubted(&self, now: Instant) -> [bool; 2] {
        let last = self.radio_faults.1.load(Ordering::Relaxed);
        let radio = last != 0 && ms(now).wrapping_sub(last) < RADIO_DOUBTED_MS;
        [self.beam_doubted.load(Ordering::Relaxed), radio]
    }

    /// Records that a part of the robot runs, where a board has a task of its own for it.
    pub fn mark(&self, part: RobotPart) {
        self.progress.mark(part);
    }

    /// Waits until [`Mailboxes::deliver`] has room for one arrival.
    pub(crate) async fn room_for_arrival(&self) {
        poll_fn(|context| self.inbox.poll_ready_to_send(context)).await;
    }

    /// Puts an input into the inbox. Must be called when there is room, without an await since the check;
    /// else the input is lost, and counted.
    pub(crate) fn deliver(&self, arrival: Arrival) {
        if self.inbox.try_send(arrival).is_err() {
            self.undelivered.fetch_add(1, Ordering::Relaxed);
        }
    }

    /// Sends a packet, or counts it as lost.
    pub(crate) fn post(&self, packet: Packet) {
        if self.outbox.try_send(packet).is_err() {
            self.unsent.fetch_add(1, Ordering::Relaxed);
        }
    }
}

fn ms(now: Instant) -> u32 {
    (now.0 / 1_000) as u32
}

/// A radio is doubted for this time after a fault, ms: less than a suspicion has to last, so that one fault
/// is no failure, and a chip that is set up again at every check of 25 ms is.
const RADIO_DOUBTED_MS: u32 = 300;

impl Default for Mailboxes {
    fn default() -> Self {
        Self::new()
    }
}
