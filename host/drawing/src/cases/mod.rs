//! `cases`: figures of a case base as SVG text, in mm of the field.

mod case;
mod description;
mod heat;
mod labels;
mod sheet;

pub use case::{CasePicture, Overlay, case_picture};
pub use heat::{CATEGORIES_MAX, HeatMap, Scale, heat_map, heat_maps};
pub use sheet::sheet;
