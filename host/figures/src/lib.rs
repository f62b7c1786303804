//! `figures`: the project's figures. The only SVG writer, palette and field of all figures. Runs on the PC.
//!
//! Cases and coverage, trials (`arena`) and the evaluation's plots and maps (`report`) are
//! drawn with it. Coordinates have y up, as on the field and in a chart; [`Svg::finish`] sets the size of the
//! unit on a screen.
#![cfg_attr(doctest, doc = include_str!("../README.md"))]
#![forbid(unsafe_code)]

mod case;
mod field;
mod heat;
mod labels;
mod sheet;
mod svg;
mod theme;
mod verdict;

pub use case::{CasePicture, Overlay, case_picture};
pub use field::{draw as draw_field, half_extent, lines as field_lines};
pub use heat::{CATEGORIES_MAX, HeatMap, Scale, heat_map, heat_maps};
pub use sheet::sheet;
pub use svg::{Anchor, At, Font, Svg, width, wrapped};
pub use theme::{Colors, Theme};
