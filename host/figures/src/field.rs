//! `field`: the field under a figure: surface, lines and goals of a league, mm; the goals in the paper's
//! colours.

use casebase::FieldMm;
use rules::{AreaForm, FieldSpec};

use super::svg::{At, Svg};
use super::theme::Colors;

/// Lines, goals and surface of a field as they are drawn, mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FieldLines {
    length: f64,
    width: f64,
    margin: f64,
    goal_width: f64,
    goal_depth: f64,
    area_depth: f64,
    area_width: f64,
    area_form: AreaForm,
    /// 0 where the league has no centre circle.
    center_radius: f64,
}

impl From<&FieldMm> for FieldLines {
    fn from(field: &FieldMm) -> Self {
        Self {
            length: f64::from(field.length),
            width: f64::from(field.width),
            margin: f64::from(field.margin),
            goal_width: f64::from(field.goal_width),
            goal_depth: GOAL_DEPTH,
            area_depth: f64::from(field.penalty_depth),
            area_width: f64::from(field.penalty_width),
            area_form: AreaForm::Box,
            center_radius: 0.0,
        }
    }
}

impl From<&FieldSpec> for FieldLines {
    fn from(field: &FieldSpec) -> Self {
        Self {
            length: mm(field.length),
            width: mm(field.width),
            margin: mm(field.margin),
            goal_width: mm(field.goal_width),
            goal_depth: mm(field.goal_depth),
            area_depth: mm(field.penalty_depth),
            area_width: mm(field.penalty_width),
            area_form: field.penalty_form,
            center_radius: mm(field.center_radius),
        }
    }
}

fn mm(metres: f32) -> f64 {
    f64::from(metres) * 1000.0
}

/// The part of the page that the field with its goals and margin takes: from −x, −y to +x, +y, mm.
pub fn half_extent(field: impl Into<FieldLines>) -> At {
    let field = field.into();
    [field.length, field.width].map(|side| side * 0.5 + field.margin.max(MARGIN_MIN))
}

/// Draws the field surface, then lines and goals.
pub fn draw(svg: &mut Svg, field: impl Into<FieldLines>, colors: &Colors) {
    let field = field.into();
    let [x, y] = half_extent(field);
    let Colors { surface, .. } = colors;
    svg.rect([-x, -y], [x, y], format_args!(r#"fill="{surface}""#));
    lines(svg, field, colors, colors.line);
}

/// Draws lines and goals alone, over existing elements.
pub fn lines(svg: &mut Svg, field: impl Into<FieldLines>, colors: &Colors, line: &str) {
    let field = field.into();
    let [x, y] = [field.length * 0.5, field.width * 0.5];
    let stroke = format!(r#"stroke="{line}" stroke-width="{LINE_WIDTH}""#);
    let style = format!(r#"fill="none" {stroke}"#);
    for (sign, fill) in [(-1.0, colors.yellow), (1.0, colors.cyan)] {
        match field.area_form {
            AreaForm::Box => {
                let area = [field.area_depth, field.area_width * 0.5];
                svg.rect([sign * x, -area[1]], [sign * (x - area[0]), area[1]], &style);
            }
            AreaForm::QuarterCircles => svg.polyline(&field.rounded_area(sign), &stroke),
        }
        let half = field.goal_width * 0.5;
        let goal = format!(r#"fill="{fill}" {stroke}"#);
        svg.rect([sign * x, -half], [sign * (x + field.goal_depth), half], goal);
    }
    svg.rect([-x, -y], [x, y], &style);
    svg.line([0.0, -y], [0.0, y], &style);
    if field.center_radius > 0.0 {
        svg.circle([0.0, 0.0], field.center_radius, &style);
    }
}

impl FieldLines {
    /// Border of a defence area of two quarter circles with a line between them, at the goal on side `sign`.
    fn rounded_area(&self, sign: f64) -> Vec<At> {
        let (x, straight) = (self.length * 0.5, self.area_width * 0.5 - self.area_depth);
        let mut border = Vec::new();
        for (side, steps) in [(-1.0, [0, 1, 2, 3, 4, 5, 6, 7, 8]), (1.0, [8, 7, 6, 5, 4, 3, 2, 1, 0])] {
            for step in steps {
                let (across, along) = (f64::from(step) * std::f64::consts::FRAC_PI_2 / 8.0).sin_cos();
                let depth = self.area_depth * across;
                border.push([sign * (x - depth), side * (straight + self.area_depth * along)]);
            }
        }
        border
    }
}

/// Width of the field's lines, mm: the four-legged league's 25 mm.
const LINE_WIDTH: f64 = 25.0;
/// Drawn depth of a goal, mm: a symbol, since `league.toml` does not contain it.
const GOAL_DEPTH: f64 = 180.0;
/// Minimum field surface drawn around the lines, mm: room for the goals.
const MARGIN_MIN: f64 = 260.0;

#[cfg(test)]
mod tests {
    use rules::League;

    use super::*;

    #[test]
    fn quarter_circles_end_on_the_goal_line_and_are_as_deep_as_the_area() {
        let field = FieldLines::from(&League::Ssl2013.field());
        assert_eq!(field.area_form, AreaForm::QuarterCircles);
        let border = field.rounded_area(1.0);
        let (first, last) = (border[0], border[border.len() - 1]);
        assert!((first[0] - field.length * 0.5).abs() < 1e-6 && (last[0] - first[0]).abs() < 1e-6);
        assert!((first[1] + field.area_width * 0.5).abs() < 1e-6 && (last[1] + first[1]).abs() < 1e-6);
        let deepest = border.iter().map(|place| place[0]).fold(f64::INFINITY, f64::min);
        assert!((deepest - (field.length * 0.5 - field.area_depth)).abs() < 1e-6, "{deepest}");
    }
}
