//! `shape`: shapes of overlays. Named layers of plain shapes: a scene can contain any overlay, and the page
//! need not know what it means. m, field frame.

use serde::{Deserialize, Serialize};

/// A layer that viewers switch on and off.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Layer {
    /// Name of the layer in addresses and settings: `case-scopes`.
    pub name: String,
    /// The label in the page's list.
    pub label: String,
    /// Visible unless the viewer switches it off.
    pub on: bool,
    /// Drawn in this order.
    pub shapes: Vec<Shape>,
}

/// Meaning of a shape; the page has a colour for each, in light and dark mode.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Tone {
    /// Of the blue team.
    Blue,
    /// Of the yellow team.
    Yellow,
    /// Of the ball, such as its path.
    Ball,
    /// Of a retrieved case, such as scopes.
    Case,
    /// A region that robots must not enter.
    Forbidden,
    /// A favourable place or state.
    Good,
    /// Neutral: none of the others.
    Plain,
}

/// A shape on the field.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "is", rename_all = "lowercase")]
pub enum Shape {
    /// An ellipse along the axes.
    Ellipse {
        /// Position of its middle, m.
        at: [f32; 2],
        /// Half axes along x and y.
        radii: [f32; 2],
        /// Meaning, from which the page takes its colour.
        tone: Tone,
        /// Filled transparently; else only its outline.
        fill: bool,
        /// Displayed where the viewer points at it.
        #[serde(default, skip_serializing_if = "String::is_empty")]
        note: String,
    },
    /// A closed region with straight sides.
    Polygon {
        /// Corners in order, m.
        points: Vec<[f32; 2]>,
        /// Meaning, from which the page takes its colour.
        tone: Tone,
        /// Filled transparently; else only its outline.
        fill: bool,
        /// Displayed where the viewer points at it.
        #[serde(default, skip_serializing_if = "String::is_empty")]
        note: String,
    },
    /// All points within `radius` of a stretch.
    Capsule {
        /// One end of the stretch, m.
        from: [f32; 2],
        /// The other end, m.
        to: [f32; 2],
        /// Radius of the capsule.
        radius: f32,
        /// Meaning, from which the page takes its colour.
        tone: Tone,
        /// Displayed where the viewer points at it.
        #[serde(default, skip_serializing_if = "String::is_empty")]
        note: String,
    },
    /// A path of straight stretches.
    Line {
        /// Points in order, m.
        points: Vec<[f32; 2]>,
        /// Meaning, from which the page takes its colour.
        tone: Tone,
        /// With a head at its end.
        arrow: bool,
        /// Drawn dashed instead of solid.
        dashed: bool,
    },
    /// A label on the field.
    Text {
        /// Position of its middle, m.
        at: [f32; 2],
        /// Text of the label.
        text: String,
        /// Meaning, from which the page takes its colour.
        tone: Tone,
    },
    /// A map of values.
    Heat(Heat),
}

/// Values over a grid.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Heat {
    /// The corner with the least x and y.
    pub low: [f32; 2],
    /// The corner with the largest x and y.
    pub high: [f32; 2],
    /// Number of cells along x.
    pub columns: u32,
    /// Row by row, least y first, 0 (nothing, not drawn) to 255.
    pub cells: Vec<u8>,
    /// The value that 255 stands for, a probability.
    pub most: f32,
    /// Displayed with the value of a place where the viewer points at it: "a pass to here arrives".
    pub note: String,
}
