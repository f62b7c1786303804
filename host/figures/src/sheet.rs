//! `sheet`: one page with a small figure of every case of a library, grouped by region.

use crate::{Anchor, Font, Svg, Theme, half_extent};

use super::case::{CasePicture, small};

/// The cases as small figures on one page, in the order given; a change of region starts a row. Scopes and
/// symbols are as in [`case_picture`](crate::case_picture), without letters, intents and captions.
pub fn sheet(title: &str, pictures: &[CasePicture<'_>]) -> String {
    let mut page = Svg::default();
    let colors = pictures.first().map_or(Theme::default(), |picture| picture.theme).colors();
    let [x, y] = pictures.first().map_or([1.0; 2], |picture| half_extent(&picture.base.field()));
    let (gap, text) = (x * 0.09, x * 0.12);
    let step = [2.0 * x + gap, 2.0 * y + gap + text * 1.4];
    let heading = |size: f64| Font { size, fill: colors.ink, bold: true, halo: None };
    page.text([0.0, 0.0], title, Anchor::Start, heading(text * 1.5));
    let mut down = -text;
    let mut column = 0;
    let mut before = None;
    for picture in pictures {
        let (region, name) = picture.name.split_once('/').unwrap_or(("", picture.name));
        if before != Some(region) {
            if column > 0 {
                down -= step[1];
            }
            (column, before) = (0, Some(region));
            down -= text * 1.7;
            page.text([0.0, down], region, Anchor::Start, heading(text * 1.3));
        } else if column == COLUMNS {
            (column, down) = (0, down - step[1]);
        }
        let left = step[0] * f64::from(column);
        let font = Font { size: text, fill: colors.ink, bold: false, halo: None };
        page.text([left, down - text * 1.4], name, Anchor::Start, font);
        page.inset(&small(picture, SYMBOL_ZOOM), [left + x, down - text * 1.8 - y]);
        column += 1;
    }
    down -= step[1];
    let right = step[0] * f64::from(COLUMNS) - gap;
    let font = Font { size: text, fill: colors.faint, bold: false, halo: None };
    page.text([0.0, down - text], LEGEND, Anchor::Start, font);
    let edge = gap;
    let lower = [-edge, down - text - edge];
    page.finish(lower, [right + edge, text * 1.6 + edge], CASE_WIDTH_PX / (2.0 * x), colors.paper, title)
}

/// Figures in a row.
const COLUMNS: u32 = 8;
/// Enlargement of symbols over those of a single figure: so that they are recognisable at a quarter of its
/// size.
const SYMBOL_ZOOM: f64 = 1.7;
/// Width of a case's figure on a screen, px.
const CASE_WIDTH_PX: f64 = 220.0;
const LEGEND: &str = "Orange: the ball, and where it may lie. Blue: robots. Grey: opponents in their scopes. \
     Green: the path of the ball, leg by leg. Dashed arrows: ways of robots.";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_library_without_a_case_has_an_empty_sheet() {
        let svg = sheet("none & nothing", &[]);
        assert!(svg.contains("none &amp; nothing") && svg.ends_with("</svg>\n"));
    }
}
