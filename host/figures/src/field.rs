//! `field`: the field under a case drawing: surface, lines and goals of a league; the goals in the paper's
//! colours.

use casebase::FieldMm;

use super::svg::Svg;
use super::theme::Colors;

/// The part of the page that the field with its goals and margin takes: from −x, −y to +x, +y, mm.
pub fn half_extent(field: &FieldMm) -> [f64; 2] {
    let room = |side: i32| f64::from(side) * 0.5 + f64::from(field.margin.max(ROOM));
    [room(field.length), room(field.width)]
}

/// Field surface, then lines and goals.
pub fn draw(svg: &mut Svg, field: &FieldMm, colors: &Colors) {
    let [x, y] = half_extent(field);
    let Colors { surface, .. } = colors;
    svg.rect([-x, -y], [x, y], format_args!(r#"fill="{surface}""#));
    lines(svg, field, colors, colors.line);
}

/// Lines and goals alone, over existing elements.
pub fn lines(svg: &mut Svg, field: &FieldMm, colors: &Colors, line: &str) {
    let [x, y] = [f64::from(field.length) * 0.5, f64::from(field.width) * 0.5];
    let style = format!(r#"fill="none" stroke="{line}" stroke-width="{LINE}""#);
    for (sign, fill) in [(-1.0, colors.yellow), (1.0, colors.cyan)] {
        let area = [f64::from(field.penalty_depth), f64::from(field.penalty_width) * 0.5];
        svg.rect([sign * x, -area[1]], [sign * (x - area[0]), area[1]], &style);
        let half = f64::from(field.goal_width) * 0.5;
        let goal = format_args!(r#"fill="{fill}" stroke="{line}" stroke-width="{LINE}""#).to_string();
        svg.rect([sign * x, -half], [sign * (x + GOAL_DEPTH), half], goal);
    }
    svg.rect([-x, -y], [x, y], &style);
    svg.line([0.0, -y], [0.0, y], &style);
}

/// Width of the field's lines, mm: the four-legged league's 25 mm.
const LINE: f64 = 25.0;
/// Drawn depth of a goal, mm: a symbol, since `league.toml` does not contain it.
const GOAL_DEPTH: f64 = 180.0;
/// Minimum field surface drawn around the lines, mm: room for the goals.
const ROOM: i32 = 260;
