//! `drift`: correlated random errors. An Ornstein–Uhlenbeck process: normal with mean 0, correlated over
//! time.

use geometry::math;

use crate::rng::Stream;

/// A standard normal error that changes over time; its user scales it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Drift {
    value: f32,
    /// Correlation of two successive values.
    keep: f32,
    /// Share of fresh noise that keeps the variance.
    renew: f32,
}

impl Drift {
    /// An error with correlation time `time` s, advanced every `dt` s; starts at a random value.
    pub(crate) fn new(time: f32, dt: f32, chance: &mut Stream) -> Self {
        let keep = if time > 0.0 { math::exp(-dt / time) } else { 0.0 };
        Self { value: chance.normal(), keep, renew: math::sqrt(1.0 - keep * keep) }
    }

    /// Advances by a step and returns the new value.
    pub(crate) fn step(&mut self, chance: &mut Stream) -> f32 {
        self.value = self.keep * self.value + self.renew * chance.normal();
        self.value
    }

    /// Present value, in standard deviations.
    pub(crate) fn value(&self) -> f32 {
        self.value
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_drift_has_unit_variance_and_its_correlation_time() {
        let mut chance = Stream::new(3, "drift");
        let mut drift = Drift::new(0.5, 0.04, &mut chance);
        let values: Vec<f32> = (0..200_000).map(|_| drift.step(&mut chance)).collect();
        let mean = |pairs: &mut dyn Iterator<Item = f32>, n: usize| pairs.sum::<f32>() / n as f32;
        let variance = mean(&mut values.iter().map(|v| v * v), values.len());
        assert!((variance - 1.0).abs() < 0.06, "{variance}");
        let later = mean(&mut values.iter().zip(&values[13..]).map(|(a, b)| a * b), values.len() - 13);
        // exp(−0.52 / 0.5).
        assert!((later - 0.353).abs() < 0.06, "{later}");
    }
}
