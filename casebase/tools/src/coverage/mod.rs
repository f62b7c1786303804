//! `coverage`: regions of the field where a library has no case (Ros et al. 2009, §5.1.1; Smyth & McKenna
//! 2001).
//!
//! A [`Survey`] retrieves many problems from the library and counts into a [`Counters`]. Counters of parts
//! merge to those of the whole, in any order and grouping, so a caller may distribute the work over threads
//! and always gets the same numbers. No threads, clock or I/O here. Lengths in mm; cells and areas in the
//! attack frame (+x towards the goal attacked), problems in the field frame.

mod area;
mod cells;
mod counters;
mod survey;

pub use area::Area;
pub use cells::{Cells, CellsError};
pub use counters::{
    AreaCounters, COST_BIN_MM, COST_BINS, CaseCounters, CellCounters, Counters, RINGS, Reach, VERDICTS,
    entropy_bits,
};
pub use survey::Survey;

/// The field of the tests, mm: that of 2007 without a margin.
#[cfg(test)]
const TEST_FIELD: casebase::FieldMm = casebase::FieldMm {
    length: 5400,
    width: 3600,
    margin: 0,
    goal_width: 800,
    penalty_depth: 650,
    penalty_width: 1300,
};
