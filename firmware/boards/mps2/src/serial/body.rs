//! `body`: simulated actuators of a board without motors. Wheels that follow their duty cycle as motors do, a
//! capacitor that fills, and probes without disturbances.

use core::sync::atomic::{AtomicBool, AtomicU32, Ordering};

use protocol::Duration;
use runtime::kicker::{FULL_VOLTS, KickerAct, KickerState};
use runtime::ports::{Kicker, Probes, Seen, WheelsPort};
use runtime::wheel::WHEELS;

/// Rim speeds, m/s, as bits.
static SPEEDS: [AtomicU32; WHEELS] = [const { AtomicU32::new(0) }; WHEELS];
/// True while the motors have current.
static DRIVEN: AtomicBool = AtomicBool::new(false);
/// The capacitor's voltage, V, as bits.
static VOLTS: AtomicU32 = AtomicU32::new(0);

/// Takes the current off all actuators at once, in any state: the first act of a panic.
pub(crate) fn stop() {
    DRIVEN.store(false, Ordering::Relaxed);
    for speed in &SPEEDS {
        speed.store(0, Ordering::Relaxed);
    }
    VOLTS.store(0, Ordering::Relaxed);
}

/// Four wheels that follow their duty cycle.
pub(crate) struct Motors;

impl WheelsPort for Motors {
    fn measured(&mut self) -> [f32; WHEELS] {
        SPEEDS.each_ref().map(|speed| f32::from_bits(speed.load(Ordering::Relaxed)))
    }

    fn drive(&mut self, duty: [f32; WHEELS], _dribbler: f32) {
        DRIVEN.store(true, Ordering::Relaxed);
        for (speed, duty) in SPEEDS.iter().zip(duty) {
            let now = f32::from_bits(speed.load(Ordering::Relaxed));
            speed.store((now + (duty * FREE_SPEED - now) * RESPONSE_PER_STEP).to_bits(), Ordering::Relaxed);
        }
    }

    fn release(&mut self) {
        stop();
    }
}

/// A kicker without a ball.
pub(crate) struct Coil;

impl Coil {
    pub(crate) const fn new() -> Self {
        Self
    }
}

impl Kicker for Coil {
    fn state(&mut self) -> KickerState {
        KickerState { ball: false, volts: volts() }
    }

    async fn act(&mut self, act: KickerAct) {
        let change = match act {
            KickerAct::Charge => CHARGE_PER_STEP,
            KickerAct::Bleed => -CHARGE_PER_STEP,
            KickerAct::Flat(_) | KickerAct::Chip(_) => -FULL_VOLTS,
            KickerAct::Rest => 0.0,
        };
        let volts = volts() + change;
        VOLTS.store((if volts > 0.0 { volts } else { 0.0 }).to_bits(), Ordering::Relaxed);
        embassy_time::Timer::after(embassy_time::Duration::from_micros(KICKER_PERIOD.0)).await;
    }
}

/// Probes of an undisturbed robot.
pub(crate) struct Senses;

impl Probes for Senses {
    fn look(&mut self) -> Seen {
        let kicker_ready = volts() >= FULL_VOLTS;
        Seen { turn: None, ball: false, tipped: false, battery: Some(16.0), kicker_ready }
    }
}

fn volts() -> f32 {
    f32::from_bits(VOLTS.load(Ordering::Relaxed))
}

/// Rim speed at a duty cycle of 1, m/s.
const FREE_SPEED: f32 = 6.0;
/// Share of a change that happens in a millisecond: a motor's time constant is 30 ms.
const RESPONSE_PER_STEP: f32 = 1.0 / 30.0;
/// Change of the capacitor's voltage in a step of the kicker, V: full in 0.4 s.
const CHARGE_PER_STEP: f32 = 0.5;
const KICKER_PERIOD: Duration = Duration::millis(1);
