//! How sure is a number, and do two differ? Intervals of shares, tests of shares and means, and many tests at once.
//!
//! Wilson 1927 for a share's interval, the pooled z test for two shares, Welch 1947 for two means of unequal spread, Holm 1979
//! for a family of tests. Two-sided throughout, no continuity correction; p from `statrs`' distributions.

use statrs::distribution::{ContinuousCDF, Normal, StudentsT};

/// How many of how many.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Count {
    /// Trials in which it was so.
    pub hits: u32,
    /// All trials.
    pub of: u32,
}

impl Count {
    /// As a share, 0 to 1; `None` of no trials.
    pub fn share(self) -> Option<f64> {
        (self.of > 0).then(|| f64::from(self.hits) / f64::from(self.of))
    }
}

/// From where to where a value may lie: a share from 0 to 1, a mean or a difference in its own unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Its lower end.
    pub low: f64,
    /// Its upper end.
    pub high: f64,
}

/// Wilson's interval with that confidence, say 0.95; `None` of no trials or where the confidence is not between 0 and 1.
pub fn wilson(count: Count, confidence: f64) -> Option<Interval> {
    let share = count.share().filter(|_| confidence > 0.0 && confidence < 1.0)?;
    let n = f64::from(count.of);
    let z = Normal::standard().inverse_cdf(f64::midpoint(1.0, confidence));
    let centre = share + z * z / (2.0 * n);
    let reach = z * (share * (1.0 - share) / n + z * z / (4.0 * n * n)).sqrt();
    let scale = 1.0 + z * z / n;
    let end = |value: f64| (value / scale).clamp(0.0, 1.0);
    Some(Interval { low: end(centre - reach), high: end(centre + reach) })
}

/// How much greater the first share is than the second, at least and at most, −1 to 1: Newcombe's score interval (1998, method
/// 10), made of Wilson's; `None` as there.
pub fn newcombe(first: Count, second: Count, confidence: f64) -> Option<Interval> {
    let (a, b) = (first.share()?, second.share()?);
    let (own, other) = (wilson(first, confidence)?, wilson(second, confidence)?);
    let reach = |x: f64, y: f64| (x * x + y * y).sqrt();
    Some(Interval {
        low: a - b - reach(a - own.low, other.high - b),
        high: a - b + reach(own.high - a, b - other.low),
    })
}

/// Student's interval of a mean; `None` where the spread is not known or the confidence is not between 0 and 1.
pub fn student(sample: Sample, confidence: f64) -> Option<Interval> {
    let sd = sample.sd.filter(|_| sample.n > 1 && confidence > 0.0 && confidence < 1.0)?;
    let student = StudentsT::new(0.0, 1.0, f64::from(sample.n - 1)).ok()?;
    let reach = student.inverse_cdf(f64::midpoint(1.0, confidence)) * sd / f64::from(sample.n).sqrt();
    Some(Interval { low: sample.mean - reach, high: sample.mean + reach })
}

/// What a test says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Test {
    /// z or t; above 0 where the first is the greater.
    pub statistic: f64,
    /// The chance of a difference at least as great between equals.
    pub p: f64,
}

impl Test {
    /// Of two that are the same and do not vary.
    const EQUAL: Self = Self { statistic: 0.0, p: 1.0 };
}

/// Do two shares differ? The pooled z test; `None` where one of them is of no trials.
pub fn two_proportions(first: Count, second: Count) -> Option<Test> {
    let (a, b) = (first.share()?, second.share()?);
    let (n, m) = (f64::from(first.of), f64::from(second.of));
    let pooled = (f64::from(first.hits) + f64::from(second.hits)) / (n + m);
    let spread = (pooled * (1.0 - pooled) * (1.0 / n + 1.0 / m)).sqrt();
    if spread == 0.0 {
        return Some(Test::EQUAL);
    }
    let z = (a - b) / spread;
    Some(Test { statistic: z, p: 2.0 * Normal::standard().sf(z.abs()) })
}

/// Numbers, by their mean and spread.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// How many.
    pub n: u32,
    /// Their mean.
    pub mean: f64,
    /// Their standard deviation (of a sample: n − 1); `None` of fewer than two, or where nobody printed it.
    pub sd: Option<f64>,
}

impl Sample {
    /// Of these numbers; `None` without any.
    pub fn of(values: impl Iterator<Item = f64> + Clone) -> Option<Self> {
        let n = u32::try_from(values.clone().count()).ok().filter(|n| *n > 0)?;
        let mean = values.clone().sum::<f64>() / f64::from(n);
        let squares: f64 = values.map(|value| (value - mean) * (value - mean)).sum();
        Some(Self { n, mean, sd: (n > 1).then(|| (squares / f64::from(n - 1)).sqrt()) })
    }
}

/// Do two means differ, whatever their spreads? `None` where a spread is not known.
pub fn welch(first: Sample, second: Sample) -> Option<Test> {
    let variance =
        |sample: Sample| sample.sd.filter(|_| sample.n > 1).map(|sd| sd * sd / f64::from(sample.n));
    let (a, b) = (variance(first)?, variance(second)?);
    let difference = first.mean - second.mean;
    if a + b == 0.0 {
        let p = if difference == 0.0 { 1.0 } else { 0.0 };
        let statistic = if difference == 0.0 { 0.0 } else { difference.signum() * f64::INFINITY };
        return Some(Test { statistic, p });
    }
    let t = difference / (a + b).sqrt();
    let part = |variance: f64, n: u32| variance * variance / f64::from(n - 1);
    let freedom = (a + b) * (a + b) / (part(a, first.n) + part(b, second.n));
    let student = StudentsT::new(0.0, 1.0, freedom).ok()?;
    Some(Test { statistic: t, p: 2.0 * student.sf(t.abs()) })
}

/// Holm's step-down: what each p of a family of tests comes to, in the order given.
pub fn holm(family: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..family.len()).collect();
    order.sort_by(|&a, &b| family[a].total_cmp(&family[b]));
    let mut adjusted = vec![1.0; family.len()];
    let mut least = 0.0_f64;
    for (rank, &place) in order.iter().enumerate() {
        least = least.max((family.len() - rank) as f64 * family[place]).min(1.0);
        adjusted[place] = least;
    }
    adjusted
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(value: f64, expected: f64, within: f64) {
        assert!((value - expected).abs() <= within, "{value}, expected {expected}");
    }

    fn count(hits: u32, of: u32) -> Count {
        Count { hits, of }
    }

    fn sample(n: u32, mean: f64, sd: f64) -> Sample {
        Sample { n, mean, sd: Some(sd) }
    }

    #[test]
    fn wilsons_interval_is_newcombes_published_one() {
        // Newcombe 1998, table I, method 3: 81/263, 15/148, 0/20, 1/29.
        for (hits, of, low, high) in [
            (81, 263, 0.2553, 0.3662),
            (15, 148, 0.0624, 0.1605),
            (0, 20, 0.0, 0.1611),
            (1, 29, 0.0061, 0.1718),
        ] {
            let interval = wilson(count(hits, of), 0.95).unwrap();
            near(interval.low, low, 5e-5);
            near(interval.high, high, 5e-5);
        }
        assert_eq!(wilson(count(0, 0), 0.95), None);
        assert_eq!(wilson(count(1, 2), 1.0), None);
    }

    #[test]
    fn newcombes_interval_of_a_difference_is_the_published_one() {
        // Newcombe 1998 (differences), table II, method 10: 56/70 − 48/80, 9/10 − 3/10, 10/10 − 0/20.
        for (first, second, low, high) in [
            ((56, 70), (48, 80), 0.0524, 0.3339),
            ((9, 10), (3, 10), 0.1705, 0.8090),
            ((10, 10), (0, 20), 0.6791, 1.0),
        ] {
            let interval = newcombe(count(first.0, first.1), count(second.0, second.1), 0.95).unwrap();
            near(interval.low, low, 5e-5);
            near(interval.high, high, 5e-5);
        }
        assert_eq!(newcombe(count(1, 2), count(0, 0), 0.95), None);
    }

    #[test]
    fn students_interval_agrees_with_a_hand_calculation() {
        // 20.5 ± 2.2622 × 1.3 / √10: t of 9 degrees of freedom from any table.
        let interval = student(sample(10, 20.5, 1.3), 0.95).unwrap();
        near(interval.low, 20.5 - 0.92997, 1e-4);
        near(interval.high, 20.5 + 0.92997, 1e-4);
        assert_eq!(student(Sample { n: 1, mean: 1.0, sd: None }, 0.95), None);
        assert_eq!(student(sample(10, 1.0, 1.0), 1.0), None);
    }

    #[test]
    fn two_shares_are_compared_by_the_pooled_z() {
        // By hand: 15/25 against 7/25: pooled 0.44, spread 0.140399, z = 2.27922, p = 0.02265.
        let test = two_proportions(count(15, 25), count(7, 25)).unwrap();
        near(test.statistic, 2.27922, 1e-5);
        near(test.p, 0.02265, 1e-5);
        let turned = two_proportions(count(7, 25), count(15, 25)).unwrap();
        near(turned.statistic, -2.27922, 1e-5);
        assert_eq!(two_proportions(count(0, 5), count(0, 9)), Some(Test::EQUAL));
        assert_eq!(two_proportions(count(0, 0), count(1, 9)), None);
    }

    #[test]
    fn welchs_t_agrees_with_a_hand_calculation() {
        // 3, 4, 1, 2.1 against 490.2, 340, 433.9: t = −9.559, 2.0009 degrees of freedom, p = 0.01075.
        let first = Sample::of([3.0, 4.0, 1.0, 2.1].into_iter()).unwrap();
        let second = Sample::of([490.2, 340.0, 433.9].into_iter()).unwrap();
        near(first.mean, 2.525, 1e-12);
        near(first.sd.unwrap(), 1.278997, 1e-6);
        let test = welch(first, second).unwrap();
        near(test.statistic, -9.5594, 1e-3);
        near(test.p, 0.01075, 1e-4);
    }

    #[test]
    fn welch_gives_the_ts_of_the_papers_possessions() {
        // Defender (Table 1) and midfield defender (Table 5), reactive less cbr.
        for (cbr, reactive, t) in [
            (sample(500, 1.34, 1.37), sample(500, 1.91, 1.39), 6.5),
            (sample(500, 1.38, 1.29), sample(500, 2.13, 1.82), 7.5),
            (sample(500, 1.35, 1.23), sample(500, 2.2, 1.33), 10.5),
            (sample(500, 0.43, 0.94), sample(500, 0.85, 1.42), 5.5),
            (sample(119, 1.14, 1.3), sample(105, 3.15, 1.57), 10.4),
            (sample(88, 1.59, 1.3), sample(94, 3.59, 1.72), 8.9),
            (sample(76, 2.08, 1.41), sample(99, 3.54, 1.97), 5.7),
            (sample(129, 0.94, 1.31), sample(97, 2.92, 1.74), 9.4),
        ] {
            near(welch(reactive, cbr).unwrap().statistic, t, 0.051);
        }
    }

    #[test]
    fn what_does_not_vary_is_equal_or_different_for_sure() {
        assert_eq!(welch(sample(5, 1.0, 0.0), sample(5, 1.0, 0.0)), Some(Test::EQUAL));
        assert_eq!(welch(sample(5, 1.0, 0.0), sample(5, 2.0, 0.0)).map(|test| test.p), Some(0.0));
        assert_eq!(welch(Sample { n: 5, mean: 1.0, sd: None }, sample(5, 2.0, 1.0)), None);
        assert_eq!(Sample::of([7.0].into_iter()), Some(Sample { n: 1, mean: 7.0, sd: None }));
        assert_eq!(Sample::of(std::iter::empty()), None);
    }

    #[test]
    fn holm_steps_down_and_never_falls() {
        // By hand: 4 × 0.005, 3 × 0.01, 2 × 0.03, 0.04 raised to 0.06.
        let adjusted = holm(&[0.01, 0.04, 0.03, 0.005]);
        for (value, expected) in adjusted.into_iter().zip([0.03, 0.06, 0.06, 0.02]) {
            near(value, expected, 1e-12);
        }
        assert_eq!(holm(&[0.6, 0.9]), [1.0, 1.0]);
        assert!(holm(&[]).is_empty());
    }
}
