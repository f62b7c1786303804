//! `tasks`: the five tasks that a board starts.
//!
//! The brain's task sleeps until something arrives or its own deadline comes, handles that one event, and
//! drains the brain's output for it. Each deadline is handled at its own time, and one that is due when it is
//! set as soon as the clock moves: in lockstep that is before the packets of the next tick. The simulator's
//! native robots keep the same order, therefore a trial has the same bits there and here
//! (docs/architecture.md §7.2).

use brain::{BrainConfig, Station};
use casebase::CaseBase;
use embassy_sync::channel::TryReceiveError;
use embassy_time::with_deadline;
use protocol::frame::RobotKeys;
use protocol::journal::Writer;
use protocol::parts::PartsReport;
use protocol::version::VersionReport;
use protocol::{Duration, Instant};

use crate::controller::Controller;
use crate::mailboxes::{Arrival, Mailboxes};
use crate::ports::{BodyPort, RadioReceiver, RadioSender, Senses};
use crate::progress::RobotPart;
use crate::recorded::Recorded;
use crate::reporting::{IMAGE, Reporting};

/// The brain's task: starts the boot epoch with its first poll.
pub async fn brain(config: &BrainConfig, base: CaseBase<'_>, boxes: &Mailboxes) -> ! {
    // Not by way of `brain_with_keys`: its future would lie on the stack for as long as the task runs, 6 kB.
    let mut station = Station::new(now(), config, base);
    think(&mut station, boxes).await
}

/// Runs as [`brain()`] does, with keys of its own; reports to its host what it runs.
pub async fn brain_with_keys(
    config: &BrainConfig,
    base: CaseBase<'_>,
    keys: RobotKeys,
    boxes: &Mailboxes,
) -> ! {
    // Constructed in place; moving it would store it twice in this future, and on the stack in between.
    let mut station = Station::with_keys(now(), config, base, keys);
    let report = VersionReport { case_base: base.hash(), ..IMAGE };
    let parts = (PartsReport::new(), now());
    think(&mut Reporting { station: &mut station, report, last: now(), boxes, parts }, boxes).await
}

/// Runs as [`brain_with_keys`] does, with all inputs and outputs in a journal.
pub async fn brain_with_journal(
    config: &BrainConfig,
    base: CaseBase<'_>,
    keys: RobotKeys,
    boxes: &Mailboxes,
    journal: Writer<'_>,
) -> ! {
    let start = now();
    let station = Station::with_keys(start, config, base, keys);
    let mut recorded = Recorded::new(start, config.epoch, station, journal);
    think(&mut recorded, boxes).await
}

/// Moves received packets into the inbox.
pub async fn radio_receive(mut radio: impl RadioReceiver, boxes: &Mailboxes) -> ! {
    loop {
        let packet = radio.receive().await;
        boxes.room_for_arrival().await;
        boxes.deliver(Arrival::Packet(packet));
    }
}

/// Sends the packets of the outbox.
pub async fn radio_send(mut radio: impl RadioSender, boxes: &Mailboxes) -> ! {
    loop {
        let packet = boxes.outbox.receive().await;
        radio.send(packet).await;
    }
}

/// Moves sensor frames into the inbox.
pub async fn sensors(mut senses: impl Senses, boxes: &Mailboxes) -> ! {
    loop {
        let sensors = senses.sense().await;
        boxes.room_for_arrival().await;
        boxes.deliver(Arrival::Sensors(sensors));
    }
}

/// Passes the brain's latest orders to the body.
pub async fn body(mut body: impl BodyPort, boxes: &Mailboxes) -> ! {
    loop {
        let orders = boxes.orders.wait().await;
        body.act(orders).await;
    }
}

/// The brain's task, for any implementation of the interface.
pub(crate) async fn think(controller: &mut impl Controller, boxes: &Mailboxes) -> ! {
    let mut last = now();
    loop {
        let time = now();
        let due = controller.poll_timeout().map(|due| due.max(last));
        // With any number of arrivals, a missed deadline waits for one of them at most.
        last = if let Some(due) = due.filter(|due| *due < time) {
            controller.handle_timeout(due);
            due
        } else if take(controller, time, boxes) {
            time
        } else if let Some(due) = deadline_before_arrival(due, last, boxes).await {
            controller.handle_timeout(due);
            due
        } else {
            continue;
        };
        empty(controller, last, boxes);
        boxes.progress.mark(RobotPart::Brain);
    }
}

/// Gives `controller` the input that has waited longest; returns whether there was any.
fn take(controller: &mut impl Controller, now: Instant, boxes: &Mailboxes) -> bool {
    // An arrival is not passed by value: it is large, and every move would copy it.
    match &boxes.inbox.try_receive() {
        Ok(Arrival::Packet(packet)) => controller.handle_packet(now, packet),
        Ok(Arrival::Sensors(sensors)) => controller.handle_sensors(now, sensors),
        Err(TryReceiveError::Empty) => return false,
    }
    true
}

/// Waits for what comes next: the deadline, or (`None`) an arrival.
async fn deadline_before_arrival(due: Option<Instant>, last: Instant, boxes: &Mailboxes) -> Option<Instant> {
    let Some(due) = due else {
        boxes.inbox.ready_to_receive().await;
        return None;
    };
    let Instant(alarm) = due.max(last + CLOCK_STEP);
    let alarm = embassy_time::Instant::from_ticks(alarm);
    with_deadline(alarm, boxes.inbox.ready_to_receive()).await.err().map(|_| due)
}

/// Drains the output of `controller`.
fn empty(controller: &mut impl Controller, now: Instant, boxes: &Mailboxes) {
    while let Some(packet) = controller.poll_packet(now) {
        boxes.post(packet);
    }
    if let Some(orders) = controller.poll_actuators(now) {
        boxes.orders.signal(orders);
    }
}

/// Embassy's clock in the project's time.
pub fn now() -> Instant {
    Instant(embassy_time::Instant::now().as_ticks())
}

/// Smallest step of the clock.
const CLOCK_STEP: Duration = Duration(1);

// Both clocks count microseconds, so an instant is copied, not converted.
const _: () = assert!(embassy_time::TICK_HZ == 1_000_000);
