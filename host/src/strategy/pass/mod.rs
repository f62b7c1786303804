//! `pass`: place, time, receiver and outcome of passes (Biswas et al. 2014 §3: pass location and pass-ahead).
//!
//! | topic | module |
//! |---|---|
//! | Constants | [`constants`] |
//! | Probability that a pass to x leads to a goal, with its factors (equations 3–5, c1–c5, c1'–c4') | [`scene`], of [`conditions`], [`intercept`], [`open`], [`reach`], [`kicks`] |
//! | Probability of a goal by a direct shot | [`shot`] |
//! | Best x for a receiver, near the previous one | [`search`] |
//! | Start times of passer and receiver, and time of the kick (Algorithm 1) | [`ahead`] |
//! | Outcome of a pass, and quality of the prediction | [`watch`], [`counters`] |
//! | Best x near the place that a case proposes | [`bridge`] |
//!
//! Attack frame, SI units; [`watch`] follows the world in the field frame. No I/O, no clock; random numbers
//! are seeded.

pub mod ahead;
pub mod bridge;
pub mod conditions;
pub mod constants;
pub mod counters;
pub mod intercept;
pub mod kicks;
pub mod open;
pub mod reach;
pub mod scene;
pub mod search;
pub mod shot;
pub mod watch;

pub use ahead::{Moves, PassAhead, PasserMove, Places, Times};
pub use constants::PassConstants;
pub use counters::PassCounters;
pub use kicks::{Kicks, PassKick};
pub use scene::{PassScene, Rating};
pub use search::{Offer, PassSearch, SAMPLES, Search};
pub use watch::{Ordered, PassVerdict, PassWatch};
