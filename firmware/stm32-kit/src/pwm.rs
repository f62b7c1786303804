//! `pwm`: PWM outputs of wheels and dribbler: four channels of one timer, and one of another.

use board_kit::motors::{Bridges, PwmDir};
use embassy_stm32::Peri;
use embassy_stm32::gpio::{Flex, Input, Level, Output, Pin, Pull, Speed};
use embassy_stm32::time::Hertz;
use embassy_stm32::timer::low_level::{CountingMode, Timer};
use embassy_stm32::timer::simple_pwm::{PwmPin, SimplePwm, SimplePwmChannel};
use embassy_stm32::timer::{Ch1, Ch2, Ch3, Ch4, GeneralInstance1Channel, GeneralInstance4Channel};
use embedded_hal::pwm::{ErrorType, SetDutyCycle};
use rules::{MotorScheme, RobotSpec};
use runtime::wheel::WHEELS;

/// Drivers with PWM and direction on the timer `T`, and a dribbler with PWM alone.
pub type Drivers<T, D> =
    Bridges<PwmDir<SimplePwmChannel<'static, T>, Output<'static>>, D, Output<'static>, Input<'static>>;

/// Pins of the four wheels, in their order on the wire.
#[allow(missing_debug_implementations, reason = "pins have none")]
pub struct WheelPins<'a, T> {
    /// The front right wheel's PWM.
    pub front_right: PwmPin<'a, T, Ch1>,
    /// The back right wheel's PWM.
    pub back_right: PwmPin<'a, T, Ch2>,
    /// The back left wheel's PWM.
    pub back_left: PwmPin<'a, T, Ch3>,
    /// The front left wheel's PWM.
    pub front_left: PwmPin<'a, T, Ch4>,
    /// The direction wires of the wheels, in the same order.
    pub directions: [Output<'a>; WHEELS],
}

/// The drivers of all five motors, without current. `enable` is high for current, `fault` pulled low by a
/// driver that has switched itself off.
pub fn drivers<T: GeneralInstance4Channel, D: SetDutyCycle>(
    timer: Peri<'static, T>,
    pins: WheelPins<'static, T>,
    dribbler: D,
    enable: Output<'static>,
    fault: Peri<'static, impl Pin>,
) -> Drivers<T, D> {
    let pwm = SimplePwm::new(
        timer,
        Some(pins.front_right),
        Some(pins.back_right),
        Some(pins.back_left),
        Some(pins.front_left),
        PWM,
        CountingMode::EdgeAlignedUp,
    );
    let channels = pwm.split();
    let [a, b, c, d] = pins.directions;
    let wheels = [(channels.ch1, a), (channels.ch2, b), (channels.ch3, c), (channels.ch4, d)];
    let wheels = wheels.map(|(channel, direction)| PwmDir::new(started(channel), direction));
    Bridges::new(wheels, dribbler, enable, Input::new(fault, Pull::Up))
}

/// The dribbler's PWM on the first channel of a timer of four.
pub fn dribbler<T: GeneralInstance4Channel>(
    timer: Peri<'static, T>,
    pin: PwmPin<'static, T, Ch1>,
) -> SimplePwmChannel<'static, T> {
    let pwm = SimplePwm::new(timer, Some(pin), None, None, None, PWM, CountingMode::EdgeAlignedUp);
    started(pwm.split().ch1)
}

/// The three phases of a brushless motor on the first three channels of a timer, low.
pub fn phases<T: GeneralInstance4Channel>(
    timer: Peri<'static, T>,
    a: PwmPin<'static, T, Ch1>,
    b: PwmPin<'static, T, Ch2>,
    c: PwmPin<'static, T, Ch3>,
) -> [SimplePwmChannel<'static, T>; 3] {
    let pwm = SimplePwm::new(timer, Some(a), Some(b), Some(c), None, PWM, CountingMode::EdgeAlignedUp);
    let channels = pwm.split();
    [channels.ch1, channels.ch2, channels.ch3].map(started)
}

fn started<T: GeneralInstance4Channel>(
    mut channel: SimplePwmChannel<'static, T>,
) -> SimplePwmChannel<'static, T> {
    channel.set_duty_cycle(0);
    channel.enable();
    channel
}

/// An output that is low, for a direction or an enable.
pub fn low(pin: Peri<'static, impl Pin>) -> Output<'static> {
    Output::new(pin, Level::Low, Speed::Low)
}

/// PWM of a timer of one channel, which embassy-stm32 has no driver for.
#[allow(missing_debug_implementations, reason = "the chip's drivers have none")]
pub struct OneChannelPwm<T: GeneralInstance1Channel> {
    timer: Timer<'static, T>,
    full: u16,
    _pin: Flex<'static>,
}

impl<T: GeneralInstance1Channel> OneChannelPwm<T> {
    /// A channel that is low. The pin: [`wire`](crate::pulse::wire).
    pub fn new(timer: Peri<'static, T>, pin: Flex<'static>) -> Self {
        let timer = Timer::new(timer);
        let registers = timer.regs_1ch();
        // 16 bits at the timer's full clock: 25 kHz of 168 MHz are 6,720 ticks.
        let full = (timer.get_clock_frequency().0 / PWM.0).min(u32::from(u16::MAX)) as u16;
        registers.psc().write_value(0);
        registers.arr().write(|end| end.set_arr(full.saturating_sub(1)));
        registers.ccmr_output(0).modify(|mode| mode.set_ocm(0, PWM_MODE1.into()));
        registers.ccr(0).write(|compare| compare.set_ccr(0));
        registers.ccer().modify(|enable| enable.set_cce(0, true));
        timer.generate_update_event();
        registers.cr1().modify(|control| control.set_cen(true));
        Self { timer, full, _pin: pin }
    }
}

impl<T: GeneralInstance1Channel> ErrorType for OneChannelPwm<T> {
    type Error = core::convert::Infallible;
}

impl<T: GeneralInstance1Channel> SetDutyCycle for OneChannelPwm<T> {
    fn max_duty_cycle(&self) -> u16 {
        self.full
    }

    fn set_duty_cycle(&mut self, duty: u16) -> Result<(), Self::Error> {
        self.timer.regs_1ch().ccr(0).write(|compare| compare.set_ccr(duty.min(self.full)));
        Ok(())
    }
}

/// Output compare mode, high until the compare value, then low (OC1M).
const PWM_MODE1: u8 = 6;
/// Scheme of motors that these boards are wired for.
const _: () = assert!(
    matches!(RobotSpec::OURS.parts.motors, MotorScheme::PwmDirection),
    "this board drives motors by PWM and direction; the robot's description has another `motors.scheme`"
);
/// Above the audible range; motor drivers with current control take 20 to 50 kHz.
const PWM: Hertz = Hertz(25_000);
