//! `pitch`: goals and boards. Goals with posts, bars and nets, boards at the margin; m, field frame.

use rules::FieldSpec;
use serde::{Deserialize, Serialize};

use super::parameters::FieldParameters;
use super::surface::Slab;

/// The field with the obstacles on it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pitch {
    /// Lines, goals and margins.
    pub field: FieldSpec,
    /// Boards and bars, which crate `rules` does not contain.
    pub around: FieldParameters,
}

impl Pitch {
    /// The corner of the field surface in the positive quarter, at the boards, m.
    pub fn corner(&self) -> [f32; 2] {
        [self.field.length * 0.5 + self.field.goal_line_margin, self.field.width * 0.5 + self.field.margin]
    }

    /// The walls of the goal at +x, two sides and the back; the other goal is its mirror image.
    pub(super) fn goal_walls(&self) -> [Slab; 3] {
        let (line, half, wall) = (self.field.length * 0.5, self.field.goal_width * 0.5, self.field.goal_wall);
        let back = line + self.field.goal_depth;
        [
            Slab { x: [line, back + wall], y: [half, half + wall] },
            Slab { x: [line, back + wall], y: [-half - wall, -half] },
            Slab { x: [back, back + wall], y: [-half - wall, half + wall] },
        ]
    }
}
