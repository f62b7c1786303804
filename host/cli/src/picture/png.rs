//! `png`: SVG drawn as pixels, with the letters of the font in `fonts` on every machine.

use std::sync::Arc;

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{self, fontdb};

/// The SVG as a PNG, [`PIXELS_PER_UNIT`] pixels for each of its own.
pub(super) fn png(svg: &str) -> Result<Vec<u8>, PngError> {
    let mut fonts = fontdb::Database::new();
    for font in FONTS {
        fonts.load_font_data(font.to_vec());
    }
    fonts.set_sans_serif_family(FONT_FAMILY);
    let options = usvg::Options {
        fontdb: Arc::new(fonts),
        font_family: FONT_FAMILY.to_owned(),
        ..usvg::Options::default()
    };
    let tree = usvg::Tree::from_str(svg, &options).map_err(PngError::Svg)?;
    let [width, height] =
        [tree.size().width(), tree.size().height()].map(|side| (side * PIXELS_PER_UNIT).round() as u32);
    let mut pixels = Pixmap::new(width, height).ok_or(PngError::Empty)?;
    resvg::render(&tree, Transform::from_scale(PIXELS_PER_UNIT, PIXELS_PER_UNIT), &mut pixels.as_mut());
    pixels.encode_png().map_err(|error| PngError::Encode(error.to_string()))
}

/// Pixels of a PNG for one of the SVG: sharp on a dense screen, and 300 dots an inch at 15 cm of a page.
const PIXELS_PER_UNIT: f32 = 2.0;
/// A part of DejaVu Sans: the letters that figures use first. Its licence lies beside it.
const FONTS: [&[u8]; 2] =
    [include_bytes!("../../fonts/DejaVuSans.ttf"), include_bytes!("../../fonts/DejaVuSans-Bold.ttf")];
const FONT_FAMILY: &str = "DejaVu Sans";

/// Why there are no pixels.
#[derive(Debug, thiserror::Error)]
pub(crate) enum PngError {
    /// The drawing is not SVG.
    #[error("{0}")]
    Svg(usvg::Error),
    /// The drawing is empty.
    #[error("it has no size")]
    Empty,
    /// The pixels cannot be encoded.
    #[error("{0}")]
    Encode(String),
}

#[cfg(test)]
mod tests {
    use super::*;
    use figures::{CasePicture, Theme, case_picture};

    #[test]
    fn a_case_in_every_symmetry_has_a_png_of_the_promised_size() {
        for league in case_library::LEAGUES {
            let base = league.base();
            // Every seventeenth stored case: all symmetries come up.
            for case in base.cases().step_by(17) {
                let picture =
                    CasePicture { base, case, name: "a/b", intent: "", overlay: None, theme: Theme::Print };
                let svg = case_picture(&picture);
                let pixels = Pixmap::decode_png(&png(&svg).unwrap()).unwrap();
                assert_eq!(pixels.width(), 1800);
            }
        }
    }

    #[test]
    fn letters_need_no_installed_font() {
        let text = |text: &str, weight: &str| {
            let svg = format!(
                r#"<svg xmlns="http://www.w3.org/2000/svg" width="100" height="20" font-family="Helvetica, sans-serif">
                   <text x="0" y="15" font-size="12" font-weight="{weight}">{text}</text></svg>"#
            );
            let pixels = Pixmap::decode_png(&png(&svg).unwrap()).unwrap();
            assert_eq!((pixels.width(), pixels.height()), (200, 40));
            pixels.pixels().iter().map(|pixel| u32::from(pixel.alpha())).sum::<u32>()
        };
        assert_eq!(text("", "normal"), 0);
        let (normal, bold) = (text("tm1 ½", "normal"), text("tm1 ½", "bold"));
        assert!(normal > 0 && bold > normal * 11 / 10, "{normal} {bold}");
    }

    #[test]
    fn a_faulty_svg_is_reported() {
        assert!(png("<svg").is_err());
    }
}
