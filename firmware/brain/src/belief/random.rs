//! `random`: seeded normal numbers for tests of the estimators.

use geometry::math;
use rand_core::{RngCore, SeedableRng};
use rand_xoshiro::Xoshiro128PlusPlus;

/// A stream of random numbers.
pub(super) struct RandomStream(Xoshiro128PlusPlus);

impl RandomStream {
    pub(super) fn new(seed: u64) -> Self {
        Self(Xoshiro128PlusPlus::seed_from_u64(seed))
    }

    /// Uniform in (0, 1).
    pub(super) fn share(&mut self) -> f64 {
        (f64::from(self.0.next_u32()) + 0.5) / 4_294_967_296.0
    }

    /// Uniform in `low..high`.
    pub(super) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.share()
    }

    /// Normal, mean 0 and deviation 1.
    pub(super) fn normal(&mut self) -> f64 {
        let radius = math::sqrt(-2.0 * math::ln(self.share() as f32));
        f64::from(radius * math::sin_cos(math::TAU * self.share() as f32).1)
    }
}
