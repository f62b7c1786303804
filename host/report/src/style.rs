//! `style`: style sheet of the report; in dark mode the same figures change their colours by rule.

use std::fmt::Write as _;

use figures::{Colors, Theme};

use crate::map::{CHANCE, LOST, SHADES};
use crate::plot::GRID;

/// The style sheet, dark colours of figures included.
pub(crate) fn sheet() -> String {
    let mut css = include_str!("report.css").to_owned();
    css += "@media screen and (prefers-color-scheme: dark) {\n";
    for (light, dark) in pairs() {
        let _ =
            writeln!(css, "svg [fill=\"{light}\"]{{fill:{dark}}}svg [stroke=\"{light}\"]{{stroke:{dark}}}");
    }
    // A field's lines are white on a light field surface, as the paper is.
    let line = Theme::Dark.colors().line;
    let white = Theme::Light.colors().line;
    let _ = writeln!(css, ".maps svg [stroke=\"{white}\"]{{stroke:{line}}}");
    css += "}\n";
    css
}

/// A figure's colours on a light and on a dark page.
fn pairs() -> Vec<(&'static str, &'static str)> {
    let (light, dark) = (Theme::Light.colors(), Theme::Dark.colors());
    let of = |c: &Colors| {
        [c.paper, c.surface, c.ink, c.faint, c.ball, c.team, c.opponent, c.path, c.warning, c.yellow, c.cyan]
    };
    let mut pairs: Vec<_> = of(light).into_iter().zip(of(dark)).collect();
    // The scale is reversed: on a dark page more is brighter.
    pairs.extend(SHADES.into_iter().zip(SHADES.into_iter().rev()));
    // Greys keep the contrast to the page that they have on white.
    pairs.extend([("#8c8c8c", "#7d8488"), ("#c4c4c4", "#4a5156")]);
    pairs.extend([(GRID, "#363c40"), (LOST, "#ff7cc0"), (CHANCE, "#79b3f2")]);
    pairs
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_colour_has_one_dark_one() {
        let mut light: Vec<_> = pairs().into_iter().map(|(light, _)| light).collect();
        let all = light.len();
        light.sort_unstable();
        light.dedup();
        assert_eq!(light.len(), all, "a colour with two dark ones");
    }
}
