//! `wheels`: PWM outputs of wheels and dribbler. PWM and direction into their drivers, and one wire that
//! takes the current off all of them.

use embassy_stm32::gpio::{Input, Level, Output, OutputType, Pull, Speed};
use embassy_stm32::peripherals::{TIM1, TIM5};
use embassy_stm32::time::Hertz;
use embassy_stm32::timer::Channel;
use embassy_stm32::timer::low_level::CountingMode;
use embassy_stm32::timer::simple_pwm::{PwmPin, SimplePwm};
use embassy_time::Instant;
use runtime::ports;
use runtime::wheel::WHEELS;

use crate::encoders::Encoders;
use crate::pins;

/// The drivers of all five motors.
pub struct Drivers {
    pwm: SimplePwm<'static, TIM1>,
    dribbler: SimplePwm<'static, TIM5>,
    directions: [Output<'static>; WHEELS],
    enable: Output<'static>,
    fault: Input<'static>,
}

impl Drivers {
    /// Drivers with all motors without current.
    pub fn new(parts: pins::Motors) -> Self {
        let low = Speed::Low;
        let mut pwm = SimplePwm::new(
            parts.timer,
            Some(PwmPin::new(parts.pwm_front_right, OutputType::PushPull)),
            Some(PwmPin::new(parts.pwm_back_right, OutputType::PushPull)),
            Some(PwmPin::new(parts.pwm_back_left, OutputType::PushPull)),
            Some(PwmPin::new(parts.pwm_front_left, OutputType::PushPull)),
            PWM,
            CountingMode::EdgeAlignedUp,
        );
        let dribbler_pin = PwmPin::new(parts.dribbler, OutputType::PushPull);
        let mut dribbler = SimplePwm::new(
            parts.dribbler_timer,
            Some(dribbler_pin),
            None,
            None,
            None,
            PWM,
            CountingMode::EdgeAlignedUp,
        );
        for channel in CHANNELS {
            pwm.channel(channel).set_duty_cycle(0);
            pwm.channel(channel).enable();
        }
        dribbler.ch1().set_duty_cycle(0);
        dribbler.ch1().enable();
        Self {
            pwm,
            dribbler,
            directions: [
                Output::new(parts.dir_front_right, Level::Low, low),
                Output::new(parts.dir_back_right, Level::Low, low),
                Output::new(parts.dir_back_left, Level::Low, low),
                Output::new(parts.dir_front_left, Level::Low, low),
            ],
            enable: Output::new(parts.enable, Level::Low, low),
            fault: Input::new(parts.fault, Pull::Up),
        }
    }

    /// Sets shares of the battery's voltage, −1 to 1, and 0 to 1 for the dribbler. All off where a driver has
    /// switched itself off: three wheels alone would turn the robot.
    pub fn drive(&mut self, rule_role: [f32; WHEELS], dribbler: f32) {
        if self.fault.is_low() {
            self.release();
            return;
        }
        let full = self.pwm.max_duty_cycle();
        for ((channel, direction), rule_role) in CHANNELS.into_iter().zip(&mut self.directions).zip(rule_role)
        {
            direction.set_level(if rule_role < 0.0 { Level::High } else { Level::Low });
            self.pwm.channel(channel).set_duty_cycle(share(rule_role.abs(), full));
        }
        let full = self.dribbler.max_duty_cycle();
        self.dribbler.ch1().set_duty_cycle(share(dribbler, full));
        self.enable.set_high();
    }

    /// No current in any of them.
    pub fn release(&mut self) {
        self.enable.set_low();
        for channel in CHANNELS {
            self.pwm.channel(channel).set_duty_cycle(0);
        }
        self.dribbler.ch1().set_duty_cycle(0);
    }

    /// Whether a driver has switched itself off.
    pub fn has_fault(&self) -> bool {
        self.fault.is_low()
    }
}

/// Motors with their encoders, as the control loop drives them.
pub struct WheelDrivers {
    drivers: Drivers,
    encoders: Encoders,
    rule_role: [f32; WHEELS],
}

impl WheelDrivers {
    /// Wheels with all motors without current.
    pub fn new(drivers: Drivers, encoders: Encoders) -> Self {
        Self { drivers, encoders, rule_role: [0.0; WHEELS] }
    }
}

impl ports::WheelsPort for WheelDrivers {
    fn measured(&mut self) -> [f32; WHEELS] {
        self.encoders.rims(protocol::Instant(Instant::now().as_micros()), self.rule_role)
    }

    fn drive(&mut self, rule_role: [f32; WHEELS], dribbler: f32) {
        self.drivers.drive(rule_role, dribbler);
        self.rule_role = if self.drivers.has_fault() { [0.0; WHEELS] } else { rule_role };
    }

    fn release(&mut self) {
        self.drivers.release();
        self.rule_role = [0.0; WHEELS];
    }
}

/// A share of full duty cycle; none for NaN.
fn share(rule_role: f32, full: u32) -> u32 {
    // The cast saturates, and turns NaN into 0.
    ((rule_role * full as f32) as u32).min(full)
}

/// Timer channels in the order of the wheels on the wire.
const CHANNELS: [Channel; WHEELS] = [Channel::Ch1, Channel::Ch2, Channel::Ch3, Channel::Ch4];
/// Above the audible range; motor drivers with current control take 20 to 50 kHz.
const PWM: Hertz = Hertz(25_000);
