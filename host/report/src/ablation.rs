//! `ablation`: ablation report. A page, a plot and a Markdown table of what every change does, one line an
//! arm.

use std::fmt::Write as _;
use std::fs;
use std::io;
use std::path::Path;

use brain::Approach;
use maud::{DOCTYPE, Markup, PreEscaped, html};
use study::evaluation::{Arm, Effect};
use study::statistics::{Count, newcombe};

use crate::columns::CONFIDENCE;
use crate::plot::{Dot, Row, axis, panel};
use crate::plot::{Figure, Key, Shape};
use crate::{Facts, Picture, description, numbers, style};

/// Inputs of an ablation's page.
#[derive(Clone, Copy, Debug)]
pub struct Ablation<'a> {
    /// The changes, in the order of lines.
    pub arms: &'a [Arm],
    /// Their effects, in every cell and over all.
    pub effects: &'a [Effect],
    /// All settings that the trials depend on.
    pub facts: &'a [Facts],
}

/// A measure's name in files, its head, its unit, its decimals, and whether it is a share.
type Look = (&'static str, &'static str, &'static str, usize, bool);

impl Ablation<'_> {
    /// Writes the page and its plot.
    pub fn write(&self, directory: &Path) -> io::Result<Picture> {
        let plots = directory.join("plots");
        fs::create_dir_all(&plots)?;
        let picture = self.figure().picture();
        fs::write(plots.join(format!("{}.svg", picture.name)), &picture.svg)?;
        fs::write(directory.join("report.html"), self.html())?;
        Ok(picture)
    }

    /// The whole page as one HTML document, plot included.
    pub fn html(&self) -> String {
        let page = html! {
            (DOCTYPE)
            html lang="en" {
                head {
                    meta charset="utf-8";
                    meta name="viewport" content="width=device-width, initial-scale=1";
                    meta name="color-scheme" content="light dark";
                    title { (TITLE) }
                    style { (PreEscaped(style::sheet())) }
                }
                body {
                    header { h1 { (TITLE) } p.lead { (self.lead()) } p.note { (NOTE) } }
                    main {
                        section id="all" { h2 { "Over all cells" } (self.table(None)) (self.figure().html()) }
                        section id="cells" {
                            h2 { "In every cell" }
                            @for cell in self.cells() {
                                details { summary { "Scenario " (cell.1) ", " (cell.0) } (self.table(Some(cell))) }
                            }
                        }
                        section id="facts" { h2 { "What decided the trials" } (crate::page::facts(self.facts)) }
                    }
                }
            }
        };
        page.into_string()
    }

    /// The effects over all cells as Markdown; the plot is named relative to `pictures`.
    pub fn markdown(&self, pictures: &str) -> String {
        let mut text = format!("{} {NOTE}\n\n| arm |", self.lead());
        for (_, head, unit, ..) in LOOKS {
            let _ = write!(text, " {head} ({unit}) |");
        }
        let _ = writeln!(text, " what is changed |\n|---|{}---|", "---:|".repeat(LOOKS.len()));
        for (arm, cells) in self.lines(None) {
            let _ = write!(text, "| {} |", arm.name);
            for (value, effect) in cells {
                let marks = effect.and_then(|effect| effect.p_holm).map_or("", numbers::marks);
                let _ = write!(text, " {value}{} |", marks.replace('*', "\\*"));
            }
            let _ = writeln!(text, " {} |", arm.what);
        }
        let _ = write!(text, "\n![{PLOT}]({pictures}ablations.svg)\n");
        text
    }

    fn lead(&self) -> String {
        let trials = self.of(None).next().map_or(0, |effect| effect.trials);
        format!(
            "Case-based attackers with one thing changed, in {trials} trials of the paper’s eight cells an arm."
        )
    }

    /// The effects in a cell, or over all.
    fn of<'a>(&'a self, cell: Option<Place<'a>>) -> impl Iterator<Item = &'a Effect> + Clone {
        self.effects.iter().filter(move |effect| place(effect) == cell)
    }

    fn cells(&self) -> Vec<Place<'_>> {
        let mut cells = Vec::new();
        for place in self.effects.iter().filter_map(place) {
            if !cells.contains(&place) {
                cells.push(place);
            }
        }
        cells
    }

    /// The unchanged team's numbers, then every arm's differences.
    fn lines(&self, cell: Option<Place<'_>>) -> Vec<(&Arm, Vec<Verdicts<'_>>)> {
        let lines = self.arms.iter().filter_map(|arm| {
            let cells = LOOKS.iter().map(|(label, _, _, decimals, _)| {
                let own = |effect: &&Effect| {
                    effect.measure == *label && (arm.is_default() || effect.arm == arm.name)
                };
                let effect = self.effects.iter().filter(|effect| place(effect) == cell).find(own)?;
                Some(if arm.is_default() {
                    (numbers::plain(effect.default, *decimals), None)
                } else {
                    (numbers::signed(effect.difference, *decimals), Some(effect))
                })
            });
            Some((arm, cells.collect::<Option<Vec<_>>>()?))
        });
        lines.collect()
    }

    fn table(&self, cell: Option<Place<'_>>) -> Markup {
        html! {
            div.scroll tabindex="0" role="region" aria-label="Effects" { table {
                thead { tr {
                    th.name scope="col" { "arm" }
                    @for (_, head, unit, ..) in LOOKS { th scope="col" { (head) span.unit { (unit) } } }
                    th.label scope="col" { "what is changed" }
                } }
                tbody { @for (arm, cells) in self.lines(cell) {
                    tr class=(if arm.is_default() { "ours" } else { "difference" }) style=(description::css(Approach::Cases)) {
                        th.name scope="row" { (arm.name) }
                        @for (value, effect) in cells { td {
                            (value)
                            @if let Some(p) = effect.and_then(|effect| effect.p_holm) {
                                @let marks = numbers::marks(p);
                                @if !marks.is_empty() { sup { (marks) } }
                                small { (numbers::p(p)) }
                            }
                        } }
                        td.label { (arm.what) @if !arm.flags.is_empty() { small { code { (arm.flags) } } } }
                    }
                } }
            } }
        }
    }

    fn figure(&self) -> Figure {
        let panels = LOOKS.iter().filter_map(|(label, head, unit, decimals, share)| {
            let dot = |effect: &Effect| {
                let sure = effect.p_holm.is_some_and(|p| p < 1.0 - CONFIDENCE);
                let reach = share.then(|| reach(effect)).flatten();
                let marks = effect.p_holm.map_or("", numbers::marks);
                let text = format!("{} {marks}", numbers::signed(effect.difference, *decimals));
                Dot { approach: Approach::Cases, ours: sure, value: effect.difference, reach, text }
            };
            let rows = self.of(None).filter(|effect| effect.measure == *label);
            let rows: Vec<_> =
                rows.map(|effect| Row { name: effect.arm.to_owned(), dots: vec![dot(effect)] }).collect();
            let ends = || {
                rows.iter().flat_map(|row| &row.dots).map(|dot| dot.reach.unwrap_or((dot.value, dot.value)))
            };
            let (low, high) =
                ends().fold((0.0_f64, 0.0_f64), |(low, high), (a, b)| (low.min(a), high.max(b)));
            let room = (high - low) * 0.2;
            let unit = if *share { "percentage points" } else { unit };
            (!rows.is_empty()).then(|| panel((*head).to_owned(), unit, &rows, axis(low - room, high)))
        });
        let key = |label: &str, filled| Key {
            label: label.to_owned(),
            color: description::color(Approach::Cases),
            filled,
            shape: Shape::Dot,
        };
        Figure {
            table: 0,
            name: "ablations".to_owned(),
            title: PLOT.to_owned(),
            keys: vec![key("differs (p < 0.05 after Holm)", true), key("no more than chance", false)],
            panels: panels.collect(),
        }
    }
}

/// A number as it is written, and the effect that it belongs to.
type Verdicts<'a> = (String, Option<&'a Effect>);

/// Opponents and scenario of a cell.
type Place<'a> = (&'static str, &'a str);

/// `None` for an effect over all cells.
fn place(effect: &Effect) -> Option<Place<'_>> {
    Some((description::opponents(effect.configuration?), effect.scenario?))
}

/// Newcombe's interval, as if the trials were not paired: wider than necessary.
fn reach(effect: &Effect) -> Option<(f64, f64)> {
    let count = |percent: f64| Count {
        hits: (percent / 100.0 * f64::from(effect.trials)).round() as u32,
        of: effect.trials,
    };
    let interval = newcombe(count(effect.value), count(effect.default), CONFIDENCE)?;
    Some((100.0 * interval.low, 100.0 * interval.high))
}

const TITLE: &str = "What each part of the case-based approach is worth";
const PLOT: &str = "What each change does over all cells: the arm less the unchanged team";
const NOTE: &str = "Differences to the unchanged team. Trials of equal seed are compared in pairs: McNemar’s exact test for shares, the \
     paired t for means; p after Holm’s correction over the arms, * below 0.05, ** below 0.01, *** below 0.001. Whiskers are Newcombe’s \
     95 % intervals as if the trials were no pairs, so wider than need be; means have none.";
const LOOKS: [Look; 7] = [
    ("to_goal", "to goal", "%", 1, true),
    ("out", "out", "%", 1, true),
    ("timeout", "timeout", "%", 1, true),
    ("possession", "opponents’ possession", "a trial", 2, false),
    ("time", "time", "s", 1, false),
    ("cases", "cases used", "a trial", 2, false),
    ("default_s", "time without a case", "s", 1, false),
];

#[cfg(test)]
mod tests {
    use study::evaluation::ARMS;

    use super::*;

    fn effect(arm: &'static str, measure: &'static str, default: f64, value: f64) -> Effect {
        Effect {
            arm,
            configuration: None,
            scenario: None,
            measure,
            trials: 100,
            default,
            value,
            difference: value - default,
            p_paired: Some(0.004),
            p_unpaired: Some(0.02),
            p_holm: Some(0.008),
        }
    }

    #[test]
    fn every_arm_has_its_differences_and_what_it_changes() {
        let (arms, name) = (&ARMS[..2], ARMS[1].name);
        let effects: Vec<_> = LOOKS.iter().map(|(label, ..)| effect(name, label, 30.0, 42.0)).collect();
        let facts =
            [Facts { title: "Program".to_owned(), entries: vec![("seed".to_owned(), "<1>".to_owned())] }];
        let ablation = Ablation { arms, effects: &effects, facts: &facts };
        let html = ablation.html();
        assert!(html.contains("30.0") && html.contains("+12.0<sup>**</sup>") && html.contains("p = 0.008"));
        assert!(html.contains(ARMS[1].flags) && html.contains("&lt;1&gt;"));
        let text = ablation.markdown("evaluation/");
        assert!(text.contains(&format!("| {name} | +12.0\\*\\* | +12.0\\*\\* |")), "{text}");
        assert!(text.contains("](evaluation/ablations.svg)"));
        // 42 against 30 of 100; Wilson's are 0.32798–0.51794 and 0.21895–0.39585, so 12 less 13.287 = 100
        // √(0.09202² + 0.09585²) and more 12.712 = 100 √(0.09794² + 0.08105²).
        let (low, high) = reach(&effects[0]).unwrap();
        assert!((low + 1.287).abs() < 1e-3 && (high - 24.712).abs() < 1e-3, "{low} {high}");
    }
}
