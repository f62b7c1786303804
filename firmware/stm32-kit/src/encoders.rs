//! `encoders`: wheel-speed measurement. Four timers count the edges of two channels each.

use board_kit::encoders::EncoderCounts;
use embassy_stm32::timer::GeneralInstance4Channel;
use embassy_stm32::timer::qei::Qei;
use rules::{RobotSpec, WheelSpec};
use runtime::wheel::WHEELS;

/// Counters of the four wheels' encoders.
#[allow(missing_debug_implementations, reason = "the chip's drivers have none")]
pub struct Encoders<A, B, C, D>
where
    A: GeneralInstance4Channel,
    B: GeneralInstance4Channel,
    C: GeneralInstance4Channel,
    D: GeneralInstance4Channel,
{
    /// Counter of the front right wheel.
    pub front_right: Qei<'static, A>,
    /// Counter of the back right wheel.
    pub back_right: Qei<'static, B>,
    /// Counter of the back left wheel.
    pub back_left: Qei<'static, C>,
    /// Counter of the front left wheel.
    pub front_left: Qei<'static, D>,
}

impl<A, B, C, D> EncoderCounts for Encoders<A, B, C, D>
where
    A: GeneralInstance4Channel,
    B: GeneralInstance4Channel,
    C: GeneralInstance4Channel,
    D: GeneralInstance4Channel,
{
    const RIM_PER_COUNT: f32 = 2.0 * core::f32::consts::PI * SPEC.radius / SPEC.counts_a_turn;

    fn counts(&self) -> [u16; WHEELS] {
        [self.front_right.count(), self.back_right.count(), self.back_left.count(), self.front_left.count()]
    }
}

const SPEC: WheelSpec = RobotSpec::OURS.wheels;
