//! `wheel`: wheel speed control at 1 kHz, from encoder to duty cycle, and to a stop when the brain is silent
//! (docs/architecture.md §2.3, §6.2). Sans-IO; m/s at the rim, duty cycle as a share of the battery's
//! voltage.

use motion::omni::{Omni, Wheels};
use protocol::robot_io::{ActuatorFrame, OmniKick};
use protocol::{Duration, Instant};
use rules::{RobotSpec, WheelSpec};

/// Number of wheels of a robot.
pub const WHEELS: usize = 4;
/// Period of the control loop (docs/architecture.md §2.3).
pub const CONTROL_PERIOD: Duration = Duration::millis(1);

/// Parts that are no longer used, as bits of the wheels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Lost {
    /// Motors.
    pub motors: u8,
    /// Encoders.
    pub encoders: u8,
    /// The gyroscope.
    pub gyroscope: bool,
}

impl Lost {
    /// Whether wheels are lost.
    pub const fn misses_a_wheel(self) -> bool {
        self.motors | self.encoders != 0
    }

    /// Whether fewer than three wheels are left, or two parts of wheels are lost: the robot stands.
    pub const fn stops(self) -> bool {
        let lost = (self.motors | self.encoders).count_ones();
        lost > 1 || lost + 3 > RobotSpec::OURS.wheels.count as u32
    }
}

/// Output of the motors until the next step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Motors {
    /// Duty cycle of each wheel, −1 to 1.
    Driven([f32; WHEELS]),
    /// Motors without current: the wheels roll freely.
    Released,
}

/// Output of the control loop for the next millisecond: motors, dribbler and kick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ControlOutput {
    /// Output of the wheels.
    pub motors: Motors,
    /// The dribbler's share of full speed, 0–1.
    pub dribbler: f32,
    /// Kick order, passed on from the brain.
    pub kick: OmniKick,
}

/// The control loop of up to four wheels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Control {
    orders: Option<(Instant, ActuatorFrame)>,
    /// Present target rim speeds, m/s; decrease without orders.
    target: [f32; WHEELS],
    integral: [f32; WHEELS],
    lost: Lost,
    /// Share of a lost motor's push that each other takes over.
    shares: [f32; WHEELS],
}

impl Control {
    /// A controller without orders: the motors are without current.
    pub const fn new() -> Self {
        Self {
            orders: None,
            target: [0.0; WHEELS],
            integral: [0.0; WHEELS],
            lost: Lost { motors: 0, encoders: 0, gyroscope: false },
            shares: [0.0; WHEELS],
        }
    }

    /// Parts that it goes on without.
    pub fn lose(&mut self, lost: Lost) {
        self.lost = lost;
        self.shares = [0.0; WHEELS];
        let Some(dead) = (0..WHEELS).find(|wheel| lost.motors & 1 << wheel != 0) else { return };
        let (all, others) = (Omni::default(), without(dead));
        // The others' pushes that together are as one of it: as their rims turn it along.
        for (wheel, share) in self.shares.iter_mut().enumerate().filter(|(wheel, _)| *wheel != dead) {
            let one = core::array::from_fn(|other| if other == wheel { 1.0 } else { 0.0 });
            *share = all.rims(others.twist(one)).get(dead).copied().unwrap_or(0.0);
        }
    }

    /// Takes the brain's new orders.
    pub fn take_orders(&mut self, now: Instant, orders: ActuatorFrame) {
        self.orders = Some((now, orders));
    }

    /// One step of a millisecond: the drive for the encoders' readings.
    pub fn step(&mut self, now: Instant, measured: [f32; WHEELS]) -> ControlOutput {
        let fresh = self.orders.filter(|(at, _)| now.since(*at) < ORDERS_AGE_MAX && !self.lost.stops());
        let fresh = fresh.map(|(_, orders)| orders);
        let (dribbler, kick) = match (self.orders, fresh) {
            (None, _) | (_, Some(ActuatorFrame::Released | ActuatorFrame::Legged { .. })) => {
                *self = Self { orders: self.orders, lost: self.lost, shares: self.shares, ..Self::new() };
                return ControlOutput { motors: Motors::Released, dribbler: 0.0, kick: OmniKick::Discharge };
            }
            (Some(_), Some(ActuatorFrame::Omni { wheels, dribbler, kick }))
                if is_finite(&wheels, dribbler) =>
            {
                self.target =
                    if self.lost.misses_a_wheel() { slowed_target(self.target, wheels) } else { wheels };
                (dribbler, kick)
            }
            // The brain is silent, or has sent NaN: brakes to a stop as fast as wheels hold the field
            // surface.
            (Some(_), _) => {
                self.target = self.target.map(braked);
                (0.0, OmniKick::Discharge)
            }
        };
        let mut duty = [0.0; WHEELS];
        for (wheel, (((duty, target), measured), integral)) in
            duty.iter_mut().zip(&self.target).zip(&measured).zip(&mut self.integral).enumerate()
        {
            let measured = if self.lost.encoders & 1 << wheel == 0 { *measured } else { f32::NAN };
            if !measured.is_finite() {
                *integral = 0.0;
            }
            // A broken sensor is ignored: the wheel runs open-loop, by the motor's own constant.
            let error = if measured.is_finite() { target - measured } else { 0.0 };
            let open = target * FEED_FORWARD + error * PROPORTIONAL;
            let trial = *integral + error * INTEGRAL_PER_STEP;
            let free = open + trial;
            *duty = free.clamp(-1.0, 1.0);
            // At the voltage limit the integral does not grow (anti-windup).
            if free == *duty || free.abs() < (open + *integral).abs() {
                *integral = trial;
            }
        }
        if self.lost.motors != 0 {
            self.share_out(&mut duty);
        }
        ControlOutput { motors: Motors::Driven(duty), dribbler, kick }
    }

    /// Gives the push of a lost motor to the others.
    fn share_out(&self, duty: &mut [f32; WHEELS]) {
        for wheel in 0..WHEELS {
            if self.lost.motors & 1 << wheel == 0 {
                continue;
            }
            let (Some(own), Some(target)) = (duty.get_mut(wheel), self.target.get(wheel)) else { return };
            let push = core::mem::take(own) - target * FEED_FORWARD;
            for (duty, share) in duty.iter_mut().zip(self.shares) {
                *duty = (*duty + push * share).clamp(-1.0, 1.0);
            }
        }
    }
}

impl Default for Control {
    fn default() -> Self {
        Self::new()
    }
}

/// Kinematics of all wheels but one; of all, where three are left that do not drive everywhere.
#[inline(never)]
pub(crate) fn without(wheel: usize) -> Omni {
    let mut wheels = Wheels::default();
    if let Some(place) = wheels.driven.get_mut(wheel) {
        *place = false;
    }
    Omni::new(&wheels).unwrap_or_default()
}

/// The target speeds a step later of a robot that goes on with three wheels. All change in the same
/// proportion: the body's motion stays on its way.
fn slowed_target(from: [f32; WHEELS], ordered: [f32; WHEELS]) -> [f32; WHEELS] {
    let fastest = ordered.iter().fold(RIM_WITH_THREE_MAX, |most, rim| most.max(rim.abs()));
    let to = ordered.map(|rim| rim * (RIM_WITH_THREE_MAX / fastest));
    let largest =
        from.iter().zip(to).fold(RIM_CHANGE_WITH_THREE, |most, (from, to)| most.max((to - from).abs()));
    let mut next = from;
    for (rim, to) in next.iter_mut().zip(to) {
        *rim += (to - *rim) * (RIM_CHANGE_WITH_THREE / largest);
    }
    next
}

/// The target speed one braking step later, m/s.
fn braked(speed: f32) -> f32 {
    (speed.abs() - BRAKE_PER_STEP).max(0.0) * speed.signum()
}

fn is_finite(wheels: &[f32; WHEELS], dribbler: f32) -> bool {
    wheels.iter().all(|speed| speed.is_finite()) && dribbler.is_finite()
}

/// An order older than this is invalid: five steps of the brain. The governor brakes for a silent host, this
/// loop for a silent brain.
pub const ORDERS_AGE_MAX: Duration = Duration::millis(50);
/// Fastest rim of a robot that goes on with three wheels, m/s: it stops from there within 0.15 m.
const RIM_WITH_THREE_MAX: f32 = 1.0;
/// Change of its rims in a step, m/s: less than four wheels brake with, and enough for the brain's plans to
/// hold (with half of it robots circle round their places).
const RIM_CHANGE_WITH_THREE: f32 = 0.7 * BRAKE_PER_STEP;
const SPEC: WheelSpec = RobotSpec::OURS.wheels;
/// Control steps in a second.
const STEPS_PER_S: f32 = (1_000_000 / CONTROL_PERIOD.0) as f32;
/// Speed by which a rim slows down in a step, m/s: as the governor brakes.
const BRAKE_PER_STEP: f32 = RobotSpec::OURS.governor.brake / STEPS_PER_S;
/// Duty for a rim speed, s/m.
const FEED_FORWARD: f32 = 1.0 / SPEC.free_speed;
/// Duty for an error, s/m.
const PROPORTIONAL: f32 = SPEC.proportional;
/// Duty that an error of 1 m/s adds in a step.
const INTEGRAL_PER_STEP: f32 = SPEC.integral / STEPS_PER_S;

#[cfg(test)]
mod tests {
    use super::*;

    /// A motor that runs 5.4 m/s free (a weak battery), reaches two thirds of a change in 30 ms, and has a
    /// load that takes 8 % of its voltage.
    fn motor(speed: f32, duty: f32) -> f32 {
        speed + ((duty - 0.08) * 5.4 - speed) * (0.001 / 0.03)
    }

    fn omni(speed: f32) -> ActuatorFrame {
        ActuatorFrame::Omni { wheels: [speed, -speed, 0.5 * speed, 0.0], dribbler: 0.5, kick: OmniKick::None }
    }

    fn run(
        control: &mut Control,
        from: u64,
        ms: u64,
        order: Option<ActuatorFrame>,
        speeds: &mut [f32; WHEELS],
    ) -> ControlOutput {
        let mut last = ControlOutput { motors: Motors::Released, dribbler: 0.0, kick: OmniKick::None };
        for t in from..from + ms {
            let now = Instant(t * 1000);
            if let Some(order) = order.filter(|_| t % 10 == 0) {
                control.take_orders(now, order);
            }
            last = control.step(now, *speeds);
            if let Motors::Driven(duty) = last.motors {
                for (speed, duty) in speeds.iter_mut().zip(duty) {
                    assert!((-1.0..=1.0).contains(&duty));
                    *speed = motor(*speed, duty);
                }
            }
        }
        last
    }

    #[test]
    fn wheels_reach_their_speeds_in_200_ms_under_load_and_on_a_weak_battery() {
        let (mut control, mut speeds) = (Control::new(), [0.0; WHEELS]);
        run(&mut control, 0, 200, Some(omni(2.0)), &mut speeds);
        for (speed, target) in speeds.iter().zip([2.0, -2.0, 1.0, 0.0]) {
            assert!((speed - target).abs() < 0.05, "{speeds:?}");
        }
        run(&mut control, 200, 400, Some(omni(-1.0)), &mut speeds);
        assert!((speeds[0] + 1.0).abs() < 0.02, "{speeds:?}");
    }

    #[test]
    fn a_brain_that_has_gone_silent_is_braked_after_50_ms_and_its_kicker_discharged() {
        let (mut control, mut speeds) = (Control::new(), [0.0; WHEELS]);
        run(&mut control, 0, 300, Some(omni(2.0)), &mut speeds);
        // The last order was at 290 ms.
        let held = run(&mut control, 300, 39, None, &mut speeds);
        assert_eq!((held.dribbler, held.kick), (0.5, OmniKick::None));
        assert!(speeds[0] > 1.9);
        let braking = run(&mut control, 339, 2, None, &mut speeds);
        assert_eq!((braking.dribbler, braking.kick), (0.0, OmniKick::Discharge));
        // 2 m/s at 5 m/s², and a while for the motor.
        run(&mut control, 341, 600, None, &mut speeds);
        assert!(speeds.iter().all(|speed| speed.abs() < 0.02), "{speeds:?}");
    }

    #[test]
    fn before_the_first_order_and_when_released_there_is_no_current() {
        let mut control = Control::new();
        let released = ControlOutput { motors: Motors::Released, dribbler: 0.0, kick: OmniKick::Discharge };
        assert_eq!(control.step(Instant(0), [0.0; WHEELS]), released);
        control.take_orders(Instant(1000), omni(1.0));
        assert_ne!(control.step(Instant(1000), [0.0; WHEELS]).motors, Motors::Released);
        control.take_orders(Instant(2000), ActuatorFrame::Released);
        assert_eq!(control.step(Instant(2000), [0.0; WHEELS]), released);
    }

    #[test]
    fn nan_in_orders_or_encoders_drives_nothing_and_leaves_nothing_behind() {
        let mut control = Control::new();
        let bad = ActuatorFrame::Omni { wheels: [f32::NAN; 4], dribbler: 0.0, kick: OmniKick::Flat(6.0) };
        control.take_orders(Instant(0), bad);
        let step = control.step(Instant(0), [0.0; WHEELS]);
        assert_eq!((step.motors, step.kick), (Motors::Driven([0.0; WHEELS]), OmniKick::Discharge));
        control.take_orders(Instant(1000), omni(1.0));
        let Motors::Driven(duty) = control.step(Instant(1000), [f32::NAN; WHEELS]).motors else {
            panic!("released")
        };
        assert!(duty.iter().all(|duty| duty.is_finite()), "{duty:?}");
    }
}
