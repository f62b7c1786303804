//! `counters`: counters of passes and calibration. Counts that add up over matches: the passes of the second
//! paper's Table 1, and the calibration of its equation 5, predicted against observed.

use serde::{Deserialize, Serialize};

use super::watch::{Ordered, PassVerdict};

/// Number of calibration bins: tenths of P(we have it).
pub const BINS: usize = 10;

/// Passes of one kind of kick, by outcome.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Fates {
    /// The receiver received it.
    pub received: u32,
    /// Another teammate received it.
    #[serde(rename = "by_mate")]
    pub by_teammate: u32,
    /// An opponent intercepted it.
    pub intercepted: u32,
    /// Passes that went past the receiver.
    pub missed: u32,
    /// The receiver came too late.
    pub late: u32,
    /// Passes that left the field.
    pub out: u32,
    /// Passes that were never kicked.
    pub no_kick: u32,
}

/// Passes whose P(we have it) lay in one tenth.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Bin {
    /// Number of passes kicked.
    pub passes: u32,
    /// Sum of their P(we have it).
    pub predicted: f64,
    /// Number of them after which the team had the ball.
    pub received: u32,
}

/// All passes of a team.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PassCounters {
    /// Passes along the ground.
    pub flat: Fates,
    /// Passes through the air.
    pub chip: Fates,
    /// By predicted P(we have it): 0–0.1, …, 0.9–1. Passes that were never kicked are in no bin.
    pub calibration: [Bin; BINS],
}

impl Fates {
    /// Number of all passes.
    pub fn ordered(&self) -> u32 {
        self.kicked() + self.no_kick
    }

    /// Those that left the passer: "attempted" in the paper's Table 1.
    pub fn kicked(&self) -> u32 {
        let Self { received, by_teammate, intercepted, missed, late, out, .. } = self;
        received + by_teammate + intercepted + missed + late + out
    }

    /// Those that the team received.
    pub fn successful(&self) -> u32 {
        self.received + self.by_teammate
    }

    fn count(&mut self, verdict: &PassVerdict) -> &mut u32 {
        match verdict {
            PassVerdict::Received { .. } => &mut self.received,
            PassVerdict::ByTeammate { .. } => &mut self.by_teammate,
            PassVerdict::Intercepted { .. } => &mut self.intercepted,
            PassVerdict::Missed { .. } => &mut self.missed,
            PassVerdict::Late { .. } => &mut self.late,
            PassVerdict::Out { .. } => &mut self.out,
            PassVerdict::NoKick { .. } => &mut self.no_kick,
        }
    }

    fn add(&mut self, other: &Self) {
        self.received += other.received;
        self.by_teammate += other.by_teammate;
        self.intercepted += other.intercepted;
        self.missed += other.missed;
        self.late += other.late;
        self.out += other.out;
        self.no_kick += other.no_kick;
    }
}

impl PassCounters {
    /// Counts one pass by its kick, verdict and predicted P(we have it).
    pub fn record(&mut self, pass: &Ordered, verdict: &PassVerdict) {
        let fates = if pass.chip { &mut self.chip } else { &mut self.flat };
        *fates.count(verdict) += 1;
        if matches!(verdict, PassVerdict::NoKick { .. }) {
            return;
        }
        // NaN counts as 0.
        let bin = ((pass.likely() * BINS as f32) as usize).min(BINS - 1);
        let bin = &mut self.calibration[bin];
        bin.passes += 1;
        bin.predicted += f64::from(pass.likely());
        bin.received += u32::from(verdict.is_success());
    }

    /// Adds the passes of another match.
    pub fn add(&mut self, other: &Self) {
        self.flat.add(&other.flat);
        self.chip.add(&other.chip);
        for (bin, more) in self.calibration.iter_mut().zip(&other.calibration) {
            bin.passes += more.passes;
            bin.predicted += more.predicted;
            bin.received += more.received;
        }
    }

    /// Difference between P(we have it) and the observed share: the mean over the bins of |predicted −
    /// observed|, each by its passes (expected calibration error); `None` without passes.
    pub fn calibration_error(&self) -> Option<f64> {
        let passes: u32 = self.calibration.iter().map(|bin| bin.passes).sum();
        let off: f64 =
            self.calibration.iter().map(|bin| (bin.predicted - f64::from(bin.received)).abs()).sum();
        (passes > 0).then(|| off / f64::from(passes))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::Point;
    use protocol::{Instant, RobotId};
    use rules::Colour;

    /// A pass with this P(receive).
    fn pass(receive: f32, chip: bool) -> Ordered {
        Ordered {
            at: Instant(0),
            us: Colour::Blue,
            passer: RobotId::ZERO,
            receiver: RobotId::ZERO,
            from: Point::default(),
            to: Point::default(),
            flight: 1.0,
            chip,
            conditions: [receive, 1.0, 1.0, 1.0, 1.0],
            pressed: 1.0,
        }
    }

    const RECEIVED: PassVerdict = PassVerdict::Received { off: 0.0, late: 0.0 };

    #[test]
    fn passes_are_counted_by_kick_and_fate_and_those_never_kicked_predict_nothing() {
        let mut counters = PassCounters::default();
        counters.record(&pass(0.95, false), &RECEIVED);
        counters.record(&pass(0.98, false), &PassVerdict::Late { receiver_off: 1.0 });
        counters.record(
            &pass(0.2, true),
            &PassVerdict::Intercepted { by: RobotId::ZERO, along: 1.0, after: 0.5 },
        );
        counters.record(&pass(0.2, true), &PassVerdict::NoKick { after: 5.0, lost_to: None });
        assert_eq!((counters.flat.kicked(), counters.flat.successful(), counters.flat.late), (2, 1, 1));
        assert_eq!((counters.chip.ordered(), counters.chip.kicked(), counters.chip.intercepted), (2, 1, 1));
        // P(we have it) = 0.4 + 0.5 · P(receive): 0.875, 0.89 and 0.5.
        let last = counters.calibration[8];
        assert_eq!((last.passes, last.received), (2, 1));
        assert_eq!(counters.calibration[5].passes, 1);
    }

    #[test]
    fn the_calibration_error_by_hand_and_over_two_matches() {
        let mut one = PassCounters::default();
        assert_eq!(one.calibration_error(), None);
        // Predicted 0.4 + 0.5 · 0.9 = 0.85 twice, one had: |1.7 − 1| / 2.
        one.record(&pass(0.9, false), &RECEIVED);
        one.record(&pass(0.9, false), &PassVerdict::Missed { by: 1.0 });
        assert!((one.calibration_error().unwrap() - 0.35).abs() < 1e-6);
        let mut other = PassCounters::default();
        // Predicted 0.4 + 0.5 · 0.3 = 0.55 twice, none had: with the above (0.7 + 1.1) / 4.
        other.record(&pass(0.3, true), &PassVerdict::Out { at: Point::default() });
        other.record(&pass(0.3, true), &PassVerdict::Out { at: Point::default() });
        one.add(&other);
        assert!((one.calibration_error().unwrap() - 0.45).abs() < 1e-6);
        assert_eq!((one.chip.out, one.flat.kicked()), (2, 2));
    }
}
