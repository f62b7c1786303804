//! `in_match`: parts that fail in a match: the robots of both teams drive on wheels and motors of their own
//! ([`Chassis`]), whose motion their bodies in the simulator follow, under host and referee. m, s.

use std::cell::RefCell;
use std::rc::Rc;

use arena::game::{Game, GameConfig, NoWatcher};
use brain::BrainConfig;
use casebase::CaseBase;
use hil_sim::{Backend, Mcu, McuError, NativeMcu, Reply};
use motion::omni::Omni;
use protocol::lockstep::TickIn;
use protocol::parts::{Part, PartState};
use protocol::robot_io::{ActuatorFrame, OmniKick, SensorFrame};
use rules::{League, RobotSpec};
use runtime::kicker::{ChargeWatch, FULL_VOLTS, KickerAct};

use crate::chassis::{Chance, Chassis, PartFault};

/// What a robot's wheels, motors, sensors and kicker are, and the fault in them.
struct Hardware {
    chassis: Chassis,
    fault: Option<PartFault>,
    watch: ChargeWatch,
    volts: f32,
    was_ready: bool,
    order: ActuatorFrame,
    seed: u64,
}

impl Hardware {
    fn new(seed: u64) -> Self {
        Self {
            chassis: Chassis::new(seed),
            fault: None,
            watch: ChargeWatch::new(),
            volts: FULL_VOLTS,
            was_ready: true,
            order: ActuatorFrame::Released,
            seed,
        }
    }

    fn plant(&mut self, fault: PartFault) {
        self.fault = Some(fault);
        self.chassis.plant(self.fault);
    }

    /// Repaired, and started again where it rolls.
    fn restart(&mut self) {
        let whole = Self::new(self.seed + 1);
        let chassis = Chassis::rolling(whole.seed, self.chassis.twist);
        *self = Self { chassis, order: self.order, was_ready: self.was_ready, ..whole };
    }

    fn failed(&self) -> Option<Part> {
        self.chassis.report().in_state(PartState::Failed).next()
    }

    /// Whether it is ordered to drive: which part of its wheels fails cannot be seen while it stands.
    fn is_driven(&self) -> bool {
        matches!(self.order, ActuatorFrame::Omni { wheels, .. } if wheels.iter().any(|rim| rim.abs() > 0.3))
    }

    /// What the brain measures.
    fn sense(&mut self, sensors: &mut SensorFrame) {
        let off = sensors.odometry.linear - self.chassis.twist.linear;
        // Bodies push each other: the chassis follows what the simulator's collisions do.
        let pushed =
            if off.norm() > PUSHED { off * (RobotSpec::OURS.hardware.mass / 0.05) } else { off * 0.0 };
        self.chassis.push = pushed.clamped(PUSH_MAX);
        let has_failed = |part| self.chassis.report().state(part) == PartState::Failed;
        sensors.ball_contact |= self.fault == Some(PartFault::BeamStuck);
        sensors.ball_contact &= !has_failed(Part::BREAK_BEAM);
        sensors.odometry = self.chassis.odometry();
        let fired = self.was_ready && !sensors.health.kicker_ready;
        self.was_ready = sensors.health.kicker_ready;
        if fired {
            self.volts = FIRED_VOLTS;
        }
        sensors.health.kicker_ready &= self.volts >= FULL_VOLTS;
        self.charge(fired);
    }

    /// The kicker's board for 10 ms.
    fn charge(&mut self, fired: bool) {
        let discharge = matches!(
            self.order,
            ActuatorFrame::Released | ActuatorFrame::Omni { kick: OmniKick::Discharge, .. }
        );
        for step in 0..10_u64 {
            let act = match self.volts < FULL_VOLTS {
                _ if fired && step == 0 => KickerAct::Flat(protocol::Duration(2_600)),
                _ if discharge => KickerAct::Bleed,
                true => KickerAct::Charge,
                false => KickerAct::Rest,
            };
            self.volts += match act {
                _ if self.fault == Some(PartFault::ChargerDead) => -self.volts * EMPTIES_PER_STEP,
                KickerAct::Charge => CHARGE_PER_STEP,
                KickerAct::Bleed => -self.volts * EMPTIES_PER_STEP,
                _ => 0.0,
            };
            self.chassis.doubted[1] =
                self.watch.step(self.chassis.now() + protocol::Duration::millis(step), act, self.volts);
        }
    }

    /// The motion that the simulator's body is to follow.
    fn drive(&mut self) -> ActuatorFrame {
        self.chassis.drive(self.order);
        let ActuatorFrame::Omni { dribbler, kick, .. } = self.order else { return self.order };
        let full = self.volts >= FULL_VOLTS || kick == OmniKick::Discharge;
        let kick = if full { kick } else { OmniKick::None };
        ActuatorFrame::Omni { wheels: Omni::default().rims(self.chassis.twist), dribbler, kick }
    }
}

/// A robot's computer with hardware that fails.
struct Computer<'a> {
    native: NativeMcu<'a>,
    hardware: Rc<RefCell<Hardware>>,
}

impl Mcu for Computer<'_> {
    fn post(&mut self, tick: &TickIn<'_>) -> Result<(), McuError> {
        let mut tick = tick.clone();
        self.hardware.borrow_mut().sense(&mut tick.sensors);
        self.native.post(&tick)?;
        let doubts = self.native.station().brain().belief().doubts_break_beam(tick.now);
        self.hardware.borrow_mut().chassis.doubted[0] = doubts;
        Ok(())
    }

    fn collect(&mut self) -> Result<Reply, McuError> {
        let mut reply = self.native.collect()?;
        let mut hardware = self.hardware.borrow_mut();
        hardware.order = reply.actuators.unwrap_or(hardware.order);
        reply.actuators = Some(hardware.drive());
        Ok(reply)
    }
}

/// Boots robots with hardware that fails.
struct Breakable {
    base: CaseBase<'static>,
    robots: Vec<Rc<RefCell<Hardware>>>,
}

impl<'a> Backend<'a> for Breakable {
    fn name(&self) -> &'static str {
        "breakable"
    }

    fn boot(&mut self, config: &BrainConfig) -> Result<Box<dyn Mcu + 'a>, McuError> {
        let hardware = Rc::new(RefCell::new(Hardware::new(1_000 * self.robots.len() as u64)));
        self.robots.push(Rc::clone(&hardware));
        Ok(Box::new(Computer { native: NativeMcu::new(config, self.base), hardware }))
    }
}

/// A match of six against six.
struct Match {
    game: Game<'static>,
    robots: Vec<Rc<RefCell<Hardware>>>,
    chance: Chance,
    named_whole: Vec<(f64, Part)>,
}

impl Match {
    fn new(seed: u64, seconds: f64) -> Self {
        let base = case_library::division_b();
        let mut backend = Breakable { base, robots: Vec::new() };
        let game = Game::new(&GameConfig::new(League::DivisionB, seed, seconds), &mut backend);
        let game = game.expect("a match");
        Self { game, robots: backend.robots, chance: Chance::new(seed), named_whole: Vec::new() }
    }

    /// One tick of 10 ms; robots that name a part without a fault are noted and restarted.
    fn step(&mut self) -> bool {
        self.game.step(&mut NoWatcher).expect("plays");
        for robot in &self.robots {
            let mut robot = robot.borrow_mut();
            if let (None, Some(part)) = (robot.fault, robot.failed()) {
                self.named_whole.push((self.game.time(), part));
                robot.restart();
            }
        }
        !self.game.is_over()
    }

    /// Breaks a part of a robot that drives, and waits for its name: seconds and part.
    fn first_named(&mut self, fault: PartFault) -> Option<(f32, Part)> {
        for _ in 0..self.chance.between(50.0, 300.0) as u32 {
            self.step();
        }
        let robot = loop {
            let chosen = self.chance.between(0.0, self.robots.len() as f32) as usize;
            let robot = &self.robots[chosen.min(self.robots.len() - 1)];
            if robot.borrow().is_driven() {
                break Rc::clone(robot);
            }
            assert!(self.step(), "the match ends before its faults are planted");
        };
        robot.borrow_mut().plant(fault);
        let named = (1..400).find_map(|tick| {
            self.step();
            robot.borrow().failed().map(|part| (tick as f32 * 0.01, part))
        });
        robot.borrow_mut().restart();
        named
    }
}

/// The fault of that number, and the part that has it: of 20, six motors, five encoders, three gyroscopes,
/// three break-beam sensors, three chargers.
fn fault(number: u64) -> (PartFault, Part) {
    let wheel = (number / 20 + number) as u8 % 4;
    match number % 20 {
        0..6 => (PartFault::MotorOpen(wheel), Part::motor(wheel)),
        6..9 => (PartFault::EncoderDead(wheel), Part::encoder(wheel)),
        9..11 => (PartFault::EncoderWild(wheel), Part::encoder(wheel)),
        11..13 => (PartFault::GyroscopeStuck, Part::GYROSCOPE),
        13 => (PartFault::GyroscopeOff(2.0), Part::GYROSCOPE),
        14..17 => (PartFault::BeamStuck, Part::BREAK_BEAM),
        _ => (PartFault::ChargerDead, Part::CHARGER),
    }
}

/// Of 20 faults of a match: named rightly within 2 s, rightly later or not in 4 s, wrongly; and what whole
/// robots named.
fn judged(seed: u64) -> ([u32; 3], usize) {
    let mut played = Match::new(seed, 400.0);
    let mut judged = [0; 3];
    for number in 20 * seed..20 * seed + 20 {
        let (planted, part) = fault(number);
        let named = played.first_named(planted);
        let kind = match named {
            Some((_, other)) if other != part => 2,
            Some((took, _)) if took <= 2.0 => 0,
            _ => 1,
        };
        println!("{seed}: {planted:?} at {:.1} s: {named:?}", played.game.time());
        judged[kind] += 1;
    }
    (judged, played.named_whole.len())
}

/// Matches of seeds that no threshold was set by.
#[test]
fn in_120_robot_minutes_of_matches_whole_robots_name_no_part() {
    let (mut ticks, mut named) = (0, Vec::new());
    for seed in LONG_SEEDS {
        let mut played = Match::new(seed, 120.0);
        while played.step() {
            ticks += 1;
        }
        println!("{seed}: {:?}", played.named_whole);
        named.extend(played.named_whole);
    }
    println!("{} minutes of robots: {} named", 12 * ticks / 6_000, named.len());
    assert_eq!(named, []);
}

/// 20 faults in each of five matches.
#[test]
fn of_100_faults_in_matches_65_are_named_within_2_s() {
    let mut sums = ([0; 3], 0);
    for seed in FAULT_SEEDS {
        let (judged, whole) = judged(seed);
        println!("{seed}: {judged:?}, {whole} of whole robots");
        sums.0.iter_mut().zip(judged).for_each(|(sum, more)| *sum += more);
        sums.1 += whole;
    }
    println!("in time, late or not, wrongly: {:?}; of whole robots {}", sums.0, sums.1);
    assert!(sums.0[0] >= 65 && sums.0[2] <= 3 && sums.1 == 0, "{sums:?}");
}

/// A motion that differs by more is a collision's, m/s: more than wheels lag behind their order.
const PUSHED: f32 = 0.4;
/// Greatest push, N: what wheels hold.
const PUSH_MAX: f32 = 15.0;
/// Voltage left by a kick, V.
const FIRED_VOLTS: f32 = 80.0;
/// Of a millisecond, V: full in 2 s.
const CHARGE_PER_STEP: f32 = 0.1;
/// Share of the voltage that its resistor takes in a millisecond: half a second.
const EMPTIES_PER_STEP: f32 = 0.002;
const FAULT_SEEDS: core::ops::Range<u64> = 100..105;
const LONG_SEEDS: core::ops::Range<u64> = 200..205;
