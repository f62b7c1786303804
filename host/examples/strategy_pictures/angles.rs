//! `angles`: figure of the open angle and the three placements of keeper and primary defenders, as the
//! paper's Figure 7.

use figures::{Anchor, Svg};
use geometry::{Angle, Attack, Point};
use host::strategy::threat::cover::{Case, Cover, cover};
use host::strategy::threat::{ThreatSettings, angle};
use rules::League;

use crate::page::{BLUE, GAP_PX, GREEN, Panel, RED, YELLOW, finish, lines_of_text, polar};
use crate::scenes;

/// SVG text of the figure.
pub(crate) fn draw() -> String {
    let field = League::Ssl2013.field();
    let part = [Point::new(-3.3, -1.45), Point::new(-0.35, 1.6)];
    let threats = [(-1.75, -1.22), (-1.35, 1.0), (-0.62, 0.12)];
    let mut panels = Vec::new();
    let mut size = [0.0, 0.0];
    for (i, threat) in threats.into_iter().enumerate() {
        let mut panel = Panel::new(field, part, [GAP_PX + i as f64 * (size[0] + GAP_PX), 92.0], 128.0);
        size = panel.size();
        let view = scenes::moment(League::Ssl2013, threat, &[], &[]);
        let cover = cover(&view, Point::new(threat.0, threat.1), 2, None, &ThreatSettings::default());
        shadows(&mut panel, &cover);
        panel.lines();
        rays(&mut panel, &cover);
        for place in &cover.primaries {
            panel.ours(*place, "D", YELLOW);
        }
        panel.ours(cover.keeper, "K", "#9fd3f0");
        panel.ball(cover.opening.from);
        let degrees = cover.opening.angle().to_degrees();
        let defenders = match cover.case {
            Case::Defender => "one defender",
            Case::DefenderAndKeeper => "a defender and the keeper",
            Case::DefendersAndKeeper => "two defenders and the keeper",
        };
        panel.title(&format!("{degrees:.1}° open: {defenders}"));
        panels.push(panel.svg);
    }
    let mut legend = Svg::default();
    let text = "Red, dashed: the open angle from the threat (the ball) to the goal; dotted: its bisector. Green, dashed: what is left for the \
                defenders (or, with one defender, for the keeper); dotted: its bisectors. Shaded: where no shot passes the defenders (yellow) \
                and the keeper (blue): 2·asin((r + r_ball)/D) each. Field of 2013, our goal.";
    let width = 3.0 * size[0] + 4.0 * GAP_PX;
    lines_of_text(&mut legend, [GAP_PX, 68.0], width - 2.0 * GAP_PX, text);
    let panels: Vec<_> = panels.iter().collect();
    finish(&panels, [width, size[1] + 92.0 + 32.0], &legend, "Open angles and the three placements")
}

/// The area behind every body that a shot cannot reach.
fn shadows(panel: &mut Panel, cover: &Cover) {
    let mut svg = Svg::default();
    let bodies = cover.primaries.iter().map(|place| (*place, "#e69f00"));
    for (body, fill) in bodies.chain([(cover.keeper, BLUE)]) {
        let Some(span) = cover.opening.shadow(body, f32::INFINITY) else { continue };
        let from = cover.opening.from;
        let near = body.distance(from);
        let at = |side: f32, by: f32| panel.at(polar(from, cover.opening.middle + Angle::new(side), by));
        let corners = [at(span.right, near), at(span.left, near), at(span.left, 6.0), at(span.right, 6.0)];
        svg.polygon(&corners, format_args!(r#"fill="{fill}" fill-opacity="0.28""#));
    }
    panel.clipped(&svg);
}

fn rays(panel: &mut Panel, cover: &Cover) {
    let (from, half) = (cover.opening.from, cover.opening.half);
    let mut svg = Svg::default();
    let mut ray = |side: f32, colour: &str, dash: &str| {
        let direction = cover.opening.direction(side);
        // Ray length up to the goal line.
        let by = (-3.0 - from.x()) / direction.x();
        let to: Point<Attack> = from + direction * by;
        let style = format!(r#"stroke="{colour}" stroke-width="2.2" stroke-dasharray="{dash}""#);
        svg.line(panel.at(from), panel.at(to), style);
    };
    ray(half, RED, DASHES);
    ray(-half, RED, DASHES);
    ray(0.0, RED, DOTS);
    // The parts of the goal that the others leave open; their borders with the posts are drawn already.
    let rests = match cover.case {
        Case::Defender => angle::Gaps::new(),
        Case::DefenderAndKeeper => cover.opening.gaps(cover.primaries.iter().copied(), f32::INFINITY),
        Case::DefendersAndKeeper => cover.opening.gaps([cover.keeper].into_iter(), f32::INFINITY),
    };
    for rest in rests.iter().filter(|rest| rest.width() > 1e-3) {
        for side in [rest.right, rest.left].into_iter().filter(|side| side.abs() < half - 1e-3) {
            ray(side, GREEN, DASHES);
        }
        ray(rest.middle(), GREEN, DOTS);
    }
    panel.clipped(&svg);
    panel.note(cover.opening.from, 12.0, "threat", Anchor::Middle);
}

const DASHES: &str = "9 5";
const DOTS: &str = "2 4";
