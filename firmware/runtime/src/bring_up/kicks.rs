//! `kicks`: interlock of raw pulses, by which a kicker is measured: between the host's orders to a bring-up
//! image and 200 V. Sans-IO; no match image has it.
//!
//! | order | kicker | result |
//! |---|---|---|
//! | not genuine, older than 0.2 s, of another start, or repeated | – | ignored |
//! | none for 0.5 s | – | disarmed: never charged, and runs empty |
//! | arm | voltage readable | charged to `full_volts`; for 2 s, or for one pulse |
//! | fire | armed, full, rested, 1 µs to the coil's longest pulse | one pulse, then at rest until it is measured |
//! | fire | else | refused, with the reason |

use protocol::bring_up::Reporter;
use protocol::pulses::{Fired, Pulse, PulseRefusal, PulseReport, open_order};
use protocol::{Duration, Instant};

use crate::kicker::{FULL_VOLTS, KICK_PAUSE, KickerAct, KickerState, pulse_max};

/// The interlock of one kicker.
#[derive(Clone, Debug)]
pub struct Kicks {
    who: Reporter,
    /// Epoch and counter of the last order taken, and when it came.
    order: (u32, u32),
    heard: Option<Instant>,
    armed: Option<Instant>,
    wanted: Option<Pulse>,
    fired: Option<Instant>,
    /// The pulse that runs or is measured.
    running: Option<(Pulse, Fired)>,
    last: Option<(Pulse, Result<Fired, PulseRefusal>)>,
    state: KickerState,
}

impl Kicks {
    /// A kicker that is not armed, of that robot.
    pub const fn new(who: Reporter) -> Self {
        let state = KickerState { ball: false, volts: f32::NAN };
        let (heard, armed, fired) = (None, None, None);
        Self { who, order: (0, 0), heard, armed, wanted: None, fired, running: None, last: None, state }
    }

    /// Takes a packet; all but live orders to this robot are ignored.
    pub fn receive(&mut self, now: Instant, packet: &[u8]) {
        let Some((place, order)) = open_order(packet, &self.who) else { return };
        let age = millis(now).wrapping_sub(order.clock);
        if order.boot_epoch != self.who.epoch || age > ORDER_AGE_MAX || place <= self.order {
            return;
        }
        if place.0 != self.order.0 {
            // Another host: its pulses have numbers of their own.
            (self.armed, self.last) = (None, None);
        }
        (self.order, self.heard) = (place, Some(now));
        if let Some(pulse) = order.fire {
            let known = [self.last.map(|last| last.0), self.running.map(|running| running.0)];
            let is_new = known.iter().flatten().all(|known| known.number != pulse.number);
            self.wanted = is_new.then_some(pulse);
        } else {
            self.armed = Some(now);
        }
    }

    /// Output of the kicker's board for the next step of about 1 ms.
    pub fn step(&mut self, now: Instant, state: KickerState) -> KickerAct {
        self.state = state;
        if let (Some((pulse, fired)), Some(since)) = (self.running, self.fired) {
            if now.since(since) < Duration(u64::from(pulse.micros)) + SETTLE_TIME {
                return KickerAct::Rest;
            }
            (self.running, self.last) = (None, Some((pulse, Ok(Fired { after: state.volts, ..fired }))));
        }
        if self.heard.is_none_or(|heard| now.since(heard) > SILENCE_MAX) {
            (self.armed, self.wanted) = (None, None);
        }
        if let Some(pulse) = self.wanted.take() {
            if let Err(refusal) = self.judge(now, pulse) {
                self.last = Some((pulse, Err(refusal)));
            } else {
                let fired = Fired { before: state.volts, after: f32::NAN, ball: state.ball };
                (self.armed, self.fired, self.running) = (None, Some(now), Some((pulse, fired)));
                let long = Duration(u64::from(pulse.micros));
                return if pulse.chip { KickerAct::Chip(long) } else { KickerAct::Flat(long) };
            }
        }
        match state.volts {
            volts if !self.is_armed(now) || volts.is_nan() => KickerAct::Bleed,
            volts if volts < FULL_VOLTS => KickerAct::Charge,
            _ => KickerAct::Rest,
        }
    }

    /// State of the kicker for the host of that epoch.
    pub fn report(&self, now: Instant, host: u32) -> PulseReport {
        let KickerState { ball, volts } = self.state;
        let ready = self.judge(now, Pulse { number: 0, chip: false, micros: 1 }).is_ok();
        let last = self.last.filter(|_| self.order.0 == host);
        PulseReport { host, clock: millis(now), ready, ball, volts, last }
    }

    /// Whether it is armed, and may be charged.
    pub fn is_armed(&self, now: Instant) -> bool {
        self.armed.is_some_and(|armed| now.since(armed) <= ARMED_FOR)
    }

    fn judge(&self, now: Instant, pulse: Pulse) -> Result<(), PulseRefusal> {
        let (longest, volts) = (pulse_max(pulse.chip), self.state.volts);
        if self.armed.is_none() {
            Err(PulseRefusal::Disarmed)
        } else if !self.is_armed(now) {
            Err(PulseRefusal::Expired)
        } else if !(1..=longest).contains(&pulse.micros) {
            Err(PulseRefusal::Length(longest))
        } else if self.fired.is_some_and(|fired| now.since(fired) < KICK_PAUSE) {
            Err(PulseRefusal::TooSoon)
        } else if volts.is_nan() || volts < FULL_VOLTS {
            Err(PulseRefusal::NotCharged(volts))
        } else {
            Ok(())
        }
    }
}

/// The clock of reports, ms.
fn millis(now: Instant) -> u32 {
    (now.0 / 1_000) as u32
}

/// Time for which an order to arm holds: a host repeats it while the capacitor charges.
const ARMED_FOR: Duration = Duration::millis(2_000);
/// Silence of the host that disarms: ten of its orders.
const SILENCE_MAX: Duration = Duration::millis(500);
/// Greatest time from a report to the order that names it, ms: as of commands in play.
const ORDER_AGE_MAX: u32 = (protocol::host_clock::AGE_MAX.0 / 1_000) as u32;
/// Time from the end of a pulse to the reading of the voltage: the coil's current has gone out, and twenty
/// readings were taken since (estimate).
const SETTLE_TIME: Duration = Duration::millis(20);

#[cfg(test)]
mod tests;
