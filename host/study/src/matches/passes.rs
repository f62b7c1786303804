//! `passes`: pass statistics of matches. The counts of passes that hosts report in a match, as a row's
//! columns, and their sums over matches: the second paper's Table 1, passes by kind of kick, and the
//! calibration of its equation 5. Shares with Wilson's 95 % intervals.

use std::fmt::Write as _;

use host::strategy::counters::{CapCounters, PlayCounters};
use host::strategy::pass::PassCounters;
use host::strategy::pass::counters::{Bin, Fates};
use serde::Serialize;

use crate::statistics::{Count, Interval, wilson};

/// Confidence level of every interval.
pub(super) const CONFIDENCE: f64 = 0.95;

/// Kinds with their numbers in a column: `flat.received:3 chip.out:1`.
pub(super) fn counted(list: &str) -> impl Iterator<Item = (&str, u32)> {
    list.split_whitespace().filter_map(|entry| {
        let (kind, n) = entry.split_once(':')?;
        Some((kind, n.parse().ok()?))
    })
}

/// Number of passes by kick and fate: `flat.received:3 chip.out:1`.
pub(super) fn fates_column(passes: &PassCounters) -> String {
    let mut passes = *passes;
    let mut text = String::new();
    for (kind, fates) in kinds(&mut passes) {
        for (fate, n) in named(fates) {
            if *n > 0 {
                // Writing to a String cannot fail.
                let _ = write!(text, "{}{kind}.{fate}:{n}", if text.is_empty() { "" } else { " " });
            }
        }
    }
    text
}

/// P(we have it) by tenths: `9:12:11.2:10` are 12 passes of the tenth from 0.9; 11.2 were expected to be
/// had, and 10 were.
pub(super) fn calibration_column(passes: &PassCounters) -> String {
    let bins = passes.calibration.iter().enumerate().filter(|(_, bin)| bin.passes > 0);
    let texts: Vec<_> = bins
        .map(|(tenth, bin)| format!("{tenth}:{}:{}:{}", bin.passes, bin.predicted, bin.received))
        .collect();
    texts.join(" ")
}

/// Parses the two columns.
pub(super) fn read(fates: &str, calibration: &str) -> PassCounters {
    let mut passes = PassCounters::default();
    for (name, n) in counted(fates) {
        let Some((kind, fate)) = name.split_once('.') else { continue };
        let of_kind = kinds(&mut passes).into_iter().find(|(label, _)| *label == kind);
        let count = of_kind.and_then(|(_, fates)| named(fates).into_iter().find(|(label, _)| *label == fate));
        if let Some((_, count)) = count {
            *count += n;
        }
    }
    for bin in calibration.split_whitespace() {
        let mut fields = bin.split(':');
        let tenth = fields.next().and_then(|field| field.parse::<usize>().ok());
        let Some(slot) = tenth.and_then(|tenth| passes.calibration.get_mut(tenth)) else { continue };
        let mut next = || fields.next();
        slot.passes += next().and_then(|field| field.parse().ok()).unwrap_or(0);
        slot.predicted += next().and_then(|field| field.parse::<f64>().ok()).unwrap_or(0.0);
        slot.received += next().and_then(|field| field.parse().ok()).unwrap_or(0);
    }
    passes
}

fn kinds(passes: &mut PassCounters) -> [(&'static str, &mut Fates); 2] {
    [("flat", &mut passes.flat), ("chip", &mut passes.chip)]
}

fn named(fates: &mut Fates) -> [(&'static str, &mut u32); 7] {
    let Fates { received, by_teammate, intercepted, missed, late, out, no_kick } = fates;
    [
        ("received", received),
        ("by_mate", by_teammate),
        ("intercepted", intercepted),
        ("missed", missed),
        ("late", late),
        ("out", out),
        ("no_kick", no_kick),
    ]
}

/// A share with its interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Share {
    /// Number of trials that hit.
    pub hits: u32,
    /// Number of all trials.
    pub of: u32,
    /// 0 to 1; `None` of zero trials.
    pub share: Option<f64>,
    /// Lower end of its 95 % interval.
    pub low: Option<f64>,
    /// Upper end of the 95 % interval.
    pub high: Option<f64>,
}

impl Share {
    /// The share of `hits` of `of` trials.
    pub fn new(hits: u32, of: u32) -> Self {
        let count = Count { hits, of };
        let interval: Option<Interval> = wilson(count, CONFIDENCE);
        let (low, high) = (interval.map(|i| i.low), interval.map(|i| i.high));
        Self { hits, of, share: count.share(), low, high }
    }
}

/// Passes of one kind of kick, all matches.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Kicked {
    /// Kind of kick: `flat` or `chip`.
    pub kick: &'static str,
    /// Started, kicked or not.
    pub ordered: u32,
    /// Passes that the receiver or another teammate received, of those that were kicked.
    pub arrived: Share,
    /// Number of passes with each fate.
    pub fates: Fates,
}

/// Passes whose P(we have it) lay in one tenth.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Tenth {
    /// 0 for 0 to 0.1, 1 for 0.1 to 0.2, …
    pub tenth: usize,
    /// Mean of their predicted P(we have it).
    pub predicted: f64,
    /// Those that their receiver received.
    pub seen: Share,
}

/// All passes of restarts of one side of a pair.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Passes {
    /// Passes by kind of kick.
    pub kinds: Vec<Kicked>,
    /// Free kicks by the Coerce and Attack Planner.
    pub cap: CapCounters,
    /// Those of its passes that arrived.
    pub cap_arrived: Share,
    /// P(we have it) against observed shares; tenths without passes are left out.
    pub calibration: Vec<Tenth>,
    /// The mean of |predicted − seen| over the tenths, by passes; `None` without passes.
    pub calibration_error: Option<f64>,
    /// Number of changes of a robot's role within a phase.
    pub role_changes: u32,
}

impl Passes {
    /// Sums of all matches' counts.
    pub fn of(play: &PlayCounters) -> Self {
        let mut passes = play.passes;
        let kinds = kinds(&mut passes).map(|(kick, fates)| Kicked {
            kick,
            ordered: fates.ordered(),
            arrived: Share::new(fates.successful(), fates.kicked()),
            fates: *fates,
        });
        let tenth = |(tenth, bin): (usize, &Bin)| {
            let predicted = bin.predicted / f64::from(bin.passes);
            (bin.passes > 0).then(|| Tenth { tenth, predicted, seen: Share::new(bin.received, bin.passes) })
        };
        Self {
            kinds: kinds.to_vec(),
            cap: play.cap,
            cap_arrived: Share::new(play.cap.successes, play.cap.attempts),
            calibration: play.passes.calibration.iter().enumerate().filter_map(tenth).collect(),
            calibration_error: play.passes.calibration_error(),
            role_changes: play.role_changes,
        }
    }
}

pub(super) fn add(sum: &mut PlayCounters, more: &PlayCounters) {
    sum.passes.add(&more.passes);
    sum.cap.attempts += more.cap.attempts;
    sum.cap.successes += more.cap.successes;
    sum.cap.reuses += more.cap.reuses;
    sum.cap.reuse_successes += more.cap.reuse_successes;
    sum.role_changes += more.role_changes;
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 3 + 1 flat passes, one chip; P(we have it) 0.95 thrice and 0.25 once.
    fn passes() -> PassCounters {
        let mut passes = PassCounters::default();
        (passes.flat.received, passes.flat.late, passes.flat.no_kick, passes.chip.out) = (2, 1, 1, 1);
        passes.calibration[9] = Bin { passes: 3, predicted: 2.850_000_000_000_1, received: 2 };
        passes.calibration[2] = Bin { passes: 1, predicted: 0.25, received: 0 };
        passes
    }

    #[test]
    fn the_columns_of_a_row_hold_what_was_counted_to_the_bit() {
        let (fates, calibration) = (fates_column(&passes()), calibration_column(&passes()));
        assert_eq!(fates, "flat.received:2 flat.late:1 flat.no_kick:1 chip.out:1");
        assert_eq!(calibration, "2:1:0.25:0 9:3:2.8500000000001:2");
        assert_eq!(read(&fates, &calibration), passes());
        assert_eq!(read("", ""), PassCounters::default());
        assert_eq!(read("flat.lost:3 steep.out:1 x", "12:1:1:1 a"), PassCounters::default());
    }

    #[test]
    fn shares_and_their_intervals_are_those_counted_by_hand() {
        let cap = CapCounters { attempts: 10, successes: 9, reuses: 4, reuse_successes: 3 };
        let mut play = PlayCounters { passes: passes(), cap, role_changes: 7 };
        let reported = Passes::of(&play);
        // Wilson's interval of 9/10, from any table: 0.5958 to 0.9821.
        let share = reported.cap_arrived;
        assert!((share.low.unwrap() - 0.5958).abs() < 1e-4 && (share.high.unwrap() - 0.9821).abs() < 1e-4);
        let flat = &reported.kinds[0];
        assert_eq!((flat.kick, flat.ordered, flat.arrived.hits, flat.arrived.of), ("flat", 4, 2, 3));
        let tenths: Vec<_> = reported.calibration.iter().map(|tenth| (tenth.tenth, tenth.seen.of)).collect();
        assert_eq!(tenths, [(2, 1), (9, 3)]);
        assert!((reported.calibration[1].predicted - 0.95).abs() < 1e-9);
        add(&mut play, &PlayCounters { passes: passes(), cap, role_changes: 7 });
        assert_eq!((Passes::of(&play).cap_arrived.of, play.role_changes), (20, 14));
    }
}
