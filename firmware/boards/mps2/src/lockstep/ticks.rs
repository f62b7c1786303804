//! `ticks`: execution of one lockstep tick. It runs the robot up to that moment and reports the result
//! (docs/architecture.md §7.2).
//!
//! Hello, set-up, ready; then tick after tick: alarms up to the tick's time, its packets in their order, its
//! sensor frame, and after each kind the tasks run until all of them wait. The robot is constructed with its
//! set-up, at time zero. A message that is invalid in its place is counted and gets no answer; another boot
//! epoch needs another process.

use core::cell::RefCell;
use core::sync::atomic::{AtomicU32, Ordering};

use casebase::CaseBase;
use critical_section::Mutex;
use embassy_executor::{SpawnError, Spawner};
use embassy_sync::blocking_mutex::raw::CriticalSectionRawMutex;
use embassy_sync::channel::Channel;
use heapless::Vec;
use protocol::link::Packet;
use protocol::lockstep::{AIR_OUT_MAX, FromRobot, TickIn, TickOut, ToRobot};
use protocol::robot_io::{ActuatorFrame, SensorFrame};
use runtime::ports::{BodyPort, RadioSender, Senses};
use runtime::{BrainConfig, Mailboxes, setup, tasks};

use super::clock::Clock;
use super::eth::{self, Inlet, Outlet};
use super::{instructions, library, stack};

pub(crate) fn run() -> ! {
    let core = cortex_m::Peripherals::take().expect("taken once, at start");
    instructions::start(core.SYST);
    let (mut inlet, mut outlet) = eth::start().expect("the machine has a LAN9118: mps2-an386");
    let clock = Clock::new();
    report(&mut outlet, &FromRobot::Hello);
    let (config, base) = wait_for_setup(&mut inlet, &mut outlet);
    start_tasks(clock.spawner(), config, base).expect("every task is started once");
    clock.settle();
    report(&mut outlet, &FromRobot::Ready);
    let mut stack = stack::used();
    loop {
        let Some(ToRobot::Tick(tick)) = read(inlet.receive()) else {
            STRANGE.fetch_add(1, Ordering::Relaxed);
            continue;
        };
        let seq = tick.seq;
        let ((), instructions) = instructions::counted(|| live(&clock, tick));
        if seq % STACK_EVERY == 0 {
            stack = stack::used();
        }
        let done = critical_section::with(|cs| DONE.borrow(cs).take());
        let air = done.air.iter().map(|packet| &packet[..]).collect();
        let answer = TickOut { seq, actuators: done.actuators, air, instructions, stack };
        report(&mut outlet, &FromRobot::Tick(answer));
    }
}

/// Identity and case base of the robot; asks again until both can be read.
fn wait_for_setup(inlet: &mut Inlet, outlet: &mut Outlet) -> (BrainConfig, CaseBase<'static>) {
    loop {
        let Some(ToRobot::Setup { config }) = read(inlet.receive()) else {
            STRANGE.fetch_add(1, Ordering::Relaxed);
            continue;
        };
        if let (Ok(config), Ok(base)) = (setup::read(config), library::case_base()) {
            return (config, base);
        }
        report(outlet, &FromRobot::Unusable);
    }
}

/// One tick: time, then packets, then the sensor frame.
fn live(clock: &Clock, tick: TickIn<'_>) {
    clock.advance(tick.now);
    for packet in &tick.air {
        if BOXES.is_full() {
            clock.settle();
        }
        // A packet longer than any frame is invalid; a radio would not have received it either.
        if !Packet::from_slice(packet).is_ok_and(|packet| BOXES.receive(packet)) {
            STRANGE.fetch_add(1, Ordering::Relaxed);
        }
    }
    // All before the sensor frame.
    clock.settle();
    if SEEN.try_send(tick.sensors).is_err() {
        STRANGE.fetch_add(1, Ordering::Relaxed);
    }
    clock.settle();
}

fn read(message: &[u8]) -> Option<ToRobot<'_>> {
    match postcard::take_from_bytes(message) {
        Ok((message, [])) => Some(message),
        _ => None,
    }
}

fn report(outlet: &mut Outlet, message: &FromRobot<'_>) {
    // Every message fits: `MESSAGE_LEN_MAX` is above six packets and an order.
    outlet.send(|buffer| postcard::to_slice(message, buffer).map_or(0, |bytes| bytes.len()));
}

/// Ticks between two measurements of the stack: one takes some 80,000 instructions, and the deepest use
/// remains visible.
const STACK_EVERY: u32 = 64;

/// Number of invalid messages and packets, for a debugger to read.
static STRANGE: AtomicU32 = AtomicU32::new(0);
/// Packets sent beyond a tick's [`AIR_OUT_MAX`], for a debugger to read.
static UNHEARD: AtomicU32 = AtomicU32::new(0);

/// Input of the tick for the sensor task; its packets go straight into the inbox, as there is no radio here.
static SEEN: Channel<CriticalSectionRawMutex, SensorFrame, 1> = Channel::new();
/// Output of the tasks in this tick.
static DONE: Mutex<RefCell<Done>> = Mutex::new(RefCell::new(Done { air: Vec::new(), actuators: None }));

#[derive(Default)]
struct Done {
    air: Vec<Packet, AIR_OUT_MAX>,
    actuators: Option<ActuatorFrame>,
}

struct Sensors;
impl Senses for Sensors {
    async fn sense(&mut self) -> SensorFrame {
        SEEN.receive().await
    }
}

struct UartSender;
impl RadioSender for UartSender {
    async fn send(&mut self, packet: Packet) {
        critical_section::with(|cs| {
            if DONE.borrow_ref_mut(cs).air.push(packet).is_err() {
                UNHEARD.fetch_add(1, Ordering::Relaxed);
            }
        });
    }
}

struct Actuators;
impl BodyPort for Actuators {
    async fn act(&mut self, wanted: ActuatorFrame) {
        critical_section::with(|cs| DONE.borrow_ref_mut(cs).actuators = Some(wanted));
    }
}

static BOXES: Mailboxes = Mailboxes::new();

fn start_tasks(spawner: Spawner, config: BrainConfig, base: CaseBase<'static>) -> Result<(), SpawnError> {
    spawner.spawn(body()?);
    spawner.spawn(radio_send()?);
    spawner.spawn(sensors()?);
    spawner.spawn(brain(config, base)?);
    Ok(())
}

#[embassy_executor::task]
async fn brain(config: BrainConfig, base: CaseBase<'static>) -> ! {
    tasks::brain(&config, base, &BOXES).await
}

#[embassy_executor::task]
async fn radio_send() -> ! {
    tasks::radio_send(UartSender, &BOXES).await
}

#[embassy_executor::task]
async fn sensors() -> ! {
    tasks::sensors(Sensors, &BOXES).await
}

#[embassy_executor::task]
async fn body() -> ! {
    tasks::body(Actuators, &BOXES).await
}
