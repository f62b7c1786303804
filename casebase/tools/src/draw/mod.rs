//! What does a case base look like? Pictures as SVG text, in mm of the field, without a dependency.

mod field;
mod heat;
mod svg;
mod theme;

pub use heat::{CATEGORIES_MAX, HeatMap, Scale, heat_map};
pub use theme::Theme;
