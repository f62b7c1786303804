//! `drawing`: what a strategy in another program shows on the page: shapes on the field, and values over
//! time. Attack frame, m.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::form::{COORDINATE_MAX_M, Pair};

/// Most shapes of an answer: the page draws them sixty times a second.
pub(super) const SHAPES_MAX: usize = 64;
/// Most values of an answer: each is a plot of its own.
pub(super) const VALUES_MAX: usize = 16;
/// Longest text of a shape and longest name of a value, bytes.
pub(super) const TEXT_MAX: usize = 40;

/// A shape on the field.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum StrategyShape {
    /// A straight line between two places of the attack frame, m.
    Line {
        /// Start of the line, m.
        from: Pair,
        /// End of the line, m.
        to: Pair,
        /// With a head at its end.
        #[serde(default)]
        arrow: bool,
    },
    /// A circle around a place of the attack frame.
    Circle {
        /// Centre of the shape, m.
        at: Pair,
        /// Radius of the circle, m.
        radius: f32,
    },
    /// A short text at a place of the attack frame.
    Text {
        /// Centre of the shape, m.
        at: Pair,
        /// At most 40 bytes.
        text: String,
    },
}

/// Shapes and values that a strategy shows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StrategyDrawing {
    /// Shapes, in the order in which they are drawn.
    pub shapes: Vec<StrategyShape>,
    /// Values by name, plotted over time.
    pub values: BTreeMap<String, f32>,
}

impl StrategyShape {
    fn is_bounded(&self) -> bool {
        let on_field = |pair: &Pair| pair.iter().all(|value| value.abs() <= COORDINATE_MAX_M);
        match self {
            Self::Line { from, to, .. } => on_field(from) && on_field(to),
            Self::Circle { at, radius } => on_field(at) && (0.0..=COORDINATE_MAX_M).contains(radius),
            Self::Text { at, text } => on_field(at) && text.len() <= TEXT_MAX,
        }
    }
}

impl StrategyDrawing {
    /// Whether the page can show it: the numbers of its parts, their places and the lengths of its texts are
    /// bounded.
    pub(super) fn is_bounded(&self) -> bool {
        self.shapes.len() <= SHAPES_MAX
            && self.shapes.iter().all(StrategyShape::is_bounded)
            && self.values.len() <= VALUES_MAX
            && self.values.iter().all(|(name, value)| name.len() <= TEXT_MAX && value.is_finite())
    }
}
