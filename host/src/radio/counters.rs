//! `counters`: running statistics: count, mean, variance and maximum of a measure, in one pass (Welford).

/// A measure's summary; its unit is the measure's.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Counters {
    count: u32,
    mean: f64,
    /// Sum of squared differences from the mean.
    squares: f64,
    max: f64,
}

impl Counters {
    /// Adds one value to all four statistics.
    pub fn add(&mut self, value: f64) {
        self.max = if self.count == 0 { value } else { self.max.max(value) };
        self.count = self.count.saturating_add(1);
        let off = value - self.mean;
        self.mean += off / f64::from(self.count);
        self.squares += off * (value - self.mean);
    }

    /// Number of values added; saturates.
    pub fn count(&self) -> u32 {
        self.count
    }

    /// Their mean; `None` of nothing.
    pub fn mean(&self) -> Option<f64> {
        (self.count > 0).then_some(self.mean)
    }

    /// Their variance; `None` of fewer than two.
    pub fn variance(&self) -> Option<f64> {
        (self.count > 1).then(|| self.squares / f64::from(self.count - 1))
    }

    /// The largest; `None` of nothing.
    pub fn max(&self) -> Option<f64> {
        (self.count > 0).then_some(self.max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mean_variance_and_maximum_are_those_of_a_hand_calculation() {
        let mut counters = Counters::default();
        assert_eq!((counters.mean(), counters.variance(), counters.max()), (None, None, None));
        for value in [2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0] {
            counters.add(value);
        }
        // Sum 40, squared differences from 5: 9+1+1+1+0+0+4+16 = 32, over 7.
        assert_eq!(counters.mean(), Some(5.0));
        assert!((counters.variance().unwrap() - 32.0 / 7.0).abs() < 1e-12);
        assert_eq!((counters.count(), counters.max()), (8, Some(9.0)));
        let mut below = Counters::default();
        below.add(-3.0);
        assert_eq!(below.max(), Some(-3.0));
    }
}
