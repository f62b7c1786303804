//! In which order does a robot's computer do what there is to do? The five tasks a board starts.
//!
//! The brain's task sleeps until something arrives or its own deadline comes. Deadlines that are due run first, each
//! when its time has come; then what arrived. After each of them everything the brain has to say is taken from it. The
//! simulator's native robots keep the same order, therefore a trial has the same bits there and here (DESIGN §7).

use brain::{BrainConfig, Station};
use casebase::CaseBase;
use embassy_time::with_deadline;
use protocol::Instant;

use crate::mailboxes::{Arrival, Mailboxes};
use crate::mind::Mind;
use crate::ports::{Body, RadioReceiver, RadioSender, Senses};

/// The robot's life: begins with the first poll of this task.
pub async fn brain(config: &BrainConfig, base: CaseBase<'_>, boxes: &Mailboxes) -> ! {
    think(Station::new(now(), config, base), boxes).await
}

/// From the air into the inbox.
pub async fn radio_receive(mut radio: impl RadioReceiver, boxes: &Mailboxes) -> ! {
    loop {
        let packet = radio.receive().await;
        boxes.inbox.send(Arrival::Packet(packet)).await;
    }
}

/// From the outbox onto the air.
pub async fn radio_send(mut radio: impl RadioSender, boxes: &Mailboxes) -> ! {
    loop {
        let packet = boxes.outbox.receive().await;
        radio.send(&packet).await;
    }
}

/// From the senses into the inbox.
pub async fn sensors(mut senses: impl Senses, boxes: &Mailboxes) -> ! {
    loop {
        let picture = senses.sense().await;
        boxes.inbox.send(Arrival::Sensors(picture)).await;
    }
}

/// From the brain's latest order to the body.
pub async fn body(mut body: impl Body, boxes: &Mailboxes) -> ! {
    loop {
        let wanted = boxes.orders.wait().await;
        body.act(wanted).await;
    }
}

/// The brain's task, for any mind.
pub(crate) async fn think(mut mind: impl Mind, boxes: &Mailboxes) -> ! {
    loop {
        let arrival = next_arrival(&mind, boxes).await;
        let now = now();
        while mind.poll_timeout().is_some_and(|due| due <= now) {
            mind.handle_timeout(now);
            empty(&mut mind, now, boxes);
        }
        match arrival {
            None => continue,
            Some(Arrival::Packet(packet)) => mind.handle_packet(now, &packet),
            Some(Arrival::Sensors(picture)) => mind.handle_sensors(now, &picture),
        }
        empty(&mut mind, now, boxes);
    }
}

/// What arrives next; `None` if the mind's deadline comes before.
async fn next_arrival(mind: &impl Mind, boxes: &Mailboxes) -> Option<Arrival> {
    let Some(Instant(deadline)) = mind.poll_timeout() else {
        return Some(boxes.inbox.receive().await);
    };
    with_deadline(embassy_time::Instant::from_ticks(deadline), boxes.inbox.receive()).await.ok()
}

/// Takes from the mind whatever it has to say.
fn empty(mind: &mut impl Mind, now: Instant, boxes: &Mailboxes) {
    while let Some(packet) = mind.poll_packet(now) {
        boxes.post(packet);
    }
    if let Some(wanted) = mind.poll_actuators(now) {
        boxes.orders.signal(wanted);
    }
}

/// Embassy's clock in the project's time.
fn now() -> Instant {
    Instant(embassy_time::Instant::now().as_ticks())
}

// Both clocks count microseconds, so an instant is copied, not converted.
const _: () = assert!(embassy_time::TICK_HZ == 1_000_000);
