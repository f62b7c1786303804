//! `betting`: sequential tests of paired trials by betting, and the error rate over all of them.
//!
//! A change is compared with no change on the same starts. Under the null hypothesis that it does not raise
//! the outcome, a bettor who stakes a fixed share of its capital on every pair in which the outcomes differ
//! does not gain on average: its capital is an *e-process*, and passes 1/α with a probability of at most α
//! whenever one looks (Ville; Shafer 2021; Ramdas & Wang 2025). The capital is spread over several shares, so
//! that small and large effects are both seen soon.
//!
//! Over many changes [`threshold`] is that of e-LOND (Xu & Ramdas 2024): the expected share of wrong changes
//! among the accepted ones stays below the stated rate, for any dependence between the tests.

use serde::Serialize;

/// Shares of the capital that are staked.
const STAKES: [f64; 5] = [0.05, 0.1, 0.2, 0.35, 0.5];

/// The bettor against "this does not raise the outcome".
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Wager {
    capital: [f64; STAKES.len()],
    /// Pairs in which only the trial with the change reached the goal.
    pub raised: u32,
    /// Pairs in which only the trial without it did.
    pub lowered: u32,
    /// All pairs, equal ones included.
    pub pairs: u32,
    #[serde(flatten)]
    differences: PairedDifference,
}

/// The difference of a value between the two sides of pairs: with a change less without it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct PairedDifference {
    /// Sum over the pairs.
    pub sum: f64,
    squares: f64,
}

impl PairedDifference {
    pub(crate) fn add(&mut self, difference: f64) {
        self.sum += difference;
        self.squares += difference * difference;
    }

    /// The sum in standard deviations of chance, which gives each difference either sign.
    pub fn z(&self) -> f64 {
        if self.squares == 0.0 { 0.0 } else { self.sum / self.squares.sqrt() }
    }
}

impl Default for Wager {
    fn default() -> Self {
        Self {
            capital: [1.0; STAKES.len()],
            raised: 0,
            lowered: 0,
            pairs: 0,
            differences: PairedDifference::default(),
        }
    }
}

impl Wager {
    /// Adds a pair: the outcome with the change and the one without it.
    pub fn add(&mut self, with: bool, without: bool) {
        self.add_difference(f64::from(u8::from(with)) - f64::from(u8::from(without)), 1.0);
    }

    /// Adds a pair by how much higher the value of the trial with the change was; values of pairs differ by
    /// at most `most`. The bet is against "the mean of the differences is not above 0": a part of the stake
    /// is won or lost.
    pub fn add_difference(&mut self, difference: f64, most: f64) {
        let difference = difference.clamp(-most, most);
        self.pairs += 1;
        self.raised += u32::from(difference > 0.0);
        self.lowered += u32::from(difference < 0.0);
        self.differences.add(difference);
        for (capital, stake) in self.capital.iter_mut().zip(STAKES) {
            *capital *= 1.0 + stake * difference / most;
        }
    }

    /// Adds pairs that were not played because the change has no effect on them.
    pub fn add_equal(&mut self, pairs: u32) {
        self.pairs += pairs;
    }

    /// Adds the pairs of another bettor with the same stakes: what was won is bet on with them.
    pub fn merge(&mut self, other: &Self) {
        for (capital, factor) in self.capital.iter_mut().zip(other.capital) {
            *capital *= factor;
        }
        self.raised += other.raised;
        self.lowered += other.lowered;
        self.pairs += other.pairs;
        self.differences.sum += other.differences.sum;
        self.differences.squares += other.differences.squares;
    }

    /// The e-value: the bettor's capital, 1 at the start.
    pub fn e_value(&self) -> f64 {
        self.capital.iter().sum::<f64>() / STAKES.len() as f64
    }

    /// Estimated gain: points of to-goal, percent of all starts; of values, hundred times their mean
    /// difference.
    pub fn gain(&self) -> f64 {
        if self.pairs == 0 { 0.0 } else { 100.0 * self.differences.sum / f64::from(self.pairs) }
    }

    /// The difference in standard deviations of chance.
    pub fn z(&self) -> f64 {
        self.differences.z()
    }

    /// The mean difference, this many standard errors of chance higher.
    pub(crate) fn bounded_gain(&self, errors: f64) -> f64 {
        (self.differences.sum + errors * self.differences.squares.sqrt()) / f64::from(self.pairs.max(1))
    }
}

/// The e-value that a test must reach: `rate` over all tests, `planned` of which are made at most, with
/// `accepted` before it.
pub fn threshold(rate: f64, planned: u32, accepted: u32) -> f64 {
    f64::from(planned.max(1)) / (rate * f64::from(accepted + 1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use hil_sim::Stream;

    #[test]
    fn without_an_effect_the_capital_passes_a_threshold_as_rarely_as_promised() {
        // 2000 bettors look after each of 400 fair pairs.
        let passed = (0..2000).filter(|seed| {
            let (mut chance, mut wager) = (Stream::new(*seed, "betting"), Wager::default());
            (0..400).any(|_| {
                wager.add(chance.chance(0.4), chance.chance(0.4));
                wager.e_value() >= 20.0
            })
        });
        let passed = passed.count();
        assert!(passed <= 100, "{passed} of 2000 at 1/20");
        assert!(passed > 0, "a bettor that never wins tests nothing");
    }

    #[test]
    fn an_effect_of_ten_points_is_found() {
        let (mut chance, mut wager) = (Stream::new(1, "betting"), Wager::default());
        for _ in 0..2000 {
            wager.add(chance.chance(0.45), chance.chance(0.35));
        }
        assert!(wager.e_value() > 600.0, "{}", wager.e_value());
        assert!((5.0..15.0).contains(&wager.gain()), "{}", wager.gain());
        wager.add_equal(2000);
        assert!((2.5..7.5).contains(&wager.gain()), "equal pairs count: {}", wager.gain());
    }

    #[test]
    fn two_halves_of_a_test_are_the_same_as_the_whole() {
        let mut chance = Stream::new(3, "betting");
        let (mut whole, mut halves) = (Wager::default(), [Wager::default(); 2]);
        for number in 0..200 {
            let pair = (chance.chance(0.5), chance.chance(0.4));
            whole.add(pair.0, pair.1);
            halves[number / 100].add(pair.0, pair.1);
        }
        let [mut first, second] = halves;
        first.merge(&second);
        assert!((first.e_value() / whole.e_value() - 1.0).abs() < 1e-9);
        assert_eq!((first.raised, first.lowered, first.pairs), (whole.raised, whole.lowered, whole.pairs));
    }

    #[test]
    fn a_difference_of_values_wins_its_part_of_the_stakes_and_fair_ones_rarely_pass() {
        let mut wager = Wager::default();
        wager.add_difference(0.3, 0.6);
        assert!((wager.e_value() - 1.12).abs() < 1e-12 && (wager.gain() - 30.0).abs() < 1e-9);
        wager.add_difference(-0.3, 0.6);
        assert_eq!((wager.z(), wager.raised, wager.lowered, wager.pairs), (0.0, 1, 1, 2));
        // Rare large losses against frequent small gains, fair on average.
        let passed = (0..2000).filter(|seed| {
            let (mut chance, mut wager) = (Stream::new(*seed, "values"), Wager::default());
            (0..400).any(|_| {
                wager.add_difference(if chance.chance(0.2) { -0.4 } else { 0.1 }, 0.6);
                wager.e_value() >= 20.0
            })
        });
        assert!(passed.count() <= 100);
    }

    #[test]
    fn one_pair_pays_the_mean_of_the_stakes() {
        let mut wager = Wager::default();
        wager.add(true, false);
        assert!((wager.e_value() - 1.24).abs() < 1e-12);
        assert!((threshold(0.1, 60, 0) - 600.0).abs() < 1e-9);
        assert!((threshold(0.1, 60, 2) - 200.0).abs() < 1e-9);
    }
}
