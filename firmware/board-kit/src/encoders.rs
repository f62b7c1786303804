//! `encoders`: what boards bring of the wheels' encoders: their counters.

use runtime::wheel::WHEELS;

/// Counters of the wheels' encoders.
pub trait EncoderCounts {
    /// Distance of the rim for a count, m; negative where it counts down when the wheel turns the robot
    /// counter-clockwise.
    const RIM_PER_COUNT: f32;

    /// Counts in the order of the wheels on the wire (front right, back right, back left, front left); they
    /// wrap.
    fn counts(&self) -> [u16; WHEELS];
}
