//! `samples`: the last few samples of a quantity and their median; a sample that is far off moves it by one
//! place at most.

/// A quantity as far as it is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The median of the samples.
    pub value: f32,
    /// The median of their distances from it.
    pub spread: f32,
    /// Number of samples that it is the median of.
    pub samples: usize,
}

impl Estimate {
    /// The median's standard error, were the samples normally distributed, in the quantity's unit.
    pub fn error(&self) -> f32 {
        // A normal sample's σ is 1.48 median distances, and the median of n has 1.25 times the mean's error.
        1.48 * 1.25 * self.spread / (self.samples.max(1) as f32).sqrt()
    }
}

/// The last `N` samples of a quantity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Samples<const N: usize> {
    values: [f32; N],
    count: usize,
    next: usize,
}

impl<const N: usize> Default for Samples<N> {
    fn default() -> Self {
        Self { values: [0.0; N], count: 0, next: 0 }
    }
}

impl<const N: usize> Samples<N> {
    /// Adds a sample; the oldest is dropped. A value that is not finite is ignored.
    pub(super) fn add(&mut self, value: f32) {
        if value.is_finite() {
            self.values[self.next] = value;
            self.next = (self.next + 1) % N;
            self.count = (self.count + 1).min(N);
        }
    }

    /// Their median and spread, where there are at least `least`.
    pub(super) fn estimate(&self, least: usize) -> Option<Estimate> {
        let known = &self.values[..self.count];
        if known.len() < least.max(1) {
            return None;
        }
        let value = median(known);
        let mut off = self.values;
        for off in &mut off {
            *off = (*off - value).abs();
        }
        Some(Estimate { value, spread: median(&off[..self.count]), samples: self.count })
    }
}

/// The middle value of at least one.
fn median(values: &[f32]) -> f32 {
    let mut sorted: heapless::Vec<f32, 64> = values.iter().copied().take(64).collect();
    sorted.sort_unstable_by(f32::total_cmp);
    let middle = sorted.len() / 2;
    if sorted.len().is_multiple_of(2) { 0.5 * (sorted[middle - 1] + sorted[middle]) } else { sorted[middle] }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_third_of_wrong_samples_moves_the_median_little_and_old_ones_are_forgotten() {
        let mut samples = Samples::<9>::default();
        assert_eq!(samples.estimate(1), None);
        for n in 0..9 {
            samples.add(if n % 3 == 0 { 5.0 } else { 0.7 + 0.01 * n as f32 });
        }
        samples.add(f32::NAN);
        let known = samples.estimate(3).unwrap();
        assert!((0.70..=0.79).contains(&known.value) && known.samples == 9, "{known:?}");
        assert_eq!(samples.estimate(10), None);
        (0..9).for_each(|_| samples.add(1.2));
        assert_eq!(samples.estimate(3), Some(Estimate { value: 1.2, spread: 0.0, samples: 9 }));
    }
}
