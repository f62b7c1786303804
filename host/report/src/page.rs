//! `page`: layout of the report page. At a glance, the claims, tables with their plots, maps, every
//! comparison, every parameter.

use maud::{DOCTYPE, Markup, PreEscaped, html};
use study::evaluation::{Claim, ClaimVerdict, Comparison, Held, Judgement, JudgementLine};

use crate::plot::{Figure, figures};
use crate::table::tables;
use crate::{Facts, Report, description, map, numbers, style};

/// The whole page.
pub(crate) fn page(report: &Report<'_>) -> Markup {
    let (figures, tables) = (figures(report), tables(report));
    html! {
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
                header {
                    h1 { (TITLE) }
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
                }
                main {
                    section id="glance" {
                        h2 { "At a glance" }
                        p.note { (GLANCE) }
                        (plots(&figures, 0))
                    }
                    @if !report.claims.is_empty() { (claims(report.claims)) }
                    @if !report.lines.is_empty() { (pattern(report.lines)) }
                    @for table in &tables {
                        section id={ "table-" (table.number) } {
                            h2 { "Table " (table.number) ": " (description::table(table.number)) }
                            p.note { (description::note(table.number)) }
                            (table.html())
                            (plots(&figures, table.number))
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
                    section id="facts" { h2 { "What decided the trials" } (facts(report.facts)) }
                }
            }
        }
    }
}

/// What was played, in a sentence.
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

fn plots(figures: &[Figure], table: u8) -> Markup {
    html! { @for figure in figures.iter().filter(|figure| figure.table == table) { (figure.html()) } }
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
    let verdict_text = html! { span class={ "verdict " (label) } { (sign) " " (label) } };
    html! {
        @if evidence.is_empty() { (verdict_text) } @else {
            details { summary { (verdict_text) } small { (evidence) } }
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
    let p = |p: Option<f64>| p.map_or(String::new(), |p| format!("{p:.2e}"));
    html! {
        div.scroll tabindex="0" role="region" aria-label="Comparisons" { table.listed {
            thead { tr {
                @for head in ["table", "scenario", "first", "second", "measure"] { th.label scope="col" { (head) } }
                @for head in ["first", "second", "difference", "z or t", "p", "p, Holm"] { th scope="col" { (head) } }
            } }
            tbody { @for c in comparisons { tr {
                td.label { (c.table) }
                td.label { (c.scenario.label()) }
                td.label { (description::approach(c.first_approach)) }
                td.label { (description::approach(c.second_approach)) }
                td.label { (c.measure.label()) }
                td { (numbers::plain(c.first, 2)) }
                td { (numbers::plain(c.second, 2)) }
                td { (numbers::signed(c.first - c.second, 2)) }
                td { (c.test.map_or(String::new(), |test| numbers::plain(test.statistic, 2))) }
                td { (p(c.test.map(|test| test.p))) }
                td { (p(c.p_holm)) sup { (c.p_holm.map_or("", numbers::marks)) } }
            } } }
        } }
    }
}

/// Names and values under their headings.
pub(crate) fn facts(facts: &[Facts]) -> Markup {
    html! {
        p.note { "The same commit, options and seed play the same trials, to the bit." }
        @for facts in facts {
            h3 { (facts.title) }
            div.scroll tabindex="0" role="region" aria-label=(facts.title) { table.facts { tbody {
                @for (name, value) in &facts.entries { tr { th scope="row" { (name) } td { (value) } } }
            } } }
        }
    }
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
