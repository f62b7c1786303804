//! `drawing`: the project's drawing library. The one writer of SVG, the one palette and the one field that
//! every picture is made of. Runs on the PC.
//!
//! Cases and coverage (`case-tools`), trials (`arena`) and the evaluation's plots and maps (`report`) are drawn with it. Places
//! are told with y up, as on the field and in a chart; [`Svg::finish`] says how large the unit is on a screen.
#![forbid(unsafe_code)]

mod field;
mod svg;
mod theme;

pub use field::{draw as draw_field, half_extent, lines as field_lines};
pub use svg::{Anchor, At, Font, Svg, width, wrapped};
pub use theme::{Colors, Theme};
