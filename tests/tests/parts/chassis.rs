//! `chassis`: a robot's wheels and body as masses with motors and friction, under the control loop and the
//! estimator of `runtime`, with faults to plant. 1 ms steps; m, kg, N, s, body frame.

use geometry::{Body, Twist, Vector};
use motion::omni::Omni;
use protocol::Instant;
use protocol::parts::PartsReport;
use protocol::robot_io::ActuatorFrame;
use rules::RobotSpec;
use runtime::parts::{Doubted, Means, PartsEstimator};
use runtime::sense::Encoder;
use runtime::wheel::{Control, Motors, WHEELS};

/// Random numbers.
#[derive(Clone, Debug)]
pub(crate) struct Chance(u64);

impl Chance {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    pub(crate) fn between(&mut self, low: f32, high: f32) -> f32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        low + (self.0 >> 40) as f32 / 16_777_216.0 * (high - low)
    }
}

/// A fault of a part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum PartFault {
    /// A motor without current: open circuit, or its driver is off.
    MotorOpen(u8),
    /// An encoder that counts nothing.
    EncoderDead(u8),
    /// An encoder that counts noise besides.
    EncoderWild(u8),
    /// A gyroscope that reports no turning.
    GyroscopeStuck,
    /// A gyroscope that reports this much too much, rad/s.
    GyroscopeOff(f32),
    /// A break-beam sensor that always sees a ball.
    BeamStuck,
    /// A kicker's board without supply: its capacitor empties, and is not charged.
    ChargerDead,
}

/// One robot.
#[derive(Debug)]
pub(crate) struct Chassis {
    omni: Omni,
    control: Control,
    means: Means,
    estimator: PartsEstimator,
    encoders: [Encoder; WHEELS],
    /// Way of each rim that its encoder has counted, m.
    counted: [f32; WHEELS],
    rims: [f32; WHEELS],
    duty: [f32; WHEELS],
    read: [f32; WHEELS],
    gyroscope: f32,
    /// Motion of the body.
    pub(crate) twist: Twist<Body>,
    /// Force on the body from outside, N.
    pub(crate) push: Vector<Body>,
    /// Break-beam sensor, capacitor with charger, and radio are doubted where they work.
    pub(crate) doubted: Doubted,
    fault: Option<PartFault>,
    noise: Chance,
    ms: u64,
}

impl Chassis {
    /// A robot that stands; `seed` of its noise.
    pub(crate) fn new(seed: u64) -> Self {
        Self {
            omni: Omni::default(),
            control: Control::new(),
            means: Means::default(),
            estimator: PartsEstimator::new(),
            encoders: [Encoder::new(RIM_PER_COUNT); WHEELS],
            counted: [0.0; WHEELS],
            rims: [0.0; WHEELS],
            duty: [0.0; WHEELS],
            read: [0.0; WHEELS],
            gyroscope: 0.0,
            twist: Twist::default(),
            push: Vector::default(),
            doubted: [false; 3],
            fault: None,
            noise: Chance::new(seed),
            ms: 0,
        }
    }

    /// Breaks a part, or repairs it.
    pub(crate) fn plant(&mut self, fault: Option<PartFault>) {
        self.fault = fault;
    }

    /// A robot that starts while it rolls.
    pub(crate) fn rolling(seed: u64, twist: Twist<Body>) -> Self {
        let whole = Self::new(seed);
        Self { rims: whole.omni.rims(twist), twist, ..whole }
    }

    /// What it says of its parts.
    pub(crate) fn report(&self) -> PartsReport {
        self.estimator.report()
    }

    /// Motion by its own measurement.
    pub(crate) fn odometry(&self) -> Twist<Body> {
        self.estimator.odometry(self.read, Some(self.gyroscope))
    }

    /// Its clock.
    pub(crate) fn now(&self) -> Instant {
        Instant(self.ms * 1_000)
    }

    /// Takes an order and drives for 10 ms.
    pub(crate) fn drive(&mut self, order: ActuatorFrame) {
        self.control.take_orders(Instant(self.ms * 1_000), order);
        for _ in 0..10 {
            self.step();
        }
    }

    fn step(&mut self) {
        self.ms += 1;
        let now = Instant(self.ms * 1_000);
        self.sense(now);
        let output = self.control.step(now, self.read);
        self.duty = if let Motors::Driven(duty) = output.motors { duty } else { [0.0; WHEELS] };
        if let Some(rolled) = self.means.add(self.read, output.motors) {
            self.estimator.step(now, &rolled, Some(self.gyroscope), self.doubted);
            self.control.lose(self.estimator.lost());
        }
        for _ in 0..SUBSTEPS {
            self.roll();
        }
    }

    fn sense(&mut self, now: Instant) {
        for (wheel, encoder) in self.encoders.iter_mut().enumerate() {
            let rim = match self.fault {
                Some(PartFault::EncoderDead(dead)) if usize::from(dead) == wheel => 0.0,
                Some(PartFault::EncoderWild(bad)) if usize::from(bad) == wheel => {
                    self.rims[wheel] + self.noise.between(-4.0, 4.0)
                }
                _ => self.rims[wheel],
            };
            self.counted[wheel] += rim * 1e-3;
            let count = (self.counted[wheel] / RIM_PER_COUNT).floor() as i64 as u16;
            self.read[wheel] = encoder.step(now, count, self.duty[wheel]);
        }
        let turning = self.twist.angular + self.noise.between(-1.7, 1.7) * GYROSCOPE_NOISE;
        self.gyroscope = match self.fault {
            Some(PartFault::GyroscopeStuck) => 0.0,
            Some(PartFault::GyroscopeOff(by)) => turning + by,
            _ => turning,
        };
    }

    /// A part of a millisecond of physics: motors turn rims, rims push the body as friction allows.
    fn roll(&mut self) {
        let ground = self.omni.rims(self.twist);
        let mut pushes = [0.0; WHEELS];
        for wheel in 0..WHEELS {
            let open = self.fault == Some(PartFault::MotorOpen(wheel as u8));
            let rim = self.rims[wheel];
            let motor = if open { 0.0 } else { MOTOR * (self.duty[wheel] * FREE_SPEED - rim) };
            let grip = ((rim - ground[wheel]) * STIFFNESS).clamp(-GRIP, GRIP);
            let friction = FRICTION * (rim / 0.02).clamp(-1.0, 1.0);
            self.rims[wheel] += (motor - grip - friction) / RIM_MASS * DT;
            pushes[wheel] = grip;
        }
        let [x, y, torque] = self.omni.forces(pushes);
        let Twist { linear, angular } = self.twist;
        let force = Vector::new(x, y) + self.push;
        let turn: Vector<Body> = Vector::new(linear.y(), -linear.x()) * angular;
        self.twist.linear = linear + (force * (1.0 / MASS) + turn) * DT;
        self.twist.angular = angular + torque / INERTIA * DT;
    }
}

const SPEC: RobotSpec = RobotSpec::OURS;
const RIM_PER_COUNT: f32 = 2.0 * std::f32::consts::PI * SPEC.wheels.radius / SPEC.wheels.counts_a_turn;
const FREE_SPEED: f32 = SPEC.wheels.free_speed;
const MASS: f32 = SPEC.hardware.mass;
/// Of a disc, kg·m².
const INERTIA: f32 = 0.5 * MASS * SPEC.hull.radius * SPEC.hull.radius;
/// Stall force of a motor at the rim, N: of 50 W and a gear of 3 on wheels of 27 mm.
const STALL: f32 = 30.0;
/// Force for each m/s that the voltage exceeds the speed.
const MOTOR: f32 = STALL / FREE_SPEED;
/// Mass of wheel and rotor at the rim, kg.
const RIM_MASS: f32 = 0.3;
/// Largest force of a wheel on the field surface, N: friction of 0.8 under a quarter of the weight.
const GRIP: f32 = 0.8 * MASS * 9.81 / 4.0;
/// Force for each m/s of slip.
const STIFFNESS: f32 = 200.0;
/// Of bearings and rollers, N.
const FRICTION: f32 = 0.3;
/// Standard deviation of the gyroscope, rad/s.
const GYROSCOPE_NOISE: f32 = 0.02;
const SUBSTEPS: u32 = 4;
const DT: f32 = 1e-3 / SUBSTEPS as f32;
