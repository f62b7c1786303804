//! `page`: skeleton and style of HTML pages. One file: no network, no scripts; light, dark and on paper.

use std::fmt::Write as _;

use maud::{DOCTYPE, Markup, PreEscaped, html};

use crate::axis::GRID_COLOR;
use crate::{Colors, Theme};

/// A page around its contents.
#[derive(Clone, Debug)]
pub struct Page<'a> {
    /// Title and heading.
    pub title: &'a str,
    /// Rules of style beside those that all pages share; may be empty.
    pub style: String,
    /// Contents below the heading.
    pub header: Markup,
    /// The sections.
    pub main: Markup,
}

impl Page<'_> {
    /// The page as one HTML document.
    pub fn html(&self) -> String {
        let page = html! {
            (DOCTYPE)
            html lang="en" {
                head {
                    meta charset="utf-8";
                    meta name="viewport" content="width=device-width, initial-scale=1";
                    meta name="color-scheme" content="light dark";
                    title { (self.title) }
                    style { (PreEscaped(STYLE)) (PreEscaped(dark_colors(&palette()))) (PreEscaped(&self.style)) }
                }
                body {
                    header { h1 { (self.title) } (self.header) }
                    main { (self.main) }
                }
            }
        };
        page.into_string()
    }
}

/// Rules of style by which figures change these colours, light to dark, on a dark page.
pub fn dark_colors(pairs: &[(&str, &str)]) -> String {
    let mut rules = "@media screen and (prefers-color-scheme: dark) {\n".to_owned();
    for (light, dark) in pairs {
        // Writing to a String cannot fail.
        let _ =
            writeln!(rules, "svg [fill=\"{light}\"]{{fill:{dark}}}svg [stroke=\"{light}\"]{{stroke:{dark}}}");
    }
    rules + "}\n"
}

/// Colours of every figure on a light page and on a dark one.
pub fn palette() -> Vec<(&'static str, &'static str)> {
    let [light, dark] = [Theme::Light, Theme::Dark].map(|theme| figure_colors(theme.colors()));
    let mut pairs: Vec<_> = light.into_iter().zip(dark).collect();
    pairs.push((GRID_COLOR, "#363c40"));
    pairs
}

/// All colours but the field's lines: these are white on a light field surface, as the paper is.
fn figure_colors(c: &Colors) -> [&'static str; 11] {
    [c.paper, c.surface, c.ink, c.faint, c.ball, c.team, c.opponent, c.path, c.warning, c.yellow, c.cyan]
}

/// Rules of style of every page.
const STYLE: &str = include_str!("page.css");

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_colour_has_one_dark_one() {
        let mut light: Vec<_> = palette().into_iter().map(|(light, _)| light).collect();
        let all = light.len();
        light.sort_unstable();
        light.dedup();
        assert_eq!(light.len(), all, "a colour with two dark ones");
    }

    #[test]
    fn a_page_escapes_its_title_and_keeps_its_style() {
        let page = Page {
            title: "a < b",
            style: dark_colors(&[("#010203", "#fdfeff")]),
            header: html! { p { "header" } },
            main: html! { section { "main" } },
        };
        let html = page.html();
        assert!(html.contains("<title>a &lt; b</title>"), "{html}");
        assert!(html.contains("<h1>a &lt; b</h1><p>header</p></header><main><section>main</section></main>"));
        assert!(html.contains("svg [fill=\"#010203\"]{fill:#fdfeff}"), "{html}");
    }
}
