//! `picture`: output of figures as SVG or PNG. An SVG as it is, or as a PNG that is equal on every machine:
//! its letters come from the font in `fonts`, never from what is installed.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{self, fontdb};

use crate::Failure;

/// Writes the SVG, or its PNG when the name ends in `.png`.
pub(crate) fn write(file: &Path, svg: &str) -> Result<(), Failure> {
    let written = if has_extension(file, "png") {
        png(svg).and_then(|bytes| std::fs::write(file, bytes).map_err(|error| error.to_string()))
    } else {
        std::fs::write(file, svg).map_err(|error| error.to_string())
    };
    written.map_err(|words| Failure::Picture { file: file.to_owned(), words })
}

/// For clap: the file name of a figure, of one of these kinds.
pub(crate) fn named(text: &str, kinds: &[&str]) -> Result<PathBuf, String> {
    let file = PathBuf::from(text);
    if kinds.iter().any(|kind| has_extension(&file, kind)) {
        return Ok(file);
    }
    let kinds: Vec<_> = kinds.iter().map(|kind| format!(".{kind}")).collect();
    Err(format!("expected a name that ends in {}", kinds.join(" or ")))
}

/// Whether the name has this extension, in upper or lower case.
pub(crate) fn has_extension(file: &Path, wanted: &str) -> bool {
    file.extension().and_then(OsStr::to_str).is_some_and(|extension| extension.eq_ignore_ascii_case(wanted))
}

/// The SVG as a PNG, [`SCALE`] pixels for each of its own.
fn png(svg: &str) -> Result<Vec<u8>, String> {
    let mut fonts = fontdb::Database::new();
    for font in FONTS {
        fonts.load_font_data(font.to_vec());
    }
    fonts.set_sans_serif_family(FAMILY);
    let options =
        usvg::Options { fontdb: Arc::new(fonts), font_family: FAMILY.to_owned(), ..usvg::Options::default() };
    let tree = usvg::Tree::from_str(svg, &options).map_err(|error| error.to_string())?;
    let [width, height] =
        [tree.size().width(), tree.size().height()].map(|side| (side * SCALE).round() as u32);
    let mut pixels = Pixmap::new(width, height).ok_or("it has no size")?;
    resvg::render(&tree, Transform::from_scale(SCALE, SCALE), &mut pixels.as_mut());
    pixels.encode_png().map_err(|error| error.to_string())
}

/// Pixels of a PNG for one of the SVG: sharp on a dense screen, and 300 dots an inch at 15 cm of a page.
const SCALE: f32 = 2.0;
/// A part of DejaVu Sans: the first font that the figures ask for. Its licence is stored beside it.
const FONTS: [&[u8]; 2] =
    [include_bytes!("../fonts/DejaVuSans.ttf"), include_bytes!("../fonts/DejaVuSans-Bold.ttf")];
const FAMILY: &str = "DejaVu Sans";

#[cfg(test)]
mod tests {
    use super::*;
    use case_tools::draw::{CasePicture, Theme, case_picture};

    #[test]
    fn a_case_in_every_symmetry_has_a_png_of_the_promised_size() {
        for league in case_library::LEAGUES {
            let base = league.base();
            // Every seventeenth stored case: all symmetries occur.
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
        let text = |words: &str, weight: &str| {
            let svg = format!(
                r#"<svg xmlns="http://www.w3.org/2000/svg" width="100" height="20" font-family="Helvetica, sans-serif">
                   <text x="0" y="15" font-size="12" font-weight="{weight}">{words}</text></svg>"#
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
    fn a_picture_has_a_name_that_tells_its_kind() {
        assert!(named("a.svg", &["svg", "png"]).is_ok());
        assert!(named("a.PNG", &["svg", "png"]).is_ok());
        assert_eq!(named("a.jpg", &["svg", "png"]).unwrap_err(), "expected a name that ends in .svg or .png");
        assert!(named("svg", &["svg"]).is_err());
    }

    #[test]
    fn a_faulty_svg_is_told() {
        assert!(png("<svg").is_err());
    }
}
