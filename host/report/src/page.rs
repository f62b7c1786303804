//! `page`: layout of the report page: at a glance, the claims, tables with their plots, maps, every
//! comparison, every parameter.

use figures::numbers::{plain, signed};
use figures::{Cell, Column, Page, Row, Table, Theme, dark_colors, row};
use maud::{Markup, html};
use study::evaluation::{Claim, ClaimVerdict, Comparison, Held, Judgement, JudgementLine};
use study::statistics::stars;

use crate::map::{CHANCE_PASS_COLOR, LOST_PASS_COLOR, SHADES};
use crate::plot::{TablePlot, plots};
use crate::table::tables;
use crate::{Facts, Report, labels, map};

pub(crate) fn page(report: &Report<'_>) -> String {
    let (plots, tables) = (plots(report), tables(report));
    let header = html! {
        p.lead { (lead(report)) }
        nav {
            a href="#glance" { "At a glance" }
            @if !report.claims.is_empty() { a href="#claims" { "Claims" } }
            @if !report.lines.is_empty() { a href="#pattern" { "Pattern" } }
            @for table in &tables { a href={ "#table-" (table.number) } { "Table " (table.number) } }
            @if !report.maps.is_empty() { a href="#maps" { "Maps" } }
            a href="#comparisons" { "Comparisons" }
            a href="#facts" { "Parameters" }
        }
    };
    let main = html! {
        section id="glance" {
            h2 { "At a glance" }
            p.note { (GLANCE) }
            (plots_of(&plots, 0))
        }
        @if !report.claims.is_empty() { (claims(report.claims)) }
        @if !report.lines.is_empty() { (pattern(report.lines)) }
        @for table in &tables {
            section id={ "table-" (table.number) } {
                h2 { "Table " (table.number) ": " (labels::table(table.number)) }
                p.note { (labels::note(table.number)) }
                (table.html())
                (plots_of(&plots, table.number))
            }
        }
        @if !report.maps.is_empty() {
            section id="maps" {
                h2 { "Where the ball was" }
                p.note { (MAPS) }
                (map::html(report.maps))
            }
        }
        (comparisons(report))
        (facts(report.facts))
    };
    Page { title: TITLE, style: style(), header, main }.html()
}

/// Rules of style of the report's pages, and the dark colours of its own figures.
pub(crate) fn style() -> String {
    // A field's lines are white on a light field surface, as the paper is.
    let [light, dark] = [Theme::Light, Theme::Dark].map(|theme| theme.colors().line);
    format!(
        "{}@media screen and (prefers-color-scheme: dark) {{\n.maps svg [stroke=\"{light}\"]{{stroke:{dark}}}\n}}\n{}",
        dark_colors(&color_pairs()),
        include_str!("report.css")
    )
}

/// Colours of the report's figures on a light page and on a dark one, beside those of every figure.
fn color_pairs() -> Vec<(&'static str, &'static str)> {
    // The scale is reversed: on a dark page more is brighter.
    let mut pairs: Vec<_> = SHADES.into_iter().zip(SHADES.into_iter().rev()).collect();
    // Greys keep the contrast to the page that they have on white.
    pairs.extend([("#8c8c8c", "#7d8488"), ("#c4c4c4", "#4a5156")]);
    pairs.extend([(LOST_PASS_COLOR, "#ff7cc0"), (CHANCE_PASS_COLOR, "#79b3f2")]);
    pairs
}

/// Sentence on the trials that were played.
fn lead(report: &Report<'_>) -> String {
    // Tables 2, 3 and 5 share the trials of other tables.
    let of =
        |table| report.rows.iter().filter(move |row| row.table == table).map(|row| row.trials).sum::<u32>();
    let (simulated, robots) = (of(1) + of(4), of(6));
    let robots =
        if robots > 0 { format!(" and {robots} with its robots’ noise and pauses") } else { String::new() };
    format!(
        "Our {simulated} simulated trials{robots} beside the tables of Ros, Arcos, López de Màntaras and Veloso (2009), \
         A case-based approach for coordinated action selection in robot soccer. Numbers in italics are the paper’s."
    )
}

fn plots_of(plots: &[TablePlot], table: u8) -> Markup {
    html! { @for (_, figure) in plots.iter().filter(|(own, _)| *own == table) { (figure.html()) } }
}

fn claims(claims: &[Claim]) -> Markup {
    let few = claims.iter().any(|claim| claim.ours_as_paper.is_some());
    html! {
        section id="claims" {
            h2 { "What the paper says, and what the numbers say" }
            p.note { (CLAIMS) }
            p { (counted("Our trials", &claims.iter().map(|claim| &claim.ours)))
                (counted("The paper’s own tables", &claims.iter().map(|claim| &claim.paper))) }
            div.scroll tabindex="0" role="region" aria-label="Claims" { table.claims {
                thead { tr {
                    th scope="col" { "claim" }
                    th scope="col" { "our trials" }
                    @if few { th scope="col" { "as many as the paper’s" } }
                    th scope="col" { "the paper’s own tables" }
                } }
                tbody { @for claim in claims { tr {
                    th scope="row" { (claim.sentence) small { "§" (claim.section) } }
                    td { (judgement(&claim.ours)) }
                    @if few { td { @if let Some(few) = &claim.ours_as_paper { (judgement(few)) } } }
                    td { (judgement(&claim.paper)) }
                } } }
            } }
        }
    }
}

/// `Our trials: 18 supported, 10 contradicted, 6 undecided.`
fn counted<'c>(whose: &str, judgements: &(impl Iterator<Item = &'c Judgement> + Clone)) -> String {
    let verdicts = [
        ClaimVerdict::Supported,
        ClaimVerdict::Contradicted,
        ClaimVerdict::Undecided,
        ClaimVerdict::Unmeasured,
    ];
    let counts = verdicts.into_iter().filter_map(|verdict| {
        let count = judgements.clone().filter(|judgement| judgement.verdict == verdict).count();
        (count > 0).then(|| format!("{count} {}", verdict.label()))
    });
    format!("{whose}: {}. ", counts.collect::<Vec<_>>().join(", "))
}

fn judgement(judgement: &Judgement) -> Markup {
    let sign = match judgement.verdict {
        ClaimVerdict::Supported => "✓",
        ClaimVerdict::Contradicted => "✗",
        ClaimVerdict::Undecided => "?",
        ClaimVerdict::Unmeasured => "–",
    };
    verdict(sign, judgement.verdict.label(), &judgement.evidence)
}

/// The verdict; its numbers on demand, because they are many.
fn verdict(sign: &str, label: &str, evidence: &str) -> Markup {
    let verdict = html! { span class={ "verdict " (label) } { (sign) " " (label) } };
    html! {
        @if evidence.is_empty() { (verdict) } @else {
            details { summary { (verdict) } small { (evidence) } }
        }
    }
}

fn pattern(lines: &[JudgementLine]) -> Markup {
    html! {
        section id="pattern" {
            h2 { "The pattern of its results, and what is asked of ours" }
            p.note { (PATTERN) }
            div.scroll tabindex="0" role="region" aria-label="Pattern" { table.claims {
                thead { tr { th scope="col" { "line" } th scope="col" { "our trials" } } }
                tbody { @for line in lines { tr {
                    th scope="row" { (line.line) small { (line.id) } }
                    td {
                        @let sign = match line.verdict { Held::Held => "✓", Held::Missed => "✗", Held::Unmeasured => "–" };
                        (verdict(sign, line.verdict.label(), &line.evidence))
                    }
                } } }
            } }
        }
    }
}

fn comparisons(report: &Report<'_>) -> Markup {
    let kinds = [
        ("Approach against approach, ours", report.between),
        ("Approach against approach, the paper’s", report.papers_between),
        ("Ours against the paper’s", report.with_paper),
    ];
    html! {
        section id="comparisons" {
            h2 { "Every comparison" }
            p.note { (COMPARISONS) }
            @for (title, comparisons) in kinds { @if !comparisons.is_empty() {
                details {
                    summary { (title) " (" (comparisons.len()) ")" }
                    (listed(comparisons))
                }
            } }
        }
    }
}

fn listed(comparisons: &[Comparison]) -> Markup {
    let labels = ["table", "scenario", "first", "second", "measure"].map(Column::text);
    let numbers =
        ["first", "second", "difference", "z or t", "p", "p, Holm"].map(|head| Column::number(head, ""));
    let rows = comparisons.iter().map(|c| {
        row![
            c.table,
            c.scenario.label(),
            labels::approach(c.first_approach),
            labels::approach(c.second_approach),
            c.measure.label(),
            plain(c.first, 2),
            plain(c.second, 2),
            signed(c.first - c.second, 2),
            c.test.map_or(String::new(), |test| plain(test.statistic, 2)),
            scientific(c.test.map(|test| test.p)),
            Cell::marked(scientific(c.p_holm), stars(c.p_holm)),
        ]
    });
    Table::new(labels.into_iter().chain(numbers)).with_rows(rows).html("Comparisons", "listed")
}

/// A probability such as `3.40e-2`; empty where there is none.
fn scientific(p: Option<f64>) -> String {
    p.map_or(String::new(), |p| format!("{p:.2e}"))
}

/// The section of names and values under their headings.
pub(crate) fn facts(facts: &[Facts]) -> Markup {
    html! {
        section id="facts" {
            h2 { "What decided the trials" }
            p.note { "The same commit, options and seed play the same trials, to the bit." }
            @for facts in facts {
                h3 { (facts.title) }
                (entries(facts).html(&facts.title, "facts"))
            }
        }
    }
}

fn entries(facts: &Facts) -> Table {
    let rows = facts.entries.iter().map(|(name, value)| -> Row { row![name, value] });
    Table::new([Column::name(""), Column::text("")]).with_rows(rows)
}

const TITLE: &str = "Case-based and reactive attackers: the paper’s tables, and ours";
const GLANCE: &str = "Right of zero the first has more. To goal, more is better; out, less is better. A whisker that crosses zero: the \
     trials cannot tell.";
const CLAIMS: &str = "Each claim of the paper’s prose (§5) as a list of numbers that should lie in some way. Supported: all lie so, and that is \
     no chance (p < 0.05 after Holm’s correction over the claim). Contradicted: one lies the other way, and that is no chance. Else \
     undecided. Open a verdict for its numbers.";
const PATTERN: &str = "Lines a to g any faithful simulation should show; the rest is what this project asks of itself. They are meant for the \
     thousands of trials of onetwo evaluate judge.";
const MAPS: &str = "The first trials of each cell, played again and watched. The attackers play to the right. A pass is lost where nobody of \
     the team gets it; a kick that was no pass but came to a teammate is the paper’s pass by chance (§5).";
const COMPARISONS: &str = "Shares by the pooled z test, means by Welch’s t, two-sided. Holm’s correction over the scenarios 1 to 4 of a table \
     and measure. * below 0.05, ** below 0.01, *** below 0.001, after correction, here and in the tables.";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_colour_has_one_dark_one() {
        let mut light: Vec<_> =
            figures::palette().into_iter().chain(color_pairs()).map(|(light, _)| light).collect();
        let all = light.len();
        light.sort_unstable();
        light.dedup();
        assert_eq!(light.len(), all, "a colour with two dark ones");
    }
}
