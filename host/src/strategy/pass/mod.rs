//! `pass`: passes: where, when, to whom, and their outcome (Biswas et al. 2014 §3: pass location and
//! pass-ahead).
//!
//! | question | answer |
//! |---|---|
//! | Which constants? | [`constants`] |
//! | How likely is a pass to x a goal, and why? (equations 3–5, c1–c5, c1'–c4') | [`scene`], of [`conditions`], [`intercept`], [`open`], [`reach`], [`kicks`] |
//! | Is a shot now likelier than all that? | [`shot`] |
//! | Which x is best for a receiver, near the one of a moment ago? | [`search`] |
//! | When do passer and receiver start, and when is the ball kicked? (Algorithm 1) | [`ahead`] |
//! | What became of a pass, and how good was the prediction? | [`watch`], [`tally`] |
//! | Which x near the place that a case proposes? | [`bridge`] |
//!
//! Attack frame, SI units; [`watch`] follows the world in the field frame. No I/O, no clock; what is random is seeded.

pub mod ahead;
pub mod bridge;
pub mod conditions;
pub mod constants;
pub mod intercept;
pub mod kicks;
pub mod open;
pub mod reach;
pub mod scene;
pub mod search;
pub mod shot;
pub mod tally;
pub mod watch;

pub use ahead::{Moves, PassAhead, PasserMove, Places, Times};
pub use constants::PassConstants;
pub use kicks::{Kicks, PassKick};
pub use scene::{Rating, Scene};
pub use search::{Offer, SAMPLES, Search, Searches};
pub use tally::PassTally;
pub use watch::{Ordered, PassWatch, Verdict};
