//! `statistics`: confidence intervals and significance tests. Intervals of shares, tests of shares and means,
//! and many tests at once.
//!
//! Wilson 1927 for a share's interval, the pooled z test for two shares, Welch 1947 for two means of unequal
//! spread, McNemar's exact test and the paired t for trials of equal seeds, Holm 1979 for a family of tests.
//! Two-sided throughout, no continuity correction; p from `statrs`' distributions.

use statrs::distribution::{Binomial, ContinuousCDF, DiscreteCDF, Normal, StudentsT};

/// A count of hits among trials.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Count {
    /// Trials in which it happened.
    pub hits: u32,
    /// Number of all trials.
    pub of: u32,
}

impl Count {
    /// Share of hits, 0 to 1; `None` of no trials.
    pub fn share(self) -> Option<f64> {
        (self.of > 0).then(|| f64::from(self.hits) / f64::from(self.of))
    }
}

/// Ends of an interval: a share from 0 to 1, a mean or a difference in its own unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Lower end, in the value's unit.
    pub low: f64,
    /// Upper end, in the value's unit.
    pub high: f64,
}

/// Wilson's interval with this confidence, for example 0.95; `None` without trials or where the confidence is
/// not between 0 and 1.
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

/// Interval of the first share less the second, −1 to 1: Newcombe's score interval (1998, method 10), made of
/// Wilson's; `None` as there.
pub fn newcombe(first: Count, second: Count, confidence: f64) -> Option<Interval> {
    let (a, b) = (first.share()?, second.share()?);
    let (own, other) = (wilson(first, confidence)?, wilson(second, confidence)?);
    let reach = |x: f64, y: f64| (x * x + y * y).sqrt();
    Some(Interval {
        low: a - b - reach(a - own.low, other.high - b),
        high: a - b + reach(own.high - a, b - other.low),
    })
}

/// Student's interval of a mean; `None` where the spread is not known or the confidence is not between 0 and
/// 1.
pub fn student(sample: Sample, confidence: f64) -> Option<Interval> {
    let sd = sample.sd.filter(|_| sample.n > 1 && confidence > 0.0 && confidence < 1.0)?;
    let student = StudentsT::new(0.0, 1.0, f64::from(sample.n - 1)).ok()?;
    let reach = student.inverse_cdf(f64::midpoint(1.0, confidence)) * sd / f64::from(sample.n).sqrt();
    Some(Interval { low: sample.mean - reach, high: sample.mean + reach })
}

/// Result of a test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Test {
    /// z or t; above 0 where the first is the greater.
    pub statistic: f64,
    /// Probability of a difference at least as large between equals.
    pub p: f64,
}

impl Test {
    /// Result for two equal samples that do not vary.
    const EQUAL: Self = Self { statistic: 0.0, p: 1.0 };

    /// Result for a difference that does not vary: p is 0, or 1 for no difference.
    fn unvarying(difference: f64) -> Self {
        if difference == 0.0 {
            return Self::EQUAL;
        }
        Self { statistic: difference.signum() * f64::INFINITY, p: 0.0 }
    }
}

/// Tests whether two shares differ, by the pooled z test; `None` where one of them has no trials.
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

/// Tests whether a share differs from a given one, 0 to 1, by the z test of one share; `None` without trials,
/// or against 0 or 1.
pub fn against(count: Count, expected: f64) -> Option<Test> {
    let spread = expected * (1.0 - expected) / f64::from(count.of.max(1));
    normal(count.share()? - expected, spread)
}

/// Tests whether a normally distributed number of this variance differs from 0; `None` where it does not
/// vary.
pub fn normal(value: f64, variance: f64) -> Option<Test> {
    let z = (variance > 0.0).then(|| value / variance.sqrt())?;
    Some(Test { statistic: z, p: 2.0 * Normal::standard().sf(z.abs()) })
}

/// Tests whether two shares of the same trials differ: McNemar's exact test on the trials in which only one
/// of the two happened.
pub fn mcnemar(only_first: u32, only_second: u32) -> Option<Test> {
    let (first, second) = (f64::from(only_first), f64::from(only_second));
    let changed = u64::from(only_first) + u64::from(only_second);
    if changed == 0 {
        return Some(Test::EQUAL);
    }
    let tail = Binomial::new(0.5, changed).ok()?.cdf(u64::from(only_first.min(only_second)));
    Some(Test { statistic: (first - second) / (first + second).sqrt(), p: (2.0 * tail).min(1.0) })
}

/// Tests whether differences of pairs have a mean other than 0: Student's paired t; `None` where their spread
/// is not known.
pub fn paired(differences: Sample) -> Option<Test> {
    let sd = differences.sd?;
    if sd == 0.0 {
        return Some(Test::unvarying(differences.mean));
    }
    let t = differences.mean / (sd / f64::from(differences.n).sqrt());
    let student = StudentsT::new(0.0, 1.0, f64::from(differences.n - 1)).ok()?;
    Some(Test { statistic: t, p: 2.0 * student.sf(t.abs()) })
}

/// The smallest true mean difference that the paired test at 0.05 finds in 80 of 100 such samples; `None`
/// where the spread is not known.
pub fn detectable(differences: Sample) -> Option<f64> {
    differences.sd.map(|sd| DETECTED_AT * sd / f64::from(differences.n).sqrt())
}

/// Standard errors from 0 of such a difference: 1.960 + 0.842.
const DETECTED_AT: f64 = 2.802;

/// Size, mean and spread of a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Number of values in the sample.
    pub n: u32,
    /// Arithmetic mean of the values.
    pub mean: f64,
    /// Their standard deviation (of a sample: n − 1); `None` of fewer than two, or where it was not printed.
    pub sd: Option<f64>,
}

impl Sample {
    /// The sample of these numbers; `None` without any.
    pub fn of(values: impl Iterator<Item = f64> + Clone) -> Option<Self> {
        let n = u32::try_from(values.clone().count()).ok().filter(|n| *n > 0)?;
        let mean = values.clone().sum::<f64>() / f64::from(n);
        let squares: f64 = values.map(|value| (value - mean) * (value - mean)).sum();
        Some(Self { n, mean, sd: (n > 1).then(|| (squares / f64::from(n - 1)).sqrt()) })
    }
}

/// Whether something happened in the same trials with a change and without it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PairedShares {
    /// Trials with the change in which it happened.
    pub with: Count,
    /// Trials without the change in which it happened.
    pub without: Count,
    /// Pairs in which it happened with the change alone.
    pub only_with: u32,
    /// Pairs in which it happened without the change alone.
    pub only_without: u32,
}

impl PairedShares {
    /// Counts of these pairs: with the change, without it.
    pub fn of(pairs: impl Iterator<Item = (bool, bool)>) -> Self {
        let (mut of, mut hits, mut only) = (0, [0, 0], [0, 0]);
        for (with, without) in pairs {
            of += 1;
            hits[0] += u32::from(with);
            hits[1] += u32::from(without);
            only[0] += u32::from(with && !without);
            only[1] += u32::from(without && !with);
        }
        let [with, without] = hits.map(|hits| Count { hits, of });
        Self { with, without, only_with: only[0], only_without: only[1] }
    }

    /// McNemar's exact test.
    pub fn test(&self) -> Option<Test> {
        mcnemar(self.only_with, self.only_without)
    }
}

/// A measure of the same trials with a change and without it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairedMeans {
    /// Trials with the change.
    pub with: Sample,
    /// Trials without the change.
    pub without: Sample,
    /// Differences of the pairs: with the change less without it.
    pub differences: Sample,
}

impl PairedMeans {
    /// Samples of these pairs: with the change, without it; `None` without pairs.
    pub fn of(pairs: impl Iterator<Item = (f64, f64)> + Clone) -> Option<Self> {
        Some(Self {
            with: Sample::of(pairs.clone().map(|(with, _)| with))?,
            without: Sample::of(pairs.clone().map(|(_, without)| without))?,
            differences: Sample::of(pairs.map(|(with, without)| with - without))?,
        })
    }

    /// Student's paired t.
    pub fn test(&self) -> Option<Test> {
        paired(self.differences)
    }
}

/// Tests whether two means differ, with unequal spreads; `None` where a spread is not known.
pub fn welch(first: Sample, second: Sample) -> Option<Test> {
    let variance =
        |sample: Sample| sample.sd.filter(|_| sample.n > 1).map(|sd| sd * sd / f64::from(sample.n));
    let (a, b) = (variance(first)?, variance(second)?);
    let difference = first.mean - second.mean;
    if a + b == 0.0 {
        return Some(Test::unvarying(difference));
    }
    let t = difference / (a + b).sqrt();
    let part = |variance: f64, n: u32| variance * variance / f64::from(n - 1);
    let freedom = (a + b) * (a + b) / (part(a, first.n) + part(b, second.n));
    let student = StudentsT::new(0.0, 1.0, freedom).ok()?;
    Some(Test { statistic: t, p: 2.0 * student.sf(t.abs()) })
}

/// Holm's step-down: the corrected p of each test of a family, in the order given.
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

/// The same for tests of several families: `None` for a test that was not made.
pub(crate) fn holm_by_family<F: PartialEq>(tests: &[(F, Option<f64>)]) -> Vec<Option<f64>> {
    let mut corrected = vec![None; tests.len()];
    for (place, (own, _)) in tests.iter().enumerate() {
        if tests[..place].iter().any(|(family, _)| family == own) {
            continue;
        }
        let of_family = tests.iter().enumerate().filter(|(_, (family, _))| family == own);
        let (members, p): (Vec<_>, Vec<_>) = of_family.filter_map(|(i, (_, p))| Some((i, (*p)?))).unzip();
        for (member, p) in members.into_iter().zip(holm(&p)) {
            corrected[member] = Some(p);
        }
    }
    corrected
}

/// Stars of a p value.
pub fn stars(p: Option<f64>) -> &'static str {
    match p {
        Some(p) if p < 0.001 => "***",
        Some(p) if p < 0.01 => "**",
        Some(p) if p < 0.05 => "*",
        _ => "",
    }
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
        // By manual calculation: 15/25 against 7/25: pooled 0.44, spread 0.140399, z = 2.27922, p = 0.02265.
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
    fn every_test_agrees_with_scipy_and_statsmodels() {
        // scipy 1.17.1, statsmodels 0.15.0: proportion_confint(method="wilson"), proportions_ztest,
        // ttest_ind_from_stats (equal_var=False), mcnemar(exact=True), ttest_1samp,
        // proportions_ztest(value=0.5, prop_var=0.5), multipletests("holm").
        for (hits, of, low, high) in [
            (155, 500, 0.271_038_91, 0.351_858_34),
            (11, 30, 0.218_739_21, 0.544_864_36),
            (0, 30, 0.0, 0.113_513_39),
            (2489, 5000, 0.483_948_11, 0.511_655_27),
        ] {
            let interval = wilson(count(hits, of), 0.95).unwrap();
            near(interval.low, low, 1e-7);
            near(interval.high, high, 1e-7);
        }
        let is = |test: Option<Test>, statistic: f64, p: f64| {
            let test = test.unwrap();
            near(test.statistic, statistic, 1e-7);
            near(test.p / p, 1.0, 1e-6);
        };
        is(two_proportions(count(170, 500), count(140, 500)), 2.051_237_1, 0.040_243_862_765_18);
        is(two_proportions(count(155, 500), count(85, 500)), 5.183_052_68, 2.182_833_512_310_612_4e-7);
        is(two_proportions(count(7, 30), count(11, 30)), -1.126_872_34, 0.259_796_459_677_94);
        is(two_proportions(count(2600, 5000), count(2500, 5000)), 2.000_400_12, 0.045_457_075_445_017);
        is(
            welch(sample(500, 1.34, 1.37), sample(500, 1.91, 1.39)),
            -6.530_619_36,
            1.041_567_952_868_135_8e-10,
        );
        is(welch(sample(30, 1.4, 1.16), sample(30, 2.27, 1.93)), -2.116_189_17, 0.039_592_999_677_248);
        is(welch(sample(500, 0.43, 0.94), sample(500, 0.85, 1.42)), -5.514_870_18, 4.609_030_013_588_255e-8);
        for (first, second, p) in
            [(6, 1, 0.125), (40, 22, 0.030_015_864_349_067), (300, 251, 0.040_770_653_475_49), (5, 5, 1.0)]
        {
            near(mcnemar(first, second).unwrap().p, p, 1e-10);
            assert_eq!(mcnemar(second, first).map(|test| test.p), mcnemar(first, second).map(|test| test.p));
        }
        let differences = [1.5, -0.25, 0.75, 2.0, 0.0, 1.25, -1.0, 0.5];
        is(
            paired(Sample::of(differences.into_iter()).unwrap()),
            1.695_540_560_690_463_2,
            0.133_793_267_684_106_7,
        );
        is(against(count(2489, 5000), 0.5), -0.311_126_983_722, 0.755_704_088_400_87);
        is(against(count(56, 89), 0.5), 2.437_995_124_014_6, 0.014_768_973_219_225);
        let adjusted = holm(&[0.0402, 0.3126, 2.2e-7, 2.4e-9, 0.04]);
        for (value, expected) in adjusted.into_iter().zip([0.12, 0.3126, 8.8e-7, 1.2e-8, 0.12]) {
            near(value, expected, 1e-12);
        }
        assert_eq!((mcnemar(0, 0), against(count(0, 0), 0.5)), (Some(Test::EQUAL), None));
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
        // By manual calculation: 4 × 0.005, 3 × 0.01, 2 × 0.03, 0.04 raised to 0.06.
        let adjusted = holm(&[0.01, 0.04, 0.03, 0.005]);
        for (value, expected) in adjusted.into_iter().zip([0.03, 0.06, 0.06, 0.02]) {
            near(value, expected, 1e-12);
        }
        assert_eq!(holm(&[0.6, 0.9]), [1.0, 1.0]);
        assert!(holm(&[]).is_empty());
    }
}
