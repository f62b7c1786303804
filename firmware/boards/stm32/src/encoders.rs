//! `encoders`: wheel-speed measurement. Four timers count the edges of two channels each.

use embassy_stm32::peripherals::{TIM2, TIM3, TIM4, TIM8};
use embassy_stm32::timer::qei::{Config, Qei};
use protocol::Instant;
use runtime::sense::Encoder;
use runtime::wheel::WHEELS;

use crate::pins;

/// The four counters, and the conversion of their counts.
pub struct Encoders {
    front_right: Qei<'static, TIM2>,
    back_right: Qei<'static, TIM3>,
    back_left: Qei<'static, TIM4>,
    front_left: Qei<'static, TIM8>,
    wheels: [Encoder; WHEELS],
}

impl Encoders {
    /// Starts the four quadrature counters at zero.
    pub fn new(parts: pins::Encoders) -> Self {
        let config = Config::default();
        Self {
            front_right: Qei::new(parts.front_right, parts.front_right_a, parts.front_right_b, config),
            back_right: Qei::new(parts.back_right, parts.back_right_a, parts.back_right_b, config),
            back_left: Qei::new(parts.back_left, parts.back_left_a, parts.back_left_b, config),
            front_left: Qei::new(parts.front_left, parts.front_left_a, parts.front_left_b, config),
            wheels: [Encoder::new(RIM_A_COUNT); WHEELS],
        }
    }

    /// Counts of the encoders, in the order of the wheels on the wire; they wrap.
    pub fn counts(&self) -> [u16; WHEELS] {
        [self.front_right.count(), self.back_right.count(), self.back_left.count(), self.front_left.count()]
    }

    /// Rim speeds, m/s; NaN for one that is broken, judged from its motor's duty cycle.
    pub fn rims(&mut self, now: Instant, rule_role: [f32; WHEELS]) -> [f32; WHEELS] {
        let mut rims = [0.0; WHEELS];
        let counts = self.counts();
        for (((rim, encoder), count), rule_role) in
            rims.iter_mut().zip(&mut self.wheels).zip(counts).zip(rule_role)
        {
            *rim = encoder.step(now, count, rule_role);
        }
        rims
    }
}

/// Radius of a wheel, m: 27 mm, as most robots' (to be set for yours).
const WHEEL_RADIUS: f32 = 0.027;
/// Counts per turn of the wheel: an encoder of 1,024 lines on the wheel's own shaft (to be set for yours;
/// negative where it counts down when the wheel turns the robot counter-clockwise).
const COUNTS_A_TURN: f32 = 4096.0;
/// Distance of the rim for a count, m.
pub const RIM_A_COUNT: f32 = 2.0 * core::f32::consts::PI * WHEEL_RADIUS / COUNTS_A_TURN;
