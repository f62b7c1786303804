//! `whatif`: text and data of a counterfactual. mm, field frame.

use case_tools::{Counterfactual, CounterfactualObstacle, Entity};
use serde::Serialize;

use super::NameOf;
use super::answer::rounded;

/// Single changes that would make one case the winner, or why there is none.
#[derive(Debug, Serialize)]
pub(super) struct WhatIf {
    id: u16,
    #[serde(flatten)]
    answer: WhatIfLine,
}

#[derive(Debug, Serialize)]
#[serde(untagged)]
enum WhatIfLine {
    Move {
        moved: &'static str,
        /// Robot id, or number of the opponent from 1.
        #[serde(skip_serializing_if = "Option::is_none")]
        number: Option<usize>,
        from: [i32; 2],
        to: [i32; 2],
        distance_mm: f64,
    },
    Nothing {
        no_single_move: &'static str,
        #[serde(skip)]
        description: String,
    },
}

impl WhatIf {
    /// `None` for the winner itself.
    pub(super) fn new(name_of: NameOf<'_, '_>, id: u16, found: &Counterfactual) -> Option<Self> {
        let answer = match *found {
            Counterfactual::Winner => return None,
            Counterfactual::Move(found) => {
                let (moved, number) = match found.entity {
                    Entity::Ball => ("ball", None),
                    Entity::Teammate(robot) => ("robot", Some(usize::from(robot.number()))),
                    Entity::Opponent(index) => ("opponent", Some(index + 1)),
                };
                let [from, to] = [found.from, found.to].map(|point| [point.x, point.y]);
                WhatIfLine::Move { moved, number, from, to, distance_mm: rounded(found.distance_mm, 1.0) }
            }
            Counterfactual::NoSingleMove(obstacle) => {
                let (no_single_move, description) = reported_obstacle(name_of, obstacle);
                WhatIfLine::Nothing { no_single_move, description }
            }
        };
        Some(Self { id, answer })
    }

    pub(super) fn id(&self) -> u16 {
        self.id
    }

    /// `would win if …` or `cannot win …`.
    pub(super) fn text(&self) -> String {
        match &self.answer {
            WhatIfLine::Move { moved, number, to: [x, y], distance_mm, .. } => {
                let number = number.map_or(String::new(), |number| format!(" {number}"));
                let article = if number.is_empty() { "the " } else { "" };
                format!("would win if {article}{moved}{number} moved by {distance_mm} mm, to ({x}, {y})")
            }
            WhatIfLine::Nothing { description, .. } => description.clone(),
        }
    }
}

fn reported_obstacle(name_of: NameOf<'_, '_>, obstacle: CounterfactualObstacle) -> (&'static str, String) {
    match obstacle {
        CounterfactualObstacle::Robots { needed, present } => {
            ("robots", format!("cannot win: it needs {needed} robots, {present} are present"))
        }
        CounterfactualObstacle::Conditions { winner, fulfilled, most } => {
            let name = name_of(winner);
            (
                "conditions",
                format!("cannot win while {name} fulfils {fulfilled} conditions: it has {most} at most"),
            )
        }
        CounterfactualObstacle::Several { tried } => {
            ("several", format!("no single move makes it win ({tried} were tried)"))
        }
    }
}
