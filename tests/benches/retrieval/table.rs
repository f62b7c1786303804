//! `table`: table of the retrieval benchmark in casebase/README.md.

use std::fmt::Write as _;

use crate::figures::{Figures, Spread};

pub(crate) fn table(all: &[Figures]) -> String {
    let mut text = format!("{HEAD}\n");
    for figures in all {
        let _ = writeln!(text, "{}", row(figures));
    }
    text
}

pub(crate) fn row(figures: &Figures) -> String {
    let [best, counted, scan] = figures.guest;
    let spread =
        |Spread { median, p99, worst, .. }: Spread| format!("{} / {} / {}", n(median), n(p99), n(worst));
    let host = figures.host.map_or("–".to_owned(), |counts| {
        counts.map(|count| n(u32::try_from(count).unwrap_or(u32::MAX))).join(" / ")
    });
    format!(
        "| {} | {:.0} | {} {} | {:.1} / {:.0} | {} | {:.0} of {:.0} | {} | {} | {:.0} × | {host} |",
        n(figures.stored as u32),
        figures.bytes_per_case,
        n(figures.problems as u32),
        figures.set,
        figures.gated[0],
        figures.gated[1],
        spread(best),
        best.mean,
        figures.mean_allowed(),
        spread(counted),
        n(scan.median),
        figures.ratio(),
    )
}

fn n(number: u32) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

const HEAD: &str = "\
| stored cases | bytes each | problems | in the gate, mean / most | best: median / p99 / worst | mean of 400 + 60 per case in the gate | with the count | scan | scan ÷ best | on the PC, mean: best / count / scan |
|---:|---:|---|---:|---:|---:|---:|---:|---:|---:|";
