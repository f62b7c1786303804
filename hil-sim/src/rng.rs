//! `rng`: seeded random streams. One seeded stream per subsystem, so that an additional draw in one changes
//! nothing in another.
//!
//! The generator is xoshiro128++ (a published stream, the same everywhere); values derived from its bits are
//! computed by `geometry::math` (docs/architecture.md §2.4).

use geometry::math;
use rand_core::{RngCore, SeedableRng};
use rand_xoshiro::Xoshiro128PlusPlus;
use serde::{Deserialize, Serialize};

use crate::hash::Fnv;

/// The random stream of one subsystem.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Stream(Xoshiro128PlusPlus);

impl Stream {
    /// The stream of subsystem `name` in the run `seed`.
    pub fn new(seed: u64, name: &str) -> Self {
        let mut hash = Fnv::default();
        hash.add(name.as_bytes());
        Self(Xoshiro128PlusPlus::seed_from_u64(seed ^ hash.value()))
    }

    /// Uniform in [0, 1), in steps of 2⁻²⁴.
    pub fn share(&mut self) -> f32 {
        (self.0.next_u32() >> 8) as f32 * (1.0 / 16_777_216.0)
    }

    /// Uniform in [low, high).
    pub fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.share()
    }

    /// True with probability `p`; draws nothing where `p` leaves no choice.
    pub fn chance(&mut self, p: f32) -> bool {
        p > 0.0 && (p >= 1.0 || self.share() < p)
    }

    /// A uniform integer in `low..=high`; `low` where the range is empty.
    pub fn whole(&mut self, low: u32, high: u32) -> u32 {
        if low >= high {
            return low;
        }
        low + ((u64::from(self.0.next_u32()) * (u64::from(high - low) + 1)) >> 32) as u32
    }

    /// Normal with mean 0 and standard deviation 1 (Box–Muller).
    pub fn normal(&mut self) -> f32 {
        let radius = math::sqrt(-2.0 * math::ln(1.0 - self.share()));
        radius * math::sin_cos(math::TAU * self.share()).1
    }

    /// Two independent normal values, at the cost of one.
    pub fn normals(&mut self) -> (f32, f32) {
        let radius = math::sqrt(-2.0 * math::ln(1.0 - self.share()));
        let (sin, cos) = math::sin_cos(math::TAU * self.share());
        (radius * cos, radius * sin)
    }

    /// Normal, drawn again until within ±`limit` standard deviations.
    pub fn normal_within(&mut self, limit: f32) -> f32 {
        for _ in 0..REDRAWS {
            let value = self.normal();
            if (-limit..=limit).contains(&value) {
                return value;
            }
        }
        0.0
    }
}

/// Maximum number of draws of a truncated normal: at ±2 the probability of needing more is 5 % to this power.
const REDRAWS: usize = 16;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seed_and_name_determine_a_stream() {
        let draw = |seed, name| Stream::new(seed, name).share();
        assert_eq!(draw(7, "air"), draw(7, "air"));
        assert_ne!(draw(7, "air"), draw(8, "air"));
        assert_ne!(draw(7, "air"), draw(7, "kicks"));
    }

    #[test]
    fn the_normal_has_mean_zero_and_deviation_one() {
        let mut stream = Stream::new(1, "test");
        let n = 40_000;
        let values: Vec<f32> = (0..n).map(|_| stream.normal()).collect();
        let mean = values.iter().sum::<f32>() / n as f32;
        let variance = values.iter().map(|v| (v - mean) * (v - mean)).sum::<f32>() / n as f32;
        // Standard errors: 1/√n = 0.005 and √(2/n) = 0.007; four of each.
        assert!(mean.abs() < 0.02, "mean {mean}");
        assert!((variance - 1.0).abs() < 0.028, "variance {variance}");
        assert!((0..n).all(|_| stream.normal_within(2.0).abs() <= 2.0));
        let pairs: Vec<_> = (0..n).map(|_| stream.normals()).collect();
        let mean = |of: fn(&(f32, f32)) -> f32| pairs.iter().map(of).sum::<f32>() / n as f32;
        assert!((mean(|p| p.0 * p.0) - 1.0).abs() < 0.028 && (mean(|p| p.1 * p.1) - 1.0).abs() < 0.028);
        assert!(mean(|p| p.0 * p.1).abs() < 0.02, "the two do not hang together");
    }

    #[test]
    fn chance_is_true_with_its_probability() {
        let mut stream = Stream::new(2, "test");
        let hits = (0..10_000).filter(|_| stream.chance(0.3)).count();
        // Binomial deviation √(n p q) = 46; four of them.
        assert!(hits.abs_diff(3_000) < 184, "{hits}");
        assert!(!stream.chance(0.0) && stream.chance(1.0));
    }

    #[test]
    fn whole_reaches_both_bounds() {
        let mut stream = Stream::new(3, "test");
        let draws: Vec<u32> = (0..200).map(|_| stream.whole(2, 4)).collect();
        assert!((2..=4).all(|k| draws.contains(&k)) && draws.iter().all(|k| (2..=4).contains(k)));
        let all: Vec<u32> = (0..200).map(|_| stream.whole(0, u32::MAX)).collect();
        assert!(all.iter().any(|k| *k > u32::MAX / 8 * 7) && all.iter().any(|k| *k < u32::MAX / 8));
    }
}
