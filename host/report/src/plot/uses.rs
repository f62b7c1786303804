//! `uses`: plot of how often each case was played and how its plays ended; a panel a kind of trial, the most
//! played first.

use arena::CycleEnd;
use arena::Profile;
use figures::{AXIS_HEIGHT, Anchor, Axis, Figure, Font, Key, PANEL_WIDTH, Panel, Shape, Svg, Theme};
use study::evaluation::CaseUse;

use crate::{Report, labels};

/// The plot of the simulated trials.
pub(super) fn figure(report: &Report<'_>) -> Figure {
    let mut kinds: Vec<Vec<&CaseUse>> = Vec::new();
    for case in report.uses.iter().filter(|case| case.profile == Profile::Simulated) {
        let kind = |case: &CaseUse| (case.configuration, case.approach);
        match kinds.iter_mut().find(|cases| cases.first().is_some_and(|first| kind(first) == kind(case))) {
            Some(cases) => cases.push(case),
            None => kinds.push(vec![case]),
        }
    }
    let panels = kinds.into_iter().filter_map(|mut cases| {
        let never = cases.iter().filter(|case| case.retrieved == 0).count();
        cases.retain(|case| case.retrieved > 0);
        // A stable sort: cases played as often stay in the order of their names.
        cases.sort_by_key(|case| std::cmp::Reverse(case.retrieved));
        panel(&cases, never)
    });
    let bar = |color, label: &str| Key { label: label.to_owned(), color, is_filled: true, shape: Shape::Bar };
    Figure {
        name: "table-3-plays".to_owned(),
        title: "What became of each case: how its plays ended, and how many there were".to_owned(),
        keys: ENDS.iter().map(|(color, label, _)| bar(color, label)).collect(),
        panels: panels.collect(),
    }
}

fn panel(cases: &[&CaseUse], never: usize) -> Option<Panel> {
    let first = cases.first()?;
    let colors = Theme::Light.colors();
    let mut svg = Svg::default();
    let axis = Axis::linear([0.0, 100.0], [BARS_LEFT, PANEL_WIDTH - NUMBERS_WIDTH]);
    let bottom = -BAR_HEIGHT * cases.len() as f64;
    axis.draw_below(&mut svg, 0.0, bottom, "% of its plays");
    let font = Font { size: 11.5, fill: colors.ink, bold: false, halo: None };
    for (i, case) in cases.iter().enumerate() {
        let (top, low) = (-BAR_HEIGHT * i as f64 - 1.5, -BAR_HEIGHT * (i + 1) as f64 + 1.5);
        svg.text([BARS_LEFT - 6.0, low + 2.5], &case.case, Anchor::End, font);
        let mut share = 0.0;
        for (color, _, names) in &ENDS {
            let plays = ends(case, names);
            let (from, to) = (share, share + 100.0 * f64::from(plays) / f64::from(case.retrieved));
            if plays > 0 {
                let corner = [axis.place(from), low];
                svg.rect(corner, [axis.place(to), top], format_args!(r#"fill="{color}""#));
            }
            share = to;
        }
        svg.text([PANEL_WIDTH, low + 2.5], &case.retrieved.to_string(), Anchor::End, font);
    }
    let font = Font { size: 11.5, fill: colors.faint, bold: false, halo: None };
    svg.text([PANEL_WIDTH, 6.0], "plays", Anchor::End, font);
    if never > 0 {
        svg.text([0.0, bottom - 31.0], &format!("{never} never played"), Anchor::Start, font);
    }
    let (approach, against) = (labels::approach(first.approach), labels::opponents(first.configuration));
    let title = format!("Cases of {approach} attackers, against {against}");
    Some(Panel { title, svg, height: -bottom + AXIS_HEIGHT })
}

/// Plays that ended with one of these; without any, with an end that has no colour of its own.
fn ends(case: &CaseUse, names: &[&str]) -> u32 {
    let all = CycleEnd::LABELS.iter().zip(case.ends);
    let own = all.filter(|(label, _)| match names {
        [] => !ENDS.iter().any(|(_, _, names)| names.contains(*label)),
        names => names.contains(*label),
    });
    own.map(|(_, plays)| plays).sum()
}

/// Colours (Okabe and Ito, greys), labels, and the ends of plays that they stand for.
const ENDS: [(&str, &str, &[&str]); 7] = [
    ("#009e73", "finished", &["finished"]),
    ("#56b4e9", "the ball left its scope", &["ball-out-of-scope"]),
    ("#cc79a7", "its path was blocked", &["path-blocked"]),
    ("#e69f00", "an action failed", &["action-failed"]),
    ("#d55e00", "an opponent was on the ball", &["opponent-on-ball"]),
    ("#8c8c8c", "anything else", &[]),
    ("#c4c4c4", "the trial was over", &["trial-over"]),
];
/// Left end of the bars, px: behind the cases' names.
const BARS_LEFT: f64 = 176.0;
/// Space for the number of plays, px.
const NUMBERS_WIDTH: f64 = 52.0;
/// Height of a bar with the gap to the next, px.
const BAR_HEIGHT: f64 = 15.0;

#[cfg(test)]
mod tests {
    use brain::Approach;
    use hil_sim::Configuration;

    use super::*;

    #[test]
    fn every_play_has_a_colour() {
        let case = CaseUse {
            profile: Profile::Simulated,
            configuration: Configuration::DefenderGoalie,
            approach: Approach::Cases,
            case: "a/b".to_owned(),
            retrieved: 105,
            // 1 to 14, in the order of `CycleEnd::LABELS`.
            ends: std::array::from_fn(|i| i as u32 + 1),
            trials: 9,
            outcomes: [0; 5],
        };
        let plays: Vec<_> = ENDS.iter().map(|(_, _, names)| ends(&case, names)).collect();
        // Robot lost 4, ball at rest 7, timeout 8, no decision 9, unknown case 10, reassigned 11, game
        // stopped 12, superseded 13 are anything else.
        assert_eq!(plays, [1, 2, 3, 5, 6, 4 + 7 + 8 + 9 + 10 + 11 + 12 + 13, 14]);
        assert_eq!(plays.iter().sum::<u32>(), case.retrieved);
        assert!(panel(&[&case], 3).unwrap().height > BAR_HEIGHT);
        assert!(panel(&[], 34).is_none());
    }
}
