//! `paper`: results of the second paper's team. Biswas et al. 2014, Tables 1 and 2: RoboCup 2013, 6 against 6
//! on 6 × 4 m.

use serde::Serialize;

/// A row of Table 2.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PaperGame {
    /// The paper's letter for the opponents.
    pub opponent: &'static str,
    /// Round robin, quarter final, semi-final, final.
    pub stage: &'static str,
    /// For and against, without shoot-outs.
    pub goals: [u32; 2],
    /// Time of the ball in their half over that in the own.
    pub offence_ratio: f64,
    /// Own shots over theirs.
    pub attack_ratio: f64,
}

/// A row of Table 1: passes by the Coerce and Attack Planner.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct PaperPasses {
    /// The paper's letter for the opponents.
    pub opponent: &'static str,
    /// Number of passes tried.
    pub attempts: u32,
    /// Number of passes that arrived.
    pub successes: u32,
    /// Coercing robots that attacked.
    pub reuses: u32,
}

const fn game(
    opponent: &'static str,
    stage: &'static str,
    goals: [u32; 2],
    offence_ratio: f64,
    attack_ratio: f64,
) -> PaperGame {
    PaperGame { opponent, stage, goals, offence_ratio, attack_ratio }
}

const fn passes(opponent: &'static str, attempts: u32, successes: u32, reuses: u32) -> PaperPasses {
    PaperPasses { opponent, attempts, successes, reuses }
}

/// Table 2: the six games, in the paper's order.
#[allow(clippy::approx_constant, reason = "Team F's attack ratio, not a circle's")]
pub const PAPER: [PaperGame; 6] = [
    game("G", "RR", [2, 0], 1.38, 1.82),
    game("F", "RR", [10, 0], 1.48, 3.14),
    game("C", "RR", [2, 1], 2.57, 1.9),
    game("E", "QF", [2, 0], 1.78, 1.55),
    game("H", "SF", [2, 0], 1.13, 1.75),
    game("B", "F", [2, 2], 1.63, 1.09),
];

/// Table 1: passes of the planner in five games.
pub const PAPER_PASSES: [PaperPasses; 5] = [
    passes("G", 11, 6, 0),
    passes("F", 6, 5, 4),
    passes("C", 16, 13, 6),
    passes("H", 11, 11, 0),
    passes("B", 4, 2, 0),
];
