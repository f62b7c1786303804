//! `team`: write a team of your own. A [`Strategy`] gets the view of a moment and answers with orders;
//! [`serve`] makes a program of it that `onetwo play`, `control` and `evaluate matches` start.
//!
//! ```text
//! host ─ a line of JSON: view, and what our coach orders ─► your program
//! host ◄─ a line of JSON: orders, drawing, values ────────── your program
//! ```
//! A robot without an order of yours does what our coach orders, so that a strategy can begin with one idea.
//! Attack frame: the team attacks towards +x; m, m/s, rad, s. The lines are described in
//! docs/strategy-protocol.md; `examples/fifty_lines.rs` is a whole team.

#![forbid(unsafe_code)]

mod planner;
mod serve;

pub use host::external::{
    Pair, StrategyAnswer, StrategyBall, StrategyField, StrategyLink, StrategyOrder, StrategyPhase,
    StrategyRobot, StrategyShape, StrategyStarter, StrategyTask, StrategyView,
};
pub use planner::{PassOffer, Planner, ShotOffer};
pub use serve::{answers, serve, serve_lines};

/// Decides what robots do.
pub trait Strategy {
    /// Orders for this moment, which comes about sixty times a second; an answer must come within 80 ms.
    fn answer(&mut self, view: &StrategyView) -> StrategyAnswer;
}
