//! `fit`: values of a description from measurements: a rising table of pulses, and counts for a metre.

/// A table of pulses, and how well it describes what was measured.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct PulseFit {
    /// Ball speed, m/s, and pulse, µs; both rise.
    pub(super) table: Vec<(f32, u64)>,
    /// Root of the mean square of measured less fitted speed, m/s.
    pub(super) rms: f32,
    /// Number of measurements.
    pub(super) count: usize,
}

impl PulseFit {
    /// The speed that the robot gets from a pulse, µs, of the table, m/s: straight lines from 0 at 0; the
    /// last beyond.
    pub(super) fn speed_of(&self, pulse: f64) -> f64 {
        let mut last = (0.0, 0.0);
        for (speed, micros) in self.table.iter().map(|(speed, micros)| (f64::from(*speed), *micros as f64)) {
            if pulse <= micros {
                return last.0 + (pulse - last.1) / (micros - last.1) * (speed - last.0);
            }
            last = (speed, micros);
        }
        last.0
    }
}

/// The mean of measurements that lie together.
#[derive(Clone, Copy, Debug)]
struct Block {
    pulse: f64,
    speed: f64,
    weight: f64,
}

impl Block {
    fn joined(self, other: Self) -> Self {
        let weight = self.weight + other.weight;
        let mean = |a: f64, b: f64| (a * self.weight + b * other.weight) / weight;
        Self { pulse: mean(self.pulse, other.pulse), speed: mean(self.speed, other.speed), weight }
    }
}

/// A table of at most `most` pairs for measured pulses, µs, and ball speeds, m/s. Speeds that fall with the
/// pulse are averaged until none does (least squares among rising functions); then the pairs that straight
/// lines between the others describe best are left out.
pub(super) fn pulses(measured: &[(f32, f32)], most: usize) -> Result<PulseFit, String> {
    let mut sorted: Vec<_> =
        measured.iter().map(|(pulse, speed)| (f64::from(*pulse), f64::from(*speed))).collect();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    // Up to this pulse the plunger does not move the ball.
    let dead =
        sorted.iter().filter(|(_, speed)| *speed < f64::from(SPEED_OF_NO_KICK)).map(|(pulse, _)| *pulse);
    let dead = dead.reduce(f64::max);
    let mut blocks: Vec<Block> = Vec::new();
    for (pulse, speed) in sorted.iter().filter(|(pulse, _)| dead.is_none_or(|dead| *pulse > dead)) {
        let one = Block { pulse: *pulse, speed: *speed, weight: 1.0 };
        match blocks.last_mut() {
            Some(last) if (pulse - last.pulse).abs() < SAME_PULSE => *last = last.joined(one),
            _ => blocks.push(one),
        }
    }
    if blocks.len() < PULSES_MIN {
        let what = format!("{} different pulses were measured", blocks.len());
        return Err(format!("{what}; measure at least {PULSES_MIN}, from the shortest to the longest"));
    }
    let table = thinned(rising(&blocks), most - usize::from(dead.is_some()));
    let start = dead.map(|pulse| Block { pulse, speed: f64::from(SPEED_OF_NO_KICK), weight: 1.0 });
    let mut rounded: Vec<(f32, u64)> = Vec::new();
    for block in start.iter().chain(&table) {
        let pair = ((block.speed * 100.0).round() as f32 / 100.0, block.pulse.round() as u64);
        if rounded.last().is_none_or(|last| pair.0 > last.0 && pair.1 > last.1) && pair.0 > 0.0 {
            rounded.push(pair);
        }
    }
    if rounded.len() < 2 {
        return Err(
            "the speed does not rise with the pulse; check the columns and the capacitor's charge".into()
        );
    }
    let mut fit = PulseFit { table: rounded, rms: 0.0, count: measured.len() };
    let squares = sorted.iter().map(|(pulse, speed)| (speed - fit.speed_of(*pulse)).powi(2));
    fit.rms = (squares.sum::<f64>() / sorted.len() as f64).sqrt() as f32;
    Ok(fit)
}

/// Pools adjacent violators: the rising means nearest to the blocks by least squares.
fn rising(blocks: &[Block]) -> Vec<Block> {
    let mut out: Vec<Block> = Vec::new();
    for block in blocks {
        let mut block = *block;
        while let Some(last) = out.last().filter(|last| last.speed >= block.speed) {
            block = last.joined(block);
            out.pop();
        }
        out.push(block);
    }
    out
}

/// At most `most` of them; the ends stay.
fn thinned(mut blocks: Vec<Block>, most: usize) -> Vec<Block> {
    while blocks.len() > most.max(2) {
        let errors = blocks.windows(3).enumerate().map(|(at, three)| {
            let [a, b, c] = [three[0], three[1], three[2]];
            let share = (b.pulse - a.pulse) / (c.pulse - a.pulse);
            (at + 1, (a.speed + share * (c.speed - a.speed) - b.speed).abs() * b.weight.sqrt())
        });
        let Some((at, _)) = errors.min_by(|a, b| a.1.total_cmp(&b.1)) else { break };
        blocks.remove(at);
    }
    blocks
}

/// Counts for a metre from driven distances, m, and counts: least squares through the origin; and the largest
/// deviation of a single drive from it, as a share.
pub(super) fn counts_per_metre(driven: &[(f32, f32)]) -> Result<(f64, f64), String> {
    let squares: f64 = driven.iter().map(|(distance, _)| f64::from(*distance).powi(2)).sum();
    let products: f64 =
        driven.iter().map(|(distance, counts)| f64::from(*distance) * f64::from(*counts)).sum();
    let least = driven.iter().map(|(distance, _)| distance.abs()).fold(f32::INFINITY, f32::min);
    if driven.is_empty() || least < DISTANCE_MIN {
        return Err(format!("drive at least {DISTANCE_MIN} m each time, measured with a tape"));
    }
    let per_metre = products / squares;
    if per_metre.abs() < 1.0 {
        return Err("the counts do not grow with the distance; check the columns".into());
    }
    let deviation = driven
        .iter()
        .map(|(distance, counts)| (f64::from(*counts) / f64::from(*distance) / per_metre - 1.0).abs());
    Ok((per_metre, deviation.fold(0.0, f64::max)))
}

/// A slower ball was not kicked, m/s: the longest pulse that gives one stands for this speed, so that a table
/// promises more only beyond it.
pub(super) const SPEED_OF_NO_KICK: f32 = 0.1;
/// Pulses that are one, µs.
const SAME_PULSE: f64 = 0.5;
/// Different pulses for a table: two ends and one that shows the curve.
const PULSES_MIN: usize = 3;
/// A shorter drive measures the tape, m.
const DISTANCE_MIN: f32 = 0.2;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kicks_of_a_known_curve_give_the_curve_back() {
        // v = 8 (1 − exp(−t/4 ms)), measured four times each with ±5 cm/s.
        let curve = |micros: f32| 8.0 * (1.0 - (-micros / 4000.0).exp());
        let measured: Vec<_> = (1..=12)
            .flat_map(|step| {
                [-0.05, -0.02, 0.02, 0.05].map(|off| (500.0 * step as f32, off + curve(500.0 * step as f32)))
            })
            .collect();
        let fit = pulses(&measured, 6).unwrap();
        assert_eq!((fit.table.len(), fit.count), (6, 48));
        assert!(fit.table.windows(2).all(|pair| pair[0].0 < pair[1].0 && pair[0].1 < pair[1].1));
        for (speed, micros) in &fit.table {
            assert!((curve(*micros as f32) - speed).abs() < 0.011, "{:?}", fit.table);
        }
        assert!((0.03..0.08).contains(&fit.rms), "{}", fit.rms);
    }

    #[test]
    fn pulses_that_do_not_move_the_ball_are_the_table_s_beginning() {
        let kicks = [(500.0, 0.0), (1000.0, 0.0), (1500.0, 0.0), (2000.0, 2.6), (3000.0, 4.4), (4000.0, 5.6)];
        let fit = pulses(&kicks, 6).unwrap();
        assert_eq!(fit.table, [(0.1, 1500), (2.6, 2000), (4.4, 3000), (5.6, 4000)]);
        assert!(fit.speed_of(1500.0) <= 0.1 + 1e-6, "no speed is promised there");
        // The dead zone's pair is one of those that are asked for.
        assert_eq!(pulses(&kicks, 3).unwrap().table.len(), 3);
        assert!(pulses(&[(500.0, 0.0), (1000.0, 0.0), (1500.0, 0.0)], 6).is_err());
    }

    #[test]
    fn falling_neighbours_are_averaged_as_by_hand() {
        let fit = pulses(&[(1000.0, 1.0), (2000.0, 3.0), (3000.0, 2.0), (4000.0, 5.0)], 16).unwrap();
        assert_eq!(fit.table, [(1.0, 1000), (2.5, 2500), (5.0, 4000)]);
        // Off by 0, 5/6 (2000 µs: 1 + 1.5 · 1000/1500), 5/6, 0.
        let at_2000 = 3.0 - (1.0 + 1.5 * 1000.0 / 1500.0);
        let at_3000 = 2.0 - (2.5 + 2.5 * 500.0 / 1500.0);
        let rms = ((at_2000 * at_2000 + at_3000 * at_3000) / 4.0_f32).sqrt();
        assert!((fit.rms - rms).abs() < 1e-5);
    }

    #[test]
    fn what_gives_no_table_is_refused_with_the_remedy() {
        assert!(
            pulses(&[(1000.0, 1.0), (1000.0, 1.1), (2000.0, 2.0)], 6).unwrap_err().contains("at least 3")
        );
        let falling = pulses(&[(1000.0, 3.0), (2000.0, 2.0), (3000.0, 1.0)], 6).unwrap_err();
        assert!(falling.contains("does not rise"), "{falling}");
    }

    #[test]
    fn a_driven_metre_has_its_counts() {
        let (per_metre, deviation) = counts_per_metre(&[(1.0, 24_000.0), (2.0, 48_600.0)]).unwrap();
        assert!((per_metre - 24_240.0).abs() < 1e-6 && (deviation - 240.0 / 24_240.0).abs() < 1e-9);
        assert!(counts_per_metre(&[(0.1, 2_400.0)]).unwrap_err().contains("tape"));
        assert!(counts_per_metre(&[]).is_err());
    }
}
