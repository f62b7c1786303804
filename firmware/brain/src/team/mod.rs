//! `team`: cooperative execution of cases: the cycle of Ros et al. 2009 §4.
//!
//! ```text
//! elect      the lowest id present proposes a cycle and names its coordinator: the retriever nearest the ball
//! retrieve   the coordinator announces case, correspondence and the ball it used, or that no case fits
//! reuse      each robot involved: ADAPT → EXECUTE → WAIT END, the others WAIT END at once
//! end        the coordinator closes the cycle when all have finished; anyone involved may abort it
//! ```
//!
//! All of it is one value, [`CycleState`](protocol::team::CycleState), which only grows and is repeated in
//! every beacon; [`Cycle`] holds it. [`election`] determines which robot proposes what, [`retrieval`] makes a
//! problem of beliefs, [`reuse`] is the state machine of Fig. 10, [`monitor`] watches whether the case still
//! applies, [`hybrid`] whether acting at once would be better.

pub mod cycle;
pub mod election;
pub mod hybrid;
pub mod monitor;
pub mod retrieval;
pub mod reuse;

pub use cycle::Cycle;
