//! `tests`: of raw pulses: a kicker's board of simulated parts, with a host whose orders are lost, late,
//! recorded or too much.

use std::vec::Vec;

use protocol::frame::TeamKey;
use protocol::host_link::HostLink;
use protocol::link::Packet;
use protocol::pulses::PulseOrder;
use protocol::{RobotId, TeamId};

use super::*;

const TEAM: TeamId = TeamId(2);
const KEY: TeamKey = TeamKey([3; 16]);

struct Bench {
    now: Instant,
    host: HostLink,
    kicks: Kicks,
    volts: f32,
    /// Pulses with the time of each.
    pulses: Vec<(Instant, Duration)>,
    charged: u32,
}

impl Bench {
    fn new() -> Self {
        let robot = RobotId::new(3).unwrap();
        let who = Reporter { team: TEAM, robot, key: KEY.of_robot(robot).host, epoch: 17 };
        let (host, kicks) = (HostLink::new(TEAM, KEY, 9), Kicks::new(who));
        Self { now: Instant(3_000_000), host, kicks, volts: 0.0, pulses: Vec::new(), charged: 0 }
    }

    fn order(&self, fire: Option<Pulse>) -> PulseOrder {
        PulseOrder { boot_epoch: 17, clock: millis(self.now), fire }
    }

    fn packet(&mut self, order: &PulseOrder) -> Packet {
        self.host.seal_order(self.now, RobotId::new(3).unwrap(), order)
    }

    fn send(&mut self, order: &PulseOrder) {
        let packet = self.packet(order);
        self.kicks.receive(self.now, &packet);
    }

    fn arm(&mut self) {
        self.send(&self.order(None));
    }

    fn order_pulse(&mut self, number: u16, micros: u16, chip: bool) {
        self.send(&self.order(Some(Pulse { number, chip, micros })));
    }

    fn steps(&mut self, ms: u64) {
        for _ in 0..ms {
            let act = self.kicks.step(self.now, KickerState { ball: true, volts: self.volts });
            match act {
                KickerAct::Rest => {}
                // Full in two seconds; empty in some.
                KickerAct::Charge => self.volts = (self.volts + FULL_VOLTS / 2_000.0).min(1.02 * FULL_VOLTS),
                KickerAct::Bleed => self.volts *= 0.9997,
                KickerAct::Flat(long) | KickerAct::Chip(long) => {
                    self.volts *= 1.0 - long.0 as f32 / 12_000.0;
                    self.pulses.push((self.now, long));
                }
            }
            self.charged += u32::from(act == KickerAct::Charge);
            self.now += Duration::millis(1);
        }
    }

    /// Armed each 50 ms for that time.
    fn arm_for(&mut self, ms: u64) {
        for _ in 0..ms / 50 {
            self.arm();
            self.steps(50);
        }
    }

    fn fire(&mut self, number: u16, micros: u16) -> Result<Fired, PulseRefusal> {
        self.order_pulse(number, micros, false);
        self.steps(30);
        let (pulse, result) = self.kicks.report(self.now, 9).last.expect("an answer");
        assert_eq!(pulse.number, number);
        result
    }
}

#[test]
fn an_armed_full_kicker_fires_one_pulse_as_long_as_ordered_and_measures_it() {
    let mut bench = Bench::new();
    bench.arm_for(3_000);
    let fired = bench.fire(1, 1_500).unwrap();
    assert_eq!(bench.pulses.iter().map(|(_, long)| long.0).collect::<Vec<_>>(), [1_500]);
    assert!(fired.ball && fired.before >= FULL_VOLTS && fired.after < fired.before - 5.0, "{fired:?}");
    // One order to arm is for one pulse, and a repeated order for no second one.
    assert_eq!(bench.fire(1, 1_500), Ok(fired));
    assert_eq!(bench.fire(2, 1_500), Err(PulseRefusal::Disarmed));
    assert_eq!(bench.pulses.len(), 1);
}

#[test]
fn from_the_pulse_to_its_measurement_the_capacitor_is_at_rest() {
    let mut bench = Bench::new();
    bench.arm_for(3_000);
    bench.order_pulse(1, 6_000, true);
    bench.steps(1);
    for _ in 0..25 {
        bench.arm();
        assert_eq!(
            bench.kicks.step(bench.now, KickerState { ball: false, volts: 90.0 }),
            KickerAct::Rest,
            "armed again"
        );
        bench.now += Duration::millis(1);
    }
    assert_eq!(bench.kicks.step(bench.now, KickerState { ball: false, volts: 90.0 }), KickerAct::Charge);
}

#[test]
fn a_kicker_that_was_never_armed_or_only_long_ago_refuses_and_runs_empty() {
    let mut bench = Bench::new();
    bench.volts = 210.0;
    assert_eq!(bench.fire(1, 1_500), Err(PulseRefusal::Disarmed));
    bench.arm_for(3_000);
    // Orders that do not arm keep it from silence, and no longer.
    for _ in 0..41 {
        bench.order_pulse(1, 1_500, false);
        bench.steps(50);
    }
    assert_eq!(bench.fire(2, 1_500), Err(PulseRefusal::Expired));
    bench.steps(20_000);
    assert!(bench.volts < 30.0 && bench.pulses.is_empty(), "{}", bench.volts);
}

#[test]
fn silence_disarms_and_never_charges() {
    let mut bench = Bench::new();
    bench.arm_for(100);
    bench.steps(460);
    assert!(bench.charged > 400);
    bench.charged = 0;
    bench.steps(10_000);
    assert_eq!(bench.charged, 0);
    assert_eq!(bench.fire(1, 1_500), Err(PulseRefusal::Disarmed));
}

#[test]
fn pulses_of_no_length_too_long_too_soon_or_without_charge_are_refused() {
    let mut bench = Bench::new();
    bench.arm_for(200);
    assert!(matches!(bench.fire(1, 1_500), Err(PulseRefusal::NotCharged(volts)) if volts < FULL_VOLTS));
    bench.arm_for(3_000);
    let longest = pulse_max(false);
    assert_eq!(bench.fire(2, longest + 1), Err(PulseRefusal::Length(longest)));
    assert_eq!(bench.fire(3, 0), Err(PulseRefusal::Length(longest)));
    assert!(bench.fire(4, longest).is_ok());
    bench.volts = 210.0;
    bench.arm_for(50);
    assert_eq!(bench.fire(5, 1_500), Err(PulseRefusal::TooSoon));
    bench.arm_for(1_000);
    bench.volts = f32::NAN;
    assert!(matches!(bench.fire(6, 1_500), Err(PulseRefusal::NotCharged(_))));
    assert_eq!(bench.pulses.len(), 1);
    // A voltage that cannot be read is not charged on.
    bench.charged = 0;
    bench.arm_for(1_000);
    assert_eq!(bench.charged, 0);
}

#[test]
fn recordings_late_and_repeated_orders_and_those_of_other_starts_do_nothing() {
    let mut bench = Bench::new();
    let now = bench.order(None);
    let old = bench.packet(&now);
    bench.steps(201);
    bench.kicks.receive(bench.now, &old);
    let now = bench.order(None);
    // From the future, which the robot never reported; and of the start before.
    bench.send(&PulseOrder { clock: now.clock + 1, ..now });
    bench.send(&PulseOrder { boot_epoch: 16, ..now });
    let forged =
        HostLink::new(TEAM, TeamKey([4; 16]), 99).seal_order(bench.now, RobotId::new(3).unwrap(), &now);
    bench.kicks.receive(bench.now, &forged);
    // Held back until one that was sent later has come.
    let held = bench.packet(&now);
    bench.order_pulse(1, 1_500, false);
    bench.kicks.receive(bench.now, &held);
    bench.steps(10);
    assert!(!bench.kicks.is_armed(bench.now) && bench.charged == 0 && bench.pulses.is_empty());
    bench.arm();
    assert!(bench.kicks.is_armed(bench.now));
}

#[test]
fn whatever_is_ordered_no_pulse_is_longer_or_sooner_than_robot_toml_allows() {
    let (mut bench, mut dice) = (Bench::new(), 1_u32);
    let mut roll = |below: u32| {
        dice = dice.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (dice >> 8) % below
    };
    for _ in 0..40_000 {
        if roll(8) < 6 {
            bench.arm();
        } else {
            let (number, micros) = (roll(65_536) as u16, roll(65_536) as u16 % 9_000);
            bench.order_pulse(number, micros, false);
        }
        if roll(500) == 0 {
            bench.volts = f32::NAN;
        }
        if bench.volts.is_nan() && roll(20) == 0 {
            bench.volts = 190.0;
        }
        bench.steps(u64::from(roll(100)));
    }
    assert!(bench.pulses.len() > 100, "{}", bench.pulses.len());
    assert!(bench.pulses.iter().all(|(_, long)| (1..=u64::from(pulse_max(false))).contains(&long.0)));
    assert!(bench.pulses.windows(2).all(|pair| pair[1].0.since(pair[0].0) >= KICK_PAUSE));
}

#[test]
fn a_restarted_host_is_not_told_the_last_ones_pulse_and_its_own_first_is_fired() {
    let mut bench = Bench::new();
    bench.arm_for(3_000);
    assert!(bench.fire(1, 1_500).is_ok());
    assert_eq!(bench.kicks.report(bench.now, 10).last, None);
    bench.host = HostLink::new(TEAM, KEY, 10);
    bench.arm_for(3_000);
    bench.order_pulse(1, 2_000, false);
    bench.steps(30);
    let last = bench.kicks.report(bench.now, 10).last;
    assert!(matches!(last, Some((Pulse { micros: 2_000, .. }, Ok(_)))), "{last:?}");
    assert_eq!(bench.pulses.len(), 2);
}
