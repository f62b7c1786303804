//! `draw`: maps of a cell drawn on the field: the ball's seconds as shades, passes as arrows, ends by
//! outcome.

use std::fmt::Write as _;

use casebase::FieldMm;
use figures::{Anchor, FigureFile, Font, Svg, Theme, draw_field, field_lines, half_extent};
use geometry::{Field, Point};
use hil_sim::{Configuration, Scenario, TrialOutcome};
use maud::{Markup, PreEscaped, html};

use super::{Map, PassKind, SQUARE_MM};
use crate::labels;

/// The maps of a page: a scenario a row, an approach a column.
pub(crate) fn html(maps: &[Map]) -> Markup {
    html! {
        div.keys { @for (sign, label) in signs() { span.key { (PreEscaped(sign)) (label) } } }
        div.keys { span.key { "ball, seconds a trial in a square of 10 cm" } (PreEscaped(scale_svg())) }
        @for (configuration, scenario, row) in rows(maps) {
            h3 { (labels::scenario(scenario)) ", against " (labels::opponents(configuration)) small { (trials(&row)) } }
            div.maps { @for map in &row {
                figure {
                    figcaption style=(labels::css(map.cell.approach)) {
                        (labels::approach(map.cell.approach)) small { (caption(map)) }
                    }
                    (PreEscaped(alone(&passes(map), map, "Passes and ends")))
                    (PreEscaped(alone(&heat(map), map, "The ball")))
                }
            } }
        }
    }
}

/// One figure a configuration: passes on the left, the ball on the right, for files.
pub(crate) fn sheets(maps: &[Map]) -> Vec<FigureFile> {
    let mut files = Vec::new();
    for (configuration, scenario, row) in rows(maps) {
        let colors = Theme::Light.colors();
        let mut svg = Svg::default();
        let Some([x, y]) = row.first().map(|map| half_extent(&map.field)) else { continue };
        let (gap, size) = (x * 0.08, x * 0.075);
        let against = labels::opponents(configuration);
        let title = format!("{}, against {against}: {}", labels::scenario(scenario), trials(&row));
        let heading = Font { size: size * 1.1, fill: colors.ink, bold: true, halo: None };
        svg.text([-x, size], &title, Anchor::Start, heading);
        let mut down = -size * 0.4;
        for map in &row {
            let fill = labels::color(map.cell.approach);
            let font = Font { size, fill, bold: true, halo: None };
            let name = labels::approach(map.cell.approach);
            svg.text([-x, down - size], name, Anchor::Start, font);
            let after = -x + figures::width(name, size) * 1.15 + size;
            let font = Font { size: size * 0.8, fill: colors.faint, bold: false, halo: None };
            svg.text([after, down - size], &caption(map), Anchor::Start, font);
            let middle = down - size * 1.6 - y;
            svg.inset(&passes(map), [0.0, middle]);
            svg.inset(&heat(map), [2.0 * x + gap, middle]);
            down = middle - y - size * 0.6;
        }
        let right = 3.0 * x + gap;
        down = legend(&mut svg, [-x, down - size * 0.5], [x + gap, right], size * 0.85);
        let lower = [-x - gap, down - gap];
        let svg = svg.finish(
            lower,
            [right + gap, size * 2.6 + gap * 0.3],
            SHEET_WIDTH_PX / (4.0 * x),
            colors.paper,
            &title,
        );
        let name = format!("maps-{}-{}", configuration.label(), scenario.label());
        files.push(FigureFile { name, svg });
    }
    files
}

/// Maps by configuration and scenario, in their order.
fn rows(maps: &[Map]) -> Vec<(Configuration, Scenario, Vec<&Map>)> {
    let mut rows: Vec<(Configuration, Scenario, Vec<&Map>)> = Vec::new();
    for map in maps {
        let (configuration, scenario) = (map.cell.configuration, map.cell.scenario);
        match rows.iter_mut().find(|(c, s, _)| (*c, *s) == (configuration, scenario)) {
            Some((_, _, row)) => row.push(map),
            None => rows.push((configuration, scenario, vec![map])),
        }
    }
    rows
}

/// `61 of 140 passes completed, 12 by chance`.
fn caption(map: &Map) -> String {
    let count = |kind| map.passes.iter().filter(|pass| pass.kind == kind).count();
    let [completed, lost, chance] = [PassKind::Completed, PassKind::Lost, PassKind::Chance].map(count);
    match completed + lost {
        0 => format!("no passes, {chance} by chance"),
        meant => format!("{completed} of {meant} passes completed, {chance} by chance"),
    }
}

/// `the first 100 trials`; a cell may have fewer.
fn trials(row: &[&Map]) -> String {
    let most = row.iter().map(|map| map.trials).max().unwrap_or_default();
    format!("the first {most} trials of each")
}

/// The ball's seconds.
fn heat(map: &Map) -> Svg {
    let colors = Theme::Light.colors();
    let mut svg = Svg::default();
    draw_field(&mut svg, &map.field, colors);
    let mut squares: [String; SHADES.len()] = Default::default();
    let (left, low) = (-f64::from(map.field.length) * 0.5, -f64::from(map.field.width) * 0.5);
    for (i, seconds) in map.seconds.iter().enumerate() {
        let Some(shade) = shade(seconds / f64::from(map.trials.max(1))) else { continue };
        let (column, row) = (i % map.columns(), i / map.columns());
        let (x, top) = (left + column as f64 * SQUARE_MM, -(low + (row + 1) as f64 * SQUARE_MM));
        let _ = write!(squares[shade], "M{x:.0} {top:.0}h{SQUARE_MM:.0}v{SQUARE_MM:.0}h-{SQUARE_MM:.0}z");
    }
    for (path, fill) in squares.iter().zip(SHADES).filter(|(path, _)| !path.is_empty()) {
        svg.element(format_args!(
            r#"<path d="{path}" fill="{fill}" stroke="{fill}" stroke-width="3" shape-rendering="crispEdges"/>"#
        ));
    }
    let mut over = Svg::default();
    field_lines(&mut over, &map.field, colors, colors.ink);
    svg.group(&over, r#"opacity="0.45""#);
    svg
}

/// The shade for this number of seconds a trial; `None` for next to nothing.
fn shade(seconds: f64) -> Option<usize> {
    SHADE_SECONDS_MIN.iter().rposition(|least| seconds >= *least)
}

/// Passes and where trials ended.
fn passes(map: &Map) -> Svg {
    let colors = Theme::Light.colors();
    let mut svg = Svg::default();
    draw_field(&mut svg, &map.field, colors);
    if let Some(start) = &map.start {
        for attacker in &start.attackers {
            kick_off(&mut svg, millimetres(attacker.position), true);
        }
        for opponent in &start.opponents {
            kick_off(&mut svg, millimetres(opponent.pose.position), false);
        }
    }
    for kind in [PassKind::Lost, PassKind::Chance, PassKind::Completed] {
        let own = map.passes.iter().filter(|pass| pass.kind == kind);
        let segments: Vec<_> = own.map(|pass| (millimetres(pass.from), millimetres(pass.to))).collect();
        // Overlapping arrows add up to a darker colour.
        arrows(&mut svg, &segments, kind, "0.4");
    }
    for outcome in [
        TrialOutcome::Timeout,
        TrialOutcome::Out,
        TrialOutcome::Block,
        TrialOutcome::Close,
        TrialOutcome::Goal,
    ] {
        for (place, _) in map.ends.iter().filter(|(_, own)| *own == outcome) {
            end(&mut svg, on_field(&map.field, millimetres(*place)), outcome);
        }
    }
    svg
}

/// Draws a robot's place at kick-off: a circle for attackers, a square for opponents, as in the paper's
/// figures.
fn kick_off(svg: &mut Svg, [x, y]: [f64; 2], attacker: bool) {
    let colors = Theme::Light.colors();
    let color = if attacker { colors.team } else { colors.opponent };
    let style = format!(r#"fill="{}" stroke="{color}" stroke-width="22""#, colors.paper);
    if attacker {
        svg.circle([x, y], 95.0, style);
    } else {
        svg.rect([x - 85.0, y - 85.0], [x + 85.0, y + 85.0], style);
    }
}

/// Arrows of a kind, each one short element: there are hundreds.
fn arrows(svg: &mut Svg, segments: &[([f64; 2], [f64; 2])], kind: PassKind, opacity: &str) {
    let (color, style) = match kind {
        PassKind::Completed => (COMPLETED_PASS_COLOR, r#"stroke-width="14""#),
        PassKind::Lost => (LOST_PASS_COLOR, r#"stroke-width="11" stroke-dasharray="34 26""#),
        PassKind::Chance => (CHANCE_PASS_COLOR, r#"stroke-width="11""#),
    };
    let (mut lines, mut heads) = (Svg::default(), Svg::default());
    for (from, to) in segments {
        let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
        let length = dx.hypot(dy);
        if length <= 0.0 {
            continue;
        }
        let head = ARROWHEAD_MM.min(length);
        let along = [dx / length * head, dy / length * head];
        let (back, side) = ([to[0] - along[0], to[1] - along[1]], [along[1] * 0.42, -along[0] * 0.42]);
        let at = |x: f64, y: f64| format!("{:.0} {:.0}", x, -y);
        lines.element(format_args!(r#"<path d="M{}L{}"/>"#, at(from[0], from[1]), at(back[0], back[1])));
        heads.element(format_args!(
            r#"<path d="M{}L{}L{}z"/>"#,
            at(to[0], to[1]),
            at(back[0] + side[0], back[1] + side[1]),
            at(back[0] - side[0], back[1] - side[1])
        ));
    }
    if !segments.is_empty() {
        svg.group(&lines, format_args!(r#"stroke="{color}" stroke-opacity="{opacity}" {style}"#));
        svg.group(&heads, format_args!(r#"fill="{color}" fill-opacity="{opacity}""#));
    }
}

/// The sign of an outcome.
fn end(svg: &mut Svg, [x, y]: [f64; 2], outcome: TrialOutcome) {
    let colors = Theme::Light.colors();
    let ink = colors.ink;
    match outcome {
        TrialOutcome::Goal => {
            svg.circle([x, y], 52.0, format!(r#"fill="{}" stroke="{ink}" stroke-width="12""#, colors.ball));
        }
        TrialOutcome::Close => {
            svg.circle([x, y], 46.0, format!(r#"fill="none" stroke="{}" stroke-width="22""#, colors.ball));
        }
        TrialOutcome::Block => {
            let style = format!(r#"fill="{}" stroke="{}" stroke-width="8""#, colors.opponent, colors.surface);
            svg.rect([x - 36.0, y - 36.0], [x + 36.0, y + 36.0], style);
        }
        TrialOutcome::Out => {
            let style = format!(r#"stroke="{ink}" stroke-width="15" stroke-opacity="0.75""#);
            svg.line([x - 32.0, y - 32.0], [x + 32.0, y + 32.0], &style);
            svg.line([x - 32.0, y + 32.0], [x + 32.0, y - 32.0], &style);
        }
        TrialOutcome::Timeout => {
            svg.circle([x, y], 26.0, format!(r#"fill="{}" stroke="{ink}" stroke-width="9""#, colors.surface));
        }
    }
}

/// A place on the figure: what lies farther out is drawn at its edge.
fn on_field(field: &FieldMm, [x, y]: [f64; 2]) -> [f64; 2] {
    let [right, top] = half_extent(field).map(|half| half - 50.0);
    [x.clamp(-right, right), y.clamp(-top, top)]
}

fn millimetres(place: Point<Field>) -> [f64; 2] {
    [f64::from(place.x()) * 1000.0, f64::from(place.y()) * 1000.0]
}

/// A map as a figure of its own.
fn alone(svg: &Svg, map: &Map, title: &str) -> String {
    let [x, y] = half_extent(&map.field);
    let mut page = Svg::default();
    page.inset(svg, [0.0, 0.0]);
    page.finish([-x, -y], [x, y], PAGE_MAP_WIDTH_PX / (2.0 * x), Theme::Light.colors().paper, title)
}

/// The signs as SVG with their meanings, in the order of the legend.
fn signs() -> Vec<(String, &'static str)> {
    let paper = Theme::Light.colors().paper;
    let drawn = entries().into_iter().map(|(sign, label)| {
        let mut svg = Svg::default();
        svg.inset(&sign, [0.0, 0.0]);
        (svg.finish([-160.0, -110.0], [160.0, 110.0], 0.11, paper, label), label)
    });
    drawn.collect()
}

fn entries() -> Vec<(Svg, &'static str)> {
    let passes = [
        (PassKind::Completed, "pass completed"),
        (PassKind::Lost, "pass lost"),
        (PassKind::Chance, "kick that came to a teammate"),
    ];
    let ends = [
        (TrialOutcome::Goal, "goal"),
        (TrialOutcome::Close, "close"),
        (TrialOutcome::Block, "block"),
        (TrialOutcome::Out, "out"),
        (TrialOutcome::Timeout, "timeout"),
    ];
    let passes = passes.into_iter().map(|(kind, label)| {
        let mut svg = Svg::default();
        arrows(&mut svg, &[([-140.0, 0.0], [150.0, 0.0])], kind, "1");
        (svg, label)
    });
    let ends = ends.into_iter().map(|(outcome, label)| {
        let mut svg = Svg::default();
        end(&mut svg, [60.0, 0.0], outcome);
        (svg, label)
    });
    let starts = [(true, "attacker at kick-off"), (false, "opponent at kick-off")];
    let starts = starts.into_iter().map(|(attacker, label)| {
        let mut svg = Svg::default();
        kick_off(&mut svg, [40.0, 0.0], attacker);
        (svg, label)
    });
    starts.chain(passes).chain(ends).collect()
}

/// Signs from `left`, the scale from `from`; returns their right end.
fn legend(svg: &mut Svg, [left, top]: [f64; 2], [from, right]: [f64; 2], size: f64) -> f64 {
    let colors = Theme::Light.colors();
    let font = Font { size, fill: colors.ink, bold: false, halo: None };
    let (mut across, mut down) = (left, top - size * 1.2);
    for (sign, label) in entries() {
        let wide = 470.0 + figures::width(label, size);
        if across > left && across + wide > from - size {
            (across, down) = (left, down - size * 1.9);
        }
        svg.inset(&sign, [across + 150.0, down + size * 0.35]);
        svg.text([across + 340.0, down], label, Anchor::Start, font);
        across += wide;
    }
    svg.inset(&scale(right - from, size), [from, top]);
    down - size * 0.5
}

/// The shades with the seconds at which each starts.
fn scale(width: f64, size: f64) -> Svg {
    let colors = Theme::Light.colors();
    let mut svg = Svg::default();
    let step = width / SHADES.len() as f64;
    let font = Font { size, fill: colors.ink, bold: false, halo: None };
    for (i, (fill, least)) in SHADES.iter().zip(SHADE_SECONDS_MIN).enumerate() {
        let x = step * i as f64;
        svg.rect([x, 0.0], [x + step, -size], format!(r#"fill="{fill}""#));
        svg.text([x, -size * 2.2], &least.to_string(), Anchor::Start, font);
    }
    svg.text(
        [0.0, -size * 3.6],
        "the ball: seconds a trial in a square of 10 cm, at least",
        Anchor::Start,
        font,
    );
    svg
}

fn scale_svg() -> String {
    let svg = scale(330.0, 12.0);
    svg.finish([0.0, -29.0], [340.0, 1.0], 1.0, Theme::Light.colors().paper, "seconds a trial")
}

/// From near the field surface's lightness evenly to dark: one hue, so that darker always reads as more.
pub(crate) const SHADES: [&str; 7] =
    ["#c9d9ea", "#a5c0de", "#7fa3cf", "#5d83bc", "#4562a3", "#374382", "#2a2459"];
/// Seconds a trial at which each shade starts.
const SHADE_SECONDS_MIN: [f64; 7] = [0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5];
/// Length of an arrow's head, mm.
const ARROWHEAD_MM: f64 = 85.0;
const COMPLETED_PASS_COLOR: &str = "#1b1b1b";
/// Reddish purple (Okabe and Ito), darker.
pub(crate) const LOST_PASS_COLOR: &str = "#b3367d";
pub(crate) const CHANCE_PASS_COLOR: &str = "#2f6fb7";
/// Width of a map on a page, px.
const PAGE_MAP_WIDTH_PX: f64 = 560.0;
/// Width of a sheet of two maps beside each other, px.
const SHEET_WIDTH_PX: f64 = 1100.0;
