//! `fit`: fits P(we have it) after a pass by maximum likelihood, and compares predicted probabilities with
//! what was seen.

/// A probability as predicted, whether it came true, and whether the fit may use it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sample {
    pub(crate) predicted: f64,
    pub(crate) seen: bool,
    pub(crate) train: bool,
}

/// `least + (most − least) · predicted` with the greatest likelihood over the training samples, in steps of
/// 0.005.
pub(crate) fn bounds(samples: &[Sample]) -> (f64, f64) {
    let train: Vec<_> = samples.iter().filter(|sample| sample.train).copied().collect();
    let steps = || (1..200).map(|i| f64::from(i) * 0.005);
    let mut best = ((0.0, 1.0), f64::NEG_INFINITY);
    for least in steps() {
        for most in steps().filter(|most| *most >= least) {
            let likelihood = mean_log_likelihood(&train, |p| least + (most - least) * p);
            if likelihood > best.1 {
                best = ((least, most), likelihood);
            }
        }
    }
    best.0
}

/// Mean logarithm of the probability that `of` gives to what was seen; no probability is taken as certain.
pub(crate) fn mean_log_likelihood(samples: &[Sample], of: impl Fn(f64) -> f64) -> f64 {
    let each = samples.iter().map(|sample| {
        let p = of(sample.predicted).clamp(1e-3, 1.0 - 1e-3);
        if sample.seen { p.ln() } else { (1.0 - p).ln() }
    });
    each.sum::<f64>() / samples.len().max(1) as f64
}

/// Prints predicted and seen shares by tenths, and the mean of their differences by number of samples.
pub(crate) fn print_reliability(samples: &[Sample], of: impl Fn(f64) -> f64) {
    let mut tenths = [(0_u32, 0.0, 0_u32); 10];
    for sample in samples {
        let p = of(sample.predicted);
        let tenth = &mut tenths[((p * 10.0) as usize).min(9)];
        *tenth = (tenth.0 + 1, tenth.1 + p, tenth.2 + u32::from(sample.seen));
    }
    let mut off = 0.0;
    for (i, (number, predicted, seen)) in tenths.into_iter().enumerate().filter(|(_, tenth)| tenth.0 > 0) {
        let (n, seen) = (f64::from(number), f64::from(seen));
        println!("  {:.1}: {number:5} predicted {:.2} seen {:.2}", i as f64 * 0.1, predicted / n, seen / n);
        off += (predicted - seen).abs();
    }
    println!("  calibration error {:.3}", off / samples.len().max(1) as f64);
}
