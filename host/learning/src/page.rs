//! `page`: the report of a run: one HTML page, JSON, and a few lines of text.

use std::fmt::Write as _;

use arena::evaluation::Profile;
use casebase::Symmetry;
use figures::Theme;
use figures::{CasePicture, case_picture};
use maud::{DOCTYPE, Markup, PreEscaped, html as markup};
use serde_json::{Value, json as value};

use crate::paired::WorldPairs;
use crate::results::{ChangeRecord, CurvePoint, Learned, Validation, Verdict};
use crate::variant::Variant;

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
            verdict(change.verdict),
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
    let (settings, diff) = (&learned.settings, learned.diff());
    let as_robots = learned.curve.iter().any(|point| point.to_goal_robots.is_some());
    let page = markup! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { "Learned cases" }
                style { (STYLE) }
            }
            body {
                h1 { "Learned cases" }
                p {
                    (learned.accepted().count()) " of " (learned.changes.len()) " proposed changes accepted, "
                    (learned.spent) " " (learned.played()) ", seed " (settings.seed) ", expected share of wrong changes at most "
                    (settings.error_rate) " over " (settings.tries) " tests."
                    @if !settings.refused.is_empty() {
                        " Changes refused by hand, not proposed: " (settings.refused.len()) "."
                    }
                    @if settings.shuffle { " Null control: chance decides every pair." }
                }
                @if !learned.curve.is_empty() {
                    h2 { "Learning curve on held-out starts" }
                    (curve(learned))
                    table {
                        tr { th { "round" } th { "trials" } th { "to goal %" } th { "random starts %" } @if as_robots { th { "as robots %" } } th { "touches" } }
                        @for point in &learned.curve {
                            tr {
                                td { (point.round) } td { (point.spent) } td { (format!("{:.2}", point.to_goal)) }
                                td { (format!("{:.2}", point.to_goal_random)) } @if as_robots { td { (robots(point)) } }
                                td { (format!("{:.3}", point.touches)) }
                            }
                        }
                    }
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
                (table(learned))
            }
        }
    };
    page.into_string()
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

fn table(learned: &Learned) -> Markup {
    markup! {
        table {
            tr { th { "round" } th { "kind" } th { "change" } th { "why tried" } th { "evidence" } th { "verdict" } }
            @for change in &learned.changes {
                tr {
                    td { (change.round) } td { (change.proposal.kind.label()) } td { (change.proposal.edit.to_string()) }
                    td { (change.proposal.reason) } td { (evidence(learned, change)) } td.word { (verdict(change.verdict)) }
                }
            }
        }
    }
}

/// The style of a line of a unified diff.
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

/// What a gain is counted in.
fn gained(learned: &Learned) -> &'static str {
    if learned.opponents.is_empty() { "points" } else { "goals in 100 scenes" }
}

/// What a validation played.
fn validated(learned: &Learned) -> &'static str {
    if learned.opponents.is_empty() { " starts." } else { " matches." }
}

const fn verdict(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Proposed => "proposed",
        Verdict::Rare => "rarely played",
        Verdict::ScreenedOut => "screened out",
        Verdict::Unconfirmed => "not confirmed",
        Verdict::Superseded => "superseded",
        Verdict::Warned => "warned",
        Verdict::Lowers => "lowers",
        Verdict::Touches => "more touches",
        Verdict::Accepted => "accepted",
    }
}

/// A case as a library has it; none where it lacks the case.
fn picture(variant: &Variant, name: &str) -> Option<String> {
    let base = variant.base();
    let number = variant.names().iter().position(|known| known == name)?;
    let case =
        base.cases().find(|case| case.authored() == number && case.symmetry() == Symmetry::Identity)?;
    let picture = CasePicture { base, case, name, intent: "", overlay: None, theme: Theme::Light };
    Some(case_picture(&picture))
}

/// The curve as an SVG.
fn curve(learned: &Learned) -> Markup {
    let last = learned.curve.last().map_or(1, |point| point.spent).max(1) as f64;
    let values = learned.curve.iter().map(|point| point.to_goal);
    let (low, high) = values.fold((100.0_f64, 0.0_f64), |(low, high), v| (low.min(v), high.max(v)));
    let (low, high) = (low - 2.0, high + 2.0);
    let place =
        |spent: u64, v: f64| (60.0 + 520.0 * spent as f64 / last, 180.0 - 160.0 * (v - low) / (high - low));
    let places = learned.curve.iter().map(|point| place(point.spent, point.to_goal));
    let places: Vec<_> = places.map(|(x, y)| (format!("{x:.1}"), format!("{y:.1}"))).collect();
    let line: Vec<String> = places.iter().map(|(x, y)| format!("{x},{y}")).collect();
    let spent = learned.curve.last().map_or(0, |point| point.spent);
    markup! {
        svg viewBox="0 0 600 225" width="600" role="img" aria-label="percent to goal over trials" {
            path d="M60 10V190H590" fill="none" stroke="#888" {}
            polyline fill="none" stroke="#1a6fb5" stroke-width="2" points=(line.join(" ")) {}
            @for (x, y) in &places { circle cx=(x) cy=(y) r="3.5" fill="#1a6fb5" {} }
            g font-size="13" {
                text x="54" y="24" text-anchor="end" { (format!("{high:.1} %")) }
                text x="54" y="184" text-anchor="end" { (format!("{low:.1} %")) }
                text x="60" y="208" { "0" }
                text x="580" y="208" text-anchor="end" { (spent) " trials" }
            }
        }
    }
}

const STYLE: &str = "body{font:15px sans-serif;max-width:70em;margin:2em auto;padding:0 1em}\
    table{border-collapse:collapse}.word{white-space:nowrap}pre{overflow-x:auto}\
    .file{font-weight:bold}.old{color:#a11}.new{color:#070}\
    td,th{padding:.2em .6em;text-align:left;border-bottom:1px solid #ccc;vertical-align:top}\
    .pictures{display:flex;gap:1em}.pictures svg{width:100%;height:auto}\
    figure{margin:0;flex:1;max-width:50%}pre{background:#f4f4f4;padding:1em}";
