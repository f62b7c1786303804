//! `windows`: numbers over windows of 1 s, with the worst such window within 10 s. Times in s.

use std::collections::{BTreeMap, VecDeque};

use host::Host;
use host::radio::LinkTotals;
use page::{LinkWindow, Windowed, milli};
use protocol::{RobotId, Who};

/// Length of a window, s: long enough for a share of some hundred frames, short enough to see a drop-out.
const WINDOW_S: f64 = 1.0;
/// The worst window is kept for so long, s: an operator looks away for less.
const PEAK_S: f64 = 10.0;
/// A window of less than this, s, is not reported: it would be a guess.
const LEAST_S: f64 = 0.95;

/// Differences of rising sums over the last second.
#[derive(Debug)]
pub(super) struct Window<const N: usize> {
    sums: VecDeque<(f64, [f64; N])>,
}

impl<const N: usize> Default for Window<N> {
    fn default() -> Self {
        Self { sums: VecDeque::new() }
    }
}

impl<const N: usize> Window<N> {
    /// Adds the sums at `t`; the window's length and what came in it, none before a second has passed. A time
    /// that steps back restarts the window.
    pub(super) fn of(&mut self, t: f64, sums: [f64; N]) -> Option<(f64, [f64; N])> {
        if self.sums.back().is_some_and(|(last, _)| t < *last) {
            self.sums.clear();
        }
        if self.sums.back().is_none_or(|(last, _)| t > *last) {
            self.sums.push_back((t, sums));
        }
        // The window starts at the newest sums that are a second old.
        while self.sums.get(1).is_some_and(|(next, _)| t - next >= WINDOW_S - 1e-9) {
            self.sums.pop_front();
        }
        let (begin, before) = self.sums.front()?;
        let length = t - begin;
        (length >= LEAST_S).then(|| (length, std::array::from_fn(|i| (sums[i] - before[i]).max(0.0))))
    }
}

/// The bad end of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Worst {
    Largest,
    Lowest,
}

/// The worst value of the last ten seconds.
#[derive(Debug, Default)]
pub(super) struct Peak {
    values: VecDeque<(f64, f32)>,
}

impl Peak {
    /// Adds the value at `t`; that value, and the worst one.
    pub(super) fn of(&mut self, t: f64, value: Option<f64>, worst: Worst) -> Windowed {
        if self.values.back().is_some_and(|(last, _)| t < *last) {
            self.values.clear();
        }
        let value = value.map(|value| milli(value as f32));
        self.values.extend(value.map(|value| (t, value)));
        while self.values.front().is_some_and(|(at, _)| t - at > PEAK_S) {
            self.values.pop_front();
        }
        let values = self.values.iter().map(|(_, value)| *value);
        let peak = match worst {
            Worst::Largest => values.reduce(f32::max),
            Worst::Lowest => values.reduce(f32::min),
        };
        [value, peak]
    }
}

#[derive(Debug, Default)]
pub(super) struct Links {
    robots: BTreeMap<(bool, u8), (Window<9>, [Peak; 6])>,
}

impl Links {
    /// Reads the links of a host at `t`; by robot.
    pub(super) fn look(&mut self, t: f64, host: &Host) -> BTreeMap<u8, LinkWindow> {
        let us = host.settings().us;
        let of = |id: RobotId| {
            let quality = host.quality(id).filter(|quality| quality.received_at().is_some())?;
            Some((Who { colour: us, id }, quality.totals()))
        };
        RobotId::all()
            .filter_map(of)
            .map(|(who, totals)| {
                let key = (who.colour == rules::Colour::Blue, who.id.number());
                let (window, peaks) = self.robots.entry(key).or_default();
                (who.id.number(), link(t, totals, window, peaks))
            })
            .collect()
    }
}

fn link(t: f64, totals: LinkTotals, window: &mut Window<9>, peaks: &mut [Peak; 6]) -> LinkWindow {
    let LinkTotals { frames, telemetry, bytes, down, up, trips } = totals;
    let sums = [frames, telemetry, bytes, down.0, down.1, up.0, up.1, trips.0].map(|count| count as f64);
    let [frames, telemetry, bytes, down_came, down_lost, up_came, up_lost, trips_n] = sums;
    let sums = [frames, telemetry, bytes, down_came, down_lost, up_came, up_lost, trips_n, trips.1];
    let over = window.of(t, sums);
    let share = |lost: f64, came: f64| (lost + came > 0.0).then(|| 100.0 * lost / (lost + came));
    let rate = |i: usize| over.map(|(length, sums)| sums[i] / length);
    let values = [
        over.and_then(|(_, sums)| (sums[7] > 0.0).then(|| sums[8] / sums[7])),
        over.and_then(|(_, sums)| share(sums[4], sums[3])),
        over.and_then(|(_, sums)| share(sums[6], sums[5])),
        rate(0),
        rate(1),
        rate(2).map(|bytes| bytes * 8e-3),
    ];
    use Worst::{Largest, Lowest};
    let worst = [Largest, Largest, Largest, Lowest, Lowest, Largest];
    let [trip_ms, loss_down, loss_up, frames, telemetry, kbps] =
        std::array::from_fn(|i| peaks[i].of(t, values[i], worst[i]));
    LinkWindow { trip_ms, loss_down, loss_up, frames, telemetry, kbps }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_window_has_what_came_in_the_last_second_and_nothing_before_one_has_passed() {
        let mut window = Window::<1>::default();
        for i in 0..200 {
            let t = f64::from(i) * 0.04;
            // 100 a second for 4 s, then none.
            let sum = (t * 100.0).min(400.0);
            let over = window.of(t, [sum]);
            if t < 0.94 {
                assert_eq!(over, None, "{t}");
                continue;
            }
            let (length, [came]) = over.expect("a window");
            assert!((LEAST_S..1.05).contains(&length), "{length}");
            let expected = (sum - ((t - length) * 100.0).min(400.0)).max(0.0);
            assert!((came - expected).abs() < 1e-6, "{t}: {came}");
            assert!(t < 5.1 || came == 0.0, "{t}: {came}");
        }
        assert!(window.sums.len() < 30);
    }

    #[test]
    fn a_time_that_steps_back_restarts_the_window() {
        let mut window = Window::<1>::default();
        for t in [0.0, 0.5, 1.0, 1.5] {
            window.of(t, [t]);
        }
        assert_eq!(window.of(0.2, [0.0]), None);
        let mut peak = Peak::default();
        assert_eq!(peak.of(9.0, Some(7.0), Worst::Largest), [Some(7.0); 2]);
        assert_eq!(peak.of(1.0, Some(2.0), Worst::Largest), [Some(2.0); 2]);
    }

    #[test]
    fn a_peak_lasts_ten_seconds() {
        let (mut high, mut low) = (Peak::default(), Peak::default());
        for i in 0..300 {
            let t = f64::from(i) * 0.1;
            let value = if i == 50 { 30.0 } else { 4.0 };
            let peak = high.of(t, Some(value), Worst::Largest);
            let expected = if (50..=150).contains(&i) { 30.0 } else { 4.0 };
            assert_eq!(peak, [Some(value as f32), Some(expected)], "{t}");
            let dip = low.of(t, Some(-value), Worst::Lowest);
            assert_eq!(dip[1], Some(-expected), "{t}");
        }
        assert_eq!(high.of(100.0, None, Worst::Largest), [None, None]);
    }

    #[test]
    fn a_link_that_loses_for_a_second_shows_it_and_keeps_it_as_its_worst() {
        let (mut window, mut peaks) = (Window::default(), <[Peak; 6]>::default());
        let mut shown = Vec::new();
        for i in 0..800_u64 {
            let t = i as f64 * 0.01;
            // From 3 to 4 s every second part of the snapshot is lost.
            let lost = i.clamp(300, 400) - 300;
            let totals = LinkTotals {
                frames: i / 2,
                telemetry: i / 10,
                bytes: i * 25,
                down: (i - lost / 2, lost / 2),
                up: (i / 2, 0),
                trips: (i / 10, (i / 10) as f64 * 6.5),
            };
            shown.push(link(t, totals, &mut window, &mut peaks));
        }
        let at = |i: usize| shown[i];
        assert_eq!(at(50), LinkWindow::default());
        assert!(at(250).loss_down == [Some(0.0), Some(0.0)] && at(250).trip_ms == [Some(6.5); 2]);
        let [now, worst] = at(400).loss_down.map(Option::unwrap_or_default);
        assert!((now - 50.0).abs() < 1.5 && (worst - 50.0).abs() < 1.5, "{now} {worst}");
        let [now, worst] = at(700).loss_down.map(Option::unwrap_or_default);
        assert!(now == 0.0 && (worst - 50.0).abs() < 1.5, "{now} {worst}");
        let frames = at(700).frames[0].unwrap_or_default();
        assert!((frames - 50.0).abs() < 1.5, "{frames}");
        assert!((at(700).kbps[0].unwrap_or_default() - 20.0).abs() < 0.1);
    }
}
