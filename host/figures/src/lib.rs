//! `figures`: figures and tables of the whole project. Runs on the PC.
//!
//! ```text
//! Svg, Theme ─┬─► field ─► case, sheet, heat map ─────────┐
//!             └─► Axis ──► Panel ──► Figure ──────────────┼─► SVG files, or a Page of HTML
//!                                    Table ───────────────┴─► text, Markdown, HTML
//! ```
//! Coordinates have y up, as on the field and in a chart: mm on fields, px in charts; [`Svg::finish`] sets
//! the size of the unit on a screen.
#![cfg_attr(doctest, doc = include_str!("../README.md"))]
#![forbid(unsafe_code)]

mod axis;
mod case;
mod dots;
mod field;
mod heat;
mod labels;
pub mod numbers;
mod page;
mod plot;
mod sheet;
mod svg;
mod table;
mod theme;
mod verdict;

pub use axis::{AXIS_HEIGHT, Axis, GRID_COLOR};
pub use case::{CasePicture, Overlay, case_picture};
pub use dots::{Dot, DotRow, dot_axis, dot_panel};
pub use field::{FieldLines, draw as draw_field, half_extent, lines as field_lines};
pub use heat::{CATEGORIES_MAX, HeatMap, Scale, heat_maps, scale_bar, shade, squares};
pub use page::{Page, dark_colors, palette};
pub use plot::{Figure, FigureFile, Key, PANEL_WIDTH, Panel, Shape, mark_style, whisker};
pub use sheet::sheet;
pub use svg::{Anchor, At, Font, Svg, width, wrapped};
pub use table::{Cell, Column, ColumnKind, Row, Table};
pub use theme::{Colors, Theme};
