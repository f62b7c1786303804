//! `page`: the report of a run: one HTML page, JSON, and a few lines of text.

use std::fmt::Write as _;

use arena::Profile;
use casebase::Symmetry;
use figures::{
    AXIS_HEIGHT, Axis, CasePicture, Column, Page, Row, Svg, Table, Theme, case_picture, mark_style, row,
};
use maud::{Markup, PreEscaped, html as markup};
use serde_json::{Value, json as value};

use crate::learning::paired::WorldPairs;
use crate::learning::results::{ChangeRecord, CurvePoint, Learned, Validation, Verdict};
use crate::learning::variant::Variant;

/// The report as JSON: settings, curve, every change with its evidence.
pub fn json(learned: &Learned) -> Value {
    let changes = learned.changes.iter().map(|change| {
        let validation = change.validation.as_ref().map(|Validation { all, kinds, worlds }| {
            let cells = kinds.iter().map(|(starts, wager)| {
                value!({
                    "starts": starts, "raised": wager.raised, "lowered": wager.lowered, "pairs": wager.pairs,
                    "gain": wager.gain(),
                })
            });
            let worlds = worlds.iter().zip([Profile::Simulated, Profile::Robots]).map(|(pairs, profile)| {
                let WorldPairs { to_goal, touches } = pairs;
                value!({
                    "profile": profile.label(), "raised": to_goal.raised, "lowered": to_goal.lowered,
                    "touches": touches.sum, "touches_z": touches.z(),
                })
            });
            value!({
                "raised": all.raised, "lowered": all.lowered, "pairs": all.pairs, "gain": all.gain(),
                "cells": cells.collect::<Vec<_>>(), "worlds": worlds.collect::<Vec<_>>(),
            })
        });
        value!({
            "round": change.round, "kind": change.proposal.kind, "case": change.proposal.edit.case,
            "edit": change.proposal.edit, "text": change.proposal.edit.to_string(),
            "reason": change.proposal.reason, "verdict": change.verdict,
            "raised": change.wager.raised, "lowered": change.wager.lowered, "pairs": change.wager.pairs,
            "share": change.share, "gain": change.wager.gain(), "e_value": change.wager.e_value(), "needed": change.needed,
            "validation": validation,
        })
    });
    value!({
        "settings": learned.settings,
        "library": { "before": format!("{:016x}", learned.start.hash), "after": format!("{:016x}", learned.end.hash) },
        "retrieval": learned.end.changed_settings(),
        "world": hil_sim::world_hash(),
        "spent": learned.spent,
        "tests": learned.tests,
        "accepted": learned.accepted().count(),
        "curve": learned.curve,
        "plays": learned.plays,
        "changes": changes.collect::<Vec<_>>(),
        "diff": learned.diff(),
    })
}

/// A few lines for the terminal.
pub fn summary(learned: &Learned) -> String {
    let mut text = String::new();
    for change in learned.changes.iter().filter(|change| {
        matches!(
            change.verdict,
            Verdict::Accepted | Verdict::Lowers | Verdict::Touches | Verdict::Warned | Verdict::Proposed
        )
    }) {
        let _ = writeln!(
            text,
            "{:>2}  {:<9} {}  {:+.2} {}, e {:.3e}",
            change.round,
            change.verdict.label(),
            change.proposal.edit,
            change.wager.gain(),
            gained(learned),
            change.wager.e_value()
        );
    }
    for point in &learned.curve {
        let _ = writeln!(
            text,
            "held-out after round {}: to goal {:.2} %, random starts {:.2} %,{} touches {:.3}; {} trials",
            point.round,
            point.to_goal,
            point.to_goal_random,
            point.to_goal_robots.map_or_else(String::new, |robots| format!(" robots {robots:.2} %,")),
            point.touches,
            point.spent
        );
    }
    for setting in learned.end.changed_settings() {
        let _ = writeln!(text, "retrieval: --set {setting}");
    }
    if !learned.settings.refused.is_empty() {
        let _ = writeln!(text, "changes refused by hand, not proposed: {}", learned.settings.refused.len());
    }
    let _ = writeln!(
        text,
        "{} of {} proposals accepted after {} tests, {} {}",
        learned.accepted().count(),
        learned.changes.len(),
        learned.tests,
        learned.spent,
        learned.played()
    );
    text
}

/// The report as one HTML page without scripts.
pub fn html(learned: &Learned) -> String {
    let diff = learned.diff();
    let main = markup! {
        @if !learned.curve.is_empty() {
            h2 { "Learning curve on held-out starts" }
            (PreEscaped(curve(&learned.curve)))
            (curve_table(&learned.curve).html("Learning curve", ""))
        }
        @if !learned.plays.is_empty() {
            h2 { "Plays to watch" }
            p {
                "Held-out starts that the learned library brings to goal and the one before does not. In the "
                "directory of this report:"
            }
            @for play in &learned.plays { pre { (play.command(&learned.end.files.league)) } }
        }
        h2 { "Accepted" }
        @if learned.accepted().next().is_none() { p { "None: the learned library is the one before." } }
        @for change in learned.accepted() { (accepted(learned, change)) }
        @if !learned.end.changed_settings().is_empty() {
            h2 { "Settings of retrieval" }
            p {
                "They are no part of the library: robots take them with "
                @for setting in learned.end.changed_settings() { code { "--set " (setting) } " " }
            }
        }
        @if !diff.is_empty() {
            h2 { "Difference of the library" }
            pre.diff { @for line in diff.lines() { span class=(line_class(line)) { (line) "\n" } } }
        }
        h2 { "All proposals" }
        (proposals(learned).html("All proposals", "proposals"))
    };
    Page { title: "Learned cases", style: STYLE.to_owned(), header: lead(learned), main }.html()
}

/// What was proposed, accepted and played.
fn lead(learned: &Learned) -> Markup {
    let settings = &learned.settings;
    markup! {
        p.lead {
            (learned.accepted().count()) " of " (learned.changes.len()) " proposed changes accepted, "
            (learned.spent) " " (learned.played()) ", seed " (settings.seed) ", expected share of wrong changes at most "
            (settings.error_rate) " over " (settings.tries) " tests."
            @if !settings.refused.is_empty() {
                " Changes refused by hand, not proposed: " (settings.refused.len()) "."
            }
            @if settings.shuffle { " Null control: chance decides every pair." }
        }
    }
}

fn curve_table(curve: &[CurvePoint]) -> Table {
    let as_robots = curve.iter().any(|point| point.to_goal_robots.is_some());
    let mut columns = vec![
        Column::number("round", ""),
        Column::number("trials", ""),
        Column::number("to goal", "%"),
        Column::number("random starts", "%"),
    ];
    columns.extend(as_robots.then(|| Column::number("as robots", "%")));
    columns.push(Column::number("touches", ""));
    let rows = curve.iter().map(|point| {
        let shares = [point.to_goal, point.to_goal_random].map(|share| format!("{share:.2}"));
        let row = row![point.round, point.spent].with(shares);
        row.with(as_robots.then(|| robots(point))).with([format!("{:.3}", point.touches)])
    });
    Table::new(columns).with_rows(rows)
}

fn accepted(learned: &Learned, change: &ChangeRecord) -> Markup {
    let edit = &change.proposal.edit;
    let [before, after] = [&learned.start, &learned.end].map(|variant| picture(variant, &edit.case));
    markup! {
        section {
            h3 { (edit.to_string()) }
            p { (change.proposal.reason) }
            p {
                (evidence(learned, change)) ", needed " (format!("{:.0}", change.needed.unwrap_or_default())) "."
                @if let Some(all) = change.validation.as_ref().map(|validation| &validation.all) {
                    " Validation: " (all.raised) " raised, " (all.lowered) " lowered in " (all.pairs) (validated(learned))
                }
            }
            div.pictures {
                @for (svg, title) in [(before, "before learning"), (after, "after learning")] {
                    @if let Some(svg) = svg { figure { (PreEscaped(svg)) figcaption { (title) } } }
                }
            }
        }
    }
}

/// Every change that was proposed, with its evidence.
fn proposals(learned: &Learned) -> Table {
    let heads = ["kind", "change", "why tried", "evidence", "verdict"];
    let columns = [Column::number("round", "")].into_iter().chain(heads.map(Column::text));
    let rows = learned.changes.iter().map(|change| -> Row {
        let proposal = &change.proposal;
        let (evidence, verdict) = (evidence(learned, change), change.verdict.label());
        row![change.round, proposal.kind.label(), proposal.edit, proposal.reason, evidence, verdict]
    });
    Table::new(columns).with_rows(rows)
}

fn line_class(line: &str) -> &'static str {
    match line.as_bytes() {
        [b'-', b'-', b'-', ..] | [b'+', b'+', b'+', ..] => "file",
        [b'-', ..] => "old",
        [b'+', ..] => "new",
        _ => "",
    }
}

fn evidence(learned: &Learned, change: &ChangeRecord) -> String {
    let wager = &change.wager;
    let (places, pairs) = match (learned.opponents.is_empty(), change.needed.is_some()) {
        (true, true) => ("situations", "pairs of all starts"),
        (true, false) => ("situations", "pairs there"),
        (false, true) => ("matches", "pairs of fresh scenes"),
        (false, false) => ("matches", "pairs of scenes there"),
    };
    format!(
        "changes {:.1} % of the {places}; {} {pairs}: {} raised, {} lowered, {:+.2} {}, e {:.3}",
        100.0 * change.share,
        wager.pairs,
        wager.raised,
        wager.lowered,
        wager.gain(),
        gained(learned),
        wager.e_value()
    )
}

/// To goal on starts that are played as by the paper's robots, percent; empty where there are none.
fn robots(point: &CurvePoint) -> String {
    point.to_goal_robots.map_or_else(String::new, |robots| format!("{robots:.2}"))
}

fn gained(learned: &Learned) -> &'static str {
    if learned.opponents.is_empty() { "points" } else { "goals in 100 scenes" }
}

/// Unit of a validation's pairs, at the end of its sentence.
fn validated(learned: &Learned) -> &'static str {
    if learned.opponents.is_empty() { " starts." } else { " matches." }
}

/// Figure of a case of a library; `None` where it lacks the case.
fn picture(variant: &Variant, name: &str) -> Option<String> {
    let base = variant.base();
    let number = variant.names().iter().position(|known| known == name)?;
    let case =
        base.cases().find(|case| case.authored() == number && case.symmetry() == Symmetry::Identity)?;
    let picture = CasePicture { base, case, name, intent: "", overlay: None, theme: Theme::Light };
    Some(case_picture(&picture))
}

/// Share of held-out starts to goal over the trials spent, as an SVG.
fn curve(points: &[CurvePoint]) -> String {
    let colors = Theme::Light.colors();
    let (mut low, mut high) = (f64::INFINITY, 0.0_f64);
    for point in points {
        (low, high) = (low.min(point.to_goal), high.max(point.to_goal));
    }
    let trials = points.last().map_or(1, |point| point.spent).max(1) as f64;
    let across = Axis::linear([0.0, trials], [0.0, CURVE_SIZE[0]]);
    let up = Axis::linear([low, high], [0.0, CURVE_SIZE[1]]);
    let mut svg = Svg::default();
    across.draw_below(&mut svg, CURVE_SIZE[1], 0.0, "trials");
    up.draw_beside(&mut svg, 0.0, CURVE_SIZE[0]);
    let places: Vec<_> =
        points.iter().map(|point| [across.place(point.spent as f64), up.place(point.to_goal)]).collect();
    svg.polyline(&places, format!(r#"stroke="{}" stroke-width="2""#, colors.team));
    for place in places {
        svg.circle(place, 3.5, mark_style(colors.team, true));
    }
    let (lower, upper) = ([-48.0, -AXIS_HEIGHT], [CURVE_SIZE[0] + 30.0, CURVE_SIZE[1] + 12.0]);
    svg.finish(lower, upper, 1.0, colors.paper, "percent to goal over trials")
}

/// Width and height of the learning curve, px.
const CURVE_SIZE: [f64; 2] = [520.0, 160.0];

/// Rules of style beside those of every page.
const STYLE: &str = "pre{overflow-x:auto;background:var(--band);padding:1em}\
    .file{font-weight:bold}.old{color:var(--bad)}.new{color:var(--good)}\
    .proposals tr > .label{min-width:0}.proposals tr > .label:last-child{white-space:nowrap}\
    .pictures{display:flex;gap:1em}.pictures svg{width:100%}.pictures figure{margin:0;flex:1;max-width:50%}";
