//! `drawing`: the project's drawing library. The only SVG writer, palette and field of all figures. Runs on
//! the PC.
//!
//! Cases and coverage ([`cases`]), trials (`arena`) and the evaluation's plots and maps (`report`) are
//! drawn with it. Coordinates have y up, as on the field and in a chart; [`Svg::finish`] sets the size of the
//! unit on a screen.
#![cfg_attr(doctest, doc = include_str!("../README.md"))]
#![forbid(unsafe_code)]

pub mod cases;
mod field;
mod svg;
mod theme;

pub use field::{draw as draw_field, half_extent, lines as field_lines};
pub use svg::{Anchor, At, Font, Svg, width, wrapped};
pub use theme::{Colors, Theme};
