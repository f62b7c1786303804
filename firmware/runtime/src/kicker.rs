//! `kicker`: interlock of charger and kicker, between the brain's requests and 200 V (docs/architecture.md
//! §6.2). Sans-IO.
//!
//! | request | ball at the dribbler | capacitor | result |
//! |---|---|---|---|
//! | `Discharge` | – | – | not charged, bled through the coil too slowly to move the plunger |
//! | none, or a kick | – | low | charged |
//! | a kick | no | full | waits: the break-beam sensor fires it, the brain's order only arms it |
//! | a kick | yes | full | one pulse, then nothing for half a second |

use protocol::robot_io::OmniKick;
use protocol::{Duration, Instant};
use rules::{KickerSpec, RobotSpec};

/// Output of the kicker's board until the next step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum KickerAct {
    /// Neither charge nor fire.
    Rest,
    /// Charge the capacitor to its limit.
    Charge,
    /// Discharge it without a kick.
    Bleed,
    /// A pulse through the flat kicker's coil, of this duration.
    Flat(Duration),
    /// The same through the chip kicker's.
    Chip(Duration),
}

/// Readings of the kicker's sensors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KickerState {
    /// The beam in front of the kicker is interrupted.
    pub ball: bool,
    /// The capacitor's voltage, V.
    pub volts: f32,
}

/// The interlock of one kicker.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interlock {
    fired: Option<Instant>,
}

impl Interlock {
    /// A kicker that has not fired yet.
    pub const fn new() -> Self {
        Self { fired: None }
    }

    /// Output for the next step.
    pub fn step(&mut self, now: Instant, request: OmniKick, state: KickerState) -> KickerAct {
        // An unreadable voltage counts as a full capacitor: it is not charged, and not fired.
        let (full, readable) = (state.volts.is_nan() || state.volts >= FULL_VOLTS, !state.volts.is_nan());
        if request == OmniKick::Discharge {
            return if readable && state.volts < EMPTY_VOLTS { KickerAct::Rest } else { KickerAct::Bleed };
        }
        let rested = self.fired.is_none_or(|fired| now.since(fired) >= KICK_PAUSE);
        let pulse = match request {
            OmniKick::Flat(speed) => pulse(speed, FLAT_PULSE).map(KickerAct::Flat),
            OmniKick::Chip(speed) => pulse(speed, CHIP_PULSE).map(KickerAct::Chip),
            OmniKick::None | OmniKick::Discharge => None,
        };
        if let Some(act) = pulse.filter(|_| readable && full && state.ball && rested) {
            self.fired = Some(now);
            return act;
        }
        if full { KickerAct::Rest } else { KickerAct::Charge }
    }

    /// Returns whether a kick would be fired at once, judged by charge and pause.
    pub fn is_ready(&self, now: Instant, volts: f32) -> bool {
        volts >= FULL_VOLTS && self.fired.is_none_or(|fired| now.since(fired) >= KICK_PAUSE)
    }
}

impl Default for Interlock {
    fn default() -> Self {
        Self::new()
    }
}

/// Whether the capacitor's voltage follows the orders to the kicker.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct ChargeWatch {
    /// When the voltage was noted, that voltage, and whether it was charged all the time since.
    from: Option<(Instant, f32, bool)>,
    doubted: bool,
}

impl ChargeWatch {
    /// A capacitor that is not doubted yet.
    pub const fn new() -> Self {
        Self { from: None, doubted: false }
    }

    /// Takes the order to the kicker and the voltage; returns whether the voltage is doubted: it hardly rose
    /// in 0.3 s of charging, fell by more than leaks away without a kick, or cannot be read.
    pub fn step(&mut self, now: Instant, act: KickerAct, volts: f32) -> bool {
        if matches!(act, KickerAct::Flat(_) | KickerAct::Chip(_) | KickerAct::Bleed) {
            self.from = None;
            return self.doubted;
        }
        let (since, before, charged) = self.from.unwrap_or((now, volts, true));
        let charged = charged && act == KickerAct::Charge;
        self.from = Some((since, before, charged));
        if now.since(since) >= WATCHED_FOR {
            let least = before + if charged { RISE_MIN } else { -FALL_MAX };
            self.doubted = volts.is_nan() || volts < least;
            self.from = None;
        }
        self.doubted
    }
}

/// Pulse length for a ball speed; `None` for an invalid speed. Never longer than the table's last.
fn pulse(speed: f32, table: &[(f32, u64)]) -> Option<Duration> {
    if !speed.is_finite() || speed <= 0.0 {
        return None;
    }
    let mut last = (0.0, 0);
    for &(to, micros) in table {
        if speed <= to {
            let share = (speed - last.0) / (to - last.0);
            return Some(Duration(last.1 + (share * (micros - last.1) as f32) as u64));
        }
        last = (to, micros);
    }
    Some(Duration(last.1))
}

/// The longest pulse of a coil in the robot's description, µs.
pub(crate) fn pulse_max(chip: bool) -> u16 {
    let table = if chip { CHIP_PULSE } else { FLAT_PULSE };
    table.last().map_or(0, |(_, micros)| *micros as u16)
}

const SPEC: KickerSpec = RobotSpec::OURS.kicker;
/// Ball speed, m/s, and the pulse for it, µs.
const FLAT_PULSE: &[(f32, u64)] = SPEC.flat_pulses;
/// The same of the chip kicker.
const CHIP_PULSE: &[(f32, u64)] = SPEC.chip_pulses;
/// The capacitor is full, V.
pub const FULL_VOLTS: f32 = SPEC.full_volts;
/// Voltage below which the capacitor is safe to touch, V.
const EMPTY_VOLTS: f32 = SPEC.empty_volts;
/// Time over which a charge is watched: less than a suspicion has to last, so that two in a row make a
/// failure.
const WATCHED_FOR: Duration = Duration::millis(300);
/// Least rise in that time while it is charged, V: 10 V/s, a tenth of what a charger gives that fills it in
/// 2 s (estimate; teams publish 1 to 3 s).
const RISE_MIN: f32 = 0.015 * FULL_VOLTS;
/// Greatest fall in that time without a kick, V (estimate: a capacitor leaks less in a minute).
const FALL_MAX: f32 = 0.1 * FULL_VOLTS;
/// Least time between two kicks.
pub(crate) const KICK_PAUSE: Duration = Duration::millis(SPEC.pause_ms);

#[cfg(test)]
mod tests {
    use super::*;

    fn state(ball: bool, volts: f32) -> KickerState {
        KickerState { ball, volts }
    }

    #[test]
    fn nothing_fires_without_ball_charge_pause_and_a_number() {
        let mut interlock = Interlock::new();
        let kick = OmniKick::Flat(4.0);
        let now = Instant(1_000_000);
        assert_eq!(interlock.step(now, kick, state(false, 210.0)), KickerAct::Rest);
        assert_eq!(interlock.step(now, kick, state(true, 150.0)), KickerAct::Charge);
        assert_eq!(interlock.step(now, kick, state(true, f32::NAN)), KickerAct::Rest);
        assert_eq!(interlock.step(now, OmniKick::Flat(f32::NAN), state(true, 210.0)), KickerAct::Rest);
        assert_eq!(interlock.step(now, OmniKick::None, state(true, 210.0)), KickerAct::Rest);
        assert_eq!(interlock.step(now, kick, state(true, 210.0)), KickerAct::Flat(Duration(2_600)));
        assert!(!interlock.is_ready(now + Duration::millis(499), 210.0));
        assert_eq!(interlock.step(now + Duration::millis(499), kick, state(true, 210.0)), KickerAct::Rest);
        let later = now + KICK_PAUSE;
        assert_eq!(
            interlock.step(later, OmniKick::Chip(3.0), state(true, 210.0)),
            KickerAct::Chip(Duration(2_900))
        );
    }

    #[test]
    fn a_discharge_bleeds_until_it_is_safe_and_never_charges() {
        let mut interlock = Interlock::new();
        for (volts, act) in [
            (210.0, KickerAct::Bleed),
            (30.0, KickerAct::Bleed),
            (29.0, KickerAct::Rest),
            (f32::NAN, KickerAct::Bleed),
        ] {
            assert_eq!(interlock.step(Instant(0), OmniKick::Discharge, state(true, volts)), act, "{volts}");
        }
    }

    #[test]
    fn a_capacitor_is_doubted_that_does_not_rise_falls_by_itself_or_cannot_be_read() {
        // Ten volts a second and less, 66 V/s and more; a kick, and a charge after it, are no leak.
        type Volts = fn(u64) -> f32;
        let cases: [(KickerAct, Volts, bool); 6] = [
            (KickerAct::Charge, |ms| 100.0 + 0.1 * ms as f32, false),
            (KickerAct::Charge, |ms| 100.0 + 0.005 * ms as f32, true),
            (KickerAct::Rest, |ms| 210.0 - 0.01 * ms as f32, false),
            (KickerAct::Rest, |ms| 210.0 - 0.1 * ms as f32, true),
            (KickerAct::Rest, |_| f32::NAN, true),
            (KickerAct::Bleed, |ms| 210.0 - 0.2 * ms as f32, false),
        ];
        for (number, (act, volts, wrong)) in cases.into_iter().enumerate() {
            let mut watch = ChargeWatch::new();
            let mut step = |ms: u64| watch.step(Instant(1_000 * ms), act, volts(ms));
            assert!((0..300).all(|ms| !step(ms)), "{number}");
            assert_eq!((300..700).any(&mut step), wrong, "{number}");
        }
        let (mut watch, fired) = (ChargeWatch::new(), KickerAct::Flat(Duration(2_600)));
        let act = |ms| if ms == 250 { fired } else { KickerAct::Charge };
        let volts = |ms| if ms < 250 { 210.0 } else { 60.0 + 0.1 * (ms - 250) as f32 };
        assert!((0..1_500).all(|ms| !watch.step(Instant(1_000 * ms), act(ms), volts(ms))));
    }

    #[test]
    fn a_pulse_grows_with_the_speed_and_has_an_end() {
        let pulses: [u64; 9] = core::array::from_fn(|n| pulse(n as f32 + 0.5, FLAT_PULSE).map_or(0, |d| d.0));
        assert!(pulses.windows(2).all(|pair| pair[0] <= pair[1]), "{pulses:?}");
        assert_eq!(pulses[8], 4_500);
        assert_eq!(pulse(-1.0, FLAT_PULSE), None);
    }
}
