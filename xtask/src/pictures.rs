//! Where do the pictures in the documentation come from? From here: `cargo xtask pictures` draws them anew.

use crate::context::{Context, Failure, run};

/// Draws every picture.
pub(crate) fn draw(context: &Context) -> Result<(), Failure> {
    PICTURES.iter().try_for_each(|line| run(&mut context.cargo(&format!("run --release -- {line}"))))
}

/// What the program is asked for each.
const PICTURES: [&str; 1] = [
    // What README's first command plays.
    "play --svg docs/trial.svg",
];
