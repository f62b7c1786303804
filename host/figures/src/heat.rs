//! `heat`: heat maps: a grid of values over the field with its legend and caption.

use crate::{Anchor, At, Colors, Font, Svg, Theme, draw_field, field_lines, half_extent, width, wrapped};
use casebase::{FieldMm, PointMm};

/// A grid of values over the field.
#[derive(Clone, Debug)]
pub struct HeatMap<'a> {
    /// One line above the field.
    pub title: &'a str,
    /// Caption below the field; wrapped to its width.
    pub caption: &'a str,
    /// Dimensions of the field below the map, mm.
    pub field: FieldMm,
    /// Two opposite corners of the grid: minimum x and y, maximum x and y; mm, field frame.
    pub area: [PointMm; 2],
    /// Number of cells along x.
    pub columns: usize,
    /// Number of cells along y.
    pub rows: usize,
    /// One value a cell, row by row from the minimum y, each from the minimum x: `values[row * columns +
    /// column]`. A value that is `None`, not finite or missing is drawn as unknown.
    pub values: &'a [Option<f64>],
    /// Scale of the values.
    pub scale: Scale<'a>,
    /// The colours of page and lines.
    pub theme: Theme,
}

/// Scale of the values of a heat map.
#[derive(Clone, Copy, Debug)]
pub enum Scale<'a> {
    /// Numbers; values beyond an end are drawn in that end's colour.
    Continuous {
        /// The value of the darkest colour.
        low: f64,
        /// The value of the brightest one.
        high: f64,
        /// Unit behind each number in the legend: `" %"`, `" cases"`.
        unit: &'a str,
    },
    /// Categories: the value is a number in this list of at most [`CATEGORIES_MAX`], rounded; others are
    /// unknown.
    Categorical {
        /// Their names in the legend.
        names: &'a [&'a str],
    },
}

/// Maximum number of distinguishable categories.
pub const CATEGORIES_MAX: usize = 8;

/// Maps beside each other in one figure as an SVG, in mm, each about 900 px wide, on the paper of the first.
pub fn heat_maps(maps: &[HeatMap<'_>]) -> String {
    let mut page = Svg::default();
    let (mut across, mut low, mut high, mut px_per_mm) = (0.0, 0.0_f64, 0.0_f64, 0.1);
    for map in maps {
        let (panel, lower, upper) = panel(map);
        page.inset(&panel, [across - lower[0], 0.0]);
        across += upper[0] - lower[0];
        (low, high) = (low.min(lower[1]), high.max(upper[1]));
        px_per_mm = PANEL_WIDTH_PX / (upper[0] - lower[0]);
    }
    let titles: Vec<_> = maps.iter().map(|map| map.title).collect();
    let paper = maps.first().map_or(Theme::default(), |map| map.theme).colors().paper;
    page.finish([0.0, low], [across, high], px_per_mm, paper, &titles.join("; "))
}

/// One map, and its lower left and upper right corners.
fn panel(map: &HeatMap<'_>) -> (Svg, At, At) {
    let colors = map.theme.colors();
    let mut svg = Svg::default();
    let [x, y] = half_extent(&map.field);
    let unit = 2.0 * x / 100.0;
    draw_field(&mut svg, &map.field, colors);
    cells(&mut svg, map, colors);
    let mut over = Svg::default();
    field_lines(&mut over, &map.field, colors, "#000000");
    svg.group(&over, format_args!(r#"opacity="{LINES_OPACITY}""#));
    let font = Font { size: unit * 2.6, fill: colors.ink, bold: true, halo: None };
    svg.text([-x, y + unit * 1.6], map.title, Anchor::Start, font);
    let legend = Legend { corner: [-x, -y - unit * 1.6], half_width: x, unit, colors };
    let mut below = match map.scale {
        Scale::Continuous { low, high, unit: label } => legend.bar(&mut svg, [low, high], label),
        Scale::Categorical { names } => legend.list(&mut svg, names),
    };
    let font = Font { size: unit * 1.9, fill: colors.faint, bold: false, halo: None };
    below -= unit;
    for line in wrapped(map.caption, font.size, 2.0 * x) {
        below -= unit * 2.7;
        svg.text([-x, below], &line, Anchor::Start, font);
    }
    (svg, [-x - unit * 2.0, below - unit * 2.0], [x + unit * 2.0, y + unit * 5.5])
}

fn cells(svg: &mut Svg, map: &HeatMap<'_>, colors: &Colors) {
    let area = map.area.map(|PointMm { x, y }| [f64::from(x), f64::from(y)]);
    squares(svg, area, [map.columns, map.rows], |column, row| {
        let value = map.values.get(row * map.columns + column).copied().flatten();
        value.and_then(|value| color(value, map.scale)).unwrap_or_else(|| colors.unknown.to_owned())
    });
}

/// Fills the area between two corners with `columns` × `rows` squares of these colours; squares of one colour
/// side by side are one rectangle. Columns are counted from the left, rows from below.
pub fn squares(
    svg: &mut Svg,
    [low, high]: [At; 2],
    [columns, rows]: [usize; 2],
    color: impl Fn(usize, usize) -> String,
) {
    let step = [(high[0] - low[0]) / columns.max(1) as f64, (high[1] - low[1]) / rows.max(1) as f64];
    let mut group = Svg::default();
    for row in 0..rows {
        let bottom = low[1] + step[1] * row as f64;
        let colors: Vec<_> = (0..columns).map(|column| color(column, row)).collect();
        let mut from = 0;
        for run in colors.chunk_by(|left, right| left == right) {
            let to = from + run.len();
            let [left, right] = [from, to].map(|column| low[0] + step[0] * column as f64);
            // Neighbours share an edge: without its own stroke a viewer shows the background between them.
            let style = format!(r#"fill="{0}" stroke="{0}""#, run[0]);
            group.rect([left, bottom], [right, bottom + step[1]], style);
            from = to;
        }
    }
    svg.group(&group, r#"stroke-width="4" shape-rendering="crispEdges""#);
}

/// Draws the colours of the scale as a bar from its upper left corner.
pub fn scale_bar(svg: &mut Svg, [x, y]: At, [width, height]: At) {
    squares(svg, [[x, y - height], [x + width, y]], [SHADE_STEPS, 1], |step, _| {
        shade((step as f64 + 0.5) / SHADE_STEPS as f64)
    });
}

/// The colour of a value; `None` where it has none.
fn color(value: f64, scale: Scale<'_>) -> Option<String> {
    match scale {
        Scale::Continuous { low, high, .. } => {
            let span = high - low;
            let share = if span == 0.0 { 0.0 } else { (value - low) / span };
            share.is_finite().then(|| shade(share))
        }
        Scale::Categorical { names } => {
            let known = names.len().min(CATEGORIES_MAX);
            let index = value.round();
            let inside = index >= 0.0 && index < known as f64;
            inside.then(|| CATEGORIES[index as usize].to_owned())
        }
    }
}

/// Colour of a share of the scale from 0 to 1, in 64 steps; beyond an end, the colour of that end.
pub fn shade(share: f64) -> String {
    let steps = SHADE_STEPS as f64;
    let along = (share.clamp(0.0, 1.0) * steps).round() / steps * (SHADES.len() - 1) as f64;
    let before = (along.floor() as usize).min(SHADES.len() - 2);
    let part = along - before as f64;
    let [red, green, blue] = [0, 1, 2].map(|channel| {
        let [from, to] = [SHADES[before][channel], SHADES[before + 1][channel]].map(f64::from);
        (from + (to - from) * part).round() as u8
    });
    format!("#{red:02x}{green:02x}{blue:02x}")
}

/// Place and sizes of the legend below a map.
struct Legend {
    /// Upper left corner, mm.
    corner: At,
    /// Half of the field's width, mm.
    half_width: f64,
    /// A hundredth of the field's width, mm.
    unit: f64,
    colors: &'static Colors,
}

impl Legend {
    /// Draws the scale as a bar with five numbers; returns its lower end.
    fn bar(&self, svg: &mut Svg, [low, high]: [f64; 2], label: &str) -> f64 {
        let ([x, y], unit) = (self.corner, self.unit);
        let [width, height] = [self.half_width * 1.2, unit * 2.0];
        scale_bar(svg, [x, y], [width, height]);
        for quarter in 0..=4 {
            let share = f64::from(quarter) * 0.25;
            let anchor = match quarter {
                0 => Anchor::Start,
                4 => Anchor::End,
                _ => Anchor::Middle,
            };
            let number = number(low + (high - low) * share, high - low);
            let place = [x + width * share, y - height - unit * 2.0];
            svg.text(place, &format!("{number}{label}"), anchor, self.font());
        }
        let unknown = x + width + unit * 6.0;
        let style = format!(r#"fill="{}""#, self.colors.unknown);
        svg.rect([unknown, y], [unknown + height, y - height], style);
        svg.text([unknown + height + unit, y - height * 0.8], UNKNOWN, Anchor::Start, self.font());
        y - height - unit * 2.2
    }

    /// Draws the categories, each behind its colour; returns their lower end.
    fn list(&self, svg: &mut Svg, names: &[&str]) -> f64 {
        let ([mut across, mut down], unit) = (self.corner, self.unit);
        let known = names.iter().zip(CATEGORIES).map(|(name, fill)| (*name, fill));
        for (name, fill) in known.chain([(UNKNOWN, self.colors.unknown)]) {
            let entry_width = unit * 6.0 + width(name, self.font().size);
            if across > self.corner[0] && across + entry_width > self.half_width {
                (across, down) = (self.corner[0], down - unit * 3.0);
            }
            svg.rect([across, down], [across + unit * 2.0, down - unit * 2.0], format!(r#"fill="{fill}""#));
            svg.text([across + unit * 3.0, down - unit * 1.6], name, Anchor::Start, self.font());
            across += entry_width;
        }
        down - unit * 2.0
    }

    fn font(&self) -> Font<'static> {
        Font { size: self.unit * 1.7, fill: self.colors.ink, bold: false, halo: None }
    }
}

/// The fewest decimals that distinguish the quarters of `span`.
fn number(value: f64, span: f64) -> String {
    let decimals = if span.abs() >= 20.0 {
        0
    } else if span.abs() >= 2.0 {
        1
    } else {
        2
    };
    let text = format!("{value:.decimals$}");
    if decimals == 0 { text } else { text.trim_end_matches('0').trim_end_matches('.').to_owned() }
}

/// From dark blue to yellow, evenly brighter, also in grey and for colour-blind readers: five colours of
/// viridis (CC0).
const SHADES: [[u8; 3]; 5] =
    [[0x44, 0x01, 0x54], [0x3b, 0x52, 0x8b], [0x21, 0x91, 0x8c], [0x5e, 0xc9, 0x62], [0xfd, 0xe7, 0x25]];
/// Okabe and Ito's, the pale ones first.
const CATEGORIES: [&str; CATEGORIES_MAX] =
    ["#56b4e9", "#e69f00", "#009e73", "#f0e442", "#0072b2", "#d55e00", "#cc79a7", "#7a7a7a"];
/// Entry of the legend for cells without a value.
const UNKNOWN: &str = "not known";
/// Opacity of the black lines over the cells: the scale's darkest colours must not hide them, nor they a
/// cell.
const LINES_OPACITY: &str = "0.6";
/// Width of a map on a screen, px.
const PANEL_WIDTH_PX: f64 = 900.0;
/// Number of steps between the ends of the scale.
const SHADE_STEPS: usize = 64;

#[cfg(test)]
mod tests {
    use super::*;

    const FIELD: FieldMm = FieldMm {
        length: 5400,
        width: 3600,
        margin: 0,
        goal_width: 800,
        penalty_depth: 600,
        penalty_width: 1200,
    };

    fn map<'a>(values: &'a [Option<f64>], scale: Scale<'a>) -> HeatMap<'a> {
        let area = [PointMm { x: -2700, y: -1800 }, PointMm { x: 2700, y: 1800 }];
        let (title, caption) = ("Share <1>", "what & where");
        HeatMap {
            title,
            caption,
            field: FIELD,
            area,
            columns: 2,
            rows: 2,
            values,
            scale,
            theme: Theme::Light,
        }
    }

    #[test]
    fn a_cell_has_the_colour_of_its_value_at_its_place() {
        let values = [Some(0.0), Some(1.0), Some(0.5), None];
        let svg = heat_maps(&[map(&values, Scale::Continuous { low: 0.0, high: 1.0, unit: "" })]);
        // Half the field is 2700 × 1800 mm; a cell's upper edge is its y on the page, which grows downwards.
        for (x, y, fill) in [
            ("-2700.0", "0.0", "#440154"),
            ("0.0", "0.0", "#fde725"),
            ("-2700.0", "-1800.0", "#21918c"),
            ("0.0", "-1800.0", "#d0d0d0"),
        ] {
            let cell = format!(r#"x="{x}" y="{y}" width="2700.0" height="1800.0" fill="{fill}""#);
            assert!(svg.replace("y=\"-0.0\"", "y=\"0.0\"").contains(&cell), "{cell} in {svg}");
        }
        assert!(svg.contains("Share &lt;1&gt;") && svg.contains("what &amp; where"));
    }

    #[test]
    fn values_beyond_the_scale_have_the_colour_of_its_end() {
        let scale = Scale::Continuous { low: 10.0, high: 20.0, unit: "" };
        assert_eq!(color(-5.0, scale).as_deref(), Some("#440154"));
        assert_eq!(color(90.0, scale).as_deref(), Some("#fde725"));
        assert_eq!(color(f64::NAN, scale), None);
        // A quarter of the scale is viridis' second colour; an eighth is half way to it.
        assert_eq!(color(12.5, scale).as_deref(), Some("#3b528b"));
        assert_eq!(color(11.25, scale).as_deref(), Some("#402a70"));
    }

    #[test]
    fn a_category_without_a_name_has_no_colour() {
        let scale = Scale::Categorical { names: &["none", "one"] };
        assert_eq!(color(1.0, scale).as_deref(), Some("#e69f00"));
        assert_eq!(color(2.0, scale), None);
        assert_eq!(color(-1.0, scale), None);
    }

    #[test]
    fn missing_values_are_drawn_as_unknown() {
        let svg = heat_maps(&[map(&[], Scale::Categorical { names: &["none"] })]);
        // A rectangle for each of the two rows, as its two cells have one colour.
        assert_eq!(svg.matches(r##"width="5400.0" height="1800.0" fill="#d0d0d0" stroke"##).count(), 2);
    }
}
