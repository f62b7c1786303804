//! What does a case base look like? Pictures as SVG text, in mm of the field, without a dependency.

mod case;
mod field;
mod heat;
mod labels;
mod sheet;
mod svg;
mod theme;
mod words;

pub use case::{CasePicture, Overlay, case_picture};
pub use heat::{CATEGORIES_MAX, HeatMap, Scale, heat_map, heat_maps};
pub use sheet::sheet;
pub use theme::Theme;
